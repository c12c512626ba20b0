"""Exact numbers p + q sqrt(d) with rational p, q: where the boundaries' coefficients live."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

_SMALL_SQUARES = 1000


@dataclass(frozen=True)
class Surd:
    """The number ``rational + irrational * sqrt(radicand)``.

    Attributes
    ----------
    rational, irrational : Fraction
        The two parts.
    radicand : int
        A positive whole number that is no square; 0 for a rational number.
    """

    rational: Fraction
    irrational: Fraction = Fraction(0)
    radicand: int = 0

    def __post_init__(self) -> None:
        if not self.irrational and self.radicand:
            object.__setattr__(self, "radicand", 0)
        if self.irrational and not self.radicand:
            raise ValueError("surd: found an irrational part without a radicand")

    @classmethod
    def of(cls, value: Surd | Fraction | int) -> Surd:
        """Return the value as a surd."""
        return value if isinstance(value, Surd) else cls(Fraction(value))

    @classmethod
    def root(cls, square: Fraction) -> Surd:
        """Return the root of a rational number that is at least zero.

        Raises
        ------
        ValueError
            If it is negative.
        """
        if square < 0:
            raise ValueError(f"square: found {square}; expected at least 0; it has no real root")
        inside, outside = square.numerator * square.denominator, Fraction(1, square.denominator)
        whole = math.isqrt(inside)
        if whole * whole == inside:
            return cls(whole * outside)
        for factor in range(2, _SMALL_SQUARES):
            while inside % (factor * factor) == 0:
                inside //= factor * factor
                outside *= factor
        whole = math.isqrt(inside)
        if whole * whole == inside:
            return cls(whole * outside)
        return cls(Fraction(0), outside, inside)

    def _field(self, other: Surd) -> int:
        if self.radicand and other.radicand and self.radicand != other.radicand:
            raise ValueError(
                f"surds: found roots of {self.radicand} and {other.radicand}; expected one field"
            )
        return self.radicand or other.radicand

    def __add__(self, other: Surd | Fraction | int) -> Surd:
        o = Surd.of(other)
        d = self._field(o)
        return Surd(self.rational + o.rational, self.irrational + o.irrational, d)

    def __neg__(self) -> Surd:
        return Surd(-self.rational, -self.irrational, self.radicand)

    def __sub__(self, other: Surd | Fraction | int) -> Surd:
        return self + (-Surd.of(other))

    def __rsub__(self, other: Fraction | int) -> Surd:
        return (-self) + other

    def __mul__(self, other: Surd | Fraction | int) -> Surd:
        o = Surd.of(other)
        d = self._field(o)
        return Surd(
            self.rational * o.rational + d * self.irrational * o.irrational,
            self.rational * o.irrational + self.irrational * o.rational,
            d,
        )

    __radd__ = __add__
    __rmul__ = __mul__

    def conjugate(self) -> Surd:
        """Return the number with the other sign of the root."""
        return Surd(self.rational, -self.irrational, self.radicand)

    def inverse(self) -> Surd:
        """Return ``1 / self``.

        Raises
        ------
        ZeroDivisionError
            If the number is zero.
        """
        norm = self.rational**2 - self.radicand * self.irrational**2
        return Surd(self.rational / norm, -self.irrational / norm, self.radicand)

    def __truediv__(self, other: Surd | Fraction | int) -> Surd:
        return self * Surd.of(other).inverse()

    def __bool__(self) -> bool:
        return bool(self.rational or self.irrational)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, int | Fraction):
            other = Surd(Fraction(other))
        if not isinstance(other, Surd):
            return NotImplemented
        # Roots of different radicands may be multiples of each other: compare their squares.
        return self._parts() == other._parts()

    def __hash__(self) -> int:
        return hash(self._parts() if self.irrational else self.rational)

    def _parts(self) -> tuple[Fraction, Fraction, bool]:
        return self.rational, self.irrational**2 * self.radicand, self.irrational > 0

    def sign(self) -> int:
        """Return -1, 0 or 1."""
        first = (self.rational > 0) - (self.rational < 0)
        second = (self.irrational > 0) - (self.irrational < 0)
        if first * second >= 0:
            return first or second
        larger = self.rational**2 > self.radicand * self.irrational**2
        return first if larger else second

    def __float__(self) -> float:
        """Return the nearest double, or one beside it, free of cancellation."""
        if not self.irrational:
            return float(self.rational)
        norm = self.rational**2 - self.radicand * self.irrational**2
        root = math.sqrt(self.radicand)
        if self.rational * self.irrational < 0:
            return float(norm) / (float(self.rational) - float(self.irrational) * root)
        return float(self.rational) + float(self.irrational) * root

    def sympy(self) -> sp.Expr:
        """Return the number as an expression."""
        rational, irrational = (sp.Rational(x) for x in (self.rational, self.irrational))
        return rational + irrational * sp.sqrt(self.radicand)


@dataclass(frozen=True)
class ExactHarmonics:
    """A periodic function with rational Fourier coefficients, Smith (7.20).

    Attributes
    ----------
    mean : Fraction
        a_0, without a half.
    cosine, sine : tuple of Fraction
        a_1, a_2, ... and b_1, b_2, ..., of one length.
    """

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

        Raises
        ------
        ValueError
            If a coefficient is no rational number.
        """
        try:
            rows = [[Fraction(x) for x in row] for row in (cosine, sine)]
            level = Fraction(mean)
        except (TypeError, ValueError, OverflowError) as problem:
            raise ValueError(
                f"Fourier coefficients: {problem}; expected rational numbers; use Fraction"
            ) from None
        count = max(map(len, rows))
        full = [tuple(row + [Fraction(0)] * (count - len(row))) for row in rows]
        return cls(level, full[0], full[1])

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
    count = max((len(f.cosine) for f, _ in pairs), default=0)
    rows = [
        [sum((w * f.harmonic(m)[kind] for f, w in pairs), Fraction(0)) for m in range(1, count + 1)]
        for kind in (0, 1)
    ]
    mean = sum((w * f.mean for f, w in pairs), Fraction(0))
    return ExactHarmonics(mean, tuple(rows[0]), tuple(rows[1]))
