"""Truncated Taylor series of one real variable, many at once: derivatives without differencing."""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial

import numpy as np
from numpy.typing import NDArray

Complex = NDArray[np.complex128]
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Taylor:
    """Series ``sum_k c[k] h^k`` about many places; ``c`` has shape (order + 1, places).

    Numbers mix with series; all series of one expression have the same order.
    """

    c: Complex

    def __add__(self, other: Taylor | complex) -> Taylor:
        """Return the sum."""
        if isinstance(other, Taylor):
            return Taylor(self.c + other.c)
        total = self.c.copy()
        total[0] += other
        return Taylor(total)

    __radd__ = __add__

    def __neg__(self) -> Taylor:
        """Return the series with its sign changed."""
        return Taylor(-self.c)

    def __sub__(self, other: Taylor | complex) -> Taylor:
        """Return the difference."""
        return self + (-other)

    def __rsub__(self, other: complex) -> Taylor:
        """Return a number less the series."""
        return -self + other

    def __mul__(self, other: Taylor | complex) -> Taylor:
        """Return the product."""
        if not isinstance(other, Taylor):
            return Taylor(self.c * other)
        out = np.zeros_like(self.c)
        for k in range(len(out)):
            out[k] = np.sum(self.c[: k + 1] * other.c[k::-1], axis=0)
        return Taylor(out)

    __rmul__ = __mul__

    def __truediv__(self, other: Taylor | complex) -> Taylor:
        """Return the quotient."""
        if not isinstance(other, Taylor):
            return Taylor(self.c / other)
        out = np.zeros_like(self.c)
        for k in range(len(out)):
            known = np.sum(out[:k] * other.c[k:0:-1], axis=0)
            out[k] = (self.c[k] - known) / other.c[0]
        return Taylor(out)

    def sqrt(self) -> Taylor:
        """Return the root, of positive real part."""
        out = np.zeros_like(self.c)
        out[0] = np.sqrt(self.c[0])
        for k in range(1, len(out)):
            known = np.sum(out[1:k] * out[k - 1 : 0 : -1], axis=0)
            out[k] = (self.c[k] - known) / (2.0 * out[0])
        return Taylor(out)

    def derivative(self, k: int) -> Complex:
        """Return the ``k``-th derivative at the places."""
        return np.asarray(factorial(k) * self.c[k])


def cosine_sine(s: Array, order: int, rate: float = 1.0) -> tuple[Taylor, Taylor]:
    """Return ``cos(rate s)`` and ``sin(rate s)`` about the places ``s``."""
    cos, sin = np.cos(rate * s), np.sin(rate * s)
    cycle = ((cos, sin), (-sin, cos), (-cos, -sin), (sin, -cos))
    sizes = [rate**k / factorial(k) for k in range(order + 1)]
    rows = [[sizes[k] * cycle[k % 4][i] for k in range(order + 1)] for i in range(2)]
    return Taylor(np.array(rows[0], dtype=complex)), Taylor(np.array(rows[1], dtype=complex))
