"""Monodromy matrices of one system at very many speeds, from stretches of the turn.

Their polynomials in the inverse speed never have to resolve how fast the monodromy matrix turns
with the speed.  Collocation at some speeds tells the error.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import BadInput
from ..core.families import LinearPeriodic, Term
from .first_order import CanonicalForm, canonical_form
from .period_products import period_product
from .refined_products import Refined, distance, gathered, refined_products, rounding_error
from .turn_series import Turn, TurnSeries

Array = NDArray[np.float64]

# Ratio of the speeds of one table.
_RATIO = 2.0
# Phase that the highest mode turns in a segment of the collocation that tells the error, and the
# fewest segments.
_PHASE, _FEWEST = 0.75, 32
# How many times the stretches that the modes ask for the harmonics of the coefficients may take.
_FINER = 8
# Error over the largest entry, at speeds between, beyond which a table is not used.
_MOST = 1e-8
# What the error at the speeds tried is multiplied by.
_MARGIN = 4.0
_TRIED = np.array([0.0, 0.381966, 1.0])


@dataclass(frozen=True)
class SpeedTable:
    """Monodromy matrices over a range of speeds.

    Attributes
    ----------
    turn : TurnSeries
        Over the inverse speed [s/rad].
    size : ndarray
        Scale of the state that they are in, shape ``(2n,)``.
    error : float
        Largest error over the largest entry of the monodromy matrices.
    """

    turn: TurnSeries
    size: Array
    error: float

    def products(self, speed: Array, scale: Array) -> tuple[Array, NDArray[np.int64]]:
        """Return the monodromy matrices at speeds, in wanted scales, and powers of two."""
        product, power = self.turn.products(1.0 / speed)
        ratio = self.size / scale
        return product * ratio[:, :, None] / ratio[:, None, :], power

    def refined(self, form: CanonicalForm) -> Refined:
        """Return what :func:`refined_products` does, for speeds within the range."""
        count = len(form.speed)
        segments = np.full(count, self.turn.stretches.shape[1], dtype=np.int64)
        return *self.products(form.speed, form.scale), np.full(count, self.error), segments

    def holds(self, speed: Array) -> NDArray[np.bool_]:
        """Return which speeds lie in its range."""
        inverse = 1.0 / speed
        found: NDArray[np.bool_] = (inverse >= self.turn.low) & (inverse <= self.turn.high)
        return found


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
    return gathered(form, _parts(form, tables, rtol))


def _parts(
    form: CanonicalForm, tables: tuple[SpeedTable, ...], rtol: float
) -> Iterator[tuple[NDArray[np.intp], Refined]]:
    """Return the members of a batch that each table holds, and what it gives; then the rest."""
    rest = np.ones(len(form.speed), dtype=bool)
    for table in tables:
        own = np.flatnonzero(rest & table.holds(form.speed))
        if len(own):
            rest[own] = False
            yield own, table.refined(form.take(own))
    left = np.flatnonzero(rest)
    if len(left):
        yield left, refined_products(form.take(left), rtol)


def _table(system: LinearPeriodic, low: float, high: float) -> SpeedTable | None:
    """Return the table between two speeds; None where it is not right."""

    def form_at(inverse: Array) -> CanonicalForm:
        return canonical_form(system, 1.0 / inverse, {}, probed=False)

    # Nothing but the scale is taken from the coordinates: any other transformation costs digits.
    size = form_at(np.array([(1.0 / low / high) ** 0.5])).scale[0]
    own = size[: system.size]
    try:
        turn = Turn(form_at, 1.0 / high, 1.0 / low, modes=(np.diag(own), np.diag(1.0 / own)))
        table = SpeedTable(turn.series(finer=_FINER), size, 0.0)
    except BadInput:
        return None
    inverse = (1.0 - _TRIED) / high + _TRIED / low
    tried = form_at(inverse)
    # Where nothing is lost to the polynomials, what is left is round-off.
    rate = float(np.max(tried.needed_rate))
    segments = max(_FEWEST, int(np.ceil(rate * system.period / _PHASE)), 2 * tried.reach)
    gap = distance(*table.products(tried.speed, tried.scale), *period_product(tried, segments))
    error = float(np.max(_MARGIN * gap + rounding_error(tried, segments)))
    return replace(table, error=error) if error <= _MOST else None
