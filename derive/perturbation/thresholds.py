"""The tip of a tongue: critical damping as a series in mu, and the least mu as its inverse.

Smith (7.50)-(7.51) is the first order of ``K_crit = mu^s (kappa_0 + kappa_1 mu + ...)``, s = 1.  At
the tip the two boundaries meet, so that the damped equation has one periodic solution y where two
met, and the solution z of the adjoint equation (K reversed) has no part along it: mean(z y) = 0.
With this condition the method of strained parameters gives K and lam2 of the tip together, order
by order.  A second entry takes the effective operator, whose tip is |B|^2 = (Im A)^2.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from .exact import ExactOperator
from .strained import Expansion, Matrix2, Pair, apply, null_vector, plus
from .surd import ExactHarmonics, Surd
from .waves import overlap

_ZERO = Surd(Fraction(0))
_ONE = Surd(Fraction(1))
_Series = list[Surd]
ExactPolynomial = Mapping[tuple[int, int], tuple[Fraction, Fraction]]
"""Complex polynomial in (mu, K): powers to real and imaginary part of the coefficient."""


@dataclass(frozen=True)
class ThresholdSeries:
    """Where damping closes a tongue, for mu > 0 (for mu < 0 take -f).

    Attributes
    ----------
    region, order : int
        n, and the highest power of mu.
    split : int or None
        s, the power with which the width and K_crit begin; None where they vanish through the
        order, and ``critical`` is empty.
    critical : tuple of Surd
        kappa_0, kappa_1, ... of ``K_crit = mu^s (kappa_0 + kappa_1 mu + ...)``, through mu^order.
    tip : tuple of Surd
        alpha_1, alpha_2, ... of ``lam2 = n^2/4 + sum alpha_k mu^k`` at the tip.
    inverse : tuple of Surd
        m_1 = 1, m_2, ... of ``mu_min = sum m_j t^j``, ``t = (K/kappa_0)^(1/s)``.
    """

    region: int
    order: int
    split: int | None
    critical: tuple[Surd, ...]
    tip: tuple[Surd, ...]
    inverse: tuple[Surd, ...]

    def critical_damping(self, mu: float) -> float:
        """Return K_crit at mu > 0 from the truncated series."""
        start = self.split or 0
        return sum(float(c) * mu ** (start + r) for r, c in enumerate(self.critical))

    def least_parameter(self, damping: float) -> float:
        """Return mu_min at K > 0 from the truncated inverse series; inf where no tongue is seen."""
        if self.split is None:
            return float("inf")
        t = math.pow(damping / float(self.critical[0]), 1 / self.split)
        return sum(float(m) * t**j for j, m in enumerate(self.inverse, 1))


def strained_thresholds(f: ExactHarmonics, region: int, order: int) -> ThresholdSeries:
    """Return the tip of a tongue to any order by strained parameters, in exact algebra.

    Parameters
    ----------
    f : ExactHarmonics
        Periodic function.
    region : int
        n >= 1.
    order : int
        Highest power of mu, >= 1.

    Returns
    -------
    ThresholdSeries
        Coefficients in Q(sqrt(a_n^2 + b_n^2)) (for c_n = 0: of what takes its place at order s).

    Raises
    ------
    ValueError
        If region or order is not such a number.
    """
    for name, value in (("region", region), ("order", order)):
        if not isinstance(value, int) or value < 1:
            raise ValueError(f"{name}: found {value!r}; expected a whole number from 1 on")
    ahead = Expansion(f, region, ())
    for _ in range(order):
        (a, b), (c, d) = ahead.next_secular()
        if b or c or a != d:
            break
        ahead.damping = (*ahead.damping, _ZERO)
        ahead.advance(-a)
    else:
        return ThresholdSeries(region, order, None, (), tuple(ahead.alpha), ())
    s = len(ahead.secular)
    first = Surd.root((((a - d) * (a - d) + 4 * b * c) / (4 * region**2)).rational)
    pair = _Tip(ahead, first, -(a + d) / 2)
    for k in range(s + 1, order + 1):
        pair.step(k)
    critical = pair.ahead.damping[s - 1 :]
    return ThresholdSeries(
        region, order, s, critical, tuple(pair.ahead.alpha), _inverse(list(critical), s)
    )


class _Tip:
    """Solution and adjoint solution at the tip, in step."""

    def __init__(self, ahead: Expansion, beta: Surd, alpha: Surd) -> None:
        back = Expansion(ahead.f, ahead.n, ahead.damping)
        self.start = len(ahead.secular)
        for known in ahead.alpha:
            back.next_secular()
            back.advance(known)
        back.next_secular()
        self.ahead, self.back = ahead, back
        for expansion, sign in ((ahead, 1), (back, -1)):
            expansion.damp(sign * beta)
            expansion.advance(alpha)
        self.v = [null_vector(ahead.operator(self.start))]
        self.w = [null_vector(back.operator(self.start))]

    def step(self, k: int) -> None:
        """Find beta_k from solvability and alpha_k from mean(z y) = 0 at order k - s."""
        n, r = self.ahead.n, k - self.start
        sides = ((self.ahead, self.v), (self.back, self.w))
        known: list[Pair] = []
        for expansion, constants in sides:
            rest = apply(expansion.next_secular(), constants[0])
            for j in range(self.start + 1, k):
                rest = plus(rest, apply(expansion.operator(j), constants[k - j]))
            known.append(rest)
        v, w = self.v[0], self.w[0]
        turned = (v[1] * n, -v[0] * n)
        beta = -_dot(w, known[0]) / _dot(w, turned)
        # With beta_k the conditions can be solved; alpha_k moves their solution along ``along``.
        particular, along = [], []
        for (expansion, constants), rest, sign in zip(sides, known, (1, -1), strict=True):
            expansion.damp(sign * beta)
            start = constants[0]
            full = plus(rest, (start[1] * (beta * n * sign), -start[0] * (beta * n * sign)))
            matrix = expansion.operator(self.start)
            particular.append(_solve(matrix, start, (-full[0], -full[1])))
            along.append(_solve(matrix, start, (-start[0], -start[1])))
        mean = _dot(w, particular[0]) + _dot(particular[1], v) + self._overlap(r)
        alpha = -mean / (_dot(w, along[0]) + _dot(along[1], v))
        for (expansion, constants), one, other in zip(sides, particular, along, strict=True):
            constants.append((one[0] + alpha * other[0], one[1] + alpha * other[1]))
            expansion.advance(alpha)

    def _overlap(self, r: int) -> Surd:
        """Return the part of mean(z y) at order r that the earlier orders make."""
        result = _ZERO
        for i in range(1, r):
            y = self.ahead.solution(i, self.v)
            z = self.back.solution(r - i, self.w)
            result = result + overlap(z, y)
        return result


def _dot(one: Pair, other: Pair) -> Surd:
    return one[0] * other[0] + one[1] * other[1]


def _solve(matrix: Matrix2, start: Pair, right: Pair) -> Pair:
    """Solve a singular system with its right side in range, the pivot of ``start`` left out."""
    pivot = 0 if start[0] else 1
    row = 0 if matrix[0][1 - pivot] else 1
    value = right[row] / matrix[row][1 - pivot]
    return (_ZERO, value) if pivot == 0 else (value, _ZERO)


def operator_thresholds(
    diagonal: ExactPolynomial, coupling: ExactPolynomial, region: int, order: int
) -> ThresholdSeries:
    """Return the tip from an effective operator ``[[A, B], [conj B, conj A]]`` in (mu, K).

    :func:`polynomials` makes the arguments from an :class:`~.exact.ExactOperator`.

    Parameters
    ----------
    diagonal, coupling : mapping of (int, int) to (Fraction, Fraction)
        A and B as polynomials in (mu, K), complete through total degree ``order``.
    region : int
        n >= 1.
    order : int
        Highest power of mu wanted.

    Returns
    -------
    ThresholdSeries
        From ``|B|^2 = (Im A)^2``.

    Notes
    -----
    Bloch's operator is similar to a symmetric one, not symmetric itself: Im A has terms without K
    from mu^(s+2) on, which belong to the condition.
    """
    starts = [i for (i, j), value in coupling.items() if j == 0 and any(value) and i <= order]
    if not starts:
        free = [diagonal.get((k, 0), (Fraction(0),))[0] for k in range(1, order + 1)]
        return ThresholdSeries(region, order, None, (), tuple(map(Surd.of, free)), ())
    s, count = min(starts), order - min(starts) + 1
    leading = coupling[s, 0]
    kappa = [Surd.root((leading[0] ** 2 + leading[1] ** 2) / Fraction(region**2))]
    imaginary = {key: im for key, (_, im) in diagonal.items()}
    sides = [{key: value[part] for key, value in coupling.items()} for part in (0, 1)]
    while True:
        scaled = [_series(side, kappa, s, s, count) for side in (imaginary, *sides)]
        squares = [_times(x, x, count) for x in scaled]
        if len(kappa) == count:
            break
        r = len(kappa)
        residual = squares[0][r] - squares[1][r] - squares[2][r]
        kappa.append(-residual / (2 * region**2 * kappa[0]))
    real = {key: re for key, (re, _) in diagonal.items()}
    tip = _series(real, kappa, s, 0, order + 1)[1:]
    return ThresholdSeries(region, order, s, tuple(kappa), tuple(tip), _inverse(kappa, s))


def polynomials(operator: ExactOperator) -> tuple[ExactPolynomial, ExactPolynomial]:
    """Return A and B of a damped operator of one function as polynomials in (mu, K).

    Raises
    ------
    ValueError
        If the operator has no damping, or several functions: combine them along a ray first.
    """
    count = len(operator.exponents[0][0])
    if not operator.damped or count != 2:
        raise ValueError(
            f"operator: found {count} parameters, damped={operator.damped}; expected mu and K; "
            "combine several functions along a ray"
        )
    diagonal, coupling = (
        {
            (powers[0], powers[1]): value
            for row, values in zip(operator.exponents, rows, strict=True)
            for powers, value in zip(row, values, strict=True)
        }
        for rows in (operator.diagonal, operator.coupling)
    )
    return diagonal, coupling


def _times(one: _Series, other: _Series, count: int) -> _Series:
    out = [_ZERO] * count
    for i, x in enumerate(one[:count]):
        for j, y in enumerate(other[: count - i]):
            out[i + j] = out[i + j] + x * y
    return out


def _series(
    polynomial: Mapping[tuple[int, int], Fraction], kappa: _Series, s: int, shift: int, count: int
) -> _Series:
    """Return ``polynomial(mu, mu^s kappa(mu)) / mu^shift`` as a series in mu."""
    power, powers = [_ONE], []
    for _ in range(1 + max((j for _, j in polynomial), default=0)):
        powers.append(power)
        power = _times(power, kappa, count)
    out = [_ZERO] * count
    for (i, j), value in polynomial.items():
        first = i + s * j - shift
        if not value or first >= count:
            continue
        for r, x in enumerate(powers[j][: count - first]):
            out[first + r] = out[first + r] + x * value
    return out


def _power(series: _Series, exponent: Fraction) -> _Series:
    """Return a power of a series that begins with 1, by Miller's recurrence."""
    out = [_ONE]
    for k in range(1, len(series)):
        terms = ((exponent * j - (k - j)) * series[j] * out[k - j] for j in range(1, k + 1))
        out.append(sum(terms, _ZERO) / k)
    return out


def _inverse(critical: _Series, s: int) -> tuple[Surd, ...]:
    """Return mu as a series in ``t = (K/kappa_0)^(1/s)``, by Lagrange's inversion."""
    ratio = [c / critical[0] for c in critical]
    return tuple(_power(ratio, Fraction(-j, s))[j - 1] / j for j in range(1, len(ratio) + 1))
