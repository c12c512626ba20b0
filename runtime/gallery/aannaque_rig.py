"""Aannaque's rig of chapter 8 as the gallery uses it: systems, speeds of the tests, stresses."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..core.errors import LinearRangeWarning, bad
from ..core.families import LinearPeriodic
from ..scenes import load_scene

if TYPE_CHECKING:
    from ..periodic import SteadyState
    from ..recovery.stress_over_speed import StressCurve

Array = NDArray[np.float64]

SHORT, LONG = "aannaque_1996_table_4_1", "aannaque_1996_long_coupler"
FRAME = 0.547
# Captions of Appendix C, Figs. C.1 to C.24 [rad/s].
SPEEDS_C = (
    *(7.11, 9.71, 11.1, 13.43, 15.44, 16.28, 16.71, 17.70, 18.27, 20.07, 20.40, 21.01),
    *(21.08, 21.89, 22.52, 22.60, 23.44, 24.35, 25.96, 27.32, 29.09, 30.21, 31.42, 35.30),
)
# Captions of Appendix D, Figs. D.1 to D.26; that of D.5 is left in the list of figures alone.
SPEEDS_D = (
    *(6.84, 7.86, 9.11, 9.68, 10.23, 11.38, 11.90, 12.44, 13.40, 14.28, 15.51, 16.45, 16.89),
    *(18.00, 18.81, 20.27, 21.37, 21.74, 22.68, 22.77, 23.36, 23.62, 23.89, 24.74, 25.34, 25.75),
)
# Where the gauges sat: the captions say the middle of the input link, section 8.5 its end.
STATIONS: Mapping[str, tuple[float, ...]] = {
    "crank": (0.0, 0.5),
    "coupler": (0.5,),
    "follower": (0.5,),
}
# Relative errors that no picture shows.
_MOTION, _CURVE = 1e-5, 1e-3


@dataclass(frozen=True)
class Cycles:
    """Stresses at the gauges over the cycle at several speeds.

    Attributes
    ----------
    speed : ndarray, shape (ns,)
        Crank speeds [rad/s].
    theta : ndarray, shape (nt,)
        Crank angles [rad].
    stress : mapping of (str, float) to ndarray, shape (ns, nt)
        Stress [Pa] of the outer fibre to the left of the link's direction, tension positive, by
        link and place x/length.
    """

    speed: Array
    theta: Array
    stress: Mapping[tuple[str, float], Array]


@lru_cache(maxsize=12)
def rig(scene: str = SHORT, frame: float = FRAME) -> LinearPeriodic:
    """Return the linkage of a built-in scene with another distance of the pivots [m].

    Raises
    ------
    BadInput
        If the scene has no linear periodic system.
    """
    return load_scene(scene, overrides={"links.frame": frame}).linear_system()


def quiet_motion(system: LinearPeriodic, speed: float | tuple[float, ...]) -> SteadyState:
    """Return the periodic motion at a crank speed [rad/s], or at each of some."""
    from ..periodic import steady_state

    with warnings.catch_warnings():
        # At a critical speed the linear range may be left; the figures' notes say so.
        warnings.simplefilter("ignore", LinearRangeWarning)
        return steady_state(system, speed, rtol=_MOTION)


@lru_cache(maxsize=16)
def cycles(scene: str, frame: float, speeds: tuple[float, ...]) -> Cycles:
    """Return the stresses at the gauges over the cycle."""
    from ..recovery import stress_operator

    system = rig(scene, frame)
    motion = quiet_motion(system, speeds)
    form, stations = stress_operator(system, motion.theta, STATIONS)
    values = np.stack(
        [
            form.values(speed, q, qd / speed)
            for speed, q, qd in zip(speeds, motion.q, motion.qd, strict=True)
        ]
    )
    # Of each station the fibre on the positive side comes first.
    found = {(one.beam, one.place): values[:, :, k] for k, one in enumerate(stations)}
    return Cycles(np.array(speeds), motion.theta, found)


@lru_cache(maxsize=16)
def curve(scene: str, frame: float, low: float, high: float, count: int) -> StressCurve:
    """Return the largest stresses at the links' middles, and the input link's end, over speeds.

    Parameters
    ----------
    scene : str
        Built-in scene.
    frame : float
        Distance of the pivots [m].
    low, high : float
        Range of the speeds [rad/s].
    count : int
        Their number.
    """
    from ..recovery.stress_over_speed import stress_curve

    return stress_curve(
        rig(scene, frame), np.linspace(low, high, count), stations=STATIONS, rtol=_CURVE
    )


def tops(x: Array, y: Array, prominence: float) -> Array:
    """Return the abscissae of the local maxima of a curve that stand out.

    Parameters
    ----------
    x, y : ndarray, shape (n,)
        The curve, x even.
    prominence : float
        Least fall on both sides over the maximum's own height.

    Raises
    ------
    BadInput
        If the curve has fewer than three points.
    """
    from scipy.signal import find_peaks

    if len(x) < 3:
        raise bad("x", f"{len(x)} points", "three at least", "take more speeds")
    logs = np.log(y)
    places, _ = find_peaks(logs, prominence=-np.log1p(-prominence))
    # A parabola through the three highest places.
    before, at, after = logs[places - 1], logs[places], logs[places + 1]
    shift = 0.5 * (before - after) / (before - 2.0 * at + after)
    return np.asarray(x[places] + shift * (x[1] - x[0]))
