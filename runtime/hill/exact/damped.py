"""Boundaries of the damped Hill's equation: real eigenvalues of the non-symmetric Hill matrix."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.errors import bad
from ...core.periodic_function import PeriodicFunction
from ..transfer import EPS
from .layout import layout, stacked, truncation
from .strong import strong_ends

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_CHUNK = 2**18
# Beyond this K the condition of the eigenvalues, of the size of exp(2 pi K) at worst, tells.
_STRONG = 0.5
# Its square is added to lam2.
_LARGEST = 1e100
# A pair is sent to the half trace while its imaginary part is below so much of its round-off.
_NEARLY = 4.0


def damped(
    f: PeriodicFunction, mu: Array, k: Array, regions: tuple[int, ...], sharp: tuple[Array, ...]
) -> tuple[Array, Array, Array, Mask]:
    """Return lower, upper, error and undecided, each ``(len(regions), n)``.

    The ends are NaN where a region is closed, or undecided.

    Parameters
    ----------
    f : PeriodicFunction
        The coefficient function.
    mu, k : ndarray, shape (n,)
        Factor and damping, K > 0.
    regions : tuple of int
        Numbers of the regions.
    sharp : (lower, upper, error)
        Undamped boundaries and their error, each ``(len(regions), n)``.

    Raises
    ------
    BadInput
        If K is beyond 1e100.

    Notes
    -----
    With y = exp(-K theta) u the multipliers +-1 of y belong to the half traces +-cosh(2 pi K) of
    u at lam2 - K^2.  Within an undamped region the half trace of u has one extremum, so that a
    damped region has two ends inside it, or none; region 0 always has its one.  The half trace
    itself serves where damping is strong, or where a region that the matrix takes for closed may
    be open within its rounding.
    """
    if float(k.max()) > _LARGEST:
        raise bad("damping", f"{k.max():.3g}", f"K up to {_LARGEST:g}", "scale the equation")
    low, high, slack = sharp
    lower = np.full(low.shape, np.nan)
    upper, error = lower.copy(), lower.copy()
    undecided: Mask = np.zeros(low.shape, dtype=bool)
    strong = k > _STRONG
    if not strong.all():
        weak = ~strong
        parts = _from_matrix(f, mu[weak], k[weak], regions, (low[:, weak], high[:, weak]))
        lower[:, weak], upper[:, weak], error[:, weak], undecided[:, weak] = parts
    for i, n in enumerate(regions):
        unsure = undecided[i] | strong
        if not unsure.any():
            continue
        ends = (low[i, unsure], high[i, unsure])
        found = strong_ends(f, mu[unsure], k[unsure], n, ends, slack[i, unsure])
        lower[i, unsure], upper[i, unsure], error[i, unsure] = found.lower, found.upper, found.error
        undecided[i, unsure] = found.undecided
    return lower, upper, error, undecided


def _from_matrix(
    f: PeriodicFunction, mu: Array, k: Array, regions: tuple[int, ...], sharp: tuple[Array, Array]
) -> tuple[Array, Array, Array, Mask]:
    """Do so by the real eigenvalues of the matrix; undecided are pairs that are almost real."""
    low, high = sharp
    shift = k * k
    cut = truncation(f, float(np.abs(mu).max()), max(regions), float(shift.max()))
    norm = cut.norm + 2.0 * float(k.max()) * (cut.harmonic + 1)
    # Twice that of the symmetric matrix: the condition of the eigenvalues is a few.
    rounding = EPS * max(8.0, 0.5 * (2.0 * cut.harmonic) ** 0.5)
    local = cut.left_out + rounding * norm + f.error * np.abs(mu)
    slack = 4.0 * local
    lower = np.full(low.shape, np.nan)
    upper, error = lower.copy(), lower.copy()
    unsure: Mask = np.zeros(low.shape, dtype=bool)
    for odd in (0, 1):
        rows = [i for i, n in enumerate(regions) if n % 2 == odd]
        if not rows:
            continue
        values = _spectra(f, odd, cut.harmonic + odd, mu, k)
        place = values.real - shift[:, None]
        real = np.where(values.imag == 0.0, place, np.nan)
        for i in rows:
            # NaN compares false: complex eigenvalues drop out here.
            inside = (real >= (low[i] - slack)[:, None]) & (real <= (high[i] + slack)[:, None])
            first = np.where(inside, real, np.inf).min(axis=1)
            last = np.where(inside, real, -np.inf).max(axis=1)
            whole = inside.sum(axis=1) >= (1 if regions[i] == 0 else 2)
            # Two ends that met are as far from being real as the root of what moves them.
            blur = _NEARLY * np.sqrt(np.maximum(high[i] - low[i], slack) * slack)
            near = (place >= (low[i] - blur)[:, None]) & (place <= (high[i] + blur)[:, None])
            near &= np.abs(values.imag) <= blur[:, None]
            unsure[i] = ~whole & (near.any(axis=1) if regions[i] else True)
            first, last = first[whole], last[whole]
            upper[i, whole] = last + shift[whole]
            if regions[i] == 0:
                lower[i, whole], error[i, whole] = -np.inf, local[whole]
                continue
            lower[i, whole] = first + shift[whole]
            error[i, whole] = _near_tip(
                local[whole], 0.5 * (last - first), 0.5 * (high[i] - low[i])[whole]
            )
    return lower, upper, error, unsure


def left_and_right(
    matrix: Array | NDArray[np.complex128],
) -> tuple[NDArray[np.complex128], NDArray[np.complex128], NDArray[np.complex128]]:
    """Return the eigenvalues of a matrix with left and right eigenvectors as columns."""
    import scipy.linalg

    found: Any = scipy.linalg.eig(matrix, left=True, check_finite=False)
    values, lefts, rights = found
    return values, lefts, rights


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
