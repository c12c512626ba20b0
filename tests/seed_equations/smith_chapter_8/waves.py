"""Exact trigonometric sums in multiples of half the angle, over one common denominator."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from .surd import ExactHarmonics, Surd

_Rows = tuple[list[int], list[int], list[int], list[int]]


@dataclass(frozen=True)
class Wave:
    """The sum of ``A_p cos(p theta/2) + B_p sin(p theta/2)`` over p = parity, parity + 2, ...

    Whole numbers over one denominator: a product with a Fourier series costs whole products only.

    Attributes
    ----------
    parity : int
        0 or 1: all p are even, or all are odd.
    radicand : int
        d of the field Q(sqrt d) of the coefficients; 0 where they are rational.
    denominator : int
        Common denominator.
    rows : tuple of four tuples of int
        Numerators of the rational and irrational parts of A, then of B, by ``(p - parity)/2``.
    """

    parity: int
    radicand: int
    denominator: int
    rows: tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...], tuple[int, ...]]

    @property
    def harmonics(self) -> tuple[int, ...]:
        """Return the p of all non-zero terms."""
        count = range(len(self.rows[0]))
        return tuple(2 * h + self.parity for h in count if any(row[h] for row in self.rows))

    def coefficient(self, p: int) -> tuple[Surd, Surd]:
        """Return (A_p, B_p)."""
        h = (p - self.parity) // 2
        if (p - self.parity) % 2 or not 0 <= h < len(self.rows[0]):
            return Surd(Fraction(0)), Surd(Fraction(0))
        numbers = [Fraction(row[h], self.denominator) for row in self.rows]
        return (
            Surd(numbers[0], numbers[1], self.radicand),
            Surd(numbers[2], numbers[3], self.radicand),
        )

    def __call__(self, theta: float) -> float:
        """Return the value at an angle [rad], in double precision."""
        total = 0.0
        for p in self.harmonics:
            a, b = self.coefficient(p)
            total += float(a) * math.cos(p * theta / 2) + float(b) * math.sin(p * theta / 2)
        return total


def single(p: int, cosine: Surd | int, sine: Surd | int) -> Wave:
    """Return the wave of one frequency p/2."""
    a, b = Surd.of(cosine), Surd.of(sine)
    fractions = [a.rational, a.irrational, b.rational, b.irrational]
    den = math.lcm(*(x.denominator for x in fractions))
    zeros = [0] * (p // 2)
    rows = [tuple([*zeros, int(x * den)]) for x in fractions]
    radicand = a.radicand or b.radicand
    return Wave(p % 2, radicand, den, (rows[0], rows[1], rows[2], rows[3]))


def _made(parity: int, radicand: int, den: int, rows: _Rows) -> Wave:
    """Reduce by the common divisor and drop trailing zeros."""
    if parity == 0 and rows[0]:
        rows[2][0] = rows[3][0] = 0
    last = len(rows[0])
    while last and not any(row[last - 1] for row in rows):
        last -= 1
    common = math.gcd(den, *(x for row in rows for x in row[:last]))
    final = [tuple(x // common for x in row[:last]) for row in rows]
    irrational = any(final[1]) or any(final[3])
    return Wave(
        parity,
        radicand if irrational else 0,
        den // common,
        (final[0], final[1], final[2], final[3]),
    )


def _empty(count: int) -> _Rows:
    return [0] * count, [0] * count, [0] * count, [0] * count


def product(wave: Wave, f: ExactHarmonics) -> Wave:
    """Return ``f`` times the wave, as (7.21) does it harmonic by harmonic."""
    den = math.lcm(*(x.denominator for x in (f.mean, *f.cosine, *f.sine)))
    terms = [
        (m, int(a * den), int(b * den))
        for m in range(len(f.cosine) + 1)
        for a, b in [f.harmonic(m)]
        if a or b
    ]
    out = _empty(len(wave.rows[0]) + len(f.cosine))
    for part in range(2 if wave.radicand else 1):
        _multiply(wave, terms, part, out[part], out[2 + part])
    return _made(wave.parity, wave.radicand, 2 * den * wave.denominator, out)


def _multiply(
    wave: Wave, terms: list[tuple[int, int, int]], part: int, cosine: list[int], sine: list[int]
) -> None:
    """Add one part (rational 0, irrational 1) of twice the product to two rows."""
    for h, (A, B) in enumerate(zip(wave.rows[part], wave.rows[2 + part], strict=True)):
        if not (A or B):
            continue
        for m, a, b in terms:
            aA, bB, aB, bA = a * A, b * B, a * B, b * A
            cosine[h + m] += aA - bB
            sine[h + m] += aB + bA
            if h >= m:
                cosine[h - m] += aA + bB
                sine[h - m] += aB - bA
            else:
                mirrored = m - h - wave.parity
                cosine[mirrored] += aA + bB
                sine[mirrored] -= aB - bA


def derivative(wave: Wave) -> Wave:
    """Return d/dtheta of the wave."""
    count = len(wave.rows[0])
    p = [2 * h + wave.parity for h in range(count)]
    a, a_root, b, b_root = wave.rows
    rows = (
        [k * x for k, x in zip(p, b, strict=True)],
        [k * x for k, x in zip(p, b_root, strict=True)],
        [-k * x for k, x in zip(p, a, strict=True)],
        [-k * x for k, x in zip(p, a_root, strict=True)],
    )
    return _made(wave.parity, wave.radicand, 2 * wave.denominator, rows)


def total(parity: int, pairs: Iterable[tuple[Surd, Wave]]) -> Wave:
    """Return the sum of numbers times waves of one parity and one field."""
    kept = [(s, w) for s, w in pairs if s and w.rows[0]]
    if not kept:
        return Wave(parity, 0, 1, ((), (), (), ()))
    fields = {d for s, w in kept for d in (s.radicand, w.radicand) if d}
    if len(fields) > 1:
        raise ValueError(f"waves: found roots of {sorted(fields)}; expected one field")
    d = fields.pop() if fields else 0
    dens = [
        math.lcm(s.rational.denominator, s.irrational.denominator) * w.denominator for s, w in kept
    ]
    den = math.lcm(*dens)
    out = _empty(max(len(w.rows[0]) for _, w in kept))
    for s, w in kept:
        scale = den // w.denominator
        p, q = int(s.rational * scale), int(s.irrational * scale)
        for kind in (0, 2):
            for h, (x, y) in enumerate(zip(w.rows[kind], w.rows[kind + 1], strict=True)):
                out[kind][h] += p * x + d * q * y
                out[kind + 1][h] += p * y + q * x
    return _made(parity, d, den, out)


def resolved(wave: Wave, n: int) -> Wave:
    """Return the particular solution of ``y'' + (n/2)^2 y = wave`` without its resonant term.

    Smith (7.30): each harmonic p is divided by ``(n^2 - p^2)/4``; that of p = n is left out.
    """
    divisors = [n * n - (2 * h + wave.parity) ** 2 for h in range(len(wave.rows[0]))]
    common = math.lcm(*(k for k in divisors if k))
    scale = [4 * (common // k) if k else 0 for k in divisors]
    rows = [[k * x for k, x in zip(scale, row, strict=True)] for row in wave.rows]
    made = (rows[0], rows[1], rows[2], rows[3])
    return _made(wave.parity, wave.radicand, common * wave.denominator, made)


def overlap(one: Wave, other: Wave) -> Surd:
    """Return twice the mean of the product of two waves of one parity."""
    result = Surd(Fraction(0))
    for p in set(one.harmonics) & set(other.harmonics):
        (a, b), (c, d) = one.coefficient(p), other.coefficient(p)
        result = result + (a * c + b * d) * (1 if p else 2)
    return result
