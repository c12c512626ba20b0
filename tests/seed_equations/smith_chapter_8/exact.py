"""Bloch's recursion in exact arithmetic: the effective operator of a region of Hill's equation.

    y'' + 2 K y' + (lam2 + sum_l eps_l f_l(theta)) y = 0,   lam2 v_m = (k^2 - 2 i K k) v_m - F * v

with wave numbers ``k = m - n/2`` and rational Fourier coefficients.  The harmonics m = n and m = 0
are resonant; the others lie ``m (m - n)`` away.  In the basis (n, 0) the effective operator is
``[[A, B], [conj B, conj A]]``, because the equation is real: the column of m = 0 is the mirrored
conjugate of that of m = n, and one of them is enough.

All is done in whole numbers.  With d the common denominator of the coefficients and L the least
common multiple of the level distances, ``Omega_k = W_k / (d L)^k`` and
``h_k = G_k / (d^k L^(k-1))`` for Gaussian integers W_k, G_k: no fraction is reduced on the way.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import combinations_with_replacement
from operator import add, mul, sub
from typing import TypeAlias

from elastolink.generated import hill_recursion

from .surd import ExactHarmonics, Surd

Exponents: TypeAlias = tuple[int, ...]
Gaussian: TypeAlias = tuple[Fraction, Fraction]
# Real and imaginary part of a row of Gaussian integers; None stands for zeros.
_Part: TypeAlias = list[int] | None
_Row: TypeAlias = tuple[_Part, _Part]
_Pair: TypeAlias = tuple[int, int]
_Couple: TypeAlias = dict[Exponents, tuple[_Pair, _Pair]]


@dataclass(frozen=True)
class ExactOperator:
    """A and B of region n as polynomials in the parameters with coefficients in Q(i).

    Where damped, the last parameter is K.  ``exponents`` holds those of the monomials of the
    degrees 1 ... order, ``diagonal`` and ``coupling`` the real and imaginary parts of the
    coefficients of A and of B, likewise.
    """

    n: int
    order: int
    damped: bool
    exponents: tuple[tuple[Exponents, ...], ...]
    diagonal: tuple[tuple[Gaussian, ...], ...]
    coupling: tuple[tuple[Gaussian, ...], ...]

    def components(
        self, parameters: Sequence[Fraction | int]
    ) -> tuple[tuple[Gaussian, ...], tuple[Gaussian, ...]]:
        """Return the homogeneous components A_k, B_k, k = 1 ... order, at rational parameters."""
        values = [Fraction(value) for value in parameters]
        a, b = (
            tuple(
                _weighted(row, [_monomial(values, e) for e in exponents])
                for row, exponents in zip(rows, self.exponents, strict=True)
            )
            for rows in (self.diagonal, self.coupling)
        )
        return a, b


@dataclass(frozen=True)
class ExactSeries:
    """Boundaries ``lam2 = n^2/4 + sum_k alpha_k t^k`` on a ray through the origin.

    ``split`` is the order at which they part, None where they agree to the last order; ``upper``
    and ``lower`` hold alpha_1 ... alpha_N with the positive and the negative root.
    """

    split: int | None
    upper: tuple[Surd, ...]
    lower: tuple[Surd, ...]


def _monomial(values: Sequence[Fraction], exponents: Exponents) -> Fraction:
    return math.prod((v**e for v, e in zip(values, exponents, strict=True)), start=Fraction(1))


def run(algebra, order):
    """Return the values of the emitted recursion by name (``h1``, ``omega1``, ...)."""
    calls = (algebra.act, algebra.resolve, algebra.project, algebra.combine)
    found = getattr(hill_recursion, f"order_{order}")(algebra.start, *calls)
    pairs = zip(("h", "omega"), found, strict=True)
    return {f"{name}{k}": value for name, values in pairs for k, value in enumerate(values, 1)}


def _weighted(row: Iterable[Gaussian], weights: Sequence[Fraction]) -> Gaussian:
    pairs = list(zip(row, weights, strict=True))
    zero = Fraction(0)
    return sum((c[0] * w for c, w in pairs), zero), sum((c[1] * w for c, w in pairs), zero)


def exact_operator(
    parts: Sequence[ExactHarmonics], n: int, order: int, damped: bool = False
) -> ExactOperator:
    """Return A and B of region n exactly, up to a total degree; where damped, K comes last."""
    algebra = _Algebra(parts, n, order // 2, damped)
    values = run(algebra, order)
    exponents = tuple(tuple(monomials(algebra.count, k)) for k in range(1, order + 1))
    diagonal: list[list[Gaussian]] = []
    coupling: list[list[Gaussian]] = []
    for k, row in enumerate(exponents, start=1):
        h: _Couple = values[f"h{k}"]
        scale = algebra.denominator**k * algebra.multiple ** (k - 1)
        for which, into in ((0, diagonal), (1, coupling)):
            pairs = [h.get(e, ((0, 0), (0, 0)))[which] for e in row]
            into.append([(Fraction(x, scale), Fraction(y, scale)) for x, y in pairs])
    # The mean of f commutes with everything: it moves lam2 and nothing else.
    for place, part in enumerate(parts):
        real, imaginary = diagonal[0][place]
        diagonal[0][place] = (real - part.mean, imaginary)
    return ExactOperator(
        n, order, damped, exponents, tuple(map(tuple, diagonal)), tuple(map(tuple, coupling))
    )


def monomials(count: int, degree: int) -> list[Exponents]:
    """Return the exponents of all monomials of a degree, the highest power of the first first."""
    chosen = combinations_with_replacement(range(count), degree)
    return [tuple(map(factors.count, range(count))) for factors in chosen]


class _Column:
    """A homogeneous component of a column of Omega: rows of Gaussian integers by monomial."""

    def __init__(self, rows: dict[Exponents, _Row]) -> None:
        self.rows = rows

    def _with(self, other: _Column, sign: int) -> _Column:
        rows = dict(self.rows)
        for exponents, row in other.rows.items():
            rows[exponents] = _sum(rows.get(exponents, (None, None)), row, sign)
        return _Column(rows)

    def __add__(self, other: _Column) -> _Column:
        return self._with(other, 1)

    def __sub__(self, other: _Column) -> _Column:
        return self._with(other, -1)


class _Algebra:
    """V, R, P on one column, in whole numbers; see the module for what is divided out.

    The harmonics run from ``-reach * H`` to ``n + reach * H``: no path of ``2 reach + 1`` steps
    from a resonant harmonic to a resonant harmonic leaves them.
    """

    def __init__(self, parts: Sequence[ExactHarmonics], n: int, reach: int, damped: bool) -> None:
        width = max(len(part.cosine) for part in parts)
        self.n, self.damped, self.count = n, damped, len(parts) + damped
        radius = reach * width
        self.numbers = range(-radius, n + radius + 1)
        self.own, self.other = radius + n, radius
        halves = [x / 2 for part in parts for x in (*part.cosine, *part.sine)]
        self.denominator = math.lcm(*(x.denominator for x in halves))
        self.taps = [self._taps(part, width) for part in parts]
        levels = [m * (m - n) for m in self.numbers]
        self.multiple = math.lcm(*(level for level in levels if level))
        self.inverses = [-self.multiple // level if level else 0 for level in levels]
        first = [0] * len(levels)
        first[self.own] = 1
        self.start = _Column({(0,) * self.count: (first, None)})

    def _taps(self, part: ExactHarmonics, width: int) -> _Row:
        """Return ``-c_m d`` for m = width ... -width, the order in which a window meets them."""
        pairs = [part.harmonic(m) for m in range(width, 0, -1)]
        real = [int(-a / 2 * self.denominator) for a, _ in pairs]
        imaginary = [int(b / 2 * self.denominator) for _, b in pairs]
        full = [*real, 0, *real[::-1]]
        turned = [*imaginary, 0, *(-x for x in imaginary[::-1])]
        return (full if any(full) else None), (turned if any(turned) else None)

    @cached_property
    def drag(self) -> list[int]:
        """Imaginary part of ``-2 i k d``."""
        return [-(2 * m - self.n) * self.denominator for m in self.numbers]

    def act(self, column: _Column) -> _Column:
        rows: dict[Exponents, _Row] = {}
        for exponents, row in column.rows.items():
            for place in range(self.count):
                if place < len(self.taps):
                    moved = _convolved(self.taps[place], row)
                else:
                    moved = _scaled(row[1], self.drag, -1), _scaled(row[0], self.drag)
                raised = (*exponents[:place], exponents[place] + 1, *exponents[place + 1 :])
                rows[raised] = _sum(rows.get(raised, (None, None)), moved)
        return _Column(rows)

    def project(self, column: _Column) -> _Couple:
        if self.n == 0:
            return {e: ((_at(x, self.own), 0), (0, 0)) for e, (x, _) in column.rows.items()}
        return {
            e: (
                (_at(x, self.own), _at(y, self.own)),
                (_at(x, self.other), -_at(y, self.other)),
            )
            for e, (x, y) in column.rows.items()
        }

    def resolve(self, column: _Column) -> _Column:
        return _Column(
            {
                e: (_scaled(x, self.inverses), _scaled(y, self.inverses))
                for e, (x, y) in column.rows.items()
            }
        )

    def combine(self, column: _Column, couple: _Couple) -> _Column:
        """Return ``Omega_j h_i``; the mirror of the column stands for the column of m = 0."""
        rows: dict[Exponents, _Row] = {}
        for first, (x, y) in column.rows.items():
            mirror = (x and x[::-1], y and [-value for value in reversed(y)])
            for second, (a, b) in couple.items():
                product = _sum(_times((x, y), a), _times(mirror, (b[0], -b[1])))
                place = tuple(map(add, first, second))
                rows[place] = _sum(rows.get(place, (None, None)), product)
        return _Column(rows)


def _at(part: _Part, place: int) -> int:
    return part[place] if part else 0


def _plus(x: _Part, y: _Part, sign: int = 1) -> _Part:
    if y is None:
        return x
    if x is None:
        return y if sign > 0 else [-value for value in y]
    return list(map(add if sign > 0 else sub, x, y))


def _sum(x: _Row, y: _Row, sign: int = 1) -> _Row:
    return _plus(x[0], y[0], sign), _plus(x[1], y[1], sign)


def _scaled(part: _Part, factors: Iterable[int], sign: int = 1) -> _Part:
    if part is None:
        return None
    return [sign * value for value in map(mul, part, factors)]


def _times(row: _Row, factor: _Pair) -> _Row:
    """Return a row times a Gaussian integer."""
    (x, y), (a, b) = row, factor

    def times(part: _Part, number: int) -> _Part:
        return [value * number for value in part] if part and number else None

    return _plus(times(x, a), times(y, b), -1), _plus(times(y, a), times(x, b))


def _convolved(taps: _Row, row: _Row) -> _Row:
    (a, b), (x, y) = taps, row
    return _plus(_folded(a, x), _folded(b, y), -1), _plus(_folded(a, y), _folded(b, x))


def _folded(taps: _Part, part: _Part) -> _Part:
    if taps is None or part is None:
        return None
    width = len(taps) // 2
    apart = [0] * width + part + [0] * width
    return [sum(map(mul, taps, apart[i : i + len(taps)])) for i in range(len(part))]


def exact_series(operator: ExactOperator, direction: Sequence[Fraction | int]) -> ExactSeries:
    """Expand both boundaries in powers of t with the parameters ``t * direction``.

    ``lam2 = n^2/4 + Re A +- sqrt(S)``, ``S = |B|^2 - (Im A)^2``.  ValueError where damping closes
    the region at first, or the ray goes through the tip of the tongue so that S begins with an odd
    power: there is no real power series then.
    """
    order = operator.order
    a, b = operator.components(direction)
    centre = [Surd(real) for real, _ in a]
    square = [Fraction(0)] * (2 * order + 1)
    for i in range(order):
        for j in range(order):
            square[i + j + 2] += b[i][0] * b[j][0] + b[i][1] * b[j][1] - a[i][1] * a[j][1]
    first = next((k for k in range(2, 2 * order + 1) if square[k]), None)
    # Where B or the drag begins; the square is complete up to this degree more than the order.
    starts = [k for k, (x, y) in enumerate(zip(a, b, strict=True), 1) if x[1] or any(y)]
    if first is None and not starts:
        return ExactSeries(None, tuple(centre), tuple(centre))
    if first != 2 * starts[0] or square[first] < 0:
        raise ValueError(
            f"found S = {square[first] if first else 0} t^{first} + ...; expected a positive "
            "even leading term; damping closes the region, or the ray meets its tip"
        )
    root = Surd.root(square[first])
    ratios = [value / square[first] for value in square[first:]]
    roots = [Fraction(1)]
    for k in range(1, order - starts[0] + 1):
        roots.append((ratios[k] - sum(roots[i] * roots[k - i] for i in range(1, k))) / 2)
    parted = [Surd(Fraction(0))] * (starts[0] - 1) + [root * value for value in roots]
    upper = tuple(c + p for c, p in zip(centre, parted, strict=True))
    lower = tuple(c - p for c, p in zip(centre, parted, strict=True))
    return ExactSeries(starts[0], upper, lower)
