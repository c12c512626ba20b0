"""The design method: a quiet speed, damping that helps, and a length for the run-up (7.5)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, cast

import numpy as np
from numpy.typing import ArrayLike

from ..beams.element_forms import required_structure
from ..core.errors import LINEAR_RANGE, BadInput, bad
from ..core.families import LinearPeriodic
from ..core.inputs import numbers
from ..core.plotting import Axes, axes_or_new
from ..core.progress import bar
from ..core.results import Check, Result
from ..recovery.stress_over_speed import ELSEWHERE, StressCurve, stress_curve
from .quiet import Band, QuietSpeeds, quiet_speeds
from .speed_profile import Array

# Damping ratios that are tried, over the system's own, and lengths over the design's.
_DAMPING = (1.0, 1.25, 1.5, 2.0, 3.0)
_LENGTHS = tuple(1.0 + 0.02 * k for k in range(12))


@dataclass(frozen=True, kw_only=True)
class StressEffect(Result):
    """Largest stresses over the speed for several values of one quantity.

    Attributes
    ----------
    name : str
        The quantity: ``damping_ratio``, or a length such as ``frame``.
    values : ndarray, shape (nv,)
        Its values.
    speed : ndarray, shape (ns,)
        Crank speeds [rad/s].
    links : tuple of str
        Links.
    maximum, error : ndarray, shape (nv, ns, links)
        Largest stress [Pa], and the error of each, relative.
    """

    name: str
    values: Array
    speed: Array
    links: tuple[str, ...]
    maximum: Array

    arrays_along: ClassVar = {
        "value": "values",
        "speed": "speed",
        "value speed link": "maximum error change",
    }
    exported: ClassVar[tuple[str, ...]] = ("change",)
    column_units: ClassVar = {"Pa": "maximum"}

    @property
    def change(self) -> Array:
        """Largest stress over that of the first value, ``(nv, ns, links)``: below 1 it helps."""
        return np.asarray(self.maximum / self.maximum[:1])

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the largest stress of all links over the speed, a line for each value."""
        ax = axes_or_new(ax)
        for value, rows in zip(self.values, self.maximum, strict=True):
            ax.semilogy(self.speed, np.max(rows, axis=1) / 1e6, label=f"{value:g}", linewidth=0.9)
        ax.set(xlabel="crank speed [rad/s]", ylabel="largest stress [MPa]")
        ax.legend(title=self.name.replace("_", " "))
        return ax


@dataclass(frozen=True, kw_only=True)
class RunningSpeed(Result):
    """A running speed, and how to get there.

    Attributes
    ----------
    quiet : QuietSpeeds
        Critical, limiting and quiet speeds at the design's own damping and length.
    band : Band
        The band that was chosen; where no band lies beyond a limiting critical speed, one below
        (``band.above`` is None).
    speed : float
        The running speed [rad/s], that of the least stress in the band.
    damping : StressEffect or None
        Stresses at the running speed for several damping ratios; None without modal damping.
    best_damping : float or None
        The ratio with the least largest stress there.
    length : StressEffect or None
        Stresses on the way up, for values of the length, the nearest to the design's first, up to
        the first that keeps the limits; None where nothing has to be passed.
    run_up_length : float or None
        The value nearest the design's at which every steady speed of the way is within the limits;
        None where no value that was tried is.
    links : tuple of str
        Links with a limit.
    """

    quiet: QuietSpeeds
    band: Band
    speed: float
    damping: StressEffect | None
    best_damping: float | None
    length: StressEffect | None
    run_up_length: float | None
    links: tuple[str, ...] = field(default=())

    column_units: ClassVar = {"m": "run_up_length"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the stresses over their limits with the quiet bands and the running speed."""
        ax = self.quiet.plot(ax)
        ax.axvline(self.speed, color="tab:red", linewidth=1.0)
        return ax


def running_speed(
    system: LinearPeriodic,
    speeds: tuple[float, float],
    limits: float | Mapping[str, float],
    *,
    length: str = "frame",
    values: Sequence[float] | None = None,
    highest: bool = True,
    rtol: float = 1e-3,
    progress: bool = False,
) -> RunningSpeed:
    """Return a running speed above a limiting critical speed, if there is one, and the way there.

    The steps of section 7.5: the stresses over the range (1), the first limiting critical speed
    and the quiet bands above it (2), damping at the chosen speed (3, 4), and the change of a length
    that brings the machine there within the limits (5).

    Parameters
    ----------
    system : LinearPeriodic
        Of a linkage of beams, with damping and geometry to vary.
    speeds : pair of float
        Lowest and highest crank speed [rad/s].
    limits : float or mapping of str to float
        Allowed stress [Pa], of all links or by link.
    length : str
        The length that is changed for the run-up.
    values : sequence of float, optional
        Values of it that are tried [m]; by default from the design's own to 22 % more, as far as
        the crank can turn.
    highest : bool
        Whether the highest quiet band is chosen, or the one with the least stress.
    rtol : float
        Wanted error of the stresses, relative.
    progress : bool
        Whether to show a progress bar.

    Returns
    -------
    RunningSpeed
        Its checks: those of the quiet speeds; ``within limits``, the largest stress at the running
        speed with its error over its limit; ``stable``, the largest multiplier's modulus there
        with its error.

    Raises
    ------
    BadInput
        If an argument is unusable, the system has no such length, or no speed of the range is
        within the limits and stable.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.running_speed(system, (30.0, 34.0), 200e6, values=[0.547], rtol=1e-2)
    >>> print(round(found.speed, 1), found.passed)
    32.3 True
    """
    required_structure(system)
    tried = _tried(system, length, values)
    quiet = quiet_speeds(system, speeds, limits, rtol=rtol)
    if not quiet.bands:
        least = int(np.argmin(quiet.worst))
        raise bad(
            "running_speed",
            f"stresses beyond their limits everywhere, least {quiet.worst[least]:.3g} of them at "
            f"{quiet.speed[least]:.4g} rad/s, or motions that are not stable",
            "a stable speed within the limits",
            "lower the range, raise the limits or stiffen the links",
        )
    offered = quiet.quiet or quiet.bands
    band = offered[-1] if highest else min(offered, key=lambda one: one.ratio)
    allowed = np.array(
        [limits[link] if isinstance(limits, Mapping) else limits for link in quiet.links]
    )
    place = int(np.argmin(np.abs(quiet.speed - band.best)))
    watched = [quiet.curve.links.index(link) for link in quiet.links]

    def within(maximum: Array) -> bool:
        return bool(np.all(maximum[:, watched] < allowed))

    damping = best = way = chosen = None
    first = len(_DAMPING) if "damping_ratio" in system.parameters else 0
    with bar(progress, first + len(tried)) as tick:
        if first:
            own = system.parameters["damping_ratio"]
            ratios = own * np.array(_DAMPING)
            here = quiet.curve.at(np.array([place]))
            damping = effect_of(system, "damping_ratio", ratios, here, rtol, tick=tick)
            reached = np.max(damping.maximum[:, :, watched] / allowed, axis=(1, 2))
            best = float(ratios[np.argmin(reached)])
        if band.above is not None:
            way, chosen = _way_up(
                system, quiet, place, within, length, tried, rtol, lambda done: tick(first + done)
            )
    return RunningSpeed(
        method="stress curves over speed, damping and length",
        error=float(np.max(quiet.error)),
        error_norm="largest stress over its limit, relative, the worst speed",
        checks=_checks(quiet, band, place),
        provenance=dict(quiet.provenance),
        quiet=quiet,
        band=band,
        speed=band.best,
        damping=damping,
        best_damping=best,
        length=way,
        run_up_length=chosen,
        links=quiet.links,
    )


def effect_of(
    system: LinearPeriodic,
    name: str,
    values: Array,
    speeds: ArrayLike | StressCurve,
    rtol: float,
    *,
    enough: Callable[[Array], bool] = lambda maximum: False,
    tick: Callable[[int], None] | None = None,
) -> StressEffect:
    """Return the curves for values of a damping ratio or length, up to the first that is enough.

    The curve of the first value may be known: it then stands for the speeds.  The whole equation is
    solved for that value alone: ``ELSEWHERE`` times what it changed there is part of the
    errors of the others.
    """
    change = system.with_parameters if name == "damping_ratio" else system.with_geometry
    systems = [change(**{name: float(value)}) for value in values]
    if isinstance(speeds, StressCurve):
        first = speeds
    else:
        first = stress_curve(systems[0], speeds, rtol=rtol, stability=False)
    curves: list[StressCurve] = []
    for made in systems:
        curve = first
        if curves:
            curve = stress_curve(made, first.speed, rtol=rtol, stability=False, whole=False)
        curves.append(curve)
        if tick is not None:
            tick(len(curves))
        if enough(curve.maximum):
            break
    equation = first.checks["equation"]
    errors = np.array([curve.error for curve in curves])
    errors[1:] += ELSEWHERE * equation.value
    return StressEffect(
        method=first.method,
        error=errors,
        error_norm="each largest stress, relative",
        checks={"converged": Check(float(np.max(errors)) / rtol, 1.0), "equation": equation},
        provenance=dict(first.provenance),
        name=name,
        values=values[: len(curves)],
        speed=first.speed,
        links=first.links,
        maximum=np.array([curve.maximum for curve in curves]),
    )


def _checks(quiet: QuietSpeeds, band: Band, place: int) -> dict[str, Check]:
    """Return the checks of the running speed."""
    # The linear range is that of this speed alone: at the critical speeds it is left in any case.
    curve = quiet.curve
    checks = dict(quiet.checks)
    if curve.deflection is not None:
        checks["linear range"] = Check(float(curve.deflection[place]), LINEAR_RANGE)
    doubt = float(np.asarray(quiet.error)[place])
    multiplier, error = cast(Array, curve.multiplier), cast(Array, curve.multiplier_error)
    return {
        **checks,
        "within limits": Check(band.ratio * (1.0 + doubt), 1.0),
        "stable": Check(float(multiplier[place] + error[place]), 1.0),
    }


def _way_up(
    system: LinearPeriodic,
    quiet: QuietSpeeds,
    end: int,
    within: Callable[[Array], bool],
    length: str,
    tried: Sequence[float],
    rtol: float,
    tick: Callable[[int], None],
) -> tuple[StressEffect, float | None]:
    """Return stresses on the way to a speed for several lengths, and the least change that does.

    A value passes where the steady stresses at all speeds of the way are within the limits.
    """
    own = system.geometry[length]
    every = max(1, end // 200)  # some 200 speeds of the way are looked at
    values = np.array(sorted(tried, key=lambda value: abs(value - own)))
    way = quiet.curve.at(np.arange(end % every, end + 1, every))
    known = way if values[0] == own else way.speed
    effect = effect_of(system, length, values, known, rtol, enough=within, tick=tick)
    return effect, float(effect.values[-1]) if within(effect.maximum[-1]) else None


def _tried(system: LinearPeriodic, name: str, values: Sequence[float] | None) -> list[float]:
    """Return lengths to try: those given, or from the design's own on while the crank turns."""
    own = system.geometry.get(name)
    if own is None:
        raise bad("length", repr(name), f"one of {sorted(system.geometry)}", "correct the name")
    if values is not None:
        given = np.atleast_1d(numbers("values", values))
        if given.ndim != 1 or not given.size:
            raise bad("values", str(values), "one row of lengths [m]", "give some")
        for value in given:
            system.with_geometry(**{name: float(value)})
        return [float(value) for value in given]
    found = []
    for factor in _LENGTHS:
        try:
            system.with_geometry(**{name: own * factor})
        except BadInput:
            break
        found.append(float(own * factor))
    return found
