"""Boundaries of the damped Hill's equation: real eigenvalues of the non-symmetric Hill matrix."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..series.periodic import PeriodicFunction
from .layout import layout, stacked, truncation
from .transfer import EPS

Array = NDArray[np.float64]

_CHUNK = 2**18


def damped(
    f: PeriodicFunction, mu: Array, k: Array, regions: tuple[int, ...], sharp: tuple[Array, Array]
) -> tuple[Array, Array, Array]:
    """Return lower, upper and error, each ``(len(regions), n)``, NaN where a region is closed.

    Parameters
    ----------
    f : PeriodicFunction
        The coefficient function.
    mu, k : ndarray, shape (n,)
        Factor and damping, K > 0.
    regions : tuple of int
        Numbers of the regions.
    sharp : (lower, upper)
        Undamped boundaries, each ``(len(regions), n)``.

    Notes
    -----
    With y = exp(-K theta) u the multipliers +-1 of y belong to the half traces +-cosh(2 pi K) of
    u at lam2 - K^2.  Within an undamped region the half trace of u has one extremum, so that a
    damped region has two ends inside it, or none; region 0 always has its one.
    """
    low, high = sharp
    shift = k * k
    cut = truncation(f, float(np.abs(mu).max()), max(regions), float(shift.max()))
    norm = cut.norm + 2.0 * float(k.max()) * (cut.harmonic + 1)
    local = cut.left_out + 2.0 * EPS * norm + f.error * np.abs(mu)
    slack = 4.0 * local
    lower = np.full(low.shape, np.nan)
    upper, error = lower.copy(), lower.copy()
    for odd in (0, 1):
        rows = [i for i, n in enumerate(regions) if n % 2 == odd]
        if not rows:
            continue
        values = _spectra(f, odd, cut.harmonic + odd, mu, k)
        for i in rows:
            real = np.where(values.imag == 0.0, values.real, np.nan) - shift[:, None]
            # NaN compares false: complex eigenvalues drop out here.
            inside = (real >= (low[i] - slack)[:, None]) & (real <= (high[i] + slack)[:, None])
            first = np.where(inside, real, np.inf).min(axis=1)
            last = np.where(inside, real, -np.inf).max(axis=1)
            whole = inside.sum(axis=1) >= (1 if regions[i] == 0 else 2)
            first, last = first[whole], last[whole]
            upper[i, whole] = last + shift[whole]
            if regions[i] == 0:
                lower[i, whole], error[i, whole] = -np.inf, local[whole]
                continue
            lower[i, whole] = first + shift[whole]
            error[i, whole] = _near_tip(
                local[whole], 0.5 * (last - first), 0.5 * (high[i] - low[i])[whole]
            )
    return lower, upper, error


def _near_tip(local: Array, half: Array, sharp_half: Array) -> Array:
    """Return the error of ends ``+-half`` that damping drew in from ``+-sharp_half``.

    The ends follow ``sqrt(sharp_half^2 - const)``: an error of the data is magnified by
    ``sharp_half / half``, and at the tip by the square root.
    """
    square = 2.0 * np.maximum(half, sharp_half) * local
    inner = half * half - square
    return (
        np.where(inner > 0.0, half - np.sqrt(np.maximum(inner, 0.0)), np.sqrt(half * half + square))
        + local
    )


def _spectra(
    f: PeriodicFunction, odd: int, harmonic: int, mu: Array, k: Array
) -> NDArray[np.complex128]:
    """Return all eigenvalues of ``k^2 - 2 K d/d theta - mu f``, shape ``(n, size)``."""
    number = np.sqrt(layout(odd, harmonic).squares)
    size = number.size
    # d/d theta takes cos k to -k sin k and sin k to k cos k; the two stand side by side, after
    # the constant where there is one.
    cos = np.arange(1 - odd, size, 2)
    out = np.empty((mu.size, size), dtype=complex)
    step = max(1, _CHUNK // (size * size))
    for start in range(0, mu.size, step):
        part = slice(start, start + step)
        stack = stacked(f, odd, harmonic, mu[part])
        drag = 2.0 * k[part, None] * number[cos]
        stack[:, cos + 1, cos] += drag
        stack[:, cos, cos + 1] -= drag
        out[part] = np.linalg.eigvals(stack) - (f.a[0] * mu[part])[:, None]
    return out
