"""Taylor polynomials: what takes over where a closed form loses its digits near zero."""

from __future__ import annotations

from typing import NamedTuple

import sympy as sp


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
        If the expression is of another kind.
    """
    parts = [
        _part(term, variable)
        for term in sp.Add.make_args(sp.expand(sp.sympify(expression).rewrite(sp.exp)))
    ]
    found: list[sp.Expr] = []
    order = 0
    while len(found) <= terms:
        coefficient = sp.Add(
            *(
                factor * rate ** (order - power) / sp.factorial(order - power)
                for factor, power, rate in parts
                if power == order or (power < order and rate != 0)
            )
        )
        coefficient = sp.expand(coefficient)
        if coefficient != 0:
            found.append(coefficient * variable**order)
        order += 1
        if order > 40 * (terms + 1) or not parts:
            raise ValueError(f"{expression} has no {terms + 1} non-zero terms in {variable}")
    return Polynomial(sp.Add(*found[:-1]), found[-1])


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
