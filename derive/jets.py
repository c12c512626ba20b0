"""Fields and their derivatives as plain jet symbols: total derivatives, integration by parts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeAlias

import sympy as sp
from sympy.core.function import AppliedUndef

Order: TypeAlias = tuple[int, int]
Flux: TypeAlias = "dict[Order, sp.Expr]"


@dataclass(frozen=True)
class Jet:
    """The derivative ``d^(k+j) field / dx^k dt^j`` as a plain symbol."""

    field: sp.Expr
    k: int
    j: int

    @property
    def symbol(self) -> sp.Symbol:
        """Its name; a leading underscore keeps it apart from the user's symbols."""
        return sp.Symbol(f"_{self.field.func.__name__}_x{self.k}_t{self.j}")

    def raised(self, k: int, j: int) -> Jet:
        """Return its derivative, k more times in x and j more times in t."""
        return Jet(self.field, self.k + k, self.j + j)


class JetSpace:
    """Translation between derivatives of the fields and jet symbols, and total derivatives."""

    def __init__(self, fields: Iterable[sp.Expr]) -> None:
        self._fields = tuple(fields)
        self._x, self._t = self._fields[0].args
        self._jets: dict[sp.Symbol, Jet] = {}

    def _register(self, jet: Jet) -> sp.Symbol:
        symbol = jet.symbol
        self._jets[symbol] = jet
        return symbol

    def enter(self, expression: sp.Expr) -> sp.Expr:
        """Replace the fields and their derivatives by jet symbols."""
        expression = sp.sympify(expression).doit(integrals=False)
        table = {f: self._register(Jet(f, 0, 0)) for f in self._fields}
        for derivative in expression.atoms(sp.Derivative):
            if derivative.expr in self._fields:
                counts = dict(derivative.variable_count)
                jet = Jet(derivative.expr, int(counts.pop(self._x, 0)), int(counts.pop(self._t, 0)))
                if counts:
                    raise ValueError(f"{derivative} is not a derivative in {self._x}, {self._t}")
                table[derivative] = self._register(jet)
        entered = expression.xreplace(table)
        kinds = {f.func for f in self._fields}
        stray = [f for f in entered.atoms(AppliedUndef) if f.func in kinds]
        if stray:
            raise ValueError(
                f"{stray[0]}: write fields at the running point {self._fields[0].args}"
            )
        return entered

    def leave(self, expression: sp.Expr) -> sp.Expr:
        """Replace jet symbols by the fields and their derivatives."""
        table = {}
        for symbol, jet in self._jets.items():
            counts = [(v, n) for v, n in ((self._x, jet.k), (self._t, jet.j)) if n]
            table[symbol] = sp.Derivative(jet.field, *counts) if counts else jet.field
        return expression.xreplace(table)

    def present(self, expression: sp.Expr) -> Iterator[tuple[sp.Symbol, Jet]]:
        """Yield the jets in an expression, in a fixed order."""
        for symbol in sorted(expression.free_symbols & set(self._jets), key=lambda s: s.name):
            yield symbol, self._jets[symbol]

    def total(self, expression: sp.Expr, variable: sp.Symbol) -> sp.Expr:
        """Return the total derivative in x or t."""
        k, j = (1, 0) if variable == self._x else (0, 1)
        result = sp.diff(expression, variable)
        for symbol, jet in self.present(expression):
            result += sp.diff(expression, symbol) * self._register(jet.raised(k, j))
        return result

    def vary(self, expression: sp.Expr) -> dict[sp.Expr, Flux]:
        """Return the coefficient of every varied jet, by field and order (k, j)."""
        table: dict[sp.Expr, Flux] = {f: {} for f in self._fields}
        for symbol, jet in self.present(expression):
            table[jet.field][jet.k, jet.j] = sp.diff(expression, symbol)
        return table

    def on_trace(self, flux: Flux, speed: sp.Expr) -> dict[int, sp.Expr]:
        """Shift time derivatives off the varied jets at a point that moves with ``speed``."""
        work, done = dict(flux), dict[int, sp.Expr]()
        while work:
            k, j = max(work, key=lambda order: (order[1], order[0]))
            coefficient = work.pop((k, j))
            if j == 0:
                done[k] = done.get(k, sp.S.Zero) + coefficient
                continue
            along = self.total(coefficient, self._t) + speed * self.total(coefficient, self._x)
            work[k, j - 1] = work.get((k, j - 1), sp.S.Zero) - along
            if speed != 0:
                work[k + 1, j - 1] = work.get((k + 1, j - 1), sp.S.Zero) - speed * coefficient
        return done

    def parts(self, variation: Flux) -> tuple[sp.Expr, Flux, Flux]:
        """Integrate by parts: Euler expression, flux in x and flux in t."""
        euler, in_x, in_t = sp.S.Zero, dict[Order, sp.Expr](), dict[Order, sp.Expr]()
        for (k, j), given in sorted(variation.items()):
            coefficient = given
            for step in reversed(range(j)):
                in_t[k, step] = in_t.get((k, step), sp.S.Zero) + coefficient
                coefficient = -self.total(coefficient, self._t)
            for step in reversed(range(k)):
                in_x[step, 0] = in_x.get((step, 0), sp.S.Zero) + coefficient
                coefficient = -self.total(coefficient, self._x)
            euler += coefficient
        return euler, in_x, in_t


def order_part(expression: sp.Expr, orders: Mapping[sp.Expr, int], power: int) -> sp.Expr:
    """Return the part of an expression that is of one power of the small parameter.

    ``expression``: in fields, their derivatives and anything else; ``orders``: field to its power
    of the small parameter (0 for a field that is not small); ``power``: which power is wanted.
    """
    expression = sp.sympify(expression)
    if not orders:
        return expression if power == 0 else sp.S.Zero
    space = JetSpace(orders)
    small = sp.Dummy("eps", positive=True)
    scaled = space.enter(expression)
    table = {
        symbol: symbol * small ** orders[jet.field]
        for symbol, jet in space.present(scaled)
        if orders[jet.field]
    }
    scaled = scaled.xreplace(table)
    for count in range(1, power + 1):
        scaled = sp.diff(scaled, small) / count
    return space.leave(sp.sympify(scaled).xreplace({small: sp.S.Zero}))


def linearise(expression: sp.Expr, orders: Mapping[sp.Expr, int], upto: int = 1) -> sp.Expr:
    """Scale each field by ``eps**order`` and keep the powers 0 to ``upto`` of eps, at ``eps = 1``.

    Parameters
    ----------
    expression : Expr
        In fields, their derivatives and anything else.
    orders : mapping
        Field to its power of the small parameter.
    upto : int
        Highest power that is kept.
    """
    return sum((order_part(expression, orders, power) for power in range(upto + 1)), sp.S.Zero)


def _entered(expression: sp.Expr, field: sp.Expr) -> tuple[sp.Expr, dict[sp.Symbol, Jet]]:
    """Return an expression in the jets of one field, and those that occur in it."""
    space = JetSpace([field])
    entered = space.enter(expression)
    return entered, dict(space.present(entered))


def linear_jets(expression: sp.Expr, field: sp.Expr) -> tuple[Flux, sp.Expr]:
    """Split an expression that is linear in one field.

    Returns ``coefficients``: coefficient of ``d^(k+j) field / dx^k dt^j`` by ``(k, j)``; ``rest``:
    what is free of the field. Raises ``ValueError`` if the expression is not linear in the field.
    """
    entered, present = _entered(expression, field)
    rest = entered.xreplace(dict.fromkeys(present, sp.S.Zero))
    coefficients = {
        (jet.k, jet.j): sp.expand(sp.diff(entered, symbol)) for symbol, jet in present.items()
    }
    if any(coefficient.has(*present) for coefficient in coefficients.values()):
        raise ValueError(f"{expression} is not linear in {field}")
    return coefficients, rest


def quadratic_jets(
    expression: sp.Expr, field: sp.Expr
) -> tuple[dict[tuple[Order, Order], sp.Expr], Flux]:
    """Split an expression that is at most quadratic in one field.

    Returns ``quadratic``: second derivative of the expression with respect to two jets, by their
    orders; both orders of a pair are listed; ``linear``: coefficients of the linear terms by ``(k,
    j)``. Raises ``ValueError`` if the expression is not a polynomial of second degree in the field.
    """
    entered, present = _entered(expression, field)
    at_rest = dict.fromkeys(present, sp.S.Zero)
    quadratic: dict[tuple[Order, Order], sp.Expr] = {}
    linear: Flux = {}
    for symbol, jet in present.items():
        slope = sp.diff(entered, symbol)
        linear[jet.k, jet.j] = slope.xreplace(at_rest)
        for other, jet_2 in present.items():
            second = sp.expand(sp.diff(slope, other))
            if second.has(*present):
                raise ValueError(f"{expression} is not quadratic in {field}")
            if second != 0:
                quadratic[(jet.k, jet.j), (jet_2.k, jet_2.j)] = second
    return quadratic, {order: value for order, value in linear.items() if value != 0}
