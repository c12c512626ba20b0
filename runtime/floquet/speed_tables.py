"""Monodromy matrices of one system at very many speeds, from tables over the speed.

Over a stretch of the crank angle in which no mode turns far, the transition matrix is a smooth
function of the inverse speed: a polynomial through few speeds gives it to round-off for all
speeds between.  The product of the stretches is then the monodromy matrix; its fast turning with
the speed never has to be resolved by the polynomials.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..families import LinearPeriodic, Term
from ..integrators.gauss_legendre import gauss_maps
from .first_order import CanonicalForm, canonical_form
from .period_products import STAGES, ordered_product, period_product
from .refined_products import Refined, distance, refined_products, rounding_error

Array = NDArray[np.float64]

# Ratio of the speeds of one table, and segments in a stretch with the phase that each may turn.
_RATIO, _MERGED, _PHASE = 2.0, 4, 1.5
# Speeds that the polynomials go through; the greater number where the smaller does not do.
_NODES = (18, 26)
_FEWEST = 4
# Error over the largest entry, at speeds between, beyond which a table is not used.
_MOST = 1e-8
# What the error at the speeds tried is multiplied by.
_MARGIN = 4.0
_TRIED = np.array([0.0, 0.381966, 1.0])
_BLOCK_FLOATS = 4_000_000


@dataclass(frozen=True)
class SpeedTable:
    """Transition matrices of even stretches of the period over a range of speeds.

    Attributes
    ----------
    low, high : float
        The range [rad/s].
    nodes : ndarray
        Inverse speeds that the polynomials go through, shape ``(m,)``.
    weights : ndarray
        Of their barycentric form, shape ``(m,)``.
    maps : ndarray
        Shape ``(m, stretches, 2n, 2n)``, scaled by ``size`` and the root of the speed.
    size : ndarray
        Scale of the state at a speed of 1 rad/s, shape ``(2n,)``.
    error : float
        Largest error over the largest entry of the monodromy matrices.
    """

    low: float
    high: float
    nodes: Array
    weights: Array
    maps: Array
    size: Array
    error: float

    def products(self, speed: Array, scale: Array) -> tuple[Array, NDArray[np.int64]]:
        """Return the monodromy matrices at speeds, in wanted scales, and powers of two."""
        together = max(1, _BLOCK_FLOATS // self.maps[0].size)
        found, powers = [], []
        for begin in range(0, len(speed), together):
            part = speed[begin : begin + together]
            rows = barycentric_rows(self.nodes, self.weights, 1.0 / part)
            stretches = rows @ self.maps.reshape(len(self.nodes), -1)
            product, power = ordered_product(stretches.reshape(-1, *self.maps.shape[1:]))
            own = _scale(self.size, part)
            found.append(_rescaled(product, own, scale[begin : begin + together]))
            powers.append(power)
        return np.concatenate(found), np.concatenate(powers)


def chebyshev_places(low: float, high: float, count: int) -> tuple[Array, Array]:
    """Return places between two ends for polynomials, and the weights of their barycentric form.

    Parameters
    ----------
    low, high : float
        The ends.
    count : int
        How many places.

    Returns
    -------
    nodes, weights : ndarray, shape (count,)
        Places from high to low, none of them an end, and weights.
    """
    order = np.pi * (np.arange(count) + 0.5) / count
    nodes = 0.5 * (low + high) + 0.5 * (high - low) * np.cos(order)
    return nodes, np.where(np.arange(count) % 2, -1.0, 1.0) * np.sin(order)


def barycentric_rows(nodes: Array, weights: Array, places: Array) -> Array:
    """Return what the values at nodes count at places, of the polynomial through them.

    Parameters
    ----------
    nodes, weights : ndarray, shape (m,)
        From :func:`chebyshev_places`.
    places : ndarray, shape (k,)
        Where the polynomial is wanted.

    Returns
    -------
    ndarray, shape (k, m)
    """
    gap = places[:, None] - nodes
    met = gap == 0.0
    parts = weights / np.where(met, 1.0, gap)
    rows = np.where(np.any(met, axis=1, keepdims=True), met, parts)
    value: Array = rows / np.sum(rows, axis=1, keepdims=True)
    return value


def _scale(size: Array, speed: Array) -> Array:
    """Return scales of the state that change with the speed as the frequencies over it do."""
    half = len(size) // 2
    root = np.sqrt(speed)[:, None]
    return np.concatenate([size[:half] * root, size[half:] / root], axis=1)


def _rescaled(matrices: Array, own: Array, wanted: Array) -> Array:
    """Return scaled matrices ``(k, [ns,] m, m)`` in other scales ``(k, m)``."""
    ratio = own / wanted
    ratio = ratio.reshape(len(ratio), *(1,) * (matrices.ndim - 3), -1)
    value: Array = matrices * ratio[..., :, None] / ratio[..., None, :]
    return value


@dataclass(frozen=True)
class TabulatedSystem(LinearPeriodic):
    """A linear periodic system with tables of its transition matrices over the speed.

    Whatever asks for monodromy matrices at its own parameters within the tables' speeds gets them
    from there.

    Attributes
    ----------
    tables : tuple of SpeedTable
        By rising speed.
    tabulated : tuple of Term or None
        The terms that they were made of: with others, of a system made from this one, they do
        not count.
    """

    tables: tuple[SpeedTable, ...] = ()
    tabulated: tuple[Term, ...] | None = None


def tabulated(system: LinearPeriodic, span: tuple[float, float]) -> LinearPeriodic:
    """Return the same system with tables over a range of speeds, where they are right.

    Parameters
    ----------
    system : LinearPeriodic
        Whose lowest frequency is not far below its highest: a table has a stretch for every
        turn or so of the fastest mode at its lowest speed.
    span : pair of float
        Lowest and highest speed [rad/s].
    """
    count = max(1, int(np.ceil(np.log(span[1] / span[0]) / np.log(_RATIO) - 1e-9)))
    ends = span[0] * (span[1] / span[0]) ** (np.arange(count + 1) / count)
    # Rounding must not leave the ends out.
    ends[[0, -1]] = span[0] * (1.0 - 1e-12), span[1] * (1.0 + 1e-12)
    made = [_table(system, low, high) for low, high in pairwise(ends.tolist())]
    own = {f.name: getattr(system, f.name) for f in fields(LinearPeriodic)}
    tables = tuple(one for one in made if one is not None)
    return TabulatedSystem(**own, tables=tables, tabulated=system.terms)


def looked_up(form: CanonicalForm, parameters: Mapping[str, ArrayLike], rtol: float) -> Refined:
    """Return :func:`refined_products`, from tables where the system has them."""
    system = form.system
    tables: tuple[SpeedTable, ...] = ()
    if isinstance(system, TabulatedSystem) and not parameters and system.tabulated is system.terms:
        tables = system.tables
    count, m = len(form.speed), form.size
    scaled, exponent = np.zeros((count, m, m)), np.zeros(count, dtype=np.int64)
    error, segments = np.zeros(count), np.zeros(count, dtype=np.int64)
    rest = np.ones(count, dtype=bool)
    for table in tables:
        own = np.flatnonzero(rest & (form.speed >= table.low) & (form.speed <= table.high))
        if not len(own):
            continue
        scaled[own], exponent[own] = table.products(form.speed[own], form.scale[own])
        segments[own], error[own] = _MERGED * table.maps.shape[1], table.error
        rest[own] = False
    left = np.flatnonzero(rest)
    if len(left):
        found = refined_products(form.take(left), rtol)
        scaled[left], exponent[left], error[left], segments[left] = found
    return scaled, exponent, error, segments


def _table(system: LinearPeriodic, low: float, high: float) -> SpeedTable | None:
    """Return the table between two speeds; None where no number of nodes is enough."""
    inverse = (1.0 - _TRIED) / high + _TRIED / low
    tried = canonical_form(system, 1.0 / inverse, {}, probed=False)
    finer: tuple[Array, NDArray[np.int64]] | None = None
    for count in _NODES:
        table = _unchecked(system, low, high, count)
        segments = _MERGED * table.maps.shape[1]
        if finer is None:
            # With half the step the collocation's own error is 2^-16 of the table's.
            finer = period_product(tried, 2 * segments)
        gap = distance(*table.products(tried.speed, tried.scale), *finer)
        noise = rounding_error(tried, 2 * segments)
        table = replace(table, error=float(np.max(_MARGIN * gap + noise)))
        if np.all(gap <= noise):
            break
    return table if table.error <= _MOST else None


def _unchecked(system: LinearPeriodic, low: float, high: float, count: int) -> SpeedTable:
    nodes, weights = chebyshev_places(1.0 / high, 1.0 / low, count)
    form = canonical_form(system, 1.0 / nodes, {}, probed=False)
    middle = form.take(slice(count // 2, count // 2 + 1))
    half = system.size
    root = float(np.sqrt(middle.speed[0]))
    size = np.concatenate([middle.scale[0, :half] / root, middle.scale[0, half:] * root])
    slowest = form.needed_rate[0] * low * nodes[0]
    number = max(_FEWEST, int(np.ceil(slowest * system.period / (_PHASE * _MERGED))))
    number = max(number, int(np.ceil(form.reach / _MERGED)))
    step = system.period / (number * _MERGED)
    scale = _scale(size, form.speed)
    together = max(1, _BLOCK_FLOATS // ((STAGES * form.size) ** 2 * count * _MERGED))
    parts = []
    for begin in range(0, number, together):
        stretches = min(together, number - begin)
        left = step * np.arange(begin * _MERGED, (begin + stretches) * _MERGED, dtype=float)
        maps = gauss_maps(STAGES, form.generator, left, step)
        while maps.shape[1] > stretches:
            maps = maps[:, 1::2] @ maps[:, 0::2]
        parts.append(_rescaled(maps, form.scale, scale))
    return SpeedTable(low, high, nodes, weights, np.concatenate(parts, axis=1), size, 0.0)
