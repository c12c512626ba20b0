"""Expansions in a small amplitude, and the tangent of a bent link as such an expansion."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from functools import cache
from typing import TypeAlias

import sympy as sp

SMALL = sp.Symbol("small", positive=True)  # its power is the order of a term
ORDER = 4  # of energies; their equations of motion are of one order less
# Number n of cos(n pi s), possibly in symbols, to what multiplies it.
Harmonics: TypeAlias = Mapping[sp.Expr, sp.Expr]


@cache
def _by_order(expression: sp.Expr) -> list[sp.Expr]:
    terms: dict[sp.Expr, list[sp.Expr]] = defaultdict(list)
    for term in sp.Add.make_args(sp.expand(expression)):
        value, power = term.as_independent(SMALL, as_Add=False)
        terms[power].append(value)
    return [sp.Add(*terms[SMALL**n]) for n in range(ORDER + 1)]


def kept(expression: sp.Expr) -> sp.Expr:
    """Return the terms of a polynomial in ``SMALL`` up to ``ORDER``."""
    return sp.Add(*(part * SMALL**n for n, part in enumerate(_by_order(expression))))


def product(one: sp.Expr, other: sp.Expr) -> sp.Expr:
    """Return the terms of a product up to ``ORDER``, without making those beyond."""
    left, right = _by_order(one), _by_order(other)
    return sp.Add(
        *(
            sp.expand(left[m] * right[n] * SMALL ** (m + n))
            for m in range(ORDER + 1)
            for n in range(ORDER + 1 - m)
        )
    )


def composed(expression: sp.Expr, changes: Mapping[sp.Expr, sp.Expr]) -> sp.Expr:
    """Return a function of quantities to which changes of second order are added."""
    once = (expression.diff(one) * by for one, by in changes.items())
    twice = (
        expression.diff(one, other) / 2 * product(by, also)
        for one, by in changes.items()
        for other, also in changes.items()
    )
    return sp.Add(expression, *once, *twice)


def tangent(angle: Harmonics) -> tuple[Harmonics, Harmonics]:
    """Return cosine and sine of an angle of first and higher order."""
    parts: list[dict[sp.Expr, sp.Expr]] = [defaultdict(lambda: sp.S.Zero) for _ in range(2)]
    power: Harmonics = {sp.S.Zero: sp.S.One}
    for n in range(ORDER + 1):
        for number, value in power.items():
            parts[n % 2][number] += (-1) ** (n // 2) * value / sp.factorial(n)
        power = _multiplied(power, angle)
    return parts[0], parts[1]


def _multiplied(one: Harmonics, other: Harmonics) -> Harmonics:
    found: dict[sp.Expr, sp.Expr] = defaultdict(lambda: sp.S.Zero)
    for m, a in one.items():
        for n, b in other.items():
            for number in (m + n, m - n):
                found[-number if number.could_extract_minus_sign() else number] += product(a, b) / 2
    return dict(found)
