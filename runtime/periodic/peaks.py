"""Largest steady deflection at many speeds, part by part: the motions themselves are not kept."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import LinearRangeWarning, bad, warn_of_large_deflection
from ..core.families import LinearPeriodic
from ..core.inputs import numbers
from ..core.progress import bar
from ..core.results import Check, Result, provenance
from .periodic_motion import SteadyState, steady_state

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

_PLACES = 41
# Numbers in the motions of the speeds that are taken together, 32 MiB.
_FLOATS = 2**22


@dataclass(frozen=True, kw_only=True)
class SteadyPeaks(Result):
    """Largest deflection of the periodic motion at each of many speeds.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], shape ``(ns,)``.
    peak : ndarray
        Largest size of the deflection over a period and over the places [m], shape ``(ns,)``; NaN
        where there is no single periodic motion.
    place : ndarray
        Place x/length where it is that large, shape ``(ns,)``.
    error : ndarray
        Error of ``peak`` over itself at that place, shape ``(ns,)``: of the motion, and of taking
        the largest at even angles.
    stable : ndarray of bool
        Whether the motion is stable, shape ``(ns,)``.
    distance : ndarray
        Distance of the closest multiplier from 1, shape ``(ns,)``.
    """

    speed: Array
    peak: Array
    place: Array
    stable: NDArray[np.bool_]
    distance: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        ("speed", "peak", "place", "error", "stable", "distance"), ("speed",)
    )

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the peaks over the speed, unstable motions dotted, and return the axes."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        rpm = self.speed * 30.0 / np.pi
        ax.plot(rpm, np.where(self.stable, self.peak, np.nan), lw=1.0, label="stable")
        if not np.all(self.stable):
            ax.plot(rpm, np.where(self.stable, np.nan, self.peak), ".", ms=3, label="unstable")
            ax.legend()
        ax.set_yscale("log")
        ax.set_xlabel("crank speed [rpm]")
        ax.set_ylabel("largest deflection [m]")
        return ax


def steady_peaks(
    system: LinearPeriodic,
    speed: ArrayLike,
    *,
    x: ArrayLike | None = None,
    rtol: float = 1e-9,
    progress: bool = False,
    **parameters: float,
) -> SteadyPeaks:
    """Return the largest deflection of the steady state at many speeds, in bounded memory.

    Parameters
    ----------
    system : LinearPeriodic
        The system, forced, with mode shapes.
    speed : array_like
        Crank speeds [rad/s], shape ``(ns,)``.
    x : array_like, optional
        Places x/length among which the largest deflection is sought; 41 from 0 to 1 by default.
    rtol : float
        Wanted error of the periodic motions.
    progress : bool
        Whether to show a progress bar.
    **parameters : float
        Parameter values that replace the system's.

    Returns
    -------
    SteadyPeaks
        Its checks: the worst of those of :func:`~.periodic_motion.steady_state` in all parts.

    Warns
    -----
    LinearRangeWarning
        If a deflection passes 5 % of the reference length.

    Raises
    ------
    BadInput
        As :func:`~.periodic_motion.steady_state`, and if the speeds are no row, a place is not a
        number from 0 to 1, or the system has no mode shapes.
    """
    speeds = numbers("speed", speed)
    if speeds.ndim != 1 or not len(speeds):
        raise bad("speed", f"shape {speeds.shape}", "a row of speeds [rad/s]", "give some")
    require_shapes("steady_peaks", system)
    places = np.linspace(0.0, 1.0, _PLACES) if x is None else np.atleast_1d(numbers("x", x))
    if places.ndim > 1 or not len(places) or not np.all((places >= 0) & (places <= 1)):
        raise bad("x", str(x), "places x/length from 0 to 1", "divide by the length")
    out = {name: np.full(len(speeds), np.nan) for name in ("peak", "place", "error", "distance")}
    stable = np.zeros(len(speeds), dtype=bool)
    checks: dict[str, Check] = {}
    together = max(1, _FLOATS // (512 * system.size))
    with bar(progress, len(speeds)) as tick:
        for begin in range(0, len(speeds), together):
            part = slice(begin, min(begin + together, len(speeds)))
            state = quiet_state(system, speeds[part], rtol, parameters)
            peaks = state.peak(places)
            at = places[np.argmax(np.nan_to_num(peaks), axis=1)]
            values = (np.max(peaks, axis=1), at, peak_error(state, at), state.distance)
            for row, value in zip(out.values(), values, strict=True):
                row[part] = value
            stable[part] = state.stable
            _join(checks, state.checks)
            if tick is not None:
                tick(part.stop)
    if "linear range" in checks:
        warn_of_large_deflection(checks["linear range"].value)
    return SteadyPeaks(
        method=state.method,
        error=out["error"],
        error_norm="of the largest deflection, over itself",
        checks=checks,
        provenance=provenance(system.changed_provenance(**parameters)),
        speed=speeds,
        stable=stable,
        peak=out["peak"],
        place=out["place"],
        distance=out["distance"],
    )


def require_shapes(where: str, system: LinearPeriodic) -> None:
    """Refuse a system whose deflection is not known, before work starts."""
    if system.shapes(np.zeros(1), np.zeros(1)) is None:
        fix = "take stress_curve for a structure of beams, or steady_state and its q"
        raise bad(where, "a system without mode shapes", "one with them", fix)


def quiet_state(
    system: LinearPeriodic,
    speeds: ArrayLike,
    rtol: float,
    parameters: Mapping[str, float] | None = None,
) -> SteadyState:
    """Return the steady state without a warning of the linear range; its check tells."""
    with warnings.catch_warnings():
        # At a resonance it is left as a matter of course.
        warnings.simplefilter("ignore", LinearRangeWarning)
        changes: dict[str, Any] = dict(parameters or {})
        return steady_state(system, speeds, rtol=rtol, **changes)


def _join(checks: dict[str, Check], more: Mapping[str, Check]) -> None:
    """Keep the worse of two checks of one name."""
    for name, check in more.items():
        known = checks.get(name)
        if known is None or _badness(check) > _badness(known):
            checks[name] = check


def _badness(check: Check) -> float:
    ratio = check.value / check.limit if check.limit > 0 else float(check.value > 0) * np.inf
    return float(np.nan_to_num(ratio, nan=np.inf, posinf=np.inf))


def peak_error(state: SteadyState, places: Array) -> Array:
    """Return the error of the peak deflection over itself, of a row of motions.

    ``places`` has the place x/length for each, shape ``(ns,)``.
    """
    out = np.full(len(state.speed), np.inf)
    shapes = None if state.shapes is None else state.shapes(np.unique(places), state.theta)
    if shapes is None:
        return np.full(len(state.speed), np.nan)
    column = np.searchsorted(np.unique(places), places)
    for k, (q, error) in enumerate(zip(state.q, state.error, strict=True)):
        here = shapes[:, column[k]]
        bent = np.einsum("tn,tn->t", here, q)
        top = np.max(np.abs(bent))
        if not (np.isfinite(top) and top > 0):
            continue
        error_here = float((np.max(np.abs(q), axis=0) * error) @ np.max(np.abs(here), axis=0))
        # Between even angles, a wave of harmonic k is lower at the nearest by (k step/2)^2/2.
        waves = np.abs(np.fft.rfft(bent))
        turn = float(np.sum(waves * np.arange(len(waves)) ** 2) / np.max(waves))
        out[k] = error_here / top + turn * (np.pi / len(state.theta)) ** 2 / 2
    return out
