"""Boundary curves of a chart with one mode: from the Hill matrix, and by perturbation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.families import Array, LinearPeriodic
from ...core.periodic_function import PeriodicFunction
from ...hill import HillForm, hill_boundaries, hill_form
from .damped_speeds import exact_speeds
from .hill_axes import is_stiffness, leaves_function_alone
from .overlay import overlay_ends
from .structure import is_damped

_MOST_ROWS = 121
_MOST_DAMPED_ROWS = 41
_MOST_REGIONS = 24


@dataclass(frozen=True)
class BoundaryCurves:
    """Ends of the unstable regions along one axis of a chart.

    Attributes
    ----------
    along : str
        The axis that the ends lie on: ``"speed"`` or the parameter that is the constant stiffness.
    regions : tuple of int
        Number of each region; 0 has an upper end alone, and is there where the axis is lam2's.
    at : ndarray, shape (n,)
        Values of the other axis.
    lower, upper : ndarray, shape (len(regions), n)
        Ends in lam2, brought to the units of the axis; NaN where there is none.
    error : ndarray, shape (len(regions), n)
        Absolute error in the units of the axis, estimated.
    left_out : int
        How many further regions reach into the chart but are not followed.
    """

    along: str
    regions: tuple[int, ...]
    at: Array
    lower: Array
    upper: Array
    error: Array
    left_out: int = 0


def boundary_curves(
    system: LinearPeriodic, names: tuple[str, str], axes: tuple[Array, Array], order: int
) -> tuple[BoundaryCurves | None, BoundaryCurves | None]:
    """Return exact and perturbation boundaries within a chart, or None where no axis suits.

    An axis suits where it is the speed, or a parameter that is the constant stiffness itself.

    Parameters
    ----------
    system : LinearPeriodic
        One mode, see :func:`~.form.hill_form`.
    names : tuple of str
        Names of the axes x and y.
    axes : tuple of ndarray
        Their values.
    order : int
        Of the perturbation.
    """
    form = hill_form(system)
    which = next((i for i in (0, 1) if _suits(form, names[i])), None)
    if which is None:
        return None, None
    along, other = names[which], names[1 - which]
    rows = axes[1 - which]
    sharp = not is_damped(system, names, axes)
    most = _MOST_ROWS if sharp else _MOST_DAMPED_ROWS
    if len(rows) > most:
        rows = np.linspace(rows[0], rows[-1], most)
    points = [_Point.of(form, along, other, float(value)) for value in rows]
    regions, left_out = _regions(axes[which], along, points)
    exact = np.full((3, len(regions), len(rows)), np.nan)
    for j, point in enumerate(points):
        exact[:, :, j] = point.ends(regions)
    near = overlay_ends(form, along, other, rows, regions, order)
    tables = (
        BoundaryCurves(along, regions, rows, ends[0], ends[1], ends[2], left_out)
        for ends in (exact, near)
    )
    return next(tables), next(tables)


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

    def ends(self, regions: tuple[int, ...]) -> Array:
        """Return lower ends, upper ends and errors in the units of the axis, shape (3, regions)."""
        if self.along != "speed":
            damping = self.damping / (2 * self.speed)
            found = hill_boundaries(self.function, 1.0, regions, damping=damping)
            # Region 0 begins at minus infinity, which is no end.
            lower = np.where(np.isfinite(found.lower), found.lower, np.nan)
            return np.stack([lower, found.upper, found.error]) * self.speed**2
        if self.stiffness <= 0.0:
            return np.full((3, len(regions)), np.nan)
        if self.damping != 0.0:
            return exact_speeds(self.function, self.stiffness, self.damping, regions)
        found = hill_boundaries(self.function, 1.0, regions)
        lam2 = np.stack([found.lower, found.upper])
        with np.errstate(invalid="ignore", divide="ignore"):
            speeds = np.sqrt(np.where(lam2 > 0, self.stiffness / lam2, np.nan))
            error = found.error * np.max(speeds / (2 * np.abs(lam2)), axis=0)
        return np.stack([speeds[0], speeds[1], error])


def _suits(form: HillForm, name: str) -> bool:
    return leaves_function_alone(form, name) if name == "speed" else is_stiffness(form, name)


def _regions(ends: Array, along: str, points: list[_Point]) -> tuple[tuple[int, ...], int]:
    """Return the regions that may reach into the chart, the lowest ones, and how many more do."""
    lows, highs, reach = [], [], 0.0
    for point in points:
        lam2 = point.stiffness / ends**2 if along == "speed" else ends / point.speed**2
        lows.append(float(lam2.min()))
        highs.append(float(lam2.max()))
        reach = max(reach, point.function.bound())
    first = int(np.floor(2 * np.sqrt(max(min(lows) - reach, 0.0))))
    # At positive stiffness region 0, of divergence, has no speed of its own.
    first = max(first, 1 if along == "speed" else 0)
    last = max(first, int(np.ceil(2 * np.sqrt(max(max(highs) + reach, 0.25)))))
    most = min(last, max(first, 1) + _MOST_REGIONS - 1)
    return tuple(range(first, most + 1)), last - most
