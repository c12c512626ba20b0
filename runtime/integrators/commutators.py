"""Methods for linear systems as data: nested commutators, and products of exponentials.

Both are written in the moments of the generator against Legendre's polynomials on the step,
``M_k = (2k + 1) h int_0^1 P_k(2x - 1) L(theta + h x) dx``, of size h^(k+1).  The same data give the
step matrices and, with letters in place of matrices, the exact series that proves their order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from ..core.errors import SelfCheckFailed
from ..core.namespaces import carried, namespace_of
from .lie_series import LieSeries, legendre_flow, letters, one
from .protocol import Array, Generator, at_nodes
from .tableau import gauss_tableau

Combination = tuple[tuple[int, Fraction], ...]
# What rounding coefficients to 40 digits leaves of an order condition.
_PROVED = Fraction(1, 10**38)


def combination(*pairs: tuple[int, Fraction | str]) -> Combination:
    """Return a linear combination: element numbers and their coefficients, as exact fractions."""
    return tuple((number, Fraction(value)) for number, value in pairs)


@dataclass(frozen=True)
class MagnusExponent:
    """One exponent per step, made of the moments by nested commutators.

    Attributes
    ----------
    name : str
        Name of the method.
    order : int
        Order of the method; it takes order/2 Gauss points and moments.
    brackets : tuple
        Pairs of combinations: bracket k is their commutator and becomes element order/2 + k, the
        moments being the first elements.
    exponent : tuple
        Combination of all elements.
    """

    name: str
    order: int
    brackets: tuple[tuple[Combination, Combination], ...]
    exponent: Combination

    def matrices(self, moments: Array) -> Array:
        """Return the exponents from moments ``(..., order/2, m, m)``."""
        elements = [moments[..., k, :, :] for k in range(moments.shape[-3])]
        for first, second in self.brackets:
            left, right = _sum(first, elements), _sum(second, elements)
            elements.append(left @ right - right @ left)
        value: Array = _sum(self.exponent, elements)
        return value

    def series(self, limit: int) -> LieSeries:
        """Return the exponent as a series in the moments, up to a weight."""
        elements = list(letters(tuple(range(1, self.order // 2 + 1)), limit))
        for first, second in self.brackets:
            elements.append(_total(first, elements).commutator(_total(second, elements)))
        return _total(self.exponent, elements)

    def verify(self) -> None:
        """Prove the order: every word's coefficient against its iterated integral.

        Raises
        ------
        SelfCheckFailed
            If a condition of the declared order fails by more than 1e-38, or all of the next order
            hold.
        """
        limit = self.order + 1
        exact = legendre_flow(self.order // 2, limit).log()
        _judge(self.name, self.order, self.series(limit) - exact)


@dataclass(frozen=True)
class ExponentialProduct:
    """A product of exponentials of combinations of the moments: no commutators.

    Attributes
    ----------
    name : str
        Name of the method.
    order : int
        Order of the method; it takes order/2 Gauss points and moments.
    factors : tuple
        Combination of the moments in each exponent, from right to left: the first acts first.
    """

    name: str
    order: int
    factors: tuple[Combination, ...]

    @cached_property
    def weights(self) -> Array:
        """Coefficients as an array, shape ``(factors, order/2)``."""
        table = np.zeros((len(self.factors), self.order // 2))
        for row, factor in zip(table, self.factors, strict=True):
            for number, value in factor:
                row[number] = float(value)
        return table

    def verify(self) -> None:
        """Prove the order; raises as :meth:`MagnusExponent.verify`."""
        limit = self.order + 1
        moments = letters(tuple(range(1, self.order // 2 + 1)), limit)
        flow = one(moments[0].weights, limit)
        for factor in self.factors:
            flow = _total(factor, moments).exp() @ flow
        _judge(self.name, self.order, flow - legendre_flow(self.order // 2, limit))


def moments_of(generator: Generator, theta: Array, step: float, count: int) -> Array:
    """Return the first moments of the generator on each step, by as many Gauss points.

    Parameters
    ----------
    generator, theta, step
        As in :class:`~.protocol.OneStep`.
    count : int
        Number of moments and of points.

    Returns
    -------
    ndarray
        Shape ``(*batch, ns, count, m, m)``.
    """
    tableau = gauss_tableau(count)
    values = at_nodes(generator, theta, step * tableau.c)
    shapes = np.polynomial.legendre.legvander(2 * tableau.c - 1, count - 1)
    weights = step * (2 * np.arange(count)[:, None] + 1) * (tableau.b * shapes.T)
    xp = namespace_of(values)
    flat = xp.reshape(values, (*values.shape[:-2], values.shape[-1] ** 2))
    moments: Array = xp.reshape(carried(weights, values) @ flat, values.shape)
    return moments


def _sum(parts: Combination, elements: Sequence[Array]) -> Array:
    total: Any = 0.0
    for number, value in parts:
        element = elements[number]
        total = total + (element if value == 1 else float(value) * element)
    result: Array = total
    return result


def _total(parts: Combination, elements: Sequence[LieSeries]) -> LieSeries:
    total = elements[0].times(Fraction(0))
    for number, value in parts:
        total = total + elements[number].times(value)
    return total


def _judge(name: str, order: int, defect: LieSeries) -> None:
    largest = [defect.largest(weight) for weight in range(1, order + 2)]
    failed = [k + 1 for k, size in enumerate(largest[:-1]) if size > _PROVED]
    if failed:
        raise SelfCheckFailed(f"{name}: declared order {order}, a condition of {failed[0]} fails")
    if largest[-1] <= _PROVED:
        raise SelfCheckFailed(f"{name}: declared order {order}, and all of the next hold too")
