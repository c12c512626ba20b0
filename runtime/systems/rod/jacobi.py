"""Jacobi polynomials on [0, 1] and their derivatives, by the recurrence in the degree."""

from __future__ import annotations

from fractions import Fraction
from math import comb, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]  # doubles, or long doubles for tables


def jacobi(size: int, x: Array, upper: int, lower: int) -> tuple[Array, Array, Array, Array]:
    """Return orthonormal Jacobi polynomials of weight ``(1 - x)^upper x^lower`` on [0, 1].

    Parameters
    ----------
    size : int
        Number of polynomials, degrees 0 to ``size - 1``.
    x : ndarray
        Shape ``(...)``; the work is done in its precision.
    upper, lower : int
        Exponents of the weight at 1 and at 0.

    Returns
    -------
    tuple of ndarray
        The polynomials and their first three derivatives, each of shape ``(..., size)``.
    """
    a, b = upper, lower
    y = 2 * x - 1
    zero = np.zeros_like(y)
    rows = [[np.ones_like(y), zero, zero, zero]]
    if size > 1:
        rows.append([((a + b + 2) * y + (a - b)) / 2, zero + (a + b + 2) / 2, zero, zero])
    for k in range(2, size):
        c = 2 * k + a + b
        first = 2 * k * (k + a + b) * (c - 2)
        slope, middle = (c - 1) * c * (c - 2) / first, (c - 1) * (a * a - b * b) / first
        second = 2 * (k + a - 1) * (k + b - 1) * c / first
        one, two = rows[-1], rows[-2]
        # The m-th derivative of y P is y P^(m) + m P^(m-1).
        rows.append(
            [
                (slope * y + middle) * one[m]
                + (m * slope * one[m - 1] if m else 0.0)
                - second * two[m]
                for m in range(4)
            ]
        )
    norms = np.array([_scale(k, a, b) for k in range(size)])
    found = [np.stack([row[m] for row in rows[:size]], axis=-1) * norms * 2**m for m in range(4)]
    return found[0], found[1], found[2], found[3]


def _scale(k: int, a: int, b: int) -> float:
    """Return one over the norm of a Jacobi polynomial on [0, 1]."""
    square = (2 * k + a + b + 1) * Fraction(comb(k + a + b, a), comb(k + a, a))
    return sqrt(square)
