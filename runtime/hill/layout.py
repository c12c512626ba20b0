"""Hill's matrix: where it is cut, and where the Fourier coefficients stand in it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, sqrt

import numpy as np
from numpy.typing import NDArray

from ..errors import BadInput, bad
from ..series.periodic import PeriodicFunction
from .transfer import EPS

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_LEFT_OUT = 1e-13
_SMALLEST_REACH, _LARGEST_REACH = 1e-300, 1e300
LARGEST = 2048


@dataclass(frozen=True)
class Truncation:
    """Where Hill's matrix is cut, and what that costs.

    Attributes
    ----------
    harmonic : int
        Highest k (whole problem) or number of half-whole k.
    left_out : float
        Majorant of the effect of the harmonics beyond on the wanted eigenvalues.
    norm : float
        Bound of the norm of the matrix, which scales its round-off.
    """

    harmonic: int
    left_out: float
    norm: float


def truncation(f: PeriodicFunction, reach: float, highest: int, shift: float = 0.0) -> Truncation:
    """Choose the truncation for the regions up to ``highest`` at ``|mu| <= reach``.

    ``reach`` is rounded up to a quarter of an octave, so that neighbouring slices share the work.
    With damping the eigenvalues are the real ones, moved up by at most ``shift`` = K^2; the
    damping term is diagonal in exp(i k theta) and imaginary there, so the bound holds unchanged.

    A normalised eigenvector to an eigenvalue below ``highest^2/4 + reach * sup|f|`` has components
    that obey ``(k^2 - lam2) |v_k| <= reach * sum_m |c_m| (|v_{k-m}| + |v_{k+m}|)``: bounding the
    low ones by 1 and the higher neighbours by the component itself gives a majorant M_k by
    recursion.  Cutting at k = N raises no eigenvalue by more than the second-order effect of what
    is left out, about ``2 sum_{k > N} M_k^2 (k^2 - lam2)``.

    Raises
    ------
    BadInput
        If more than 2048 harmonics would be needed.
    """
    if not reach < _LARGEST_REACH:
        raise _too_large(reach, f)
    octave = 2.0 ** (0.25 * ceil(4.0 * math.log2(reach))) if reach > _SMALLEST_REACH else 0.0
    return _truncation(f, max(octave, reach), highest, shift)


@lru_cache(maxsize=256)
def _truncation(f: PeriodicFunction, reach: float, highest: int, shift: float) -> Truncation:
    half = (0.5 * reach) * f.amplitudes[1:]
    bound = 2.0 * float(half.sum())
    taps = half[: int(np.count_nonzero(np.cumsum(half[::-1]) > 1e-17))][::-1]
    ceiling = 0.25 * highest * highest + shift + 1.5 * bound
    goal = max(_LEFT_OUT, EPS * ceiling)
    start, width = int(sqrt(ceiling)) + 1, len(taps)
    lag = _longest_gap(half)
    # Component k stands at index width + k; all that lies below the start is bounded by 1.
    size = np.ones(width + start + 64)
    terms = [math.inf] * (2 * lag)
    for k in range(start, LARGEST):
        if width + k >= len(size):
            size = np.concatenate([size, np.ones(len(size))])
        gap = k * k - ceiling
        value = min(1.0, float(taps @ size[k : width + k]) / gap)
        size[width + k] = value
        terms.append(2.0 * value * value * gap)
        last, before = sum(terms[-lag:]), sum(terms[-2 * lag : -lag])
        # What follows falls off at least about as fast as from one stretch to the next.
        left_out = last / (1.0 - last / before) if last < before else math.inf
        if left_out <= goal:
            return Truncation(max(k - lag, highest), left_out, float(k * k) + bound)
    raise _too_large(reach, f)


def _too_large(reach: float, f: PeriodicFunction) -> BadInput:
    return bad(
        "hill_boundaries",
        f"|mu| up to {reach:.3g}, {f.harmonics} harmonics",
        f"a problem that {LARGEST} harmonics settle",
        "truncate the function or take a smaller mu",
    )


def _longest_gap(amplitudes: Array) -> int:
    """Return the longest step between harmonics that stand out (2 for even harmonics alone)."""
    ahead = np.maximum.accumulate(amplitudes[::-1])[::-1]
    present = np.flatnonzero((amplitudes >= 0.1 * ahead) & (amplitudes > 0.0))
    if present.size < 2:
        return int(present[0]) + 1 if present.size else 1
    return int(max(present[0] + 1, (present[1:] - present[:-1]).max()))


@dataclass(frozen=True)
class Layout:
    """Where the coefficients of f stand in its matrix, and the squares of k."""

    first: Index
    second: Index
    squares: Array
    highest: int


@lru_cache(maxsize=64)
def layout(odd: int, harmonic: int) -> Layout:
    """Return the index arrays for k up to ``harmonic`` (whole) or so many half-whole k.

    The basis runs cos 0, cos 1, sin 1, ... or cos 1/2, sin 1/2, cos 3/2, ...  Products of two
    functions give the coefficients at the sum and at the difference of their numbers.
    """
    twice = np.repeat(np.arange(odd, 2 * harmonic + 1, 2), 2)
    sine = np.tile([0, 1], len(twice) // 2)
    if not odd:
        twice, sine = np.delete(twice, 1), np.delete(sine, 1)
    j, k = twice[:, None], twice
    js, ks = sine[:, None].astype(bool), sine.astype(bool)
    total, apart = (j + k) // 2, np.abs(j - k) // 2
    m = int(total.max()) + 1
    # Blocks of the table: a/2, b/2, -b/2, -a/2.
    mixed = js != ks
    larger = np.where(js, j > k, k > j)
    first = np.where(mixed, total + m, np.where(js & ks, total + 3 * m, total))
    second = np.where(mixed, apart + np.where(larger, m, 2 * m), apart)
    squares: Array = np.square(0.5 * twice)
    for item in (first, second, squares):
        item.setflags(write=False)
    return Layout(first, second, squares, m - 1)


@lru_cache(maxsize=64)
def matrix(f: PeriodicFunction, odd: int, harmonic: int) -> Array:
    """Return the matrix of ``f - mean`` in the basis of :func:`layout`, read-only."""
    where = layout(odd, harmonic)
    m = where.highest + 1
    table = np.zeros(4 * m)
    n = min(m, len(f.a))
    table[1:n] = 0.5 * f.a[1:n]
    table[m + 1 : m + n] = 0.5 * f.b[1:n]
    table[2 * m : 3 * m] = -table[m : 2 * m]
    table[3 * m :] = -table[:m]
    out: Array = table[where.first]
    out += table[where.second]
    if not odd:
        out[0] *= sqrt(0.5)
        out[:, 0] *= sqrt(0.5)
    out.setflags(write=False)
    return out


def stacked(f: PeriodicFunction, odd: int, harmonic: int, mu: Array) -> Array:
    """Return Hill's matrices ``k^2 - mu (f - mean)`` at mu ``(n,)``, shape ``(n, size, size)``."""
    out: Array = np.negative(mu)[:, None, None] * matrix(f, odd, harmonic)
    size = out.shape[1]
    out.reshape(mu.size, size * size)[:, :: size + 1] += layout(odd, harmonic).squares
    return out
