"""Exact numbers p + q sqrt(d) with rational p, q, and functions with rational coefficients."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from itertools import zip_longest


@dataclass(frozen=True, eq=False)
class Surd:
    """The number ``rational + irrational * sqrt(radicand)``; the radicand is no square, or 0."""

    rational: Fraction
    irrational: Fraction = Fraction(0)
    radicand: int = 0

    @classmethod
    def of(cls, value: Surd | Fraction | int) -> Surd:
        """Return the value as a surd."""
        return value if isinstance(value, Surd) else cls(Fraction(value))

    @classmethod
    def root(cls, square: Fraction) -> Surd:
        """Return the root of a rational number that is at least zero."""
        inside, outside = square.numerator * square.denominator, Fraction(1, square.denominator)
        for factor in range(2, 1000):
            while inside % (factor * factor) == 0 and inside:
                inside //= factor * factor
                outside *= factor
        whole = math.isqrt(inside)
        if whole * whole == inside:
            return cls(whole * outside)
        return cls(Fraction(0), outside, inside)

    def _field(self, other: Surd) -> int:
        if self.irrational and other.irrational and self.radicand != other.radicand:
            raise ValueError(f"surds: found roots of {self.radicand} and {other.radicand}")
        return self.radicand if self.irrational else other.radicand

    def __add__(self, other: Surd | Fraction | int) -> Surd:
        o = Surd.of(other)
        d = self._field(o)
        return Surd(self.rational + o.rational, self.irrational + o.irrational, d)

    def __neg__(self) -> Surd:
        return Surd(-self.rational, -self.irrational, self.radicand)

    def __sub__(self, other: Surd | Fraction | int) -> Surd:
        return self + (-Surd.of(other))

    def __mul__(self, other: Surd | Fraction | int) -> Surd:
        if not isinstance(other, Surd):
            return Surd(self.rational * other, self.irrational * other, self.radicand)
        d = self._field(other)
        return Surd(
            self.rational * other.rational + d * self.irrational * other.irrational,
            self.rational * other.irrational + self.irrational * other.rational,
            d,
        )

    __radd__ = __add__
    __rmul__ = __mul__

    def __truediv__(self, other: Surd | Fraction | int) -> Surd:
        o = Surd.of(other)
        norm = o.rational**2 - o.radicand * o.irrational**2
        return self * Surd(o.rational / norm, -o.irrational / norm, o.radicand)

    def __bool__(self) -> bool:
        return bool(self.rational or self.irrational)

    def _parts(self) -> tuple[Fraction, Fraction, bool]:
        # Roots of different radicands may be multiples of each other: compare their squares.
        return self.rational, self.irrational**2 * self.radicand, self.irrational > 0

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Surd | int | Fraction):
            return NotImplemented
        return self._parts() == Surd.of(other)._parts()

    def __float__(self) -> float:
        """Return the nearest double, or one beside it, free of cancellation."""
        root = math.sqrt(self.radicand)
        if self.rational * self.irrational < 0:
            norm = self.rational**2 - self.radicand * self.irrational**2
            return float(norm) / (float(self.rational) - float(self.irrational) * root)
        return float(self.rational) + float(self.irrational) * root


@dataclass(frozen=True)
class ExactHarmonics:
    """A periodic function, Smith (7.20): a_0 without a half, a_1, a_2, ... and b_1, b_2, ..."""

    mean: Fraction
    cosine: tuple[Fraction, ...]
    sine: tuple[Fraction, ...]

    @classmethod
    def of(
        cls,
        mean: Fraction | int | str = 0,
        cosine: Iterable[Fraction | int | str] = (),
        sine: Iterable[Fraction | int | str] = (),
    ) -> ExactHarmonics:
        """Return the function from numbers of any rational kind; a float is taken as it is stored.

        The shorter row is filled up with zeros.
        """
        pairs = [tuple(map(Fraction, p)) for p in zip_longest(cosine, sine, fillvalue=0)]
        return cls(Fraction(mean), tuple(a for a, _ in pairs), tuple(b for _, b in pairs))

    def harmonic(self, m: int) -> tuple[Fraction, Fraction]:
        """Return (a_m, b_m); (a_0, 0) for the mean."""
        if m == 0:
            return self.mean, Fraction(0)
        if m > len(self.cosine):
            return Fraction(0), Fraction(0)
        return self.cosine[m - 1], self.sine[m - 1]

    def without(self, m: int) -> ExactHarmonics:
        """Return the function less its m-th harmonic, m >= 1."""

        def cut(row: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
            return tuple(Fraction(0) if i == m else x for i, x in enumerate(row, 1))

        return ExactHarmonics(self.mean, cut(self.cosine), cut(self.sine))


def combine(
    functions: Iterable[ExactHarmonics], weights: Iterable[Fraction | int]
) -> ExactHarmonics:
    """Return the weighted sum of functions: a direction in the space of several parameters.

    Smith (8.39), (8.42) with the weights 1 and eps2/eps1.
    """
    pairs = [(f, Fraction(w)) for f, w in zip(functions, weights, strict=True)]
    count = max(len(f.cosine) for f, _ in pairs)
    rows = [
        [sum(w * f.harmonic(m)[kind] for f, w in pairs) for m in range(1, count + 1)]
        for kind in (0, 1)
    ]
    return ExactHarmonics.of(sum(w * f.mean for f, w in pairs), *rows)
