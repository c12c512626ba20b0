"""Power series at zero: what takes over where a closed form loses its digits."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

import sympy as sp
from sympy.polys.constructor import construct_domain


class Polynomial(NamedTuple):
    """A Taylor polynomial at zero and the first term that it leaves out."""

    value: sp.Expr
    remainder: sp.Expr


def taylor(expression: sp.Expr, variable: sp.Symbol, terms: int) -> Polynomial:
    """Return the first non-zero terms of the Taylor series at zero.

    Parameters
    ----------
    expression : Expr
        Sum of products of polynomials, sin, cos, sinh, cosh and exp of multiples of the variable.
    variable : Symbol
        It.
    terms : int
        Number of non-zero terms.

    Raises
    ------
    ValueError
        If the expression is of another kind, or has fewer terms.
    """
    coefficients = series_terms(expression, variable)
    found = [value * variable**order for order, value in islice(coefficients, terms + 1)]
    if len(found) <= terms:
        raise ValueError(f"{expression} has no {terms + 1} non-zero terms in {variable}")
    return Polynomial(sp.Add(*found[:-1]), found[-1])


def series_terms(expression: sp.Expr, variable: sp.Symbol) -> Iterator[tuple[int, sp.Expr]]:
    """Yield order and coefficient of the non-zero terms of the Taylor series at zero.

    The parts ``c variable^n exp(a variable)`` of the expression go on by ``a / k`` from term to
    term, in the field of their coefficients.

    ``expression``, ``variable``: as for :func:`taylor`.
    """
    terms = sp.Add.make_args(sp.expand(sp.sympify(expression).rewrite(sp.exp)))
    parts = [_part(term, variable) for term in terms if term != 0]
    if not parts:
        return
    factors, powers, rates = zip(*parts, strict=True)
    field, numbers = construct_domain([*factors, *rates], field=True)
    values, rates = numbers[: len(parts)], numbers[len(parts) :]
    order, idle = 0, 0
    while idle < _IDLE:
        total = field.zero
        for i, power in enumerate(powers):
            if order > power:
                values[i] = values[i] * rates[i] * field.from_sympy(sp.Rational(1, order - power))
            if order >= power:
                total += values[i]
        coefficient = sp.expand(field.to_sympy(total))
        idle = 0 if coefficient != 0 else idle + 1
        if coefficient != 0:
            yield order, coefficient
        order += 1


_IDLE = 40  # orders without a term, after which there is none


def _part(term: sp.Expr, variable: sp.Symbol) -> tuple[sp.Expr, int, sp.Expr]:
    """Return c, n and a of ``c variable^n exp(a variable)``."""
    factor, rest = term.as_independent(variable, as_Add=False)
    power, rate = 0, sp.S.Zero
    for item in sp.Mul.make_args(sp.powsimp(rest, combine="exp")):
        base, exponent = item.as_base_exp()
        if item.func is sp.exp and not sp.expand(item.args[0] / variable).has(variable):
            rate += sp.expand(item.args[0] / variable)
        elif base == variable and exponent.is_Integer and exponent > 0:
            power += int(exponent)
        elif item != 1:
            raise ValueError(f"{item} is no power and no exponential of a multiple of {variable}")
    return factor, power, rate
