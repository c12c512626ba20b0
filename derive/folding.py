"""Scalars folded together before they meet an array: one product per array instead of several."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import sympy as sp

from .staged import Step, Steps


def fold_scalars(
    steps: Steps, outputs: Sequence[sp.Expr], scalars: Iterable[str]
) -> tuple[Steps, list[sp.Expr]]:
    """Name every product and sum of single numbers that stands beside an array.

    Parameters
    ----------
    steps : Steps
        Intermediate quantities.
    outputs : sequence of Expr
        What is returned.
    scalars : iterable of str
        Names of the arguments that are single numbers.

    Returns
    -------
    steps, outputs
        With further steps, in numbers alone.
    """
    folding = _Folding(set(scalars))
    found: list[Step] = []
    for symbol, value in steps.steps:
        folded = folding.plain(value)
        if folding.is_scalar(value):
            folding.scalars.add(symbol.name)
        found += [*folding.take(), (symbol, folded)]
    finals = [folding.plain(sp.sympify(value)) for value in outputs]
    return Steps((*found, *folding.take())), finals


class _Folding:
    """The names given so far."""

    def __init__(self, scalars: set[str]) -> None:
        self.scalars = scalars
        self._names: dict[sp.Expr, sp.Symbol] = {}
        self._new: list[Step] = []

    def take(self) -> list[Step]:
        """Return the definitions made since the last call."""
        new, self._new = self._new, []
        return new

    def is_scalar(self, value: sp.Basic) -> bool:
        return all(symbol.name in self.scalars for symbol in value.free_symbols)

    def plain(self, value: sp.Basic) -> sp.Basic:
        """Return an expression with its scalar parts named."""
        if self.is_scalar(value) or not value.args:
            return value
        if not isinstance(value, sp.Mul | sp.Add):
            return value.func(*(self.plain(part) for part in value.args))
        numbers = [part for part in value.args if self.is_scalar(part)]
        arrays = [self.plain(part) for part in value.args if not self.is_scalar(part)]
        return value.func(self._named(value.func(*numbers)), *arrays)

    def _named(self, value: sp.Expr) -> sp.Expr:
        """Return a name for a product or sum of scalars, its sign apart."""
        if value.is_number or value.is_Symbol:
            return value
        if value.could_extract_minus_sign():
            return -self._named(-value)
        if value not in self._names:
            symbol = sp.Symbol(f"c{len(self._names)}", real=True)
            self._names[value] = symbol
            self.scalars.add(symbol.name)
            self._new.append((symbol, value))
        return self._names[value]
