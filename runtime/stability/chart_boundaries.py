"""Boundary curves of a chart with one mode: from the Hill matrix, and by perturbation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..core.families import Array, LinearPeriodic
from ..core.periodic_function import PeriodicFunction
from ..hill import HillForm, hill_boundaries, hill_form, perturbation_boundaries
from ..hill.boundaries import near_tip
from ..hill.fourier_matrix import by_parity, slope, stacked, truncation
from .boundary_speeds import inverse_roots
from .chart_axes import is_stiffness, leaves_function_alone, on_grid

_EPS = float(np.finfo(float).eps)
Ends = tuple[Array, Array, Array]
Solve = Callable[[int, Array], Ends]


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
    """
    form = hill_form(system)
    suited = [
        leaves_function_alone(form, name) if name == "speed" else is_stiffness(form, name)
        for name in names
    ]
    if not any(suited):
        return None, None
    which = suited.index(True)
    along, other = names[which], names[1 - which]
    rows = axes[1 - which]
    sharp = not system.is_damped(**on_grid(names, axes)[1])
    # Rows between which a curve is drawn straight; a damped one takes some ten times as long.
    most = 121 if sharp else 41
    if len(rows) > most:
        rows = np.linspace(rows[0], rows[-1], most)
    points = [_Point.of(form, along, other, float(value)) for value in rows]
    regions, left_out = _regions(axes[which], along, points)
    exact = np.stack([point.ends(regions) for point in points], axis=2)
    near = _overlay(form, other, rows, points, regions, order)
    curves = partial(BoundaryCurves, along, regions, rows, left_out=left_out)
    return curves(*exact), curves(*near)


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
            return _damped_speeds(self.function, self.stiffness, self.damping, regions)
        found = hill_boundaries(self.function, 1.0, regions)
        lam2 = np.stack([found.lower, found.upper])
        with np.errstate(invalid="ignore", divide="ignore"):
            speeds = np.sqrt(np.where(lam2 > 0, self.stiffness / lam2, np.nan))
            error = found.error * np.max(speeds / (2 * np.abs(lam2)), axis=0)
        return np.stack([speeds[0], speeds[1], error])


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
    most = min(last, max(first, 1) + 23)
    return tuple(range(first, most + 1)), last - most


def _damped_speeds(
    f: PeriodicFunction, stiffness: float, damping: float, regions: tuple[int, ...]
) -> Array:
    """Return speeds at the ends of damped regions in lam2, and their error, (3, regions)."""
    # NaN where damping has closed the region, and at the lower end of one that reaches on to
    # infinite speed.  The function f is the same at every speed, stiffness k [1/s^2] and damping c
    # [1/s] are positive.
    # With lam2 = s^2 and K = r s, r = c / (2 sqrt(k)), Hill's matrix gives (k^2 - f) v - 2 r s D v
    # = s^2 v, D = d/d theta.  A region lies within the undamped one moved by K^2 (see boundaries),
    # which is how real s get its number.
    ratio = damping / (2.0 * np.sqrt(stiffness))
    sharp = hill_boundaries(f, 1.0, regions)
    highest = float(np.sqrt(max(float(np.max(sharp.upper)), 0.25)))
    cut = truncation(f, 1.0, max(regions), (ratio * highest) ** 2)
    local = cut.left_out + 8.0 * _EPS * (cut.norm + 2.0 * ratio * highest * cut.harmonic) + f.error
    out = np.full((3, len(regions)), np.nan)
    for odd, rows in by_parity(regions):
        s = _inverse_speeds(f, odd, cut.harmonic + odd, ratio)
        shifted = s * s * (1.0 - ratio * ratio)
        for i in rows:
            low, high = float(sharp.lower[i]), float(sharp.upper[i])
            own = np.sort(s[(shifted >= low - 4 * local) & (shifted <= high + 4 * local)])
            if low < 0.0 < high and len(own):
                # The region reaches on to infinite speed: one end alone.
                error = local * np.sqrt(stiffness) / (2.0 * own[-1] ** 3)
                out[1:, i] = np.sqrt(stiffness) / own[-1], error
            if low < 0.0 or len(own) < 2:
                continue
            ends = own[[0, -1]]
            speeds = np.sqrt(stiffness) / ends
            error = near_tip(local, 0.5 * (ends[1] ** 2 - ends[0] ** 2), 0.5 * (high - low))
            out[:, i] = *speeds, error * np.max(speeds / (2.0 * ends**2))
    return out


def _inverse_speeds(f: PeriodicFunction, odd: int, harmonic: int, ratio: float) -> Array:
    """Return all real s > 0 with a solution of one parity."""
    drag = -ratio * slope(odd, harmonic)
    unit = np.eye(len(drag))
    whole = stacked(f, odd, harmonic, np.ones(1))[0] - float(f.a[0]) * unit
    values, _ = inverse_roots([-unit, drag, whole], symmetric=False)
    return np.asarray(values.real[(values.imag == 0.0) & (values.real > 0.0)])


def _overlay(
    form: HillForm,
    other: str,
    rows: Array,
    points: Sequence[_Point],
    regions: tuple[int, ...],
    order: int,
) -> Array:
    """Return lower ends, upper ends and errors in the units of the axis."""
    speed, stiffness, damping = (
        np.array([getattr(point, name) for point in points])
        for name in ("speed", "stiffness", "damping")
    )
    solve = _solver(form, other, rows, points, order)

    def ends(n: int) -> Array:
        if points[0].along == "speed":
            return _along_speed(solve, n, stiffness, damping)
        found = np.stack(solve(n, damping / (2 * speed))) * speed**2
        return np.where(np.isfinite(found), found, np.nan)

    return np.stack([ends(n) for n in regions], axis=1)


def _along_speed(solve: Solve, n: int, stiffness: Array, damping: Array) -> Array:
    """Return the ends of one region in speed, where lam2 and K both depend on it."""
    # At crank speed w, lam2 = k / w^2 and K = c / (2 w) = r sqrt(lam2): an end is where the lam2
    # that belongs to K gives that K again.
    out = np.full((3, len(stiffness)), np.nan)
    usable = stiffness > 0.0
    ratio = np.where(usable, damping / (2 * np.sqrt(np.where(usable, stiffness, 1.0))), 0.0)
    sharp = solve(n, np.zeros_like(damping))
    for side in (0, 1):
        lam2, error, slow = np.array(sharp[side]), np.array(sharp[2]), np.zeros_like(ratio)
        if np.any(ratio > 0.0):
            lam2, error, slow = _settled(solve, n, ratio, lam2, side)
        with np.errstate(invalid="ignore", divide="ignore"):
            lam2 = np.where(usable & (lam2 > 0.0), lam2, np.nan)
            out[side] = np.sqrt(stiffness / lam2)
            spread = error / (1.0 - slow) * out[side] / (2 * lam2)
        out[2] = np.fmax(out[2], spread)
    return out


def _settled(solve: Solve, n: int, ratio: Array, start: Array, side: int) -> Ends:
    """Return lam2, its error and the rate of the steps; NaN where they do not settle."""
    lam2, change, slow = start, np.full_like(start, np.inf), np.zeros_like(start)
    error = np.full_like(start, np.nan)
    # Steps towards the K that belongs to the lam2 of an end, and the change that ends them.
    for _ in range(60):
        with np.errstate(invalid="ignore"):
            found = solve(n, np.where(lam2 > 0.0, ratio * np.sqrt(np.maximum(lam2, 0.0)), 0.0))
            new, error = np.where(lam2 > 0.0, found[side], np.nan), found[2]
            before, change = change, np.abs(new - lam2)
            rate = np.where(before > 0, change / before, 0.0)
            slow = np.where(np.isfinite(rate) & (change > 1e-11), rate, slow)
            lam2 = new
            if not np.any(change > 1e-13 * np.abs(lam2)):
                break
    with np.errstate(invalid="ignore"):
        settled = (change <= 1e-9 * np.abs(lam2)) & (slow < 0.9)
    return np.where(settled, lam2, np.nan), np.where(settled, error, np.nan), slow


def _solver(form: HillForm, other: str, rows: Array, points: Sequence[_Point], order: int) -> Solve:
    """Return lower and upper ends in lam2 and their error, of all rows for one region and K."""
    functions, factors = _functions(form, other, rows)
    # More functions than this cost more together than row by row.
    if len(functions) <= 2:

        def together(n: int, damping: Array) -> Ends:
            found = perturbation_boundaries(functions, factors, (n,), order, damping)
            return found.lower[0], found.upper[0], found.error[0]

        return together

    def apart(n: int, damping: Array) -> Ends:
        rows = zip(points, damping.tolist(), strict=True)
        found = [perturbation_boundaries(p.function, 1.0, (n,), order, k) for p, k in rows]
        lower, upper, error = np.array([[r.lower[0], r.upper[0], r.error[0]] for r in found]).T
        return lower, upper, error

    return apart


def _functions(
    form: HillForm, other: str, rows: Array
) -> tuple[list[PeriodicFunction], list[Array]]:
    """Return functions and factors, one for each row, whose sum is the periodic part."""
    # Parts that change in proportion are one function.
    changes: dict[str, Any] = {} if other == "speed" else {other: rows}
    scales = form.system.scale_values(**changes)
    # Of one coordinate: what belongs to the rows takes the place of columns.
    mass = form.system.array("M", 0.0, **changes)[0, 0]
    divisor = rows**2 if other == "speed" else np.ones_like(rows)
    functions: list[PeriodicFunction] = []
    factors: list[Array] = []
    inertial = ((scale, part, mass) for scale, part in form.inertial)
    elastic = ((scale, part, divisor * mass) for scale, part in form.elastic)
    for scale, part, over in (*inertial, *elastic):
        value = 1.0 if scale is None else np.asarray(scales[scale], dtype=float)
        factor = np.broadcast_to(value, rows.shape) / over
        size = float(np.max(np.abs(factor), initial=0.0))
        if size == 0.0:
            continue
        unit = factor / size
        like = [i for i, known in enumerate(factors) if np.max(np.abs(unit - known)) <= 1e-15]
        if like:
            functions[like[0]] = functions[like[0]] + part * size
        else:
            functions.append(part * size)
            factors.append(unit)
    if not functions:
        return [PeriodicFunction()], [np.zeros_like(rows)]
    return functions, factors
