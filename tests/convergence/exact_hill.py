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
from itertools import combinations_with_replacement, zip_longest
from operator import add, mul
from typing import TypeAlias

import numpy as np
from elastolink.generated import hill_recursion

Exponents: TypeAlias = tuple[int, ...]
Gaussian: TypeAlias = tuple[Fraction, Fraction]


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
