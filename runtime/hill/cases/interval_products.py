"""Products of the exact matrices of intervals: half trace, entries and multipliers with errors.

A matrix of determinant 1 is held by half trace, half difference of its diagonal, and the entries
off it, times a power of two: ``J^2 - 1 = difference^2 + upper lower`` keeps its digits next to a
boundary of stability.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import log
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....generated import hill_meissner
from ..transfer import EPS

Array = NDArray[np.float64]
Powers = NDArray[np.int64]

_interval: Callable[..., tuple[Array, Array]] = hill_meissner.interval
_one_more: Callable[..., tuple[Array, ...]] = hill_meissner.one_more_interval

_CHUNK = 2**19
# Rounding of cosine and sine, and of a product of matrices, in units of their last digit.
_ROUNDING = 2.0
_LARGEST_POWER = 1000


@dataclass(frozen=True)
class Products:
    """Half trace, half difference and entries off the diagonal, times ``2**power``, with errors.

    All of shape ``(4, n)``; ``defect`` is the largest relative deviation of a determinant from 1.
    """

    parts: Array
    errors: Array
    power: Powers
    defect: float

    @classmethod
    def of(cls, q: Array, t: Array, drag: Array) -> Products:
        """Multiply the matrices of all intervals, a part of the points at a time.

        Parameters
        ----------
        q : ndarray, shape (n, N)
            Levels without damping.
        t : ndarray, shape (N,)
            Lengths.
        drag : ndarray, shape (n,)
            K^2, which was taken off the levels.
        """
        n, count = q.shape
        parts, errors = np.empty((4, n)), np.empty((4, n))
        power = np.empty(n, dtype=np.int64)
        step = max(1, _CHUNK // (8 * count))
        for start in range(0, n, step):
            rows = slice(start, start + step)
            parts[:, rows], errors[:, rows], power[rows] = _product(q[rows].T, t, drag[rows])
        half, difference, upper, lower = parts
        ones = np.ldexp(1.0, np.maximum(-2 * power, -1074).astype(int))
        square = difference * difference + upper * lower
        gap = np.abs(half * half - square - ones)
        size = half * half + difference * difference + np.abs(upper * lower) + ones
        return cls(parts, errors, power, float(np.max(gap / size, initial=0.0)))

    def damped(self, k: Array, period: float) -> dict[str, NDArray[Any]]:
        """Return the fields of the result, with K ``(n,)``."""
        half, error = self.parts[0], self.errors
        decay = _Decay.of(k * period, self.power)
        square, square_error = self._square()
        with np.errstate(over="ignore", invalid="ignore"):
            entries, spread = self._with_drag(k)
            spread = spread + EPS * (2.0 + k * period) * (np.abs(entries) + spread)
            value = decay.times(half)
            own = decay.times(error[0]) + EPS * (1.0 + k * period) * np.abs(value)
            margin, margin_error = self._margin(square, square_error, decay, value, own)
            multipliers, apart = self._multipliers(square, square_error, decay)
            shape = (-1, 2, 2)
            return {
                "half_trace": value,
                "error": own,
                "margin": margin,
                "margin_error": margin_error,
                "matrix": np.moveaxis(decay.times(entries), 0, -1).reshape(shape),
                "matrix_error": np.moveaxis(decay.times(spread), 0, -1).reshape(shape),
                "multipliers": multipliers,
                "multiplier_error": apart,
            }

    def _with_drag(self, k: Array) -> tuple[Array, Array]:
        """Return the entries in (y, y') of y = exp(-K theta) u, but for the decay, with errors."""
        (half, difference, upper, lower), error = self.parts, self.errors
        turned = lower - 2.0 * k * difference - k * k * upper
        entries = np.stack(
            [half + difference + k * upper, upper, turned, half - difference - k * upper]
        )
        spread = error[0] + error[1] + k * error[2]
        below = error[3] + 2.0 * k * error[1] + k * k * error[2]
        return entries, np.stack([spread, error[2], below, spread])

    def _margin(
        self, square: Array, noise: Array, decay: _Decay, value: Array, error: Array
    ) -> tuple[Array, Array]:
        """Return boundary level less size of the half trace, and its error."""
        half = np.abs(self.parts[0])
        one = np.ldexp(1.0, np.clip(-self.power, -_LARGEST_POWER, _LARGEST_POWER))
        # Little damping: both differences from 1, formed without subtracting.
        small = np.minimum(decay.exponent, 1.0)
        lift = 2.0 * np.sinh(0.5 * small) ** 2
        below = np.ldexp(square / (half + one), self.power)
        below_error = np.ldexp(noise / (half + one), self.power)
        near = np.exp(-small) * (lift - below)
        near_error = np.exp(-small) * (below_error + 2.0 * EPS * (lift + np.abs(below)))
        far = 0.5 * (1.0 + np.exp(-2.0 * decay.exponent)) - np.abs(value)
        little = decay.exponent < 1.0
        return np.where(little, near, far), np.where(little, near_error, error + EPS)

    def _square(self) -> tuple[Array, Array]:
        """Return ``(J^2 - 1) / 4**power`` and its error: difference^2 + upper lower."""
        _, difference, upper, lower = self.parts
        error = self.errors
        square = difference * difference + upper * lower
        noise = 2.0 * np.abs(difference) * error[1] + error[1] ** 2
        noise += np.abs(upper) * error[3] + np.abs(lower) * error[2] + error[2] * error[3]
        return square, noise + EPS * (difference * difference + np.abs(upper * lower))

    def _multipliers(
        self, square: Array, noise: Array, decay: _Decay
    ) -> tuple[NDArray[np.complex128], Array]:
        """Return the multipliers and their errors, each ``(n, 2)``."""
        half = self.parts[0]
        root = np.sqrt(np.abs(square))
        # The root moves by noise / (2 root), at a boundary by sqrt(noise).
        moved = np.minimum(np.sqrt(noise), noise / np.maximum(2.0 * root, 1e-300))
        real = square >= 0.0
        sign = np.where(half < 0.0, -1.0, 1.0)
        large = decay.times(half + sign * root)
        small = np.exp(-2.0 * decay.exponent) / np.where(large == 0.0, np.inf, large)
        pair = np.empty((half.size, 2), dtype=np.complex128)
        pair.real = np.where(real, np.stack([large, small]), decay.times(half)).T
        pair.imag = np.where(real, 0.0, decay.times(np.stack([root, -root]))).T
        rounding = EPS * (1.0 + decay.exponent)
        error = decay.times(self.errors[0] + moved) + rounding * np.abs(pair[:, 0])
        share = np.where(real, np.abs(small) / np.where(large == 0.0, 1.0, np.abs(large)), 1.0)
        other = np.minimum(error * share, 1.0 + error) + rounding * np.abs(pair[:, 1])
        return pair, np.stack([error, other], axis=-1)


@dataclass(frozen=True)
class _Decay:
    """The factor exp(-K T) and the powers of two of the parts, together: neither overflows alone.

    Attributes
    ----------
    exponent : ndarray, shape (n,)
        K T.
    factor : ndarray, shape (n,)
        Between 1/2 and 2.
    power : ndarray of int, shape (n,)
        With the factor, ``2**power`` of the parts times exp(-K T).
    """

    exponent: Array
    factor: Array
    power: Powers

    @classmethod
    def of(cls, exponent: Array, power: Powers) -> _Decay:
        """Divide the factor into a power of two and a rest."""
        down = np.rint(-exponent / log(2.0))
        factor = np.exp(-exponent - down * log(2.0))
        return cls(exponent, factor, power + down.astype(np.int64))

    def times(self, values: Array) -> Array:
        """Return values of the parts' scale, ``(..., n)``, times the decay."""
        return np.asarray(np.ldexp(values * self.factor, self.power))


def _product(q: Array, t: Array, drag: Array) -> tuple[Array, Array, NDArray[np.int64]]:
    """Return parts ``(4, n)``, their errors, and powers of two, for levels ``(N, n)``."""
    count, n = q.shape
    c, s = _interval(q, t[:, None])
    before = np.empty((count + 1, 4, n))
    powers = np.zeros((count + 1, n), dtype=np.int64)
    before[0] = np.array([1.0, 0.0, 0.0, 0.0])[:, None]
    for i in range(count):
        stepped = np.stack(_one_more(*before[i], c[i], s[i], q[i]))
        _, more = np.frexp(np.abs(stepped).max(axis=0))
        before[i + 1] = np.ldexp(stepped, -more)
        powers[i + 1] = powers[i] + more
    # What the rounding of each matrix does to the whole: |after| error |before|.
    after, after_power = np.tile([[1.0], [0.0], [0.0], [1.0]], (1, n)), np.zeros(n, np.int64)
    total = np.zeros((4, n))
    for i in range(count - 1, -1, -1):
        noise = np.where(drag > 0.0, EPS * (drag + np.abs(q[i])), 0.0)
        own = _interval_error(c[i], s[i], q[i], t[i], noise)
        known = _entries(before[i])
        term = _times(_times(np.abs(after), own), np.abs(known))
        total += np.ldexp(term, np.minimum(powers[i] + after_power - powers[-1], 1000))
        after = _times(after, np.stack([c[i], s[i], -q[i] * s[i], c[i]]))
        _, more = np.frexp(np.abs(after).max(axis=0))
        after, after_power = np.ldexp(after, -more), after_power + more
    mixed = 0.5 * (total[0] + total[3])
    return before[-1], np.stack([mixed, mixed, total[1], total[2]]), powers[-1]


def _interval_error(c: Array, s: Array, q: Array, t: float, noise: Array) -> Array:
    """Return the errors ``(4, n)`` of the entries of one matrix, with that of one product."""
    turned, stretched = np.abs(q * t * s), np.abs(t * c)
    cosine = EPS * (_ROUNDING * np.abs(c) + turned) + noise * np.abs(t * s)
    # ds/dq is (t c - s) / (2 q), and of the order t^2 s where q is small.
    slope = np.minimum(t * t, 0.5 / np.maximum(np.abs(q), 1e-300)) * (np.abs(s) + stretched)
    sine = EPS * (_ROUNDING * np.abs(s) + stretched) + noise * slope
    lower = np.abs(q) * sine + (EPS * np.abs(q) + noise) * np.abs(s)
    more = _ROUNDING * EPS * np.abs(np.stack([c, s, q * s, c]))
    return np.asarray(np.stack([cosine, sine, lower, cosine]) + more)


def _entries(parts: Array) -> Array:
    half, difference, upper, lower = parts
    return np.stack([half + difference, upper, lower, half - difference])


def _times(first: Array, second: Array) -> Array:
    """Multiply 2 x 2 matrices given as rows of four entries, shape ``(4, n)``."""
    a, b, c, d = first
    e, f, g, h = second
    return np.stack([a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h])
