"""Hill's matrix: where it is cut, and how it is filled.

In the basis cos k theta, sin k theta (k whole, or half-whole: ``odd``) the matrix of the operator
``-d2/dtheta2 - 2 K d/dtheta - mu f`` is ``k^2 - 2 K d/dtheta - mu f``: symmetric without damping.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import lru_cache
from math import ceil, sqrt
from typing import NamedTuple

import numpy as np

from ..core.errors import BadInput, bad
from ..core.periodic_function import PeriodicFunction
from .checks import EPS, LARGEST, Array, Complex

# What the cut leaves out by default: below the round-off of eigenvalues of size 1e3.
LEFT_OUT = 1e-13


def chunks(count: int, size: int) -> Iterator[slice]:
    """Yield parts of a stack of so many square matrices, so small that each stays in the cache."""
    step = max(1, 2**18 // (size * size))
    for start in range(0, count, step):
        yield slice(start, start + step)


def by_parity(regions: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
    """Yield the parity of each problem that has regions, and their places in the sequence."""
    for odd in (0, 1):
        rows = [i for i, n in enumerate(regions) if n % 2 == odd]
        if rows:
            yield odd, rows


class Truncation(NamedTuple):
    """Where Hill's matrix is cut, and what that costs."""

    harmonic: int  # highest k (whole problem) or number of half-whole k
    # Bound of what the harmonics beyond lower the wanted eigenvalues by (undamped; proved,
    # round-off of its own evaluation included).
    left_out: float
    norm: float  # bound of the norm of the matrix

    @property
    def rounding(self) -> float:
        """Estimate of the round-off of eigenvalues."""
        # LAPACK's eigenvalues in roundings of the norm: of 4000 random cases on two machines one
        # was off by 5.4, of 1400 ends 999 in 1000 by up to 2.1; they grow with the root of the size
        # beyond some 60 rows.
        return EPS * max(3.5, 0.5 * sqrt(2.0 * self.harmonic)) * self.norm


def truncation(
    f: PeriodicFunction, reach: float, highest: int, shift: float = 0.0, goal: float = LEFT_OUT
) -> Truncation:
    """Choose the truncation for the regions up to ``highest`` at ``|mu| <= reach``.

    ``reach`` is rounded up to a quarter of an octave, so that neighbouring slices share the work.
    With damping the eigenvalues are the real ones, moved up by at most ``shift`` = K^2; the
    damping term is diagonal in exp(i k theta) and imaginary there, so the majorant holds unchanged.

    Let E hold, in its columns, the orthonormal eigenvectors of the eigenvalues up to the wanted
    one, all below ``highest^2/4 + reach * sup|f|``.  The norms of its rows are at most 1 and obey
    ``(k^2 - lam2) |E_k| <= reach * sum_m |c_m| (|E_{k-m}| + |E_{k+m}|)``: bounding the low ones by
    1 and the higher neighbours by the row itself gives a majorant M_k by recursion.  The cut
    columns P E are trial vectors for the matrix that is kept.  With ``G = E* (1 - P) E`` their
    Rayleigh quotients exceed the wanted eigenvalue lam2 by no more than

        (|G|^2 (lam2 - lowest) + sup <(1 - P) u, (H - lam2) (1 - P) u>) / (1 - |G|),

    and both terms are sums of ``M_k^2`` over the harmonics left out.  (Rayleigh and Ritz: what is
    left out never lowers the eigenvalues of the matrix below the true ones.)
    """
    if not reach < 1e300:
        raise _too_large(reach, f)
    octave = 2.0 ** (0.25 * ceil(4.0 * math.log2(reach))) if reach > 1e-300 else 0.0
    return _truncation(f, max(octave, reach), highest, shift, goal)


@lru_cache(maxsize=256)
def _truncation(
    f: PeriodicFunction, reach: float, highest: int, shift: float, goal: float
) -> Truncation:
    half = (0.5 * reach) * f.amplitudes[1:]
    bound = 2.0 * float(half.sum())
    # Harmonics of mu f that are together smaller count by their norm.
    kept = int(np.count_nonzero(np.cumsum(half[::-1]) > 1e-17))
    # Harmonics this small are left out of the majorant and counted by their norm (Weyl), once in
    # the equation and once in its matrix.
    dropped = 4.0 * float(half[kept:].sum())
    # A hair above, for the rounding of the distance of k^2 from it.
    ceiling = (0.25 * highest * highest + shift + 1.5 * bound) * (1.0 + 8.0 * EPS)
    goal = max(goal, EPS * ceiling) if goal >= LEFT_OUT else goal
    spread = 0.25 * highest * highest + shift + 2.0 * bound
    start = int(sqrt(ceiling)) + 1
    cut = _majorant(half[:kept][::-1], ceiling, start, bound, goal)
    if cut is None:
        raise _too_large(reach, f)
    square, energy = cut
    # A few thousand roundings, each relative: one per cent covers them.
    left_out = 1.01 * (energy + square * square * spread) / (1.0 - np.minimum(square, 0.5))
    good = np.flatnonzero((left_out <= goal) & (square < 0.5))
    if not good.size or start + int(good[0]) - 1 > LARGEST:
        raise _too_large(reach, f)
    harmonic = max(start + int(good[0]) - 1, highest)
    bounded = float(left_out[min(harmonic - start + 1, left_out.size - 1)])
    return Truncation(harmonic, bounded + dropped, float((harmonic + 1) ** 2) + bound)


def _majorant(
    taps: Array, ceiling: float, start: int, bound: float, goal: float
) -> tuple[Array, Array] | None:
    """Return sums over all k >= start, start + 1, ... of ``2 M_k^2`` and of the energy in them."""
    # `taps` runs from the highest harmonic down to the first.  None where the sums do not come
    # below the goal within a few times the largest matrix.
    width, together = len(taps), float(taps.sum())
    # Component k stands at index width + k; all that lies below the start is bounded by 1.
    size = np.ones(width + 4 * LARGEST + 1)
    for k in range(start, 4 * LARGEST):
        gap = k * k - ceiling
        size[width + k] = min(1.0, float(taps @ size[k : width + k]) / gap)
        if (k - start) % 16 != 8:
            continue
        # The energy beyond k, by a geometric series: as many components as there are taps are each
        # at most sum(taps) / gap times the largest before them.
        first = float(size[k + 1 : width + k + 1].max(initial=0.0))
        ratio = (together / ((k + 1) ** 2 - ceiling)) ** 2 * math.exp(2.0 * width / (k + 1))
        if ratio >= 1.0:
            continue
        rest = 2.0 * width * first * first * ((k + 1.0) ** 2 + 2.0 * bound) * ratio / (1.0 - ratio)
        if rest <= 0.1 * goal:
            squares = 2.0 * np.square(size[width + start : width + k + 1])
            # Half-whole k stand half a step higher than the whole k whose majorant they take.
            weights = np.square(np.arange(start, k + 1) + 1.0) + 2.0 * bound
            squares, energy = (
                np.append(np.cumsum(item[::-1])[::-1] + rest, rest)
                for item in (squares, squares * weights)
            )
            return squares, energy
    return None


def _too_large(reach: float, f: PeriodicFunction) -> BadInput:
    found = f"|mu| up to {reach:.3g}, {f.harmonics} harmonics"
    expected = f"a problem that {LARGEST} harmonics settle"
    return bad("hill_boundaries", found, expected, "truncate the function or take a smaller mu")


def squares(odd: int, harmonic: int) -> Array:
    """Return k^2 of each function of the basis, for k up to ``harmonic``, or so many half-whole k.

    It runs cos 0, cos 1, sin 1, ... or cos 1/2, sin 1/2, cos 3/2, ...
    """
    twice = np.arange(odd, 2 * harmonic + 1, 2)
    return np.repeat(np.square(0.5 * twice), 2)[1 - odd :]


@lru_cache(maxsize=64)
def slope(odd: int, harmonic: int) -> Array:
    """Return the matrix of 2 d/dtheta in the basis of :func:`squares`, read-only."""
    twice = np.arange(odd, 2 * harmonic + 1, 2)
    out = np.zeros((2 * twice.size, 2 * twice.size))
    cos = 2 * np.arange(twice.size)
    # d/d theta takes cos k to -k sin k and sin k to k cos k, which stand side by side.
    out[cos + 1, cos], out[cos, cos + 1] = -twice, twice
    out.setflags(write=False)
    return out[1 - odd :, 1 - odd :]


def _waves(f: PeriodicFunction, size: int) -> Complex:
    """Return the coefficients of exp(i m theta), |m| < size, at place m; 0 for the mean."""
    c = np.zeros(2 * size, dtype=complex)
    kept = min(f.harmonics + 1, size)
    c[1:kept] = 0.5 * (f.a - 1j * f.b)[1:kept]
    c[size + 1 :] = c[size - 1 : 0 : -1].conj()
    return c


@lru_cache(maxsize=64)
def matrix(f: PeriodicFunction, odd: int, harmonic: int) -> Array:
    """Return the matrix of ``f - mean`` in the basis of :func:`squares`, read-only."""
    twice = np.arange(odd, 2 * harmonic + 1, 2)
    c = _waves(f, 2 * harmonic + 1)
    apart, total = c[(twice[:, None] - twice) // 2], c[(twice[:, None] + twice) // 2]
    even, uneven = apart + total, apart - total
    pairs = np.array([[even.real, uneven.imag], [-even.imag, uneven.real]])
    out: Array = pairs.transpose(2, 0, 3, 1).reshape(2 * twice.size, 2 * twice.size)
    if not odd:
        # The constant of norm 1 in place of cos 0 and sin 0.
        out[1], out[:, 1] = sqrt(0.5) * out[0], sqrt(0.5) * out[:, 0]
        out[1, 1] = 0.0
        out = out[1:, 1:]
    out.setflags(write=False)
    return out


def stacked(
    f: PeriodicFunction, odd: int, harmonic: int, mu: Array, damping: Array | float = 0.0
) -> Array:
    """Return ``k^2 - 2 K d/d theta - mu (f - mean)`` for mu and K ``(n,)``, one matrix each."""
    out: Array = np.negative(mu)[:, None, None] * matrix(f, odd, harmonic)
    size = out.shape[1]
    out.reshape(mu.size, size * size)[:, :: size + 1] += squares(odd, harmonic)
    if np.any(damping):
        out -= np.reshape(damping, (-1, 1, 1)) * slope(odd, harmonic)
    return out


def banded(f: PeriodicFunction, odd: int, harmonic: int, mu: float) -> Array:
    """Return the lower band of one of those matrices, shape ``(width + 1, size)``, for SciPy.

    In this order of the basis the matrix has ``2 f.harmonics + 1`` diagonals below the main one,
    which from ``k = f.harmonics`` on repeat with each k.
    """
    levels = squares(odd, harmonic)
    first, width = 2 * f.harmonics + 2 - odd, 2 * f.harmonics + 1
    corner = matrix(f, odd, 2 * f.harmonics + 2)
    band = np.array([np.append(corner.diagonal(-i), np.zeros(i)) for i in range(width + 1)])
    columns = np.arange(levels.size)
    out = -mu * band[:, np.where(columns < first, columns, first + (columns - first) % 2)]
    out[0] += levels
    return np.asarray(out)


def couplings(f: PeriodicFunction, size: int) -> Complex:
    """Return ``-c_(k-l)`` for all pairs of so many harmonics exp(i k theta), the mean left out."""
    every = np.arange(size)
    return np.asarray(-_waves(f, size)[np.subtract.outer(every, every)])
