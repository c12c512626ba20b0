"""Boundaries of Hill's equation by strained parameters in exact algebra, as Smith chapter 7 does.

    y'' + 2 K y' + (lam2 + mu f(theta)) y = 0,  K = mu beta_1 + mu^2 beta_2 + ...
    lam2 = n^2/4 + sum alpha_k mu^k,            y = y_0 + mu y_1 + ...

Each order is one equation y_k'' + (n/2)^2 y_k = right side (7.16)-(7.18), (7.42).  That y_k must be
periodic gives two conditions on the resonant harmonic (7.22), (7.31)-(7.32), (7.44).  Everything
is real and trigonometric, in the numbers p + q sqrt(d), d = a_n^2 + b_n^2 - 4 beta^2 n^2.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from .surd import ExactHarmonics, Surd
from .waves import Wave, derivative, product, resolved, single, total

_ZERO = Surd(Fraction(0))
_ONE = Surd(Fraction(1))
Matrix2 = tuple[tuple[Surd, Surd], tuple[Surd, Surd]]
Pair = tuple[Surd, Surd]


class DampedAway(ValueError):  # noqa: N818 - reads as what it is
    """The boundaries are not real, or are no power series in mu: damping has closed the tongue."""


@dataclass(frozen=True)
class StrainedBranch:
    """One of the two boundaries of a region.

    Attributes
    ----------
    alpha : tuple of Surd
        alpha_1 ... alpha_N of (7.12).
    amplitudes : tuple of pairs of Surd
        (A_k, B_k) of the resonant harmonic of y_k.
    solutions : tuple of Wave
        y_0, y_1, ...: the periodic solution on the boundary.
    """

    alpha: tuple[Surd, ...]
    amplitudes: tuple[Pair, ...]
    solutions: tuple[Wave, ...]


@dataclass(frozen=True)
class StrainedBoundaries:
    """Both boundaries of one region, exactly, up to an order.

    Attributes
    ----------
    region, order : int
        n and N.
    split : int or None
        The order s at which the two boundaries part: 1 unless c_n = 0.  None where they agree
        through order N (coexistence, or a tongue narrower than mu^N); for region 0 as well, which
        has one boundary.
    radicand : Fraction or None
        The square under the root of alpha_s, times four: ``a_n^2 + b_n^2 - 4 beta_1^2 n^2`` for
        s = 1.
    branches : tuple of two StrainedBranch
        With the positive and the negative root, (7.37).  Equal where ``split`` is None; then
        ``solutions`` holds the cosine-like solution in the first and the sine-like in the second,
        both of which are boundary solutions (for region 0 twice the same).

    Notes
    -----
    Normalisation: A_0 = 1 and A_k = 0 afterwards; where a boundary has A_0 = 0, for which (7.24)
    fails, B_0 = 1 and B_k = 0.  alpha_k needs the solutions up to y_{k-s} only: those are given.
    """

    region: int
    order: int
    split: int | None
    radicand: Fraction | None
    branches: tuple[StrainedBranch, StrainedBranch]

    def evaluate(self, mu: float) -> tuple[float, float]:
        """Return lam2 on both branches from the truncated series, in double precision."""
        one, other = (
            sum(float(a) * mu**k for k, a in enumerate(branch.alpha, 1)) + self.region**2 / 4
            for branch in self.branches
        )
        return one, other


class Expansion:
    """The solutions that belong to a fixed resonant harmonic, order by order.

    ``columns[i][k]`` is the part of order k of the solution whose resonant harmonic is
    ``cos(n theta/2)`` (i = 0) or ``sin(n theta/2)`` (i = 1) at order 0 and nothing afterwards.  As
    the equations are linear in y, any solution is ``y_k = sum_j columns[k-j] v_j`` with the free
    constants v_j = (A_j, B_j): that is how these stay undetermined as long as they are.
    ``secular[k-1]`` holds what f and damping return to the resonant harmonic at order k.
    """

    def __init__(self, f: ExactHarmonics, n: int, damping: tuple[Surd, ...]) -> None:
        self.f = f
        self.n = n
        self.damping = damping
        self.alpha: list[Surd] = []
        self.secular: list[Matrix2] = []
        kinds = ((1, 0), (0, 1)) if n else ((1, 0),)
        self.columns: list[list[Wave]] = [[single(n, *kind)] for kind in kinds]
        self._returned: list[Wave] = []

    def copy(self) -> Expansion:
        """Return an independent copy, to go on with another alpha."""
        twin = Expansion(self.f, self.n, self.damping)
        twin.alpha, twin.secular = list(self.alpha), list(self.secular)
        twin.columns = [list(column) for column in self.columns]
        return twin

    def next_secular(self) -> Matrix2:
        """Return the matrix of the next order; its rows are the cosine and the sine condition."""
        k = len(self.secular) + 1
        self._returned = [
            total(
                self.n % 2,
                [
                    (_ONE, product(column[k - 1], self.f)),
                    *(
                        (2 * self.damping[j - 1], derivative(column[k - j]))
                        for j in range(1, min(k, len(self.damping)) + 1)
                    ),
                ],
            )
            for column in self.columns
        ]
        pairs = [wave.coefficient(self.n) for wave in self._returned]
        if len(pairs) == 1:
            pairs.append((_ZERO, pairs[0][0]))
        matrix = ((pairs[0][0], pairs[1][0]), (pairs[0][1], pairs[1][1]))
        self.secular.append(matrix)
        return matrix

    def damp(self, beta: Surd) -> None:
        """Set the damping of the present order, whose matrix was made without it.

        Its other effect at this order, ``2 beta y_0'``, is resonant and leaves the columns alone.
        """
        self.damping = (*self.damping, beta)
        (a, b), (c, d) = self.secular[-1]
        turn = beta * self.n
        self.secular[-1] = ((a, b + turn), (c - turn, d))

    def advance(self, alpha: Surd) -> None:
        """Take alpha of the present order and solve its equation for the columns."""
        k = len(self.secular)
        self.alpha.append(alpha)
        for column, returned in zip(self.columns, self._returned, strict=True):
            terms = [(_ONE, returned)]
            terms += [(self.alpha[j - 1], column[k - j]) for j in range(1, k)]
            minus = [(-factor, wave) for factor, wave in terms]
            column.append(resolved(total(self.n % 2, minus), self.n))

    def operator(self, k: int) -> Matrix2:
        """Return alpha_k + secular_k: what multiplies v_{j} in the condition of order j + k."""
        (a, b), (c, d) = self.secular[k - 1]
        return (a + self.alpha[k - 1], b), (c, d + self.alpha[k - 1])

    def solution(self, k: int, amplitudes: list[Pair]) -> Wave:
        """Return y_k for known constants v_0 ... v_k."""
        return total(
            self.n % 2,
            [
                (amplitudes[j][i], column[k - j])
                for j in range(k + 1)
                for i, column in enumerate(self.columns)
            ],
        )


def apply(matrix: Matrix2, vector: Pair) -> Pair:
    """Return the product of a 2 x 2 matrix and a vector."""
    (a, b), (c, d) = matrix
    return a * vector[0] + b * vector[1], c * vector[0] + d * vector[1]


def plus(one: Pair, other: Pair) -> Pair:
    """Return the sum of two vectors."""
    return one[0] + other[0], one[1] + other[1]


def null_vector(matrix: Matrix2) -> Pair:
    """Return the null vector of a singular matrix, (1, B) or (0, 1), Smith (7.24), (7.47)."""
    a, b = matrix[0] if any(matrix[0]) else matrix[1]
    return (_ONE, -a / b) if b else (_ZERO, _ONE)


def strained_boundaries(
    f: ExactHarmonics,
    region: int,
    order: int,
    damping: Fraction | int | Iterable[Fraction | int] = 0,
) -> StrainedBoundaries:
    """Return the boundaries of a region to any order by Smith's method, in exact algebra.

    Parameters
    ----------
    f : ExactHarmonics
        Periodic function; for several parameters their combination along a ray
        (:func:`~.surd.combine`).
    region : int
        n >= 0.
    order : int
        N >= 1, the highest power of mu.
    damping : Fraction, int or iterable of them
        beta of ``K = beta mu``; several numbers mean ``K = beta_1 mu + beta_2 mu^2 + ...``, as the
        degenerate case c_n = 0 needs it.

    Raises
    ------
    ValueError
        If region or order is not such a number.
    DampedAway
        If the root in the order where the boundaries part is imaginary (no real boundary for
        small mu), or zero by damping (at the critical K the boundary is a series in sqrt(mu), not
        in mu).

    Notes
    -----
    Smith (7.12)-(7.37), (7.41)-(7.49).  Where c_n = 0 the constants of y_0 stay undetermined until
    the order s at which the secular matrix is no multiple of the unit matrix; alpha_{s+k} comes
    with B_k then.
    """
    _check(region, order)
    rates = (damping,) if isinstance(damping, int | Fraction) else tuple(damping)
    expansion = Expansion(f, region, tuple(Surd.of(Fraction(b)) for b in rates))
    for k in range(1, order + 1):
        (a, b), (c, d) = expansion.next_secular()
        if b or c or a != d:
            roots = _roots(expansion.secular[-1], k, region)
            break
        expansion.advance(-a)
    else:
        return _unsplit(expansion, order)
    radicand, half = roots
    centre = -(a + d) / 2
    branches = [_branch(expansion.copy(), expansion, centre + half, k, order)]
    if half.radicand:
        branches.append(_conjugated(branches[0]))
    else:
        branches.append(_branch(expansion.copy(), expansion, centre - half, k, order))
    return StrainedBoundaries(region, order, k, radicand, (branches[0], branches[1]))


def _check(region: int, order: int) -> None:
    for name, value, least in (("region", region, 0), ("order", order, 1)):
        if not isinstance(value, int) or value < least:
            raise ValueError(f"{name}: found {value!r}; expected a whole number from {least} on")


def _roots(matrix: Matrix2, k: int, n: int) -> tuple[Fraction, Surd]:
    """Return d and half its root: the determinant of (7.22), (7.45) as a quadratic in alpha."""
    (a, b), (c, d) = matrix
    square = ((a - d) * (a - d) + 4 * b * c).rational
    if square < 0:
        raise DampedAway(
            f"damping: closes region {n} at order {k} (4 times the square under the root is "
            f"{square}); expected a weaker one; see the thresholds for the least mu"
        )
    if square == 0:
        raise DampedAway(
            f"damping: is critical for region {n} at order {k}; expected a weaker one; at the tip "
            "of the tongue the boundary is a series in the root of mu"
        )
    return square, Surd.root(square / 4)


def _branch(
    own: Expansion, before: Expansion, alpha: Surd, split: int, order: int
) -> StrainedBranch:
    """Go on from the order where the boundaries part, with one of the two alphas."""
    own._returned = before._returned
    own.advance(alpha)
    pencil = own.operator(split)
    amplitudes = [null_vector(pencil)]
    pivot = 0 if amplitudes[0][0] else 1
    other = (pencil[0][1 - pivot], pencil[1][1 - pivot])
    for k in range(split + 1, order + 1):
        matrix = own.next_secular()
        known = apply(matrix, amplitudes[0])
        for j in range(split + 1, k):
            known = plus(known, apply(own.operator(j), amplitudes[k - j]))
        # other * x + v_0 * alpha_k = -known, (7.34): Cramer's rule gives (7.35).
        start = amplitudes[0]
        determinant = other[0] * start[1] - other[1] * start[0]
        free = (known[1] * start[0] - known[0] * start[1]) / determinant
        own.advance((other[1] * known[0] - other[0] * known[1]) / determinant)
        amplitudes.append((_ZERO, free) if pivot == 0 else (free, _ZERO))
    solutions = tuple(own.solution(k, amplitudes) for k in range(len(amplitudes)))
    return StrainedBranch(tuple(own.alpha), tuple(amplitudes), solutions)


def _conjugated(branch: StrainedBranch) -> StrainedBranch:
    """Return the branch with the other sign of an irrational root."""
    return StrainedBranch(
        tuple(a.conjugate() for a in branch.alpha),
        tuple((a.conjugate(), b.conjugate()) for a, b in branch.amplitudes),
        tuple(
            Wave(
                w.parity,
                w.radicand,
                w.denominator,
                (w.rows[0], _negative(w.rows[1]), w.rows[2], _negative(w.rows[3])),
            )
            for w in branch.solutions
        ),
    )


def _negative(row: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(-x for x in row)


def _unsplit(expansion: Expansion, order: int) -> StrainedBoundaries:
    """Return the record of two boundaries that agree through the order asked for."""
    branches = [
        StrainedBranch(
            tuple(expansion.alpha),
            tuple([((_ONE, _ZERO), (_ZERO, _ONE))[i], *[(_ZERO, _ZERO)] * (order - 1)]),
            tuple(column[:order]),
        )
        for i, column in enumerate(expansion.columns)
    ]
    return StrainedBoundaries(expansion.n, order, None, None, (branches[0], branches[-1]))
