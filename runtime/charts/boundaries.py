"""Boundary curves of a chart with one mode: exact from the Hill matrix, and first order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..families import Array, LinearPeriodic
from ..hill.form import HillForm, hill_form, is_stiffness
from ..hill.matrix import Boundaries, hill_boundaries
from ..hill.perturbation import perturbation_boundaries
from ..series.periodic import PeriodicFunction

_MOST_ROWS = 121
_MOST_DAMPED_ROWS = 41
_MOST_ROUNDS = 40
_MOST_REGIONS = 24


@dataclass(frozen=True)
class BoundaryCurves:
    """Ends of the unstable regions along one axis of a chart.

    Attributes
    ----------
    along : str
        The axis that the ends lie on: ``"speed"`` or the parameter that is the constant stiffness.
    regions : tuple of int
        Number of each region.
    at : ndarray, shape (n,)
        Values of the other axis.
    lower, upper : ndarray, shape (len(regions), n)
        Ends in lam2, brought to the units of the axis; NaN where there is none.
    error : ndarray, shape (len(regions), n)
        Absolute error in the units of the axis, estimated.
    """

    along: str
    regions: tuple[int, ...]
    at: Array
    lower: Array
    upper: Array
    error: Array


def boundary_curves(
    system: LinearPeriodic, names: tuple[str, str], axes: tuple[Array, Array]
) -> tuple[BoundaryCurves | None, BoundaryCurves | None]:
    """Return exact and first-order boundaries within a chart, or None where no axis suits.

    An axis suits where it is the speed, or a parameter that is the constant stiffness itself.

    Parameters
    ----------
    system : LinearPeriodic
        One mode, see :func:`~.form.hill_form`.
    names : tuple of str
        Names of the axes x and y.
    axes : tuple of ndarray
        Their values.
    """
    form = hill_form(system)
    which = next((i for i in (0, 1) if _suits(form, names[i])), None)
    if which is None:
        return None, None
    along, other = names[which], names[1 - which]
    rows = axes[1 - which]
    most = _MOST_ROWS if form.damping() == 0.0 and other != "damping" else _MOST_DAMPED_ROWS
    if len(rows) > most:
        rows = np.linspace(rows[0], rows[-1], most)
    points = [_Point.of(form, along, other, float(value)) for value in rows]
    regions = _regions(axes[which], along, points)
    tables: list[BoundaryCurves] = []
    for solve in (hill_boundaries, perturbation_boundaries):
        ends = np.full((3, len(regions), len(rows)), np.nan)
        for j, point in enumerate(points):
            ends[:, :, j] = point.ends(solve, regions)
        tables.append(BoundaryCurves(along, regions, rows, *ends))
    return tables[0], tables[1]


@dataclass(frozen=True)
class _Point:
    """One row of the chart: a Hill equation whose lam2 and damping follow the axis."""

    along: str
    speed: float
    function: PeriodicFunction
    stiffness: float
    damping: float

    @classmethod
    def of(cls, form: HillForm, along: str, other: str, value: float) -> _Point:
        changes = {} if other == "speed" else {other: value}
        speed = value if other == "speed" else 1.0
        f = form.function(speed, **changes)
        return cls(along, speed, f, form.stiffness(**changes), form.damping(**changes))

    def ends(self, solve: Callable[..., Boundaries], regions: tuple[int, ...]) -> Array:
        """Return lower ends, upper ends and errors in the units of the axis, shape (3, regions)."""
        if self.along != "speed":
            found = solve(self.function, 1.0, regions, damping=self.damping / (2 * self.speed))
            return np.stack([found.lower, found.upper, found.error])
        number = np.asarray(regions)
        at_rest = 2.0 * np.sqrt(self.stiffness) / number
        speeds = np.stack([at_rest, at_rest])
        error = np.zeros(len(regions))
        for _ in range(1 if self.damping == 0.0 else _MOST_ROUNDS):
            before = speeds
            moved, error = self._speeds(solve, regions, speeds)
            speeds = np.where(np.isnan(before), np.nan, moved)  # a closed region stays closed
            if not np.any(np.abs(speeds - before) > 1e-13 * np.abs(speeds)):
                break
        return np.stack([speeds[0], speeds[1], error])

    def _speeds(
        self, solve: Callable[..., Boundaries], regions: tuple[int, ...], speeds: Array
    ) -> tuple[Array, Array]:
        """Return the speeds of both ends for the damping K = c / (2 w) at the speeds given."""
        pick = np.arange(len(regions))
        damping = np.nan_to_num(self.damping / (2.0 * speeds)).ravel()
        if self.damping == 0.0:
            damping = damping[:1]
            pick = np.zeros_like(pick)
        found = solve(self.function, np.ones(len(damping)), regions, damping=damping)
        half = len(regions) if len(damping) > 1 else 0
        index = np.arange(len(regions))
        lam2 = np.stack([found.lower[index, pick], found.upper[index, pick + half]])
        error = np.maximum(found.error[index, pick], found.error[index, pick + half])
        with np.errstate(invalid="ignore", divide="ignore"):
            moved = np.sqrt(np.where(lam2 > 0, self.stiffness / lam2, np.nan))
            moved_error: Array = error * np.max(moved / (2 * np.abs(lam2)), axis=0)
        return moved, moved_error


def _suits(form: HillForm, name: str) -> bool:
    return not form.elastic if name == "speed" else is_stiffness(form, name)


def _regions(ends: Array, along: str, points: list[_Point]) -> tuple[int, ...]:
    """Return the regions that may reach into the chart, the lowest ones first."""
    lows, highs, reach = [], [], 0.0
    for point in (points[0], points[-1]):
        lam2 = point.stiffness / ends**2 if along == "speed" else ends
        lows.append(float(lam2.min()))
        highs.append(float(lam2.max()))
        reach = max(reach, point.function.bound())
    first = max(1, int(np.floor(2 * np.sqrt(max(min(lows) - reach, 0.0)))))
    last = int(np.ceil(2 * np.sqrt(max(max(highs) + reach, 0.25))))
    return tuple(range(first, min(last, first + _MOST_REGIONS - 1) + 1))
