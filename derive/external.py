"""Functions that a derivation leaves open: their values and derivatives as plain symbols."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TypeVar

import sympy as sp
from sympy.core.function import AppliedUndef

_Form = TypeVar("_Form", sp.Expr, sp.ImmutableDenseMatrix)


@dataclass(frozen=True)
class ExternalValues:
    """What has to be passed in to evaluate expressions with open functions.

    Attributes
    ----------
    table : mapping
        Applied function or derivative to its symbol: ``phi`` for ``phi(s)``, ``phi_d2`` for its
        second derivative with respect to its argument.
    """

    table: Mapping[sp.Expr, sp.Symbol]

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """The symbols, by name."""
        return tuple(sorted(set(self.table.values()), key=lambda s: s.name))

    def plain(self, form: _Form) -> _Form:
        """Return an expression or matrix with the open functions replaced by their symbols."""
        replaced: _Form = form.xreplace(dict(self.table))
        return replaced


def external_values(forms: Iterable[sp.Basic]) -> ExternalValues:
    """Name the values and derivatives of all open functions in expressions or matrices.

    ``forms``: with applied undefined functions of one argument each, as differentiation leaves
    them. Raises ``ValueError`` if a function has several arguments, or is applied to different
    ones.
    """
    table: dict[sp.Expr, sp.Symbol] = {}
    arguments: dict[str, sp.Expr] = {}
    known = tuple(forms)
    for form in known:
        found = list(sp.ordered(form.atoms(AppliedUndef, sp.Derivative, sp.Subs)))
        bound = {v for item in found if isinstance(item, sp.Subs) for v in item.bound_symbols}
        for item in found:
            if item.free_symbols & bound:
                continue  # the inside of a derivative at a composite argument
            name, argument, order = _parts(item)
            if arguments.setdefault(name, argument) != argument:
                raise ValueError(
                    f"{name} is applied to {arguments[name]} and to {argument}; "
                    "give the two applications different names"
                )
            table[item] = sp.Symbol(f"{name}_d{order}" if order else name)
    # A function that occurs only inside its derivatives need not be passed in itself.
    used = set().union(*(form.xreplace(table).free_symbols for form in known))
    return ExternalValues(
        MappingProxyType({item: symbol for item, symbol in table.items() if symbol in used})
    )


def _parts(item: sp.Expr) -> tuple[str, sp.Expr, int]:
    """Return the name of the function, its argument, and the order of the derivative."""
    at = None
    if isinstance(item, sp.Subs):
        (at,) = item.point
        item = item.expr
    order = 0
    if isinstance(item, sp.Derivative):
        order = item.derivative_count
        item = item.expr
    if not isinstance(item, AppliedUndef) or len(item.args) != 1:
        raise ValueError(f"{item} is not a function of one argument")
    return item.func.__name__, item.args[0] if at is None else at, order
