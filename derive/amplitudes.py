"""Expansions in small amplitudes, order by order; tangents of a bent link as such expansions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

import sympy as sp

ORDER = 4  # of energies; their equations of motion are of one order less


@dataclass(frozen=True)
class Expansion:
    """A sum of parts of order 0, 1, ... ``ORDER`` in the amplitudes; products drop what is higher.

    Attributes
    ----------
    parts : tuple of Expr
        By order; what is left out behind them is zero.
    """

    parts: tuple[sp.Expr, ...] = ()

    def __post_init__(self) -> None:
        """Bring all expansions to one length."""
        missing = ORDER + 1 - len(self.parts)
        object.__setattr__(self, "parts", (*self.parts, *[sp.S.Zero] * missing))

    @classmethod
    def sum(cls, expansions: Iterable[Expansion]) -> Expansion:
        """Return the sum of any number of expansions."""
        return cls(tuple(map(sp.Add, *((e.parts) for e in (cls(), *expansions)))))

    def __add__(self, other: Expansion) -> Expansion:
        """Return the sum."""
        return Expansion.sum((self, other))

    def __mul__(self, other: Expansion | sp.Expr) -> Expansion:
        """Return the product with an expansion, or with what has no order."""
        if not isinstance(other, Expansion):
            return self.each(lambda part: part * other)
        return Expansion(
            tuple(
                sp.Add(*(self.parts[i] * other.parts[order - i] for i in range(order + 1)))
                for order in range(ORDER + 1)
            )
        )

    def __neg__(self) -> Expansion:
        """Return the expansion with the other sign."""
        return self * sp.S.NegativeOne

    def each(self, change: Callable[[sp.Expr], sp.Expr]) -> Expansion:
        """Return the expansion with every part changed."""
        return Expansion(tuple(map(change, self.parts)))

    def whole(self) -> sp.Expr:
        """Return the sum of the parts."""
        return sp.Add(*self.parts)


def composed(expression: sp.Expr, changes: Mapping[sp.Expr, Expansion]) -> Expansion:
    """Return a function of quantities that change by expansions without a part of order 0 or 1.

    ``changes``: what is added to each quantity; two of them are of order ``ORDER``, so that three
    drop out.
    """
    found = [Expansion((expression,))]
    for one, change in changes.items():
        found.append(change * expression.diff(one))
        found += [
            change * also * (expression.diff(one, other) / 2) for other, also in changes.items()
        ]
    return Expansion.sum(found)


# Number n of cos(n pi s), possibly in symbols, to what multiplies it.
Harmonics: TypeAlias = "dict[sp.Expr, Expansion]"


def each(harmonics: Harmonics, change: Callable[[sp.Expr], sp.Expr]) -> Harmonics:
    """Return harmonics with every part of their expansions changed."""
    return {n: value.each(change) for n, value in harmonics.items()}


def scaled(harmonics: Harmonics, factor: Expansion | sp.Expr) -> Harmonics:
    """Return harmonics times what is the same along the link."""
    return {n: value * factor for n, value in harmonics.items()}


def added(one: Harmonics, other: Harmonics) -> Harmonics:
    """Return the sum of harmonics."""
    none = Expansion()
    return {n: one.get(n, none) + other.get(n, none) for n in {**one, **other}}


def _product(one: Harmonics, other: Harmonics) -> Harmonics:
    found: Harmonics = {}
    for m, a in one.items():
        for n, b in other.items():
            for number in (m + n, m - n):
                at = -number if number.could_extract_minus_sign() else number
                found = added(found, {at: a * b * sp.Rational(1, 2)})
    return each(found, sp.expand)


def tangent(angle: Harmonics) -> tuple[Harmonics, Harmonics]:
    """Return cosine and sine of a small angle, which has no part of order 0."""
    power: Harmonics = {sp.S.Zero: Expansion((sp.S.One,))}
    cosine, sine = power, dict[sp.Expr, Expansion]()
    for n in range(1, ORDER + 1):
        power = scaled(_product(power, angle), sp.Rational(1, n))
        term = scaled(power, sp.S.NegativeOne ** (n // 2))
        cosine, sine = (cosine, added(sine, term)) if n % 2 else (added(cosine, term), sine)
    return cosine, sine
