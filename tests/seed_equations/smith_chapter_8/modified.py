"""Several parameters, Smith chapter 8: the standard, the modified and the alternative method.

    y'' + {lam2 + eps_1 f_1 + ... + eps_p f_p} y = 0

The standard method wants one double series and fails; the modified method collects the n-th
harmonics in ``delta cos(n theta - psi)`` and counts delta as a further parameter; the alternative
method goes along a ray.  All by exact algebra, with the angle psi as a symbol.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from types import MappingProxyType

import sympy as sp
from sympy.simplify.fu import TR8

from .second_order import a as _a
from .second_order import b as _b
from .second_order import centre_and_coupling, second_order_matrix, second_order_sums
from .second_order import m as _m
from .second_order import n as _n
from .strained import Matrix2, strained_boundaries
from .surd import ExactHarmonics, combine

psi = sp.Symbol("psi", real=True)
_Powers = tuple[int, ...]
_HALF = sp.Rational(1, 2)


@dataclass(frozen=True)
class StandardMethod:
    """What the standard method asks of the zero-order solution, Smith (8.7)-(8.17).

    Attributes
    ----------
    region : int
        n.
    ratios : tuple of tuple of (Expr, Expr)
        For each function the two vectors (A_00, B_00) that its own condition leaves, with the
        positive and the negative root; any vector does where its n-th harmonic vanishes, and the
        row is empty then.
    determinants : tuple of Fraction
        ``a_n d_n - b_n c_n`` of each pair of functions.
    consistent : bool
        Whether one zero-order solution satisfies all conditions: all determinants vanish.
    """

    region: int
    ratios: tuple[tuple[tuple[sp.Expr, sp.Expr], ...], ...]
    determinants: tuple[Fraction, ...]
    consistent: bool


def standard_method(functions: Sequence[ExactHarmonics], region: int) -> StandardMethod:
    """Apply the standard method to first order and see whether its conditions agree.

    Parameters
    ----------
    functions : sequence of ExactHarmonics
        f_1 ... f_p.
    region : int
        n >= 1.

    Returns
    -------
    StandardMethod

    Notes
    -----
    Smith (8.12)-(8.17).  The condition is (8.17) in the form that needs no division.
    """
    ratios: list[tuple[tuple[sp.Expr, sp.Expr], ...]] = []
    for f in functions:
        if not any(f.harmonic(region)):
            ratios.append(())
            continue
        branches = strained_boundaries(f, region, 1).branches
        ratios.append(
            tuple((v[0].sympy(), v[1].sympy()) for v in (x.amplitudes[0] for x in branches))
        )
    pairs = [f.harmonic(region) for f in functions]
    determinants = tuple(
        x[0] * y[1] - x[1] * y[0] for i, x in enumerate(pairs) for y in pairs[i + 1 :]
    )
    return StandardMethod(region, tuple(ratios), determinants, not any(determinants))


@cache
def common_solution_condition() -> sp.Expr:
    """Return what vanishes where (8.7) and (8.8) admit one zero-order solution.

    Each pair of conditions, its alpha eliminated, is a quadratic in ``t = B_00/A_00``; the
    resultant of two quadratics vanishes where they share a root, infinite roots included.
    """
    t = sp.Symbol("t")
    an, bn, cn, dn = sp.symbols("a_n b_n c_n d_n", real=True)

    def quadratic(x: sp.Expr, y: sp.Expr) -> sp.Expr:
        secular = sp.Matrix([[x, y], [y, -x]]) / 2 * sp.Matrix([1, t])
        return sp.expand(2 * (secular[0] * t - secular[1]))

    return sp.factor(sp.resultant(quadratic(an, bn), quadratic(cn, dn), t))


@dataclass(frozen=True)
class ModifiedBranch:
    """One boundary by the modified method, Smith (8.20), (8.28)-(8.35).

    Attributes
    ----------
    alpha : mapping of powers to Expr
        alpha_ijk... by the powers of (eps_1 ... eps_p, delta), orders 1 and 2, as functions of psi.
    excess : mapping of powers to Expr
        What is left of the second secular condition of a second-order equation without delta.  No
        constant of the method enters it: unless it vanishes that equation has no periodic solution.
    constants : mapping of powers to Expr
        The constant of each first-order solution that the second condition of the equation with
        delta fixes, beside the resonant harmonic of y_000 (which is normalised away).
    """

    alpha: Mapping[_Powers, sp.Expr]
    excess: Mapping[_Powers, sp.Expr]
    constants: Mapping[_Powers, sp.Expr]


@dataclass(frozen=True)
class ModifiedMethod:
    """The modified method to second order for given functions.

    Attributes
    ----------
    region : int
        n.
    functions : tuple of ExactHarmonics
        f_1 ... f_p.
    lower, upper : ModifiedBranch
        The branch A' = 1 (alpha_001 = -1/2) and the branch B' = 1 (alpha_001 = +1/2).
    """

    region: int
    functions: tuple[ExactHarmonics, ...]
    lower: ModifiedBranch
    upper: ModifiedBranch

    @property
    def solvable(self) -> bool:
        """Whether every second-order equation has a periodic solution for every psi."""
        branches = (self.lower, self.upper)
        return not any(x != 0 for branch in branches for x in branch.excess.values())

    def polar(self, parameters: Sequence[float]) -> tuple[float, float]:
        """Return delta_n and psi_n, Smith (8.19), with the quadrant its tangent leaves open."""
        cosine, sine = (
            sum(
                e * float(f.harmonic(self.region)[kind])
                for e, f in zip(parameters, self.functions, strict=True)
            )
            for kind in (0, 1)
        )
        return math.hypot(cosine, sine), math.atan2(sine, cosine)

    def boundaries(self, parameters: Sequence[float]) -> tuple[float, float]:
        """Return (lower, upper) in lam2 to second order, in double precision.

        Raises
        ------
        ValueError
            If delta_n vanishes: psi_n has no value there, and the method no answer.
        """
        delta, angle = self.polar(parameters)
        if delta == 0.0:
            raise ValueError(
                f"parameters: delta_{self.region} vanishes at {tuple(parameters)}; expected a "
                "point where psi has a value; use the uniform form"
            )
        point = (*parameters, delta)
        lower, upper = (
            sum(
                float(value.subs(psi, angle))
                * math.prod(x**k for x, k in zip(point, powers, strict=True))
                for powers, value in branch.alpha.items()
            )
            + self.region**2 / 4
            for branch in (self.lower, self.upper)
        )
        return lower, upper

    def unsolved(self, parameters: Sequence[float]) -> float:
        """Return the second-order part of the secular conditions that the method cannot meet.

        Its square over delta_n is the third-order term that no power series in delta_n has.
        """
        _, angle = self.polar(parameters)
        return sum(
            float(value.subs(psi, angle))
            * math.prod(x**k for x, k in zip(parameters, powers[:-1], strict=True))
            for powers, value in self.upper.excess.items()
        )


def modified_method(functions: Sequence[ExactHarmonics], region: int) -> ModifiedMethod:
    """Carry the modified method to second order: all second-order coefficients, by machine.

    Parameters
    ----------
    functions : sequence of ExactHarmonics
        f_1 ... f_p, any number.
    region : int
        n >= 1.

    Returns
    -------
    ModifiedMethod
        For p = 2 alpha_200, alpha_020, alpha_002, alpha_110, alpha_101, alpha_011 of (8.30)-(8.35)
        and what remains unsolved.

    Raises
    ------
    ValueError
        If there is no function, or the region is no whole number from 1 on.

    Notes
    -----
    Smith (8.18)-(8.37).  In the frame of ``cos, sin((n theta - psi)/2)`` the secular matrix of
    order one in delta is diag(1/2, -1/2), and those of the eps multiples of the unit matrix.
    """
    if not functions or not isinstance(region, int) or region < 1:
        raise ValueError(
            f"modified method: found {len(functions)} functions, region {region!r}; expected at "
            "least one function and a whole number from 1 on"
        )
    bare = [f.without(region) for f in functions]
    zeros = [0] * (region - 1)
    waves = [
        ExactHarmonics.of(0, [*zeros, 1]),
        ExactHarmonics.of(0, [*zeros, 0], [*zeros, 1]),
    ]
    count = len(bare)
    matrices: dict[_Powers, sp.Matrix] = {}
    for i, f in enumerate(bare):
        matrices[_powers(count, i, i)] = _matrix(second_order_matrix(f, region))
        for j in range(i + 1, count):
            matrices[_powers(count, i, j)] = _mixed(f, bare[j], region)
        matrices[_powers(count, i, count)] = sp.cos(psi) * _mixed(f, waves[0], region) + sp.sin(
            psi
        ) * _mixed(f, waves[1], region)
    squares = [_matrix(second_order_matrix(wave, region)) for wave in waves]
    matrices[_powers(count, count, count)] = (
        sp.cos(psi) ** 2 * squares[0]
        + sp.sin(psi) ** 2 * squares[1]
        + sp.cos(psi) * sp.sin(psi) * _mixed(waves[0], waves[1], region)
    )
    turned = {powers: _turned(matrix) for powers, matrix in matrices.items()}
    means = [sp.Rational(f.mean) for f in functions]
    lower, upper = (_branch(turned, means, row) for row in (0, 1))
    return ModifiedMethod(region, tuple(functions), lower, upper)


def _powers(count: int, i: int, j: int) -> _Powers:
    return tuple((k == i) + (k == j) for k in range(count + 1))


def _matrix(matrix: Matrix2) -> sp.Matrix:
    return sp.Matrix([[x.sympy() for x in row] for row in matrix])


def _mixed(one: ExactHarmonics, other: ExactHarmonics, region: int) -> sp.Matrix:
    """Return the secular matrix of the product of two parameters, by polarisation."""
    both = combine((one, other), (1, 1))
    return (
        _matrix(second_order_matrix(both, region))
        - _matrix(second_order_matrix(one, region))
        - _matrix(second_order_matrix(other, region))
    )


def _turned(matrix: sp.Matrix) -> sp.Matrix:
    """Return a matrix in the frame of cos, sin((n theta - psi)/2), in multiples of psi."""
    turn = sp.Matrix([[sp.cos(psi / 2), -sp.sin(psi / 2)], [sp.sin(psi / 2), sp.cos(psi / 2)]])
    return (turn.T * matrix * turn).applyfunc(lambda x: sp.expand(TR8(sp.expand(x))))


def _branch(
    matrices: Mapping[_Powers, sp.Matrix], means: Sequence[sp.Expr], row: int
) -> ModifiedBranch:
    """Solve the secular conditions with y_000 the cosine (row 0) or the sine (row 1)."""
    other, count = 1 - row, len(means)
    sign = 1 if row else -1
    alpha: dict[_Powers, sp.Expr] = {
        tuple(int(k == i) for k in range(count + 1)): -mean for i, mean in enumerate(means)
    }
    alpha[(*[0] * count, 1)] = sign * _HALF
    excess: dict[_Powers, sp.Expr] = {}
    constants: dict[_Powers, sp.Expr] = {}
    for powers, matrix in matrices.items():
        alpha[powers] = -matrix[row, row]
        if powers[-1]:
            # The first-order constant meets alpha_001 -+ 1/2 in its own row, which is not zero.
            first = (*powers[:-1], powers[-1] - 1)
            constants[first] = -sign * matrix[other, row]
        else:
            excess[powers] = matrix[other, row]
    return ModifiedBranch(*(MappingProxyType(x) for x in (alpha, excess, constants)))


def modified_formulas() -> Mapping[str, sp.Expr]:
    """Return the second-order coefficients for general functions as sums over harmonics.

    Returns
    -------
    mapping of str to Expr
        ``alpha_200``, ``alpha_110``, ``alpha_101`` and ``alpha_002`` of the upper branch in terms
        of ``a, b`` (f_1), ``c, d`` (f_2), n and psi; the lower branch has -1 in place of the symbol
        ``sigma``, and alpha_020, alpha_011 have c, d in place of a, b.  In the sums the harmonics
        with index n are those of the bar functions: zero.
    """
    sigma = sp.Symbol("sigma", real=True)
    c, d = sp.IndexedBase("c", real=True), sp.IndexedBase("d", real=True)
    ranges = [(_m, 1, sp.oo), (_m, 1, sp.floor((_n - 1) / 2))]
    square, cross = [], []
    for w0, real, imaginary in second_order_sums().summands():
        term = w0 - sigma * (real * sp.cos(psi) - imaginary * sp.sin(psi))
        square.append(term)
        cross.append(_polarised(term, c, d))
    above = second_order_sums().summands()[0]
    meeting = above[0] - sigma * (above[1] * sp.cos(psi) - above[2] * sp.sin(psi))
    wave = {_a[_m]: sp.cos(psi), _b[_m]: sp.sin(psi)}
    twice = {_a[_m + _n]: _a[2 * _n], _b[_m + _n]: _b[2 * _n]}
    with_delta = sp.expand(meeting.xreplace({**wave, **twice}).xreplace({_m: _n}))
    alone = {_a[2 * _n]: 0, _b[2 * _n]: 0}
    linear = sum(sp.diff(with_delta, x).xreplace(alone) * x for x in (_a[2 * _n], _b[2 * _n]))
    return MappingProxyType(
        {
            "alpha_200": _summed(square, ranges),
            "alpha_110": _summed(cross, ranges),
            "alpha_101": sp.factor(TR8(sp.expand(linear))),
            "alpha_002": sp.simplify(with_delta.xreplace(alone)),
        }
    )


def _polarised(term: sp.Expr, c: sp.IndexedBase, d: sp.IndexedBase) -> sp.Expr:
    """Return the coefficient of eps_1 eps_2 of a quadratic term for the sum of two functions."""
    one, two = sp.symbols("eps_1 eps_2")
    table = {
        x: one * x + two * (c if x.base == _a else d)[x.indices[0]] for x in term.atoms(sp.Indexed)
    }
    return sp.factor(sp.expand(term.xreplace(table)).coeff(one, 1).coeff(two, 1))


def _summed(terms: Sequence[sp.Expr], ranges: Sequence[tuple[sp.Expr, ...]]) -> sp.Expr:
    even = sp.Piecewise((terms[2], sp.Eq(sp.Mod(_n, 2), 0)), (0, True))
    return sp.Sum(terms[0], ranges[0]) + sp.Sum(terms[1], ranges[1]) + even


def alternative_method(
    functions: Sequence[ExactHarmonics],
    region: int,
    parameters: Sequence[Fraction | int],
    order: int = 2,
) -> tuple[float, float]:
    """Return (lower, upper) in lam2 by the alternative method, Smith (8.38)-(8.44).

    Parameters
    ----------
    functions : sequence of ExactHarmonics
        f_1 ... f_p.
    region : int
        n >= 1.
    parameters : sequence of rational numbers
        eps_1 ... eps_p, not all zero.  The largest in size takes the part of eps_1 in (8.39), so
        that no quotient grows.
    order : int
        Order of the series along the ray.

    Raises
    ------
    ValueError
        If all parameters are zero, where no ray is given.
    """
    point = [Fraction(x) for x in parameters]
    scale = max(point, key=abs, default=Fraction(0))
    if not scale:
        raise ValueError("parameters: found all zero; expected a ray; lam2 = n^2/4 there")
    h = combine(functions, [x / scale for x in point])
    one, other = strained_boundaries(h, region, order).evaluate(float(scale))
    return min(one, other), max(one, other)


def uniform_second_order(
    functions: Sequence[ExactHarmonics], region: int, parameters: Sequence[Fraction | int]
) -> tuple[float, float]:
    """Return (lower, upper) in lam2 by the uniform form, right to O(eps^3) in every direction.

    ``n^2/4 - sum a_0 eps + w0 +- |c_n - W|`` with the harmonics of the combined function.
    """
    whole = combine(functions, parameters)
    w0, (real, imaginary) = centre_and_coupling(whole, region)
    cosine, sine = whole.harmonic(region)
    width = math.hypot(float(cosine / 2 - real), float(-sine / 2 - imaginary))
    centre = float(Fraction(region**2, 4) - whole.mean + w0)
    return centre - width, centre + width
