"""Resonance curves: the largest deflection of the steady state against the crank speed."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic, require_system
from ..core.inputs import numbers
from ..core.maxima import local_maxima, narrowed
from ..core.plotting import ABOVE, Axes, axes_or_new
from ..core.results import Result, provenance
from ..periodic.periodic_motion import quiet_state
from .critical import label_speeds
from .held import mean_frequencies


@dataclass(frozen=True, kw_only=True)
class ResonanceCurve(Result):
    """Largest deflection of the periodic motion against the crank speed, and its maxima.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], rising, shape ``(ns,)``.
    peak : ndarray
        Largest size of the deflection over a period [m], shape ``(ns,)``; NaN where there is no
        single periodic motion.
    stable : ndarray of bool
        Whether that motion is stable, shape ``(ns,)``.
    error : ndarray
        Error of ``peak`` over itself, shape ``(ns,)``: of the periodic motion, and of what
        lies between its angles.
    maxima : ndarray
        Speeds of the local maxima within the range [rad/s], refined, shape ``(nm,)``.
    maxima_peak : ndarray
        Largest deflections there [m], shape ``(nm,)``.
    maxima_error : ndarray
        How far each maximum may be from its speed [rad/s], shape ``(nm,)``.
    order, mode : ndarray of int
        Label of each maximum, shape ``(nm,)``: the mode, of the first three, counted from 1, whose
        mean natural frequency over the speed is nearest to a whole number n, and that number.  A
        guess where the frequencies vary much over the cycle.
    ratio : ndarray
        That mean frequency over n times the speed, shape ``(nm,)``; 1 where the mean says it all.
    mean_frequency : ndarray
        Mean natural frequencies over the cycle, crank held [rad/s], six or all of fewer.
    x : float
        Place x/length.
    """

    speed: Array
    peak: Array
    stable: NDArray[np.bool_]
    maxima: Array
    maxima_peak: Array
    maxima_error: Array
    order: NDArray[np.int64]
    mode: NDArray[np.int64]
    ratio: Array
    mean_frequency: Array
    x: float

    arrays_along: ClassVar = {
        "speed": "speed peak stable error",
        "maximum": "maxima maxima_peak maxima_error order mode ratio",
        "frequency": "mean_frequency",
    }
    column_units: ClassVar = {"m": "peak maxima_peak", "rad/s": "maxima maxima_error"}

    @property
    def joined(self) -> tuple[Array, Array]:
        """Speeds [rad/s] and peaks [m] with the refined maxima among them, by rising speed."""
        speed = np.concatenate([self.speed, self.maxima])
        peak = np.concatenate([self.peak, self.maxima_peak])
        order = np.argsort(speed, kind="stable")
        return speed[order], peak[order]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the curve with its maxima labelled by n and return the axes."""
        ax = axes_or_new(ax)
        speeds, peaks = self.joined
        ax.semilogy(speeds, 1e3 * peaks, linewidth=0.9)
        for speed, peak, order, mode in zip(
            self.maxima, 1e3 * self.maxima_peak, self.order, self.mode, strict=True
        ):
            name = rf"$\omega_{mode}/{order}$" if order > 1 else rf"$\omega_{mode}$"
            ax.annotate(name, (speed, peak), (0, 3), **ABOVE)
        ax.set(xlabel="crank speed [rad/s]", ylabel="largest deflection [mm]")
        return ax


def resonance_curve(
    system: LinearPeriodic,
    speed: ArrayLike,
    *,
    x: float | None = None,
    rtol: float = 1e-6,
    **parameters: float,
) -> ResonanceCurve:
    """Return the largest steady deflection against the crank speed, with its maxima refined.

    A system that is forced once and more in a revolution resonates near the mean first natural
    frequency over n = 1, 2, ... (Beale & Scott, section 3.2, ask whether it does where the
    frequency varies much).  With little damping a resonance is at the ends of the unstable region
    2n, where a multiplier is 1, and the motion between them is unstable: see ``stable``.

    Parameters
    ----------
    system : LinearPeriodic
        The system, forced, with mode shapes; some damping keeps the maxima finite.
    speed : array_like
        Crank speeds [rad/s], rising, shape ``(ns,)``, at least 3.  A maximum between two of them
        that shows at neither is missed.
    x : float, optional
        Place x/length of the deflection: by default the end, or the middle where the end is held.
    rtol : float
        Wanted error of the periodic motions.
    **parameters : float
        Parameter values that replace the system's.

    Returns
    -------
    ResonanceCurve
        Its checks: those of the worst steady state of the curve, ``linear range`` among them.

    Raises
    ------
    BadInput
        As :func:`~..periodic.steady_state`; and if the speeds do not rise.

    Examples
    --------
    >>> import elastolink as el
    >>> import numpy as np
    >>> scene = el.load_scene("smith_1972_5152_sixteenth_inch", {"coupler.damping_ratio": 0.02})
    >>> curve = el.resonance_curve(scene.system(), np.linspace(30.0, 40.0, 21), x=0.5)
    >>> print(curve.maxima.round(2), (1000.0 * curve.maxima_peak).round(2), curve.order)
    [32.9] [3.47] [5]
    """
    require_system(system)
    speeds = numbers("speed", speed)
    if x is not None and not (isinstance(x, Real) and 0 <= x <= 1):
        raise bad("x", repr(x), "one place x/length from 0 to 1", "divide by the length")
    if speeds.ndim != 1 or len(speeds) < 3 or not np.all(np.diff(speeds) > 0):
        raise bad("speed", speed, "at least three rising speeds [rad/s]", "use numpy.linspace")
    if system.shapes(np.zeros(1), np.zeros(1)) is None:
        fix = "take stress_curve for a structure of beams, or steady_state and its q"
        raise bad("resonance_curve", "a system without mode shapes", "one with them", fix)
    mean, _ = mean_frequencies(system, min(6, system.size), 1e-12, parameters=parameters)
    state = quiet_state(system, speeds, rtol, parameters)
    place = state.place if x is None else float(x)
    peak = state.peak(place)
    tops = local_maxima(peak)

    def peaks(at: Array) -> Array:
        return quiet_state(system, at, rtol, parameters).peak(place)

    low, high = narrowed(peaks, speeds[tops - 1], speeds[tops + 1], 4)
    maxima = 0.5 * (low + high)
    heights = peaks(maxima) if len(maxima) else maxima
    # Modes that a maximum may be labelled by: of a high one any speed is near some fraction.
    mode, order = label_speeds(mean[:3], maxima)
    return ResonanceCurve(
        method=state.method,
        error=state.peak_error(place),
        error_norm="of the largest deflection, over itself",
        checks={name: state.checks[name] for name in sorted(state.checks)},
        provenance=provenance(system.changed_provenance(**parameters)),
        speed=speeds,
        peak=peak,
        stable=state.stable,
        maxima=maxima,
        maxima_peak=heights,
        maxima_error=0.5 * (high - low),
        order=order,
        mode=mode,
        ratio=mean[mode - 1] / (order * maxima),
        mean_frequency=mean,
        x=place,
    )
