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
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement
from operator import add, mul
from typing import TypeAlias

import numpy as np
from elastolink.generated import hill_recursion

from .surd import ExactHarmonics, Surd

Exponents: TypeAlias = tuple[int, ...]
Gaussian: TypeAlias = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class ExactOperator:
    """A and B of region n as polynomials in the parameters with coefficients in Q(i).

    Where damped, the last parameter is K.  ``exponents`` holds those of the monomials of the
    degrees 1 ... order, ``diagonal`` and ``coupling`` the real and imaginary parts of the
    coefficients of A and of B, likewise.
    """

    order: int
    exponents: tuple[tuple[Exponents, ...], ...]
    diagonal: tuple[tuple[Gaussian, ...], ...]
    coupling: tuple[tuple[Gaussian, ...], ...]

    def components(
        self, parameters: Sequence[Fraction | int]
    ) -> tuple[tuple[Gaussian, ...], tuple[Gaussian, ...]]:
        """Return the homogeneous components A_k, B_k, k = 1 ... order, at rational parameters."""
        values = [Fraction(value) for value in parameters]
        weights = [[math.prod(map(pow, values, e)) for e in row] for row in self.exponents]

        def weighted(coefficients: tuple[Gaussian, ...], row: list[Fraction]) -> Gaussian:
            real, imaginary = (sum(map(mul, part, row)) for part in zip(*coefficients, strict=True))
            return real, imaginary

        a, b = (tuple(map(weighted, rows, weights)) for rows in (self.diagonal, self.coupling))
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


def exact_operator(
    parts: Sequence[ExactHarmonics], n: int, order: int, damped: bool = False
) -> ExactOperator:
    """Return A and B of region n exactly, up to a total degree; where damped, K comes last."""
    algebra = _Algebra(parts, n, order // 2, damped)
    calls = (algebra.act, algebra.resolve, algebra.project, algebra.combine)
    operators, _ = getattr(hill_recursion, f"order_{order}")(algebra.start, *calls)
    exponents = tuple(_monomials(algebra.count, k) for k in range(1, order + 1))
    diagonal: list[list[Gaussian]] = []
    coupling: list[list[Gaussian]] = []
    for k, (row, h) in enumerate(zip(exponents, operators, strict=True), start=1):
        scale = algebra.denominator**k * algebra.multiple ** (k - 1)
        pairs = [h.get(e, np.zeros((2, 2), dtype=object)) for e in row]
        diagonal.append([(Fraction(x, scale), Fraction(y, scale)) for (x, _), (y, _) in pairs])
        coupling.append([(Fraction(x, scale), Fraction(-y, scale)) for (_, x), (_, y) in pairs])
    # The mean of f commutes with everything: it moves lam2 and nothing else.
    for place, part in enumerate(parts):
        real, imaginary = diagonal[0][place]
        diagonal[0][place] = (real - part.mean, imaginary)
    return ExactOperator(order, exponents, tuple(map(tuple, diagonal)), tuple(map(tuple, coupling)))


def _monomials(count: int, degree: int) -> tuple[Exponents, ...]:
    """Return the exponents of all monomials of a degree, the highest power of the first first."""
    chosen = combinations_with_replacement(range(count), degree)
    return tuple(tuple(map(factors.count, range(count))) for factors in chosen)


class _Polynomial(dict[Exponents, np.ndarray]):
    """Arrays of Gaussian integers by exponents; real and imaginary part along the first axis."""

    def accumulate(self, exponents: Exponents, value: np.ndarray) -> None:
        self[exponents] = self[exponents] + value if exponents in self else value

    def __add__(self, other: _Polynomial) -> _Polynomial:
        out = _Polynomial(self)
        for exponents, value in other.items():
            out.accumulate(exponents, value)
        return out

    def __sub__(self, other: _Polynomial) -> _Polynomial:
        return self + _Polynomial({exponents: -value for exponents, value in other.items()})


def _times(x: Sequence, y: np.ndarray) -> np.ndarray:
    """Return the product of a Gaussian integer, or an array of them, and an array of them."""
    return np.stack([x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0]])


class _Algebra:
    """V, R, P on one column, in whole numbers; see the module for what is divided out.

    The harmonics run from ``-reach * H`` to ``n + reach * H``: no path of ``2 reach + 1`` steps
    from a resonant harmonic to a resonant harmonic leaves them.
    """

    def __init__(self, parts: Sequence[ExactHarmonics], n: int, reach: int, damped: bool) -> None:
        self.n, self.count = n, len(parts) + damped
        self.width = max(len(part.cosine) for part in parts)
        radius = reach * self.width
        numbers = np.array(range(-radius, n + radius + 1), dtype=object)
        self.resonant = [radius + n, radius]
        halves = [x / 2 for part in parts for x in (*part.cosine, *part.sine)]
        self.denominator = math.lcm(*(x.denominator for x in halves))
        self.taps = [self._taps(part) for part in parts]
        self.drag = (0, (n - 2 * numbers) * self.denominator) if damped else None
        levels = numbers * (numbers - n)
        self.multiple = math.lcm(*(level for level in levels if level))
        self.inverses = np.array([-self.multiple // k if k else 0 for k in levels], dtype=object)
        first = np.zeros((2, len(levels)), dtype=object)
        first[0, radius + n] = 1
        self.start = _Polynomial({(0,) * self.count: first})

    def _taps(self, part: ExactHarmonics) -> dict[int, tuple[int, int]]:
        """Return ``-c_m d`` of the harmonics m that a function has."""
        taps = {}
        for m in range(1, len(part.cosine) + 1):
            a, b = (int(-x / 2 * self.denominator) for x in part.harmonic(m))
            if a or b:
                taps |= {m: (a, -b), -m: (a, b)}
        return taps

    def act(self, column: _Polynomial) -> _Polynomial:
        out, width = _Polynomial(), self.width
        edge = np.zeros((2, width), dtype=object)
        for exponents, row in column.items():
            apart = np.hstack([edge, row, edge])
            raised = [tuple(map(add, exponents, unit)) for unit in _monomials(self.count, 1)]
            for place, taps in zip(raised, self.taps, strict=False):
                for m, c in taps.items():
                    out.accumulate(place, _times(c, apart[:, width - m :][:, : row.shape[1]]))
            if self.drag:
                out.accumulate(raised[-1], _times(self.drag, row))
        return out

    def project(self, column: _Polynomial) -> _Polynomial:
        """Return the resonant entries; for n = 0 there is one."""
        kept = np.array([1, int(self.n > 0)], dtype=object)
        return _Polynomial({e: row[:, self.resonant] * kept for e, row in column.items()})

    def resolve(self, column: _Polynomial) -> _Polynomial:
        return _Polynomial({e: row * self.inverses for e, row in column.items()})

    def combine(self, column: _Polynomial, h: _Polynomial) -> _Polynomial:
        """Return ``Omega_j h_i``; the mirror of the column stands for the column of m = 0."""
        out = _Polynomial()
        for first, row in column.items():
            mirror = np.stack([row[0, ::-1], -row[1, ::-1]])
            for second, pair in h.items():
                product = _times(pair[:, 0], row) + _times(pair[:, 1], mirror)
                out.accumulate(tuple(map(add, first, second)), product)
        return out


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
