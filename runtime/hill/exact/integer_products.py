"""Hill's operator on Fourier vectors in exact integer arithmetic, for enclosures.

A vector holds the coefficients of ``sum_k alpha_k cos k theta + beta_k sin k theta``, k whole or
half-whole, as integers; the products with the function are convolutions of integers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

import numpy as np
from numpy.typing import NDArray

from ...core.periodic_function import PeriodicFunction

Array = NDArray[np.float64]
Integers = list[int]

# Binary digits after the point: of trial vectors, and of the coefficients mu a_m, mu b_m.
VECTOR_BITS, FUNCTION_BITS = 62, 160
# What a product of the operator with a vector counts in.
PRODUCT_UNIT = 1 << (VECTOR_BITS + FUNCTION_BITS + 2)


@dataclass(frozen=True)
class Wave:
    """A trial function: integers alpha and beta by k = first, first + 1, ...; first is 0 or 1/2.

    ``beta[0]`` is zero where the first k is 0.
    """

    odd: int
    alpha: Integers
    beta: Integers

    def padded(self, count: int) -> Wave:
        """Return the same function with ``count`` coefficients of each kind."""
        rest = [0] * (count - len(self.alpha))
        return Wave(self.odd, self.alpha + rest, self.beta + rest)

    def plus(self, other: Wave, factor: int) -> Wave:
        """Return ``self + factor * other``; ``other`` may be shorter."""
        if len(other.alpha) < len(self.alpha):
            other = other.padded(len(self.alpha))
        alpha = [x + factor * y for x, y in zip(self.alpha, other.alpha, strict=True)]
        beta = [x + factor * y for x, y in zip(self.beta, other.beta, strict=True)]
        return Wave(self.odd, alpha, beta)

    def scaled(self, bits: int) -> Wave:
        """Return the function times ``2**bits``."""
        return Wave(self.odd, [x << bits for x in self.alpha], [x << bits for x in self.beta])


def inner(x: Wave, y: Wave) -> int:
    """Return ``(1/pi)`` times the integral of x y over a period (4 pi for half-whole k: halved)."""
    total = sum(p * q for p, q in zip(x.alpha, y.alpha, strict=False))
    total += sum(p * q for p, q in zip(x.beta, y.beta, strict=False))
    return total if x.odd else total + x.alpha[0] * y.alpha[0]


def wave(odd: int, column: Array) -> Wave:
    """Round an eigenvector in the basis of :func:`.layout.layout` to integers."""
    values = np.array(column)
    if not odd:
        values = np.concatenate([[values[0] * np.sqrt(0.5), 0.0], values[1:]])
    whole = np.rint(values * 2.0**VECTOR_BITS).astype(np.int64)
    return Wave(odd, whole[::2].tolist(), whole[1::2].tolist())


class HillOperator:
    """``4 (k^2 - mu (f - mean) - 2 K d/d theta)`` in units of ``2**-FUNCTION_BITS``.

    Attributes
    ----------
    rounding : Fraction
        Bound of the norm of what rounding the coefficients changed in the operator without the
        factor 4 (the damping term is exact).
    """

    def __init__(self, f: PeriodicFunction, mu: float, damping: float = 0.0) -> None:
        factor = Fraction(mu)
        reach = f.harmonics
        unit = 1 << FUNCTION_BITS
        self._a = [_rounded(factor * Fraction(float(x)), unit) for x in f.a[1:]]
        self._b = [_rounded(factor * Fraction(float(x)), unit) for x in f.b[1:]]
        self._reach = reach
        drag = 4 * Fraction(damping) * unit
        # K = m 2^-e with a long e has digits beyond the unit: they count as rounding as well.
        self._drag = _rounded(drag, 1)
        self.rounding = Fraction(2 * reach, unit)
        self._drag_rounding = Fraction(0 if drag == self._drag else 1, unit)
        self.even = not any(self._b)

    def __call__(self, x: Wave) -> Wave:
        """Apply the operator; the result reaches as many harmonics further as f has."""
        count = len(x.alpha) + self._reach
        alpha, beta = self._product(x, count)
        # With numbers twice as large k is whole.
        out_a, out_b = [], []
        wide = x.padded(count)
        for i, (p, q) in enumerate(zip(wide.alpha, wide.beta, strict=True)):
            twice = 2 * i + x.odd
            square = (twice * twice) << FUNCTION_BITS
            # -2 K d/d theta times 4: cos k gives +2 K k sin k, sin k gives -2 K k cos k.
            drag = self._drag * twice
            out_a.append(square * p - 2 * alpha[i] - drag * q)
            out_b.append(square * q - 2 * beta[i] + drag * p)
        return Wave(x.odd, out_a, out_b)

    def drag_rounding(self, highest: int) -> Fraction:
        """Return the norm of the rounding of K's term on vectors up to k = highest."""
        return self._drag_rounding * highest

    def _product(self, x: Wave, count: int) -> tuple[Integers, Integers]:
        """Return twice the coefficients of (f - mean) x, in units of both."""
        if not self._reach:
            return [0] * count, [0] * count
        # Complex coefficients, doubled: alpha - i beta at k > 0, the conjugate at -k, so that
        # the doubled product of two functions has their sum of products.
        start = 1 - x.odd
        real = x.alpha[::-1] + x.alpha[start:]
        imaginary = x.beta[::-1] + [-v for v in x.beta[start:]]
        if not x.odd:
            middle = len(x.alpha) - 1
            real[middle], imaginary[middle] = 2 * x.alpha[0], 0
        f_real = [*self._a[::-1], 0, *self._a]
        left = len(real) // 2 + self._reach
        rr, ri = _convolved(f_real, real, imaginary)
        if not self.even:
            f_imaginary = [*self._b[::-1], 0, *(-v for v in self._b)]
            ir, ii = _convolved(f_imaginary, real, imaginary)
            rr = [p - q for p, q in zip(rr, ii, strict=True)]
            ri = [p + q for p, q in zip(ri, ir, strict=True)]
        alpha, beta = rr[left:], [-v for v in ri[left:]]
        if not x.odd:
            # The constant itself, not twice the complex coefficient.
            alpha[0], beta[0] = alpha[0] // 2, 0
        return alpha[:count], beta[:count]


def _rounded(value: Fraction, unit: int) -> int:
    return round(value * unit)


def _convolved(f: Integers, x: Integers, y: Integers) -> tuple[Integers, Integers]:
    """Return the convolutions of f with x and with y by one product of long integers."""
    gap = len(f) - 1
    joined = x + [0] * gap + y
    largest = max(map(abs, f)), max(max(map(abs, joined)), 1)
    terms = min(len(f), len(x))
    size = (largest[0].bit_length() + largest[1].bit_length() + terms.bit_length() + 2) // 8 + 1
    product = _packed(f, size) * _packed(joined, size)
    out = _unpacked(product, size, len(joined) + gap)
    length = len(x) + gap
    return out[:length], out[length : 2 * length]


def _packed(values: Sequence[int], size: int) -> int:
    """Return ``sum_i values[i] 256^(size i)``."""
    offset = 1 << (8 * size - 1)
    raw = b"".join([(v + offset).to_bytes(size, "little") for v in values])
    return int.from_bytes(raw, "little") - offset * _ones(size, len(values))


def _unpacked(value: int, size: int, count: int) -> Integers:
    """Undo :func:`_packed` for values below half of ``256^size``."""
    offset = 1 << (8 * size - 1)
    raw = (value + offset * _ones(size, count)).to_bytes(size * count + 1, "little")
    return [
        int.from_bytes(raw[i : i + size], "little") - offset for i in range(0, size * count, size)
    ]


def _ones(size: int, count: int) -> int:
    return int.from_bytes((b"\x01" + bytes(size - 1)) * count, "little")


def root_above(value: Fraction) -> Fraction:
    """Return an upper bound of the square root, a hair above it."""
    shift = max(0, 128 + value.denominator.bit_length() - value.numerator.bit_length())
    shift += shift % 2
    scaled = -((-value.numerator << shift) // value.denominator)
    return Fraction(isqrt(scaled) + 1, 1 << (shift // 2))
