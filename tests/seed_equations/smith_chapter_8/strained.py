"""Boundaries of Hill's equation by strained parameters in exact algebra, as Smith chapter 7 does.

    y'' + 2 K y' + (lam2 + mu f(theta)) y = 0,  K = mu beta_1 + mu^2 beta_2 + ...
    lam2 = n^2/4 + sum alpha_k mu^k,            y = y_0 + mu y_1 + ...

Each order is one equation y_k'' + (n/2)^2 y_k = right side (7.16)-(7.18), (7.42).  That y_k must be
periodic gives two conditions on the resonant harmonic (7.22), (7.31)-(7.32), (7.44).  Everything
is real and trigonometric, in the numbers p + q sqrt(d), d = a_n^2 + b_n^2 - 4 beta^2 n^2.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction

from .exact import ExactSeries
from .surd import ExactHarmonics, Surd, combine

Pair = tuple[Surd, Surd]
_ZERO, _ONE = Surd(Fraction(0)), Surd(Fraction(1))


class Wave(dict[int, Pair]):
    """The sum of ``A cos(p theta/2) + B sin(p theta/2)``, as ``{p: (A, B)}`` with p >= 0."""

    def coefficient(self, p: int) -> Pair:
        """Return (A_p, B_p)."""
        return self.get(p, (_ZERO, _ZERO))

    def add(self, p: int, cosine: Surd, sine: Surd) -> None:
        """Add a term; p may be negative."""
        a, b = self.coefficient(abs(p))
        self[abs(p)] = (a + cosine, (b + sine if p > 0 else b - sine) if p else _ZERO)


def total(*terms: tuple[Surd | int, Wave]) -> Wave:
    """Return the sum of numbers times waves."""
    out = Wave()
    for factor, wave in terms:
        for p, (a, b) in wave.items():
            out.add(p, a * factor, b * factor)
    return out


def product(wave: Wave, f: ExactHarmonics) -> Wave:
    """Return ``f`` times the wave, as (7.21) does it harmonic by harmonic."""
    out = Wave()
    for p, (A, B) in wave.items():
        for m in range(len(f.cosine) + 1):
            a, b = (x / 2 for x in f.harmonic(m))
            if a or b:
                aA, bB, aB, bA = A * a, B * b, B * a, A * b
                out.add(p + 2 * m, aA - bB, aB + bA)
                out.add(p - 2 * m, aA + bB, aB - bA)
    return out


def derivative(wave: Wave) -> Wave:
    """Return d/dtheta of the wave."""
    return Wave({p: (b * Fraction(p, 2), a * Fraction(-p, 2)) for p, (a, b) in wave.items()})


def resolved(wave: Wave, n: int) -> Wave:
    """Return the solution of ``y'' + (n/2)^2 y = wave`` without its resonant term, (7.30)."""
    divisors = {p: Fraction(4, n * n - p * p) for p in wave if p != n}
    return Wave({p: tuple(x * k for x in wave[p]) for p, k in divisors.items()})


class _Expansion:
    """The solutions that belong to a fixed resonant harmonic, order by order.

    ``columns[i][k]`` is the part of order k of the solution whose resonant harmonic is
    ``cos(n theta/2)`` (i = 0) or ``sin(n theta/2)`` (i = 1) at order 0 and nothing afterwards.  As
    the equations are linear in y, any solution is ``y_k = sum_j columns[k-j] v_j`` with the free
    constants v_j = (A_j, B_j).  ``secular[k-1]`` holds what f and damping return to the resonant
    harmonic at order k; its rows are the cosine and the sine condition.
    """

    def __init__(self, f: ExactHarmonics, n: int, rates: tuple[Fraction, ...]) -> None:
        self.f, self.n, self.rates = f, n, rates
        self.alpha: list[Surd] = []
        self.secular: list[tuple[Pair, Pair]] = []
        kinds = ((_ONE, _ZERO), (_ZERO, _ONE)) if n else ((_ONE, _ZERO),)
        self.columns = [[Wave({n: kind})] for kind in kinds]

    def conditions(self) -> tuple[Pair, Pair]:
        """Return the secular matrix of the next order."""
        k = len(self.alpha) + 1
        damping = [(j, 2 * rate) for j, rate in enumerate(self.rates[:k], 1)]
        self.returned = [
            total((1, product(y[k - 1], self.f)), *((b, derivative(y[k - j])) for j, b in damping))
            for y in self.columns
        ]
        pairs = [wave.coefficient(self.n) for wave in self.returned]
        one, other = pairs if self.n else (pairs[0], (_ZERO, pairs[0][0]))
        self.secular.append(((one[0], other[0]), (one[1], other[1])))
        return self.secular[-1]

    def advance(self, alpha: Surd) -> None:
        """Take alpha of the present order and solve its equation for the columns."""
        k = len(self.secular)
        for y, returned in zip(self.columns, self.returned, strict=True):
            terms = ((-factor, y[k - j]) for j, factor in enumerate(self.alpha, 1))
            y.append(resolved(total((-1, returned), *terms), self.n))
        self.alpha.append(alpha)

    def applied(self, k: int, v: Pair) -> Pair:
        """Return (alpha_k + secular_k) v; without alpha_k where it is not known yet."""
        (a, b), (c, d) = self.secular[k - 1]
        alpha = self.alpha[k - 1] if k <= len(self.alpha) else _ZERO
        return (a + alpha) * v[0] + b * v[1], c * v[0] + (d + alpha) * v[1]


def strained_boundaries(
    f: ExactHarmonics,
    region: int,
    order: int,
    damping: Fraction | int | Iterable[Fraction | int] = 0,
) -> ExactSeries:
    """Return the boundaries of a region to any order, Smith (7.12)-(7.37), (7.41)-(7.49).

    ``damping`` is beta of ``K = beta mu``; several numbers mean ``K = beta_1 mu + beta_2 mu^2 +
    ...``.  ValueError where damping closes the region or is critical: there is no real series then.
    """
    rates = (damping,) if isinstance(damping, int | Fraction) else tuple(damping)
    # With mu over the common denominator the function has whole coefficients.
    unit = math.lcm(*(x.denominator for x in (f.mean, *f.cosine, *f.sine)))
    whole = combine([f], [unit])
    arguments = whole, region, tuple(Fraction(x) * unit**j for j, x in enumerate(rates, 1))
    expansion = _Expansion(*arguments)
    (a, b), (c, d) = expansion.conditions()
    while not (b or c or a != d) and len(expansion.secular) < order:
        expansion.advance(-a)
        (a, b), (c, d) = expansion.conditions()
    if not (b or c or a != d):
        expansion.advance(-a)
        both = tuple(x * Fraction(1, unit**k) for k, x in enumerate(expansion.alpha, 1))
        return ExactSeries(None, both, both)
    # The determinant of (7.22), (7.45) is a quadratic in alpha.
    square = ((a - d) * (a - d) + 4 * b * c).rational / 4
    if square <= 0:
        raise ValueError(
            f"damping: closes region {region}, or is critical: found a root of {square}"
        )
    split, middle, half = len(expansion.secular), -(a + d) / 2, Surd.root(square)
    branches = [_branch(arguments, split, alpha, order) for alpha in (middle + half, middle - half)]
    upper, lower = (
        tuple(x * Fraction(1, unit**k) for k, x in enumerate(alphas, 1)) for alphas in branches
    )
    return ExactSeries(split, upper, lower)


def _branch(arguments, split: int, alpha: Surd, order: int) -> list[Surd]:
    """Go on from the order where the boundaries part, with one of the two alphas."""
    own = _Expansion(*arguments)
    for _ in range(split):
        own.conditions()
        own.advance(-own.secular[-1][0][0] if len(own.secular) < split else alpha)
    columns = [own.applied(split, v) for v in ((_ONE, _ZERO), (_ZERO, _ONE))]
    # The null vector of a singular matrix, (1, B) or (0, 1), Smith (7.24), (7.47).
    row = next(row for row in zip(*columns, strict=True) if any(row))
    start = (_ONE, -row[0] / row[1]) if row[1] else (_ZERO, _ONE)
    free = 1 if start[0] else 0
    other, constants = columns[free], [start]
    for k in range(split + 1, order + 1):
        own.conditions()
        pairs = [own.applied(k - j, v) for j, v in enumerate(constants)]
        known = [sum(column, _ZERO) for column in zip(*pairs, strict=True)]
        # other * x + v_0 * alpha_k = -known, (7.34): Cramer's rule gives (7.35).
        determinant = other[0] * start[1] - other[1] * start[0]
        x = (known[1] * start[0] - known[0] * start[1]) / determinant
        own.advance((other[1] * known[0] - other[0] * known[1]) / determinant)
        constants.append((_ZERO, x) if free else (x, _ZERO))
    return own.alpha
