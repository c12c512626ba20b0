"""Matrices of stretches as Chebyshev series in one variable: made, evaluated, multiplied."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core import chebyshev
from ..periodic.transition import product as ordered_product

Array = NDArray[np.float64]

_BLOCK_FLOATS = 1_000_000


@dataclass(frozen=True)
class Tabulated:
    """The solution over stretches of the angle, as Chebyshev series in one variable.

    Attributes
    ----------
    low, high : float
        Ends of the variable; ``low`` may equal ``high``.
    stretches : ndarray
        Chebyshev coefficients of their matrices, shape ``(leaves, count, m, m)``.
    """

    low: float
    high: float
    stretches: Array

    def weights(self, values: Array) -> Array:
        """Return the Chebyshev polynomials at values of the variable, ``(n, leaves)``.

        Of any array namespace; beyond the ends as at them.
        """
        xp = values.__array_namespace__()
        count = len(self.stretches)
        if count == 1:
            one: Array = xp.ones_like(values)[:, None]
            return one
        half, middle = 0.5 * (self.high - self.low), 0.5 * (self.high + self.low)
        place = xp.clip((values - middle) / half, -1.0, 1.0)
        found: Array = xp.cos(xp.acos(place)[:, None] * xp.arange(count, dtype=values.dtype))
        return found

    def products(self, values: Array) -> tuple[Array, NDArray[np.int64]]:
        """Return the products of all stretches, and the powers of two taken out of them.

        Parameters
        ----------
        values : ndarray
            Values of the variable, shape ``(n,)``.

        Returns
        -------
        matrices : ndarray
            Shape ``(n, m, m)``.
        power : ndarray of int
            Shape ``(n,)``.
        """
        m = self.stretches.shape[-1]
        weights = self.weights(values)
        found = np.empty((len(values), m, m))
        power = np.zeros(len(values), dtype=np.int64)
        together = max(1, _BLOCK_FLOATS // self.stretches[0].size)
        for start in range(0, len(values), together):
            part = slice(start, start + together)
            found[part], power[part] = ordered_product(mixed(weights[part], self.stretches))
        return found, power


def nodes(low: float, high: float, count: int) -> Array:
    """Return Chebyshev nodes between two ends, shape ``(count,)``, falling, none of them an end."""
    value: Array = 0.5 * (low + high) + 0.5 * (high - low) * chebyshev.nodes(count)
    return value


def coefficients(values: Array) -> Array:
    """Return the Chebyshev coefficients of arrays from those at the nodes, both ``(n, ...)``."""
    found: Array = chebyshev.analysis(len(values)) @ values.reshape(len(values), -1)
    return found.reshape(values.shape)


def mixed(weights: Array, table: Array) -> Array:
    """Return weighted sums over the first axis of a table, in the namespace of the weights."""
    xp = weights.__array_namespace__()
    flat = xp.asarray(table.reshape(len(table), -1))
    value: Array = xp.reshape(weights @ flat, (weights.shape[0], *table.shape[1:]))
    return value


def running_products(maps: Array, together: int) -> Array:
    """Return the products of stretches from the first of each group to each of them.

    Parameters
    ----------
    maps : ndarray
        Matrices of stretches, shape ``(..., k, m, m)``; they are overwritten.
    together : int
        Stretches of a group; the last may have fewer.

    Returns
    -------
    ndarray
        Same shape.
    """
    for k in range(1, together):
        own = maps[..., k::together, :, :]
        own[...] = own @ maps[..., k - 1 :: together, :, :][..., : own.shape[-3], :, :]
    return maps
