"""Coefficients of one-step methods, as data that prove themselves when they are made."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import ClassVar

import numpy as np

from ..core.errors import SelfCheckFailed
from .collocation import Array, CollocationTableau

Tree = tuple["Tree", ...]


@dataclass(frozen=True)
class ExplicitTableau:
    """Butcher coefficients of an explicit Runge-Kutta method, as exact fractions.

    The constructor checks the row sums and every rooted-tree condition up to the declared order,
    and that some condition of the next order fails.

    Attributes
    ----------
    name : str
        Name of the method.
    c : tuple of Fraction
        Nodes.
    a : tuple of tuple of Fraction
        Stage weights; row i holds i entries.
    b : tuple of Fraction
        Weights of the step.
    order : int
        Order of the step.
    error : tuple of Fraction, optional
        Weights of the estimate of the local error, ``h sum_i error_i k_i``.

    Raises
    ------
    SelfCheckFailed
        If a row sum or an order condition does not hold.
    """

    name: str
    c: tuple[Fraction, ...]
    a: tuple[tuple[Fraction, ...], ...]
    b: tuple[Fraction, ...]
    order: int
    error: tuple[Fraction, ...] | None = None

    def __post_init__(self) -> None:
        for i, (node, row) in enumerate(zip(self.c, self.a, strict=True)):
            if len(row) != i or sum(row, Fraction(0)) != node:
                raise SelfCheckFailed(f"{self.name}: row {i} does not sum to its node {node}")
        observed = self.attained_order(self.b)
        if observed != self.order:
            raise SelfCheckFailed(
                f"{self.name}: declared order {self.order}, conditions {observed}"
            )
        if self.error is not None and sum(self.error, Fraction(0)) != 0:
            raise SelfCheckFailed(f"{self.name}: the error weights do not sum to zero")

    def attained_order(self, weights: tuple[Fraction, ...]) -> int:
        """Return the largest order whose rooted-tree conditions all hold for ``weights``."""
        order = 0
        while all(
            sum(w * phi for w, phi in zip(weights, self._elementary(tree), strict=True))
            == Fraction(1, _density(tree))
            for tree in rooted_trees(order + 1)
        ):
            order += 1
        return order

    def _elementary(self, tree: Tree) -> list[Fraction]:
        """Return the elementary weights of the stages for one tree."""
        product = [Fraction(1)] * len(self.c)
        for branch in tree:
            inner = self._elementary(branch)
            for i, row in enumerate(self.a):
                product[i] *= sum((a * inner[j] for j, a in enumerate(row)), Fraction(0))
        return product


def rooted_trees(order: int) -> tuple[Tree, ...]:
    """Return the rooted trees with ``order`` vertices; a tree is the sorted tuple of its branches.

    Examples
    --------
    >>> [len(rooted_trees(n)) for n in range(1, 7)]
    [1, 1, 2, 4, 9, 20]
    """
    return _trees(order)


@cache
def _trees(order: int) -> tuple[Tree, ...]:
    return tuple(sorted(set(_forests(order - 1, order - 1))))


def _forests(vertices: int, largest: int) -> Iterator[Tree]:
    if vertices == 0:
        yield ()
    for size in range(1, min(vertices, largest) + 1):
        for tree in _trees(size):
            for rest in _forests(vertices - size, size):
                yield tuple(sorted((tree, *rest)))


def _vertices(tree: Tree) -> int:
    return 1 + sum(_vertices(branch) for branch in tree)


def _density(tree: Tree) -> int:
    product = _vertices(tree)
    for branch in tree:
        product *= _density(branch)
    return product


@dataclass(frozen=True)
class GaussTableau(CollocationTableau):
    """Collocation at the Gauss points of [0, 1]: ``stages`` stages, order ``2 stages``, symplectic.

    The constructor also checks the condition ``b_i a_ij + b_j a_ji = b_i b_j`` of symplectic
    methods.
    """

    method: ClassVar[str] = "gauss_legendre"

    @property
    def order(self) -> int:
        """Order of the method."""
        return 2 * self.stages

    def _own_gaps(self) -> Mapping[str, Array]:
        a, b = self.a, self.b
        return {
            "row sums": np.abs(a.sum(axis=1) - self.c),
            "symplectic": np.abs(b[:, None] * a + (b[:, None] * a).T - np.outer(b, b)),
        }


@cache
def gauss_tableau(stages: int) -> GaussTableau:
    """Return the Gauss collocation coefficients for a number of stages.

    The stage weights are the integrals of the Lagrange polynomials, by their Legendre expansion,
    which stays accurate for many stages.

    Raises
    ------
    ValueError
        If ``stages`` is below 1.
    """
    x, w = np.polynomial.legendre.leggauss(stages)
    values = np.polynomial.legendre.legvander(x, stages)
    rise = values[:, 2:] - values[:, :-2]
    a = w / 4 * ((1 + x)[:, None] + rise @ values[:, 1:stages].T)
    for array in (x, w, a):
        array.flags.writeable = False
    return GaussTableau(stages, (1 + x) / 2, w / 2, a)
