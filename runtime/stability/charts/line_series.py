"""Invariants of several modes over a chart: few lines, a few nodes on each, or every point."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...core import chebyshev
from ...core.families import Array
from ...core.progress import bar
from .lines import Line, Lines
from .sampling import Sampler, Series, relative_error

_EPS = float(np.finfo(float).eps)
# Nodes to begin with on a line, and lines across it.
_FIRST, _FEWEST_LINES = 32, 9
# Share of the values along an axis from which each of them is taken instead of nodes.
_NEARLY_ALL = 0.8
# Round-off of samples, roughly, relative to the largest, below which no tail falls.
_NOISE = 1e-12
# Invariants beyond this are not interpolated: elsewhere in the chart others are about 1.
_WIDE = 1e8
# Tails beyond this are no round-off.
_SMALL = 1e-8

Tick = Callable[[int], None] | None
# Value of the outer axis, ends and values of the variable of the inner one.
_Place = tuple[float, float, float, Array]


def series_by_lines(sampler: Sampler, *, progress: bool) -> Series:
    """Return the invariants of a chart of several modes.

    Parameters
    ----------
    sampler : Sampler
        The chart.
    progress : bool
        Whether to show a progress bar.

    Returns
    -------
    Series
        ``nodes`` is 0 along an axis all of whose values were taken.

    Raises
    ------
    BadInput
        If modes, lines and nodes amount to more than an hour or so.
    """
    surface = _Surface(sampler)
    surface.find_inner()
    lines = surface.first_lines()
    while True:
        with bar(progress, lines or len(surface.across)) as tick:
            found = surface.sample(lines, tick)
        if surface.too_wide(found.values) and (lines or surface.count):
            # No series spans this; every point for itself.
            surface.set_count(len(surface.wanted))
            lines = 0
            continue
        grown = surface.next_lines(found, lines)
        if grown == lines and not surface.grow_inner(found):
            return surface.series(found)
        lines = grown


class _Found:
    """Invariants on lines, ``values`` and the ``weight`` of their errors ``(lines, nodes, k)``."""

    def __init__(self, outer: Array, values: Array, weight: Array, direct: bool) -> None:
        self.outer, self.values, self.weight, self.direct = outer, values, weight, direct


class _Surface:
    """A chart whose inner axis is solved line by line."""

    def __init__(self, sampler: Sampler) -> None:
        self.sampler = sampler
        self.lines = Lines(sampler)
        which = self.lines.inner
        self.wanted = sampler.transform(sampler.names[which], sampler.axes[which])
        self.across = sampler.axes[1 - which]
        self.low, self.high = float(self.wanted.min()), float(self.wanted.max())
        self.count = 0
        self.ends: dict[float, Line] = {}
        # Tails before the last refinement: round-off, where it has not halved them.
        self.before = (np.inf, np.inf)
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
        return max(self.sampler.rtol, _NOISE * size)

    def line(self, outer: float) -> Line:
        """Return a line of the chart."""
        if outer not in self.ends:
            return self.lines.line(outer, self.low, self.high, self.values)
        return self.ends[outer]

    def find_inner(self) -> None:
        """Settle how many nodes a line needs, judged on the lines at both ends of the other axis.

        The number is doubled until the tail is small; then the coefficients tell where it begins.
        """
        if len(self.wanted) <= _FIRST or self.lines.inner_is_geometry:
            return
        self.sampler.allowed(2, len(self.wanted))
        self.ends = {float(outer): self.line(float(outer)) for outer in self.across[[0, -1]]}
        self.count = _FIRST
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
        return not float(np.max(np.abs(values))) <= _WIDE

    def set_count(self, count: int) -> None:
        """Take so many nodes, or every value of the chart where those are hardly more."""
        self.count = 0 if count > _NEARLY_ALL * len(self.wanted) else count
        self.kept.clear()

    def first_lines(self) -> int:
        """Return with how many lines to begin; 0 stands for one at every value."""
        return 0 if len(self.across) <= _FEWEST_LINES else _FEWEST_LINES

    def places(self, lines: int) -> Array:
        """Return where the lines lie: all values of the axis, or nested Chebyshev points."""
        if not lines:
            return self.across
        low, high = float(self.across[0]), float(self.across[-1])
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
        done = len(places) - len(left)
        items = [(place, self.low, self.high, values) for place in left]
        for number, found in self.sampler.workers.run(_on_line, items):
            self.kept[left[number]] = found
            done += 1
            if tick is not None:
                tick(done)
        rows = [self.kept[float(place)] for place in places]
        return _Found(
            places, np.stack([r[0] for r in rows]), np.stack([r[1] for r in rows]), not lines
        )

    def table(self, found: _Found) -> Array:
        """Return Chebyshev coefficients along both axes, values along one that is taken whole."""
        table = found.values
        if not found.direct:
            table = np.tensordot(chebyshev.extrema_analysis(len(found.outer)), table, axes=1)
        if self.count:
            table = np.einsum("ij,ljk->lik", chebyshev.analysis(self.count), table, optimize=True)
        return np.asarray(table)

    def tails(self, found: _Found) -> tuple[float, float, float]:
        """Return the tails along lines and across them, and the size of the coefficients."""
        table = np.abs(self.table(found))
        inner = _tail(np.max(table, axis=(0, 2))) if self.count else 0.0
        outer = 0.0 if found.direct else _tail(np.max(table, axis=(1, 2)))
        return inner, outer, max(1.0, float(np.max(table)))

    def next_lines(self, found: _Found, lines: int) -> int:
        """Return how many lines are wanted next; the same number where the tail is small."""
        _, outer, size = self.tails(found)
        settled = self._settled(outer, self.before[0], size)
        self.before = (outer, self.before[1])
        if not lines or settled:
            return lines
        more = 2 * lines - 1
        return 0 if more > _NEARLY_ALL * len(self.across) else more

    def grow_inner(self, found: _Found) -> bool:
        """Take more nodes where the lines inside the chart need them; return whether so."""
        inner, _, size = self.tails(found)
        settled = self._settled(inner, self.before[1], size)
        self.before = (self.before[0], inner)
        if not self.count or settled:
            return False
        self.set_count(self.count + self.count // 3)
        return True

    def _settled(self, tail: float, before: float, size: float) -> bool:
        """Return whether a tail is small, or no more than round-off, which more nodes keep."""
        return tail <= self.limit(size) or 0.5 * before < tail <= _SMALL * size

    def series(self, found: _Found) -> Series:
        """Return the chart from the samples."""
        with np.errstate(invalid="ignore"):
            errors = self.solution_error(found)[:, None] * found.weight
        error = np.max(errors, axis=-1)
        sample = relative_error(error, found.values)
        nodes = [0, 0]
        nodes[self.lines.inner] = self.count
        nodes[1 - self.lines.inner] = 0 if found.direct else len(found.outer)
        if not any(nodes):
            values = found.values
            if self.lines.inner == 1:
                values, error, errors = (np.swapaxes(a, 0, 1) for a in (values, error, errors))
            return Series(values, error, sample, (0, 0), _method(nodes), errors)
        inner, outer, size = self.tails(found)
        table = self.table(found)
        if self.count:
            place = chebyshev.unit(self.wanted, self.low, self.high)
            along = chebyshev.basis(place, self.count).T
            table = np.einsum("xi,lik->lxk", along, table, optimize=True)
        if not found.direct:
            low, high = float(self.across[0]), float(self.across[-1])
            place = chebyshev.unit(self.across, low, high)
            table = np.tensordot(chebyshev.basis(place, len(found.outer)).T, table, axes=1)
        # Round-off of the series is spread over the chart by its largest values.
        total = inner + outer + float(np.max(error)) + 8 * _EPS * size
        error = np.full(table.shape[:2], total)
        if self.lines.inner == 1:
            table, error = np.swapaxes(table, 0, 1), error.T
        return Series(table, error, sample, (nodes[0], nodes[1]), _method(nodes))

    def solution_error(self, found: _Found) -> Array:
        """Return the relative error of samples at each value, from other solutions on four lines.

        The differences are those of the value itself and of its neighbours.
        """
        with np.errstate(invalid="ignore"):
            grown = int(np.argmax(np.max(found.weight, axis=(1, 2))))
        picked = sorted({0, len(found.outer) // 2, len(found.outer) - 1, grown})
        values = self.values
        items = [
            (float(found.outer[i]), self.low, self.high, values, found.values[i]) for i in picked
        ]
        gaps = self.sampler.workers.map(_gap_on_line, items)
        gap = np.pad(np.max(gaps, axis=0), 1, mode="edge")
        return np.asarray(np.maximum(np.maximum(gap[:-2], gap[1:-1]), gap[2:]) + 64 * _EPS)


def _on_line(sampler: Sampler, place: _Place) -> tuple[Array, Array]:
    """Return the invariants on a line, and the weights of their errors."""
    return Lines(sampler).line(*place)(place[3])


def _gap_on_line(sampler: Sampler, item: tuple[float, float, float, Array, Array]) -> Array:
    """Return by how much another solution differs on a line."""
    return Lines(sampler).error(*item)


def _method(nodes: list[int]) -> str:
    if not any(nodes):
        return "characteristic polynomial at each point"
    return "characteristic polynomial at Chebyshev nodes, spectral interpolation"


def _tail(sizes: Array) -> float:
    """Return the sum of the sizes of the last two coefficients (an eighth of many) of an axis."""
    return float(np.sum(sizes[-min(max(2, len(sizes) // 32), 8) :]))
