"""Transition matrices for all values of one variable at once: Chebyshev series of segments.

The segments of the period are solved at a few Chebyshev nodes of the variable, mostly the inverse
speed, and multiplied together as long as the products are still polynomials of that degree to
round-off.  What is left for each value is to evaluate polynomials and to multiply.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, log

import numpy as np
from numpy.typing import NDArray

from ..core import chebyshev
from ..core.errors import bad
from .equation import Equation
from .transition import Method, product, rung, segments_from, segments_of

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
# Chebyshev nodes of small states: more than the segments need, so that their products can be
# tables, too.  Of large ones as many as a few segments need; of any at the most.
_SMALL, _NODES, _TRIED, _TRIAL_NODES, _MOST_NODES = 12, 32, 4, 24, 72
# Numbers in a table: 480 MB.
_MOST_FLOATS = 60_000_000
# Values that are evaluated together, in numbers of their matrices.
_BLOCK = 1_000_000


@dataclass(frozen=True)
class Table:
    """Transition matrices over a range of one variable."""

    low: float  # ends of the variable
    high: float
    # Chebyshev coefficients of the matrices of groups of segments, (nodes, count, m, m), and of
    # those from the left end of its group to each given angle, (nodes, nt, m, m), or (nodes, 0, m,
    # m) where each angle is a left end.
    groups: Array
    inner: Array
    within: NDArray[np.intp]  # the group of each given angle, (nt,)
    tail: float  # what the series leave out, relative to the matrices

    def weights(self, values: Array) -> Array:
        """Return the Chebyshev polynomials at values of the variable, ``(n, nodes)``."""
        places = chebyshev.unit(values, self.low, self.high)
        return np.cos(np.arccos(places)[:, None] * np.arange(len(self.groups)))

    def products(self, values: Array) -> tuple[Array, NDArray[np.int64]]:
        """Return the matrices over the period ``(n, m, m)``, powers of two taken out, and these."""
        together = max(1, _BLOCK // self.groups[0].size)
        parts = [
            product(_mixed(self.weights(values[begin : begin + together]), self.groups))
            for begin in range(0, len(values), together)
        ]
        matrices, exponents = zip(*parts, strict=True)
        return np.concatenate(matrices), np.concatenate(exponents)

    def flows(self, values: Array) -> tuple[Array, Array]:
        """Return the matrices from angle 0 to each given one, and over the period.

        Shapes ``(n, nt, m, m)`` and ``(n, m, m)``.
        """
        weights = self.weights(values)
        single = _mixed(weights, self.groups)
        running = np.empty((len(values), single.shape[1] + 1, *single.shape[2:]))
        running[:, 0] = np.eye(single.shape[-1])
        for k in range(single.shape[1]):
            running[:, k + 1] = single[:, k] @ running[:, k]
        flows = running[:, self.within]
        if self.inner.shape[1]:
            flows = _mixed(weights, self.inner) @ flows
        return flows, running[:, -1]


def _mixed(weights: Array, table: Array) -> Array:
    """Return weighted sums over the first axis of a table."""
    value: Array = (weights @ table.reshape(len(table), -1)).reshape(-1, *table.shape[1:])
    return value


def table_of(
    equation_at: Callable[[Array], Equation],
    ends: tuple[float, float],
    count: int,
    way: Method,
    rtol: float,
    *,
    samples: int = 0,
    half: bool = False,
    nodes: int | None = None,
    first: Equation | None = None,
) -> Table:
    """Return the table of a range, whose ends are equal for one value alone.

    ``equation_at`` goes from values of the variable to the equation there, all members in the same
    scale; ``count`` is the number of segments of the period, ``rtol`` what the series may leave out
    of a matrix, relative to it.  Matrices are wanted at ``samples`` even angles of the period from
    0, too.  With ``half`` half of the period is enough.  A few segments tell how many Chebyshev
    nodes there are to begin with, where ``nodes`` does not; ``first`` is the equation at
    :func:`places` of these, where it is at hand.  Tables beyond 480 MB are refused.
    """
    low, high = ends
    if samples:
        count = samples * -(-count // samples)
    if low == high:
        nodes = 1
    elif nodes is None:
        trial = equation_at(places(ends, _TRIAL_NODES))
        nodes = _nodes_for(trial, count, way, 4.0 * rtol / count)
    equation = equation_at(places(ends, nodes)) if first is None else first
    while True:
        m = 2 * equation.size + equation.forced
        if nodes * (count + samples) * m**2 > _MOST_FLOATS:
            found = f"tables of {8e-6 * nodes * (count + samples) * m**2:.3g} MB"
            fix = "raise the lowest speed or lower samples"
            raise bad("prepare", found, f"at most {8e-6 * _MOST_FLOATS:.3g} MB", fix)
        if half:
            h = equation.period / count
            maps = segments_from(equation, h * np.arange(0.5 * count), h, way).maps
        else:
            maps = segments_of(equation, count, way).maps
        tail = _tail(maps)
        if tail <= max(rtol, 64.0 * _EPS) or nodes == 1 or 2 * nodes > _MOST_NODES:
            break
        nodes += nodes // 2
        equation = equation_at(places(ends, nodes))
    return _grouped(maps, ends, samples, max(tail, 64.0 * _EPS))


def octaves(low: float, high: float) -> Array:
    """Return the ends of parts of a range for one table each, equal ratios of at most 2."""
    # Nodes for an octave cost two thirds of those for its halves.
    count = max(1, ceil(log(high / low) / log(2.0) - 1e-9))
    edges: Array = low * (high / low) ** (np.arange(count + 1) / count)
    edges[[0, -1]] = low, high
    return edges


def places(ends: tuple[float, float], nodes: int) -> Array:
    """Return the values of the variable at Chebyshev nodes, shape ``(nodes,)``."""
    low, high = ends
    return np.asarray(0.5 * (low + high) + 0.5 * (high - low) * chebyshev.nodes(nodes))


def _nodes_for(equation: Equation, count: int, way: Method, tolerance: float) -> int:
    """Return the number of nodes whose last two Chebyshev coefficients are below a tolerance."""
    # The equation is that at a trial number of nodes, the tolerance relative to the largest
    # coefficient.  Coefficients beyond the trial's fall as those of its second half do.
    if 2 * equation.size < _SMALL:
        return _NODES
    h = equation.period / count
    sizes = _sizes(
        _series(segments_from(equation, h * np.arange(0.0, count, count / _TRIED), h, way).maps)
    )
    logs = np.log(np.maximum(sizes / np.max(sizes), _EPS))
    wanted, last = np.log(max(tolerance, 64.0 * _EPS)), float(np.max(logs[-2:]))
    if last <= wanted:
        return chebyshev.length(logs, wanted) + 2
    fall = (logs[len(logs) // 2] - last) / (len(logs) // 2)
    return min(len(logs) + int((last - wanted) / max(fall, 0.01)) + 1, _MOST_NODES)


def flows_at(equation: Equation, count: int, way: Method, samples: int) -> tuple[Array, Array]:
    """Return the matrices from angle 0 to even angles, and over the period, of every member.

    Shapes ``(n, samples, m, m)`` and ``(n, m, m)``; ``count`` segments, or the next multiple of
    the number of angles.
    """
    return products_to(segments_of(equation, samples * -(-count // samples), way).maps, samples)


def products_to(maps: Array, samples: int) -> tuple[Array, Array]:
    """Return products of maps ``(n, count, m, m)``: to even places from the first on, and of all.

    The number of maps is a multiple of that of the places.
    """
    every = maps.shape[1] // samples
    running = np.broadcast_to(np.eye(maps.shape[-1]), maps[:, 0].shape)
    flows = np.empty((len(maps), samples, *maps.shape[2:]))
    for k in range(samples * every):
        if k % every == 0:
            flows[:, k // every] = running
        running = maps[:, k] @ running
    return flows, running


def _series(values: Array) -> Array:
    """Return Chebyshev coefficients over the first axis."""
    flat = chebyshev.analysis(len(values)) @ values.reshape(len(values), -1)
    return np.asarray(flat.reshape(values.shape))


def _sizes(series: Array) -> Array:
    """Return the largest entry of each coefficient, without a copy of large tables."""
    flat = series.reshape(len(series), int(np.prod(series.shape[1:])))
    return np.asarray(np.maximum(flat.max(axis=1, initial=0.0), -flat.min(axis=1, initial=0.0)))


def _tail(maps: Array) -> float:
    """Return the last two Chebyshev coefficients over the largest entry; 0 of one node."""
    if len(maps) == 1:
        return 0.0
    last = chebyshev.analysis(len(maps))[-2:] @ maps.reshape(len(maps), -1)
    return float(np.max(_sizes(last)) / np.max(_sizes(maps)))


def _grouped(maps: Array, ends: tuple[float, float], samples: int, tail: float) -> Table:
    """Multiply neighbouring segments while the products remain polynomials of the same degree."""
    # Entries may not grow too far either: what is small in a group keeps its digits.
    count, size = maps.shape[1], 1
    merged = maps
    while merged.shape[1] % 2 == 0 and size < 8:
        pairs = merged[:, 1::2] @ merged[:, 0::2]
        if _tail(pairs) > 4.0 * tail or np.max(_sizes(pairs)) > 1e3:
            break
        merged, size = pairs, 2 * size
    at = np.arange(samples) * (count // max(samples, 1))
    within, rest = at // size, at % size
    inner = maps[:, :0]
    if np.any(rest):
        inner = np.empty((len(maps), samples, *maps.shape[2:]))
        running = np.broadcast_to(
            np.eye(maps.shape[-1]), (len(maps), count // size, *maps.shape[2:])
        )
        for place in range(size):
            inner[:, rest == place] = running[:, within[rest == place]]
            if place + 1 < size:
                running = maps[:, place::size] @ running
    series = [_series(merged), _series(inner)]
    sizes = np.maximum(*(_sizes(part) for part in series))
    used = chebyshev.length(sizes, _EPS * float(np.max(sizes)))
    left = _tail(merged) * (count // size)
    return Table(*ends, series[0][:used], series[1][:used], within, left)


def next_rung(count: int) -> int:
    """Return the least number of segments of the ladder that is larger."""
    level = 0
    while rung(level) <= count:
        level += 1
    return rung(level)
