"""Invariants of a chart, line by line: half traces of one mode, polynomials of several.

Of several modes a whole line of speeds comes from one table of segments; of one mode a line shares
the function of Hill's equation where the inner axis leaves that alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..core import chebyshev
from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.periodic_function import PeriodicFunction
from ..core.progress import bar
from ..hill import HillForm, discriminant, hill_form
from ..hill.form import is_hill
from ..periodic.equation import Equation, at_geometry, equation_of, sampled
from ..periodic.tables import Table, places, table_of
from ..periodic.transition import cheapest
from .chart_axes import (
    Axes,
    Names,
    fixed_speed,
    is_symplectic,
    leaves_function_alone,
    on_grid,
    plain_axes,
)
from .invariants import frobenius, from_sum, sum_weights_back, weighed_characteristic

# What does independent pieces of work, such as the builtin map.
Map = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]

# Flops, roughly, that one chart may cost: an hour or so.
_MOST_WORK = 1e13


@dataclass(frozen=True)
class Series:
    """Invariants on the chart ``(ny, nx, k)``, absolute errors ``(ny, nx)``, how they were found.

    ``sample_error`` is that of single samples, relative to the size of the invariants; ``errors``
    are those of each invariant ``(ny, nx, k)`` where they are known one by one.
    """

    values: Array
    error: Array
    sample_error: float
    nodes: tuple[int, int]
    method: str
    errors: Array | None = None


class Sampler:
    """What is asked of a chart at a fixed speed [rad/s], or with the speed as an axis."""

    def __init__(
        self, system: LinearPeriodic, names: Names, axes: Axes, speed: float | None, rtol: float
    ) -> None:
        self.speed = fixed_speed(system, names, speed)
        self.system, self.names, self.axes, self.rtol = system, names, axes, rtol
        grid = on_grid(names, axes)[1]
        # Whether some damping term acts at some angle, somewhere on the chart.
        self.damped = system.is_damped(**{k: grid[k] for k in grid if k not in system.geometry})
        self.reduced = is_symplectic(system, self.damped)
        self.shaped = any(name in system.geometry for name in names)
        turned = system.has("Kg") and "speed" in names
        self.hill = is_hill(system) and not self.shaped and not turned
        self.form = hill_form(system) if self.hill else None
        self.plain = (
            None if self.form is None or self.damped else plain_axes(self.form, names, self.speed)
        )

    def transform(self, name: str, values: Array) -> Array:
        """Return the variable in which the invariants are entire."""
        if name != "speed":
            return values
        return np.asarray(1.0 / values if self.damped else 1.0 / values**2)

    def back(self, name: str, values: Array) -> Array:
        """Undo :meth:`transform`."""
        if name != "speed":
            return values
        return np.asarray(1.0 / values if self.damped else 1.0 / np.sqrt(values))

    def allowed(self, lines: int, nodes: int) -> None:
        """Refuse a chart whose lines, and nodes on each, would take more than an hour or so."""
        if self.hill:
            return
        ends = zip(self.names, self.axes, ([0, 0, -1, -1], [0, -1, 0, -1]), strict=True)
        corner: dict[str, Any] = {
            name: axis[pick] for name, axis, pick in ends if name not in self.system.geometry
        }
        speed = corner.pop("speed", np.full(4, self.speed))
        rate = float(np.max(equation_of(self.system, speed, corner).rate()))
        # A segment has a phase of 4 rad; its series cost as much as 3000 products of matrices.
        segments = max(8.0, rate * self.system.period / 4.0)
        product = 2.0 * (2 * self.system.size) ** 3
        work = lines * (nodes + 3000) * segments * product
        if all(name in self.system.geometry for name in self.names):
            # A point alone costs 300 products, and its system, made anew, 1.4e8 flops.
            work = lines * nodes * (300 * segments * product + 1.4e8)
        if work > _MOST_WORK:
            found = (
                f"{self.system.size} modes, {lines} lines of {nodes} points, up to "
                f"{segments:.2g} segments of the period each"
            )
            fix = "raise the lowest speed, give fewer modes or points, or narrower axes"
            raise bad("stability_chart", found, f"at most {_MOST_WORK / work:.2g} of that", fix)


def relative_error(error: Array, values: Array) -> float:
    """Return the largest error over the larger of 1 and the size of the invariants there.

    Invariants that overflowed have none; one that is NaN, or an error that is, counts as infinite.
    """
    # A maximum over one entry is dear.
    largest = np.abs(values[..., 0]) if values.shape[-1] == 1 else np.max(np.abs(values), axis=-1)
    size = np.maximum(1.0, largest)
    if np.any(np.isnan(size) | (np.isnan(error) & np.isfinite(size))):
        return float("inf")
    finite = np.isfinite(size)
    return float(np.max(error[finite] / size[finite], initial=0.0))


# Wanted error of the matrices, and what mirrored coefficients may differ, over the largest.
_RTOL, _ALIKE = 1e-12, 1e-13
_EPS = float(np.finfo(float).eps)
# Nodes to begin with on a line, and lines across it.
_FIRST, _FEWEST_LINES = 32, 9
# Share of the values along an axis from which each of them is taken instead of nodes.
_NEARLY_ALL = 0.8

# Invariants at values of the inner variable, and the weights of their errors.
Samples = Callable[[Array], tuple[Array, Array]]
Tick = Callable[[int], None]


@dataclass(frozen=True)
class Line:
    """A table of transition matrices, of a period or of half of one, over the inner variable."""

    table: Table
    half: bool
    reduced: bool

    def __call__(self, values: Array) -> tuple[Array, Array]:
        """Return invariants ``(n, k)`` at values of the variable, and the weight of errors of each.

        The weight is by how much an error of relative size 1 in the matrices moves an invariant.
        Where the growth overflows the invariants are infinite, with the sign of the first.
        """
        plain, power = self.table.products(values)
        with np.errstate(over="ignore", invalid="ignore"):
            matrices = np.ldexp(plain, power[:, None, None])
            if self.half:
                n = plain.shape[-1] // 2
                sums = 2.0 * mirrored_sums(matrices)
                change = n + 4.0 * frobenius(matrices[:, :n, n:]) * frobenius(matrices[:, n:, :n])
                found, weight = weighed_characteristic(sums, n, change)
                found, weight = from_sum(found), weight @ np.abs(sum_weights_back(n))
            else:
                wanted = plain.shape[-1] // (2 if self.reduced else 1)
                found, weight = weighed_characteristic(matrices, wanted)
        finite = np.all(np.isfinite(found) & np.isfinite(weight), axis=-1)
        if not np.all(finite):
            grown = ~finite & np.all(np.isfinite(plain), axis=(-2, -1))
            # Half a period tells the trace of the whole but for a unit matrix, which is lost in it.
            traced = mirrored_sums(plain) - np.eye(plain.shape[-1] // 2) if self.half else plain
            sign = np.sign(np.trace(traced, axis1=-2, axis2=-1))
            found[~finite], weight[~finite] = np.nan, np.inf
            found[grown] = np.where(sign[grown] > 0, -np.inf, np.inf)[:, None]
        return found, weight


def _each(lines: Sequence[Line], values: Array) -> tuple[Array, Array]:
    """Return the same from lines that hold for one value each."""
    found, weight = zip(
        *(line(value) for line, value in zip(lines, values[:, None], strict=True)), strict=True
    )
    return np.concatenate(found), np.concatenate(weight)


def mirrored_sums(halves: Array) -> Array:
    """Return P with ``X + X^-1 = diag(2 P, 2 P^T)``, X over a period that is its own mirror image.

    With F = [[a, b], [c, d]] over half a period and R = diag(1, -1), ``X = R F^-1 R F``; F is
    symplectic, so that the upper left block of X is ``1 + 2 b^T c``, and X^-1 = R X R.
    """
    n = halves.shape[-1] // 2
    cross = np.swapaxes(halves[..., :n, n:], -1, -2) @ halves[..., n:, :n]
    return np.asarray(np.eye(n) + 2.0 * cross)


def is_mirrored(equation: Equation) -> bool:
    """Return whether a system is the same after a reversal of the crank.

    Mass and stiffness are even functions of the angle then, A is odd, and nothing is damped.
    """
    if equation.damped or equation.harmonics < 0:
        return False
    angles = equation.even_angles()
    for name in equation.fields:
        value = equation.at(name, angles)
        # A constant has one place.
        back = value if value.shape[1] == 1 else np.roll(value[:, ::-1], 1, axis=1)
        odd = -1.0 if name == "gyroscopic" else 1.0
        if not np.max(np.abs(value - odd * back)) <= _ALIKE * np.max(np.abs(value)):
            return False
    return True


class Lines:
    """Makes the lines of a chart.

    The inner axis is the speed where that is one of the axes; of two others one that is no
    geometry, for which the system is made anew at each value.
    """

    def __init__(self, sampler: Sampler) -> None:
        self.system, self.names = sampler.system, sampler.names
        self.back, self.reduced = sampler.back, sampler.reduced
        self.inner = self.names.index("speed") if "speed" in self.names else 0
        if self.names[self.inner] in self.system.geometry:
            self.inner = 1
        self.speed = sampler.speed
        variable = sampler.transform(self.names[self.inner], sampler.axes[self.inner])
        self.ends = float(variable.min()), float(variable.max())

    @property
    def inner_is_geometry(self) -> bool:
        """Whether the system is made anew at each point."""
        return self.names[self.inner] in self.system.geometry

    def line(self, outer: float, values: Array, fineness: float = 1.0) -> Samples:
        """Return the line at a value of the outer axis; of two geometries at given values alone."""
        inner_name, outer_name = self.names[self.inner], self.names[1 - self.inner]
        fixed = {outer_name: float(outer)}
        if not self.inner_is_geometry:
            return self._table(fixed, inner_name, self.ends, fineness)
        points = [({**fixed, inner_name: float(v)}, float(v)) for v in values]
        return partial(_each, [self._table(at, None, (v, v), fineness) for at, v in points])

    def error(self, values: Array, known: tuple[float, Array]) -> Array:
        """Return by how much another solution differs from invariants, over the weight of errors.

        Known are the place of a line and what was found there.  One number per value; 0 where
        either overflows, infinite where either is NaN.
        """
        outer, found = known
        # Another number of segments gives another solution: thrice the difference is the error.
        again, weight = self.line(outer, values, 1.37)(values)
        grown = np.isinf(again) | np.isinf(found)
        with np.errstate(invalid="ignore"):
            gap = np.where(grown, 0.0, np.abs(again - found) / weight)
        worst: Array = np.max(np.where(np.isnan(gap), np.inf, gap), axis=-1)
        return 3.0 * worst

    def _table(
        self, fixed: dict[str, float], inner: str | None, ends: tuple[float, float], fineness: float
    ) -> Line:
        system, rest = at_geometry(self.system, fixed)
        known = sampled(system)

        def plain(values: Array) -> Equation:
            point: dict[str, Any] = {**rest}
            if inner is not None:
                point[inner] = self.back(inner, values)
            speed = np.broadcast_to(point.pop("speed", self.speed), values.shape)
            return equation_of(known, speed, point)

        # To begin with: at most lines of the scenes' charts twelve nodes are enough.
        nodes = 12 if ends[1] > ends[0] else 1
        judged = plain(places(ends, nodes))
        unit = judged.scale[len(judged.scale) // 2]
        # A bound of what modes that no segment resolves make of waves doubles a chart's time, for
        # no smaller error.  Longer segments vary more along the axis: with 32 of them the rod of a
        # quick return wants 18 nodes in place of 12, and half as much time again as with 48.
        way, count = cheapest(judged, _RTOL, 16, fewest=48, stiff=False)
        # A multiple of 16 can be multiplied by pairs, of half a period too.
        count = 16 * int(np.ceil(fineness * count / 16))

        def scaled(values: Array) -> Equation:
            made = plain(values)
            return replace(made, scale=np.broadcast_to(unit, made.scale.shape))

        half = self.reduced and is_mirrored(judged)
        first = replace(judged, scale=np.broadcast_to(unit, judged.scale.shape))
        table = table_of(scaled, ends, count, way, _RTOL, half=half, nodes=nodes, first=first)
        return Line(table, half, self.reduced)


class HillLines:
    """The lines of a chart of one mode.

    The axis that changes the function of Hill's equation is the outer one.
    """

    inner_is_geometry = False

    def __init__(self, sampler: Sampler, form: HillForm) -> None:
        self.inner = 0 if leaves_function_alone(form, sampler.names[0]) else 1
        self._shared = leaves_function_alone(form, sampler.names[self.inner])
        self._form, self._back, self._speed = form, sampler.back, sampler.speed
        self._along, self._outer = sampler.names[self.inner], sampler.names[1 - self.inner]

    def line(self, outer: float, values: Array) -> Samples:
        """Return the line at a value of the outer axis."""
        return partial(self._half_traces, float(self._back(self._outer, np.asarray(outer))))

    def _half_traces(self, outer: float, values: Array) -> tuple[Array, Array]:
        """Return half traces and their errors, ``(n, 1)`` each."""
        form = self._form
        along = self._back(self._along, values)
        points = [{self._outer: outer, self._along: float(v)} for v in along]
        speeds = np.array([p.pop("speed", self._speed) for p in points])
        lam2 = np.array([form.stiffness(**p) for p in points]) / speeds**2
        damping = np.array([form.damping(**p) for p in points]) / (2 * speeds)
        # Points of one function go together.
        runs = [slice(None)] if self._shared else [slice(i, i + 1) for i in range(len(speeds))]
        found = [
            discriminant(
                form.function(float(speeds[run][0]), **points[run][0]), lam2[run], 1.0, damping[run]
            )
            for run in runs
        ]
        value = np.concatenate([one.value for one in found])
        error = np.concatenate([np.broadcast_to(one.error, one.value.shape) for one in found])
        return value[:, None], error[:, None]


def invariants(sampler: Sampler, workers: Map, *, progress: bool) -> Series:
    """Return the invariants of a chart in the way that suits it, its lines by ``workers``."""
    if sampler.plain is not None:
        return _plain_hill(sampler, *sampler.plain)
    surface = _Surface(sampler, workers)
    surface.find_inner()
    # Of one mode, whose lines are cheap, no fewer than are worth a series; 0: one at every value.
    fewest = 2 * _FEWEST_LINES if sampler.hill else _FEWEST_LINES
    lines = 0 if len(surface.across) <= fewest else _FEWEST_LINES
    while True:
        with bar(progress, lines or len(surface.across)) as tick:
            found = surface.sample(lines, tick)
        if surface.too_wide(found.values) and (lines or surface.count):
            # No series spans this; every point for itself.
            surface.set_count(len(surface.wanted))
            lines = 0
            continue
        wanted = surface.refined(found, lines)
        if wanted is None:
            return surface.series(found)
        lines = wanted


def _plain_hill(
    sampler: Sampler, which: int, f: PeriodicFunction, lam2: Callable[[Array], Array]
) -> Series:
    """Return half traces where the axes are lam2 and the factor of one function."""
    axes = sampler.axes
    order = np.argsort(lam2(axes[which]))
    found = discriminant(f, lam2(axes[which])[order, None], axes[1 - which])
    values, error = np.empty_like(found.value), np.empty_like(found.value)
    values[order], error[order] = found.value, found.error
    if which == 0:
        values, error = values.T, error.T
    sample = relative_error(error, values[..., None])
    return Series(values[..., None], error, sample, (0, 0), f"half trace, {found.method}")


class _Found(NamedTuple):
    """Invariants on lines, ``values`` and the ``weight`` of their errors ``(lines, nodes, k)``."""

    outer: Array
    values: Array
    weight: Array
    direct: bool


class _Surface:
    """A chart whose inner axis is solved line by line."""

    def __init__(self, sampler: Sampler, workers: Map) -> None:
        self.sampler, self.workers = sampler, workers
        form = sampler.form
        self.lines: Lines | HillLines = Lines(sampler) if form is None else HillLines(sampler, form)
        which = self.lines.inner
        self.wanted = sampler.transform(sampler.names[which], sampler.axes[which])
        self.across = sampler.transform(sampler.names[1 - which], sampler.axes[1 - which])
        self.low, self.high = float(self.wanted.min()), float(self.wanted.max())
        self.count = 0
        self.ends: dict[float, Samples] = {}
        # Tails before the last refinement: round-off, where it has not halved them.
        self.before = {"inner": np.inf, "outer": np.inf}
        self.kept: dict[float, tuple[Array, Array]] = {}

    @property
    def values(self) -> Array:
        """Where lines are sampled: at nodes, or at every value of the chart."""
        if not self.count:
            return self.wanted
        half = 0.5 * (self.high - self.low)
        return np.asarray(0.5 * (self.low + self.high) + half * chebyshev.nodes(self.count))

    def limit(self, size: float) -> float:
        """Return how large a tail may be: no larger where only other parts of the chart grow."""
        # Round-off of samples, roughly, relative to the largest, below which no tail falls.
        return max(self.sampler.rtol, 1e-12 * size)

    def find_inner(self) -> None:
        """Settle how many nodes a line needs, judged on the lines at both ends of the other axis.

        The number is doubled until the tail is small; then the coefficients tell where it begins.
        """
        if len(self.wanted) <= _FIRST or self.lines.inner_is_geometry:
            return
        self.sampler.allowed(2, len(self.wanted))
        self.count = _FIRST
        self.ends = {
            float(outer): self.lines.line(float(outer), self.wanted)
            for outer in self.across[[0, -1]]
        }
        while self.count < 2 * len(self.wanted):
            found = [line(self.values)[0] for line in self.ends.values()]
            if any(self.too_wide(values) for values in found):
                self.set_count(len(self.wanted))
                return
            tables = [chebyshev.analysis(self.count) @ values for values in found]
            size = max(1.0, max(float(np.max(np.abs(table))) for table in tables))
            sizes = np.max(np.abs(np.concatenate(tables, axis=1)), axis=1)
            needed = chebyshev.length(sizes, self.limit(size) / 8)
            if needed <= self.count - max(2, self.count // 16):
                # Inside the chart a little more may be needed than at its edges.
                self.set_count(needed + 3 + needed // 16)
                return
            self.count *= 2
        self.set_count(self.count)

    @staticmethod
    def too_wide(values: Array) -> bool:
        """Return whether invariants grow so much that a series would lose the others."""
        # Invariants beyond this are not interpolated: elsewhere in the chart others are about 1.
        return not float(np.max(np.abs(values))) <= 1e8

    def set_count(self, count: int) -> None:
        """Take so many nodes, or every value of the chart where those are hardly more."""
        self.count = 0 if count > _NEARLY_ALL * len(self.wanted) else count
        self.kept.clear()

    def places(self, lines: int) -> Array:
        """Return where the lines lie: all values of the axis, or nested Chebyshev points."""
        if not lines:
            return self.across
        low, high = float(self.across.min()), float(self.across.max())
        places = np.asarray(0.5 * (low + high) + 0.5 * (high - low) * chebyshev.extrema(lines))
        places[[0, -1]] = high, low
        return places

    def sample(self, lines: int, tick: Tick) -> _Found:
        """Return the invariants on a number of lines; those that are known are not solved again."""
        places = self.places(lines)
        values = self.values
        self.sampler.allowed(len(places), len(values))
        wanted = [float(place) for place in places if float(place) not in self.kept]
        for place in [place for place in wanted if place in self.ends]:
            self.kept[place] = self.ends[place](values)
        left = [place for place in wanted if place not in self.ends]
        solved = self.workers(partial(_on_line, self.lines, values), left)
        for done, (place, found) in enumerate(zip(left, solved, strict=True), start=1):
            self.kept[place] = found
            tick(len(places) - len(left) + done)
        rows = [self.kept[float(place)] for place in places]
        return _Found(
            places, np.stack([r[0] for r in rows]), np.stack([r[1] for r in rows]), not lines
        )

    def table(self, found: _Found) -> Array:
        """Return Chebyshev coefficients along both axes, values along one that is taken whole."""
        table = found.values
        if not found.direct:
            table = chebyshev.extrema_coefficients(table)
        if self.count:
            table = np.einsum("ij,ljk->lik", chebyshev.analysis(self.count), table, optimize=True)
        return np.asarray(table)

    def tails(self, found: _Found) -> tuple[float, float, float]:
        """Return the tails along lines and across them, and the size of the coefficients."""
        table = np.abs(self.table(found))
        inner = _tail(np.max(table, axis=(0, 2))) if self.count else 0.0
        outer = 0.0 if found.direct else _tail(np.max(table, axis=(1, 2)))
        return inner, outer, max(1.0, float(np.max(table)))

    def refined(self, found: _Found, lines: int) -> int | None:
        """Return how many lines are wanted next, where need be of more nodes; None when settled."""
        inner, outer, size = self.tails(found)
        if not self._settled("outer", outer, size) and lines:
            more = 2 * lines - 1
            return 0 if more > _NEARLY_ALL * len(self.across) else more
        if not self._settled("inner", inner, size) and self.count:
            self.set_count(self.count + self.count // 3)
            return lines
        return None

    def _settled(self, axis: str, tail: float, size: float) -> bool:
        """Return whether a tail is small, or no more than round-off, which more nodes keep."""
        before, self.before[axis] = self.before[axis], tail
        # Tails beyond this are no round-off.
        return tail <= self.limit(size) or 0.5 * before < tail <= 1e-8 * size

    def series(self, found: _Found) -> Series:
        """Return the chart from the samples."""
        with np.errstate(invalid="ignore"):
            errors = self.solution_error(found)[:, None] * found.weight
        error = np.max(errors, axis=-1)
        sample = relative_error(error, found.values)
        what = "half trace" if self.sampler.hill else "characteristic polynomial"
        nodes = [0, 0]
        nodes[self.lines.inner] = self.count
        nodes[1 - self.lines.inner] = 0 if found.direct else len(found.outer)
        if not any(nodes):
            values = found.values
            if self.lines.inner == 1:
                values, error, errors = (np.swapaxes(a, 0, 1) for a in (values, error, errors))
            return Series(values, error, sample, (0, 0), f"{what} at each point", errors)
        inner, outer, size = self.tails(found)
        table = self.table(found)
        if self.count:
            place = chebyshev.unit(self.wanted, self.low, self.high)
            along = chebyshev.basis(place, self.count).T
            table = np.einsum("xi,lik->lxk", along, table, optimize=True)
        if not found.direct:
            low, high = float(self.across.min()), float(self.across.max())
            place = chebyshev.unit(self.across, low, high)
            table = np.tensordot(chebyshev.basis(place, len(found.outer)).T, table, axes=1)
        # Round-off of the series is spread over the chart by its largest values.
        total = inner + outer + float(np.max(error)) + 8 * _EPS * size
        error = np.full(table.shape[:2], total)
        if self.lines.inner == 1:
            table, error = np.swapaxes(table, 0, 1), error.T
        method = f"{what} at Chebyshev nodes, spectral interpolation"
        return Series(table, error, sample, (nodes[0], nodes[1]), method)

    def solution_error(self, found: _Found) -> Array:
        """Return the relative error of samples at each value, from other solutions on four lines.

        The differences are those of the value itself and of its neighbours.  Half traces know their
        error.
        """
        if isinstance(self.lines, HillLines):
            return np.ones(len(self.values))
        with np.errstate(invalid="ignore"):
            grown = int(np.argmax(np.max(found.weight, axis=(1, 2))))
        picked = sorted({0, len(found.outer) // 2, len(found.outer) - 1, grown})
        items = [(float(found.outer[i]), found.values[i]) for i in picked]
        gaps = self.workers(partial(self.lines.error, self.values), items)
        gap = np.pad(np.max(list(gaps), axis=0), 1, mode="edge")
        return np.asarray(np.maximum(np.maximum(gap[:-2], gap[1:-1]), gap[2:]) + 64 * _EPS)


def _on_line(lines: Lines | HillLines, values: Array, outer: float) -> tuple[Array, Array]:
    return lines.line(outer, values)(values)


def _tail(sizes: Array) -> float:
    """Return the sum of the sizes of the last two coefficients (an eighth of many) of an axis."""
    return float(np.sum(sizes[-min(max(2, len(sizes) // 32), 8) :]))
