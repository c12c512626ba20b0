"""Chebyshev series in one and two variables: nodes, coefficients, values, size of the tail."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@lru_cache(maxsize=256)
def nodes(count: int) -> Array:
    """Return the zeros of T_count in ``[-1, 1]``, shape ``(count,)``, falling; read-only."""
    # The sine of the angle from the middle is exactly odd, the cosine is not.
    k = np.arange(count)
    x: Array = np.sin((count - 1 - 2 * k) * (np.pi / (2 * count)))
    x.setflags(write=False)
    return x


@lru_cache(maxsize=256)
def analysis(count: int) -> Array:
    """Return the matrix from values at :func:`nodes` to coefficients, shape ``(count, count)``."""
    j, k = np.arange(count)[:, None], np.arange(count)
    # Whole periods are taken off in integers: the cosine's argument stays small.
    steps = (j * (2 * k + 1)) % (4 * count)
    matrix: Array = np.cos(steps * (np.pi / (2 * count))) * (2.0 / count)
    matrix[0] *= 0.5
    matrix.setflags(write=False)
    return matrix


@lru_cache(maxsize=64)
def extrema(count: int) -> Array:
    """Return the ends and extrema of T_(count-1), shape ``(count,)``, falling; read-only.

    Every second of them are those for half the degree.
    """
    k = np.arange(count)
    x: Array = np.sin((count - 1 - 2 * k) * (np.pi / (2 * (count - 1))))
    x.setflags(write=False)
    return x


def extrema_coefficients(values: Array) -> Array:
    """Return the coefficients of the series through values at :func:`extrema`, ``(count, ...)``."""
    turn = np.concatenate([values, values[-2:0:-1]])
    found: Array = np.fft.rfft(turn, axis=0).real / (len(values) - 1)
    found[[0, -1]] *= 0.5
    return found


def basis(x: Array, count: int) -> Array:
    """Return ``T_0 ... T_{count-1}`` at ``x`` (shape ``(n,)``, within [-1, 1]): ``(count, n)``."""
    return np.asarray(np.polynomial.chebyshev.chebvander(x, count - 1).T)


def tensor_values(coefficients: Array, x: Array, y: Array) -> Array:
    """Evaluate a double series at all pairs: x ``(nx,)``, y ``(ny,)`` to ``(nx, ny)``.

    The long product runs over the shorter of the two sets of coefficients.
    """
    n, m = coefficients.shape
    left, right = basis(x, n), basis(y, m)
    if m <= n:
        return np.asarray((left.T @ coefficients) @ right)
    return np.asarray(left.T @ (coefficients @ right))


def point_values(coefficients: Array, x: Array, y: Array) -> Array:
    """Evaluate a double series at the points ``(x[i], y[i])``, shape ``(n,)``."""
    n, m = coefficients.shape
    out = np.empty(x.size)
    step = max(64, 2**18 // (n + m))
    for start in range(0, x.size, step):
        part = slice(start, start + step)
        left, right = basis(x[part], n), basis(y[part], m)
        out[part] = np.einsum("ij,ij->j", coefficients.T @ left, right)
    return out


def length(sizes: Array, tolerance: float) -> int:
    """Return how many leading entries of ``sizes`` are needed before all stay below a tolerance."""
    above = np.flatnonzero(sizes > tolerance)
    return int(above[-1]) + 1 if above.size else 1


def unit(values: Array, low: float, high: float) -> Array:
    """Map ``[low, high]`` to ``[-1, 1]``; a point range maps to zero."""
    half = 0.5 * (high - low)
    if half == 0.0:
        return np.zeros_like(values)
    return np.clip((values - (low + half)) / half, -1.0, 1.0)
