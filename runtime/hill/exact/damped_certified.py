"""Proofs for the damped Hill's equation: enclosed real eigenvalues, and regions without any.

The matrix is not symmetric, so each eigenvalue is proved by Newton's method in the space of its
eigenvector (Kantorovich), and where a region is closed the operator is proved to be invertible
for every lam2 in it.  Both rest on a bound of the norm of an inverse: an approximate one for the
low harmonics, checked by multiplication, and a Neumann series for the rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import inf, sqrt

import numpy as np
from numpy.typing import NDArray

from ...core.periodic_function import PeriodicFunction
from .damped import left_and_right
from .enclosure import Ball
from .integer_products import (
    FUNCTION_BITS,
    PRODUCT_UNIT,
    VECTOR_BITS,
    HillOperator,
    Wave,
    inner,
    root_above,
    wave,
)
from .isolation import Spectrum
from .layout import layout, stacked

Array = NDArray[np.float64]

_U = 0.5 * float(np.finfo(float).eps)
# How often an interval is halved before a region counts as undecided.
_PIECES = 400


@dataclass(frozen=True)
class DampedProblem:
    """The damped matrix in one of the two problems, without its mean, cut and uncut.

    Attributes
    ----------
    low : ndarray, shape (size, size)
        The matrix of the harmonics that are kept.
    across : ndarray, shape (size, more)
        What couples them to the harmonics beyond.
    first_beyond : float
        k^2 of the first of those.
    bound : float
        Bound of the norm of mu (f - mean).
    odd : int
        Which problem.
    right, left : HillOperator
        The operator and its transpose, exact.
    """

    low: Array
    across: Array
    first_beyond: float
    bound: float
    odd: int
    right: HillOperator
    left: HillOperator

    @classmethod
    def of(cls, f: PeriodicFunction, mu: float, k: float, found: Spectrum) -> DampedProblem:
        """Build it with the truncation of the undamped spectrum."""
        odd, harmonic = found.odd, found.harmonic
        size = len(layout(odd, harmonic).squares)
        wide = stacked(f, odd, harmonic + max(1, f.harmonics), np.array([mu]))[0]
        low = wide[:size, :size].copy()
        number = np.sqrt(layout(odd, harmonic).squares)
        cos = np.arange(1 - odd, size, 2)
        low[cos + 1, cos] += 2.0 * k * number[cos]
        low[cos, cos + 1] -= 2.0 * k * number[cos]
        return cls(
            low=low,
            across=wide[:size, size:],
            first_beyond=(harmonic + (0.5 if odd else 1.0)) ** 2,
            bound=abs(mu) * float(f.amplitudes[1:].sum()) * (1.0 + 1e-12),
            odd=odd,
            right=HillOperator(f, mu, k),
            left=HillOperator(f, mu, -k),
        )

    def inverse_norm(self, lam2: float, border: Array | None = None) -> float:
        """Bound the norm of the inverse of the whole operator less lam2, infinite if none is found.

        ``border`` joins one row and one column, ``(H - lam2) u - s border`` and ``border . u``.
        """
        size = len(self.low)
        matrix, across = self.low - lam2 * np.eye(size), self.across
        if border is not None:
            matrix = np.block([[matrix, -border[:, None]], [border[None], np.zeros((1, 1))]])
            across = np.vstack([across, np.zeros((1, across.shape[1]))])
        gap = self.first_beyond - lam2 - self.bound
        try:
            inverse = np.linalg.inv(matrix)
        except np.linalg.LinAlgError:
            return inf
        norm = float(np.linalg.norm(inverse))
        if not (gap > 0.0 and np.isfinite(norm)):
            return inf
        gamma = 1.01 * (size + 24) * _U
        weight = float(np.linalg.norm(matrix)) + sqrt(size) * self.bound + abs(lam2) * sqrt(size)
        defect = float(np.linalg.norm(inverse @ matrix - np.eye(len(matrix))))
        defect += 3.0 * gamma * norm * weight
        if not defect < 0.5:
            return inf
        leaving = float(np.linalg.norm(inverse @ across))
        leaving += 2.0 * gamma * norm * self.bound * sqrt(size)
        share = leaving / (1.0 - defect) * self.bound / gap
        if not share < 0.9:
            return inf
        schur = norm / (1.0 - defect) / (1.0 - share)
        # A hair for the rounding of these few operations.
        return 1.001 * (schur * (1.0 + self.bound / gap) ** 2 + 1.0 / gap)

    def eigenvalue(self, value: float, right: Array, left: Array) -> Ball | None:
        """Enclose a real eigenvalue from approximations of it and of its vectors, if that works."""
        norm = self.inverse_norm(value, right)
        if norm == inf:
            return None
        y, z = wave(self.odd, right), wave(self.odd, left)
        image = self.right(y)
        unit = 4 << FUNCTION_BITS
        guess = round(Fraction(inner(y, image), inner(y, y)))
        # Rounding in the coefficients acts like a residual.
        rounding = self.right.rounding + self.right.drag_rounding(len(image.alpha) + 1)
        size_y = root_above(Fraction(inner(y, y), 1 << (2 * VECTOR_BITS)))
        size_z = root_above(Fraction(inner(z, z), 1 << (2 * VECTOR_BITS)))
        residual = _size(image.plus(y, -guess)) + rounding * size_y
        kappa = Fraction(norm)
        # The matrix was bounded at the value in doubles, with the vector in doubles.
        moved = abs(Fraction(guess, unit) - Fraction(value)) + Fraction(1, 1 << 50)
        if kappa * moved >= Fraction(1, 2):
            return None
        kappa = kappa / (1 - kappa * moved)
        if 2 * kappa * kappa * residual >= 1:
            return None
        reach = 2 * kappa * residual
        other = _size(self.left(z).plus(z, -guess)) + rounding * size_z
        product = inner(z, y)
        scale = Fraction(abs(product), 1 << (2 * VECTOR_BITS))
        if not scale:
            return None
        middle = Fraction(inner(z, image), product) / unit
        radius = ((other + reach * size_z) * reach + rounding * size_y * size_z) / scale
        return Ball(middle, radius)

    def has_none(self, low: float, high: float) -> bool:
        """Prove that no eigenvalue lies between two numbers; False where that does not succeed."""
        pending = [(low, high)]
        for _ in range(_PIECES):
            if not pending:
                return True
            start, end = pending.pop()
            middle = 0.5 * (start + end)
            half = 1.01 * max(end - middle, middle - start)
            norm = self.inverse_norm(middle)
            if norm == inf or (norm * half >= 1.0 and end - start < 1e-13 * (1.0 + abs(middle))):
                return False
            if norm * half >= 1.0:
                pending += [(start, middle), (middle, end)]
        return False


def _size(x: Wave) -> Fraction:
    """Return the norm of a product of the operator with a trial function, from above."""
    return root_above(Fraction(inner(x, x), PRODUCT_UNIT * PRODUCT_UNIT))


@dataclass(frozen=True)
class RealPairs:
    """Real eigenvalues of the cut matrix, with right and left vectors of norm 1 as columns."""

    values: Array
    rights: Array
    lefts: Array

    @classmethod
    def of(cls, problem: DampedProblem) -> RealPairs:
        """Compute them in doubles."""
        values, lefts, rights = left_and_right(problem.low)
        real = values.imag == 0.0
        right, left = rights[:, real].real, lefts[:, real].real
        return cls(
            values[real].real,
            right / np.linalg.norm(right, axis=0),
            left / np.linalg.norm(left, axis=0),
        )


def damped_ends(
    problem: DampedProblem, pairs: RealPairs, k: float, n: int, found: Spectrum
) -> tuple[Ball | None, Ball] | bool | None:
    """Return the enclosed ends of region n; True where it is proved closed, None if undecided.

    Region n without damping stands at numbers n - 1 and n of the spectrum; with damping its ends
    are the real eigenvalues there, moved up by K^2: two of them, or none (one in region 0).
    """
    shift = Fraction(k) * Fraction(k)
    low = found.values[n - 1] if n else -inf
    high = found.values[n]
    slack = found.reach + 1e-9 * (1.0 + abs(high))
    # Only the neighbours of the same problem matter: ends lie in regions of this problem alone.
    below = found.values[n - 2] + found.reach if n >= 2 else -inf
    above = found.values[n + 1] - found.reach
    balls = []
    near = (pairs.values - k * k >= low - slack) & (pairs.values - k * k <= high + slack)
    for i in np.flatnonzero(near):
        value, right, left = float(pairs.values[i]), pairs.rights[:, i], pairs.lefts[:, i]
        ball = problem.eigenvalue(value, right, left)
        if ball is None:
            continue
        place = ball.middle - shift
        inside = n < 2 or place - ball.radius > Fraction(below)
        if inside and place + ball.radius < Fraction(above):
            balls.append(ball)
    balls.sort(key=lambda ball: ball.middle)
    if n == 0:
        return (None, balls[0]) if len(balls) == 1 else None
    if len(balls) == 2 and balls[0].middle + balls[0].radius < balls[1].middle - balls[1].radius:
        return balls[0], balls[1]
    closed = not balls and problem.has_none(
        low - found.reach + k * k * (1.0 - 1e-14), high + found.reach + k * k * (1.0 + 1e-14)
    )
    return True if closed else None
