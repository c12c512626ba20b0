"""Speeds between which one damped mode is unstable: all at once, without iteration.

At crank speed w the damping is K = c / (2 w) and lam2 = k / w^2.  With s = sqrt(k) / w both are
polynomials in s, so that the condition for a multiplier +-1 is an eigenvalue problem in s.
"""

from __future__ import annotations

import numpy as np

from ...core.families import Array
from ...core.periodic_function import PeriodicFunction
from ...hill import hill_boundaries
from ...hill.fourier_matrix import layout, stacked, truncation

_EPS = float(np.finfo(float).eps)


def exact_speeds(
    f: PeriodicFunction, stiffness: float, damping: float, regions: tuple[int, ...]
) -> Array:
    """Return the exact ends of unstable regions, and their errors.

    Parameters
    ----------
    f : PeriodicFunction
        The periodic part, the same at every speed.
    stiffness, damping : float
        k [1/s^2] > 0 and c [1/s] > 0.
    regions : tuple of int
        Numbers from 1.

    Returns
    -------
    ndarray, shape (3, len(regions))
        Speed at the lower and at the upper end in lam2, and the error of either [rad/s]; NaN
        where damping has closed the region, and at the lower end of one that reaches on to
        infinite speed.

    Notes
    -----
    With lam2 = s^2 and K = r s, r = c / (2 sqrt(k)), Hill's matrix gives
    ``(k^2 - f) v - 2 r s D v = s^2 v``, D = d/d theta.  A region lies within the undamped one
    moved by K^2 (see :func:`~.damped.damped`), which is how real s get its number.
    """
    ratio = damping / (2.0 * np.sqrt(stiffness))
    sharp = hill_boundaries(f, 1.0, regions)
    highest = float(np.sqrt(max(float(np.max(sharp.upper)), 0.25)))
    cut = truncation(f, 1.0, max(regions), (ratio * highest) ** 2)
    local = cut.left_out + 8.0 * _EPS * (cut.norm + 2.0 * ratio * highest * cut.harmonic) + f.error
    out = np.full((3, len(regions)), np.nan)
    for odd in (0, 1):
        if not any(n % 2 == odd for n in regions):
            continue
        s = _inverse_speeds(f, odd, cut.harmonic + odd, ratio)
        shifted = s * s * (1.0 - ratio * ratio)
        for i, n in enumerate(regions):
            if n % 2 != odd:
                continue
            low, high = float(sharp.lower[i]), float(sharp.upper[i])
            own = np.sort(s[(shifted >= low - 4 * local) & (shifted <= high + 4 * local)])
            if low < 0.0 < high and len(own):
                # The region reaches on to infinite speed: one end alone.
                error = local * np.sqrt(stiffness) / (2.0 * own[-1] ** 3)
                out[1:, i] = np.sqrt(stiffness) / own[-1], error
            if low < 0.0 or len(own) < 2:
                continue
            ends = own[[0, -1]]
            width = 0.5 * float(ends[1] ** 2 - ends[0] ** 2)
            speeds = np.sqrt(stiffness) / ends
            error = _drawn_in(local, width, 0.5 * (high - low))
            out[:, i] = *speeds, error * float(np.max(speeds / (2.0 * ends**2)))
    return out


def _inverse_speeds(f: PeriodicFunction, odd: int, harmonic: int, ratio: float) -> Array:
    """Return all real s > 0 with a solution of one parity."""
    number = np.sqrt(layout(odd, harmonic).squares)
    size = number.size
    whole = stacked(f, odd, harmonic, np.ones(1))[0] - float(f.a[0]) * np.eye(size)
    drag = np.zeros((size, size))
    # d/d theta takes cos k to -k sin k and sin k to k cos k, which stand side by side.
    cos = np.arange(1 - odd, size, 2)
    drag[cos + 1, cos] = 2.0 * ratio * number[cos]
    drag[cos, cos + 1] = -drag[cos + 1, cos]
    companion = np.block([[np.zeros((size, size)), np.eye(size)], [whole, drag]])
    values = np.linalg.eigvals(companion)
    return np.asarray(values.real[(values.imag == 0.0) & (values.real > 0.0)])


def _drawn_in(local: float, half: float, sharp_half: float) -> float:
    """Return the error of ends ``+-half`` that damping drew in from ``+-sharp_half``.

    An error of the data is magnified by ``sharp_half / half``, and at the tip by the square root.
    """
    square = 2.0 * max(half, sharp_half) * local
    inner = half * half - square
    moved = half - np.sqrt(inner) if inner > 0.0 else np.sqrt(half * half + square)
    return float(moved) + local
