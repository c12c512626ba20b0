"""Where two natural frequencies meet or all but meet over the crank angle: crossing or veering."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .eigenproblem import HeldModes

Array = NDArray[np.float64]
Modes = Callable[[Array], HeldModes]
Arrays = Callable[[Array], tuple[Array, Array]]

# Places within a bracket per pass: each pass keeps a quarter of it.
_WITHIN = 9
_PASSES = 26
_FLAT = 1e-9
# Gaps smaller than so many round-offs are none.
_ROUNDED = 16.0


@dataclass(frozen=True)
class Encounter:
    """Two neighbouring natural frequencies that cross or veer away from each other.

    Near it the squares differ by ``sqrt(gap^2 + slope^2 (theta - angle)^2)``.

    Attributes
    ----------
    kind : {"crossing", "veering"}
        A crossing has no gap beyond round-off: each shape goes on along its own curve.  At a
        veering the curves stay apart and the modes trade their shapes.
    lower : int
        Rank of the lower frequency, from 1.
    angle : float
        Crank angle of the least gap [rad], within the period.
    frequency : float
        Mean of the two frequencies there [rad/s].
    gap : float
        Their least difference [rad/s].
    gap_error : float
        Round-off of it [rad/s]: a gap below is none.
    slope : float
        Difference of the slopes of the two curves away from it [rad/s per rad].
    width : float
        ``gap/slope`` [rad]: within so much of the angle the shapes trade; 0 of a crossing.
    coupling : float
        Rate [rad per rad] at which the two shapes turn into each other at the angle,
        ``|u_2^T (K' - omega_1^2 M') u_1| / (omega_2^2 - omega_1^2)``; 0 of a crossing.
    curvature : float
        What the coupling adds to the second derivative of the upper frequency, and takes from the
        lower [rad/s per rad^2]; 0 of a crossing.
    trade : float
        ``2 coupling width``: 1 where two modes veer and no third takes part; 0 of a crossing.
    """

    kind: Literal["crossing", "veering"]
    lower: int
    angle: float
    frequency: float
    gap: float
    gap_error: float
    slope: float
    width: float
    coupling: float
    curvature: float
    trade: float


def least_gap(modes: Modes, low: float, high: float, rank: int) -> tuple[float, float]:
    """Return the angle of the least gap above a rank (from 0) within a bracket, and its doubt."""
    for _ in range(_PASSES):
        theta = np.linspace(low, high, _WITHIN)
        frequency = modes(theta).frequency
        gap = frequency[:, rank + 1] - frequency[:, rank]
        best = int(np.argmin(gap))
        low, high = theta[max(best - 1, 0)], theta[min(best + 1, _WITHIN - 1)]
        # About a veering the gap is flat; down to a crossing it falls to nothing.
        if np.ptp(gap) <= _FLAT * gap[best] or high - low <= 1e-14 * max(1.0, abs(low)):
            break
    return float(0.5 * (low + high)), float(high - low)


def describe(
    modes: Modes, arrays: Arrays, angle: float, doubt: float, rank: int, period: float
) -> Encounter:
    """Return the record of the least gap above a rank (from 0), known to be at an angle."""
    at = modes(np.array([angle]))
    one, two = at.frequency[0, rank : rank + 2]
    gap = float(two - one)
    step = 1e-3 * period / (2.0 * np.pi)
    turning = _coupling(arrays, at, angle, rank, step)
    rate = turning / max(two**2 - one**2, float(np.finfo(float).eps) * two**2)
    # Over a part of what the shapes need to trade the square of the gap is a parabola.
    reach = min(0.25 / rate, step) if rate > 0.0 else step
    slope, gap_error = _slope(modes, angle, reach, rank)
    # At a veering the gap is flat, and hardly wrong for the angle's doubt.
    drift = slope * doubt
    gap_error += min(drift, drift**2 / gap) if gap > 0.0 else drift
    frequency = 0.5 * float(one + two)
    crossing = gap <= gap_error
    width = 0.0 if crossing or not slope > 0.0 else gap / slope
    coupling = 0.0 if crossing else float(rate)
    return Encounter(
        kind="crossing" if crossing else "veering",
        lower=rank + 1,
        angle=angle % period,
        frequency=frequency,
        gap=gap,
        gap_error=gap_error,
        slope=slope,
        width=width,
        coupling=coupling,
        curvature=0.0 if crossing else float(turning * rate / frequency),
        trade=2.0 * coupling * width,
    )


def _coupling(arrays: Arrays, at: HeldModes, angle: float, rank: int, step: float) -> float:
    """Return ``|u_2^T (K' - omega_1^2 M') u_1|`` by differences of the fourth order."""
    theta = angle + step * np.array([-2.0, -1.0, 1.0, 2.0])
    weight = np.array([1.0, -8.0, 8.0, -1.0]) / (12.0 * step)
    mass, stiffness = arrays(theta)
    slope = np.tensordot(weight, stiffness - at.frequency[0, rank] ** 2 * mass, axes=1)
    return float(abs(at.shape[0, :, rank + 1] @ slope @ at.shape[0, :, rank]))


def _slope(modes: Modes, angle: float, reach: float, rank: int) -> tuple[float, float]:
    """Return the difference of the slopes, from the gap's square, and the gap's round-off."""
    around = modes(angle + reach * np.array([-1.0, 0.0, 1.0]))
    gap = around.frequency[:, rank + 1] - around.frequency[:, rank]
    error = _ROUNDED * float(np.max(around.error[:, rank : rank + 2]))
    bend = (gap[0] ** 2 + gap[2] ** 2) / 2.0 - gap[1] ** 2
    return float(np.sqrt(max(bend, 0.0)) / reach), error
