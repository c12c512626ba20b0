"""Integrals of the modes of a beam with an overhang, and of their drift, by end values alone.

``e`` is a mode, ``f = de/dxi`` its drift as the support moves:

    e'''' = B e,    f'''' = B f + B' e,    B = beta^4.

Green's identity, and its counterpart for equal indices with weights in eta, turn each integral
into values at pin, support and tip.  There the conditions hold, those on the drift being the
derivatives of those on the mode along the moving support.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import sympy as sp
from sympy.polys.matrices import DomainMatrix

from ..projection.greens_identity import NoPrimitive, primitive

eta, place = sp.symbols("eta place", positive=True)
MODE, DRIFT = "e", "f"
PIN, BEFORE, AFTER, TIP = "pin", "before", "after", "tip"
_WHERE = {PIN: sp.S.Zero, BEFORE: place, AFTER: place, TIP: sp.S.One}
_SIGNS = {PIN: -1, BEFORE: 1, AFTER: -1, TIP: 1}
_ORDERS = range(4)
# A factor of an integrand: the mode or its drift, and the order of its derivative by eta.
Factor = tuple[str, int]
Square = tuple[Factor, Factor]


@dataclass(frozen=True)
class Ends:
    """Values of one mode and of its drift where the conditions leave them open.

    ``beta``: fourth root of B; ``values``: symbol by place, kind (``"e"`` or ``"f"``) and order of
    the derivative by eta. After the support, the jump of the third derivative there.
    """

    beta: sp.Symbol
    values: Mapping[tuple[str, str, int], sp.Symbol]

    @classmethod
    def of(cls, suffix: str = "") -> Ends:
        """Return the end values of a mode; the names end with a suffix."""
        values = {key: sp.Symbol(name + suffix, real=True) for name, key in END_NAMES.items()}
        return cls(sp.Symbol("beta" + suffix, positive=True), values)

    @property
    def constant(self) -> sp.Expr:
        """B."""
        return self.beta**4

    def at(self, where: str, kind: str, order: int) -> sp.Expr:
        """Return a derivative at a place, from the conditions where they fix it.

        The conditions of Beale & Scott (3), (4): at the pin and the tip those on the drift are the
        same.  ``e(xi; xi) = 0`` gives ``f = -e'`` at the support; slope and moment are continuous
        there, and so is ``f'``, while ``f''`` jumps against ``e'''``.
        """
        key = (where, kind, order)
        if (where, order) in ((PIN, 0), (PIN, 2), (TIP, 2), (TIP, 3)):
            return sp.S.Zero
        if where in (BEFORE, AFTER) and order == 0:
            return sp.S.Zero if kind == MODE else -self.at(where, MODE, 1)
        if where == AFTER and (kind, order) in ((MODE, 1), (MODE, 2), (DRIFT, 1)):
            return self.at(BEFORE, kind, order)
        if where == AFTER and (kind, order) == (DRIFT, 2):
            return self.at(BEFORE, DRIFT, 2) - self.values[AFTER, MODE, 3]
        if where == AFTER and order == 3:
            return self.at(BEFORE, kind, 3) + self.values[key]
        return self.values[key]

    @property
    def constant_rate(self) -> sp.Expr:
        """B', from Green's identity for a mode and its own drift: ``int e^2 = 1`` is its factor."""
        form = {(3, 0): 1, (2, 1): -1, (1, 2): 1, (0, 3): -1}  # of f and e: its slope is B' e^2
        return sp.expand(
            sum(
                sign * factor * self.at(where, DRIFT, m) * self.at(where, MODE, n)
                for where, sign in _SIGNS.items()
                for (m, n), factor in form.items()
            )
        )

    def along(self, symbol: sp.Symbol) -> sp.Expr:
        """Return the derivative of a value of the mode at the support by the support's place.

        The value at a point that moves with the support: drift and slope of what is there.
        """

        def moved(where: str, order: int) -> sp.Expr:
            further = (
                self.at(where, MODE, order + 1)
                if order < 3
                else self.constant * self.at(where, MODE, 0)
            )
            return self.at(where, DRIFT, order) + further

        (key,) = (key for key, value in self.values.items() if value == symbol)
        where, kind, order = key
        if kind != MODE or where not in (BEFORE, AFTER):
            raise ValueError(f"{symbol} is no value of the mode at the support")
        if where == AFTER:
            return sp.expand(moved(AFTER, order) - moved(BEFORE, order))
        return sp.expand(moved(BEFORE, order))


END_NAMES: Mapping[str, tuple[str, str, int]] = {
    "root_slope": (PIN, MODE, 1),
    "root_shear": (PIN, MODE, 3),
    "slope": (BEFORE, MODE, 1),
    "moment": (BEFORE, MODE, 2),
    "shear": (BEFORE, MODE, 3),
    "reaction": (AFTER, MODE, 3),
    "tip": (TIP, MODE, 0),
    "tip_slope": (TIP, MODE, 1),
    "root_slope_drift": (PIN, DRIFT, 1),
    "root_shear_drift": (PIN, DRIFT, 3),
    "slope_drift": (BEFORE, DRIFT, 1),
    "moment_drift": (BEFORE, DRIFT, 2),
    "shear_drift": (BEFORE, DRIFT, 3),
    "reaction_drift": (AFTER, DRIFT, 3),
    "tip_drift": (TIP, DRIFT, 0),
    "tip_slope_drift": (TIP, DRIFT, 1),
}

_P, _Q = sp.symbols("p q", positive=True)
RATE = sp.Symbol("rate", real=True)  # of a root, over it: B' / B = 4 rate


def pair_integral(weight: sp.Expr, row: Factor, column: Factor, ends: tuple[Ends, Ends]) -> sp.Expr:
    """Return an integral over two different modes.

    ``weight``: polynomial in eta; ``row``, ``column``: factor of the first mode, and of the second;
    ``ends``: of the two modes.
    """
    form = primitive(sp.sympify(weight), eta, (row[1], column[1]), (_P, _Q))
    kinds = (row[0], column[0])
    total = sp.S.Zero
    for where, sign in _SIGNS.items():
        for orders, factor in form.items():
            both = sp.Mul(*(e.at(where, k, n) for e, k, n in zip(ends, kinds, orders, strict=True)))
            if both != 0:
                total += sign * factor.subs(eta, _WHERE[where]) * both
    # B' e in the fourth derivative of a drift is not part of the identity: taken off again.
    for one in (0, 1):
        if kinds[one] != DRIFT:
            continue
        for orders, factor in form.items():
            if orders[one] == 3:
                rest = [(kinds[0], orders[0]), (kinds[1], orders[1])]
                rest[one] = (MODE, 0)
                total -= ends[one].constant_rate * factor_integral(factor, rest[0], rest[1], ends)
    return total


def factor_integral(
    factor: sp.Expr, row: Factor, column: Factor, ends: tuple[Ends, Ends]
) -> sp.Expr:
    """Return an integral with a weight that has rational functions of both constants in it."""
    found = sp.Poly(factor, eta)
    return sp.Add(
        *(
            coefficient * pair_integral(eta**power, row, column, ends)
            for (power,), coefficient in found.terms()
        )
    )


GAP = sp.Symbol("gap", real=True)


def in_roots(expression: sp.Expr, ends: tuple[Ends, Ends]) -> sp.Expr:
    """Put fourth powers of the roots in the place of the constants, but for their difference."""
    inverse, first, second = sp.Symbol("inverse"), *(e.constant for e in ends)
    total = sp.S.Zero
    for term in sp.Add.make_args(sp.expand(expression)):
        above, below = sp.fraction(sp.factor(term))
        power = sp.degree(below, _P) if below.has(_P) else 0
        total += sp.cancel(above * (_P - _Q) ** power / below) * inverse**power
    found = sp.collect(sp.expand(total), inverse, evaluate=False)
    return sp.Add(
        *(sp.factor(part) * power.subs(inverse, 1 / GAP) for power, part in found.items())
    ).subs({_P: first, _Q: second})


def gap_step(ends: tuple[Ends, Ends]) -> tuple[sp.Symbol, sp.Expr]:
    """Return the difference of the constants of two modes, as a product."""
    return GAP, sp.factor(ends[0].constant - ends[1].constant)


def pair_rate(integral: sp.Expr, ends: tuple[Ends, Ends]) -> sp.Expr:
    """Return the derivative by the support's place of an integral over two modes.

    ``integral``: as :func:`in_roots` returns it, in values at the support and the constants'
    difference; ``ends``: of the two modes.
    """
    total = sp.diff(integral, GAP) * (ends[0].constant_rate - ends[1].constant_rate)
    for mode in ends:
        for symbol in mode.values.values():
            if integral.has(symbol):
                total += sp.diff(integral, symbol) * mode.along(symbol)
    parts = sp.collect(sp.expand(total), 1 / GAP, evaluate=False)
    return sp.Add(*(sp.factor(part) * power for power, part in parts.items()))


def single_integral(weight: sp.Expr, order: int, ends: Ends) -> sp.Expr:
    """Return the integral of one mode's derivative with a polynomial weight in eta."""
    form = primitive(sp.sympify(weight), eta, (order,), (_P,))
    total = sp.Add(
        *(
            sign * factor.subs(eta, _WHERE[where]) * ends.at(where, MODE, n)
            for where, sign in _SIGNS.items()
            for (n,), factor in form.items()
        )
    )
    return sp.expand(total).subs(_P, ends.constant)


# ---------------------------------------------------------------- equal indices

_ALL: tuple[Factor, ...] = tuple(product((MODE, DRIFT), _ORDERS))


def _slope(factor: Factor) -> tuple[tuple[Factor, int], ...]:
    """Return the derivative of a factor at B = B' = 1."""
    kind, order = factor
    if order < 3:
        return (((kind, order + 1), 1),)
    source = (((MODE, 0), 1),) if kind == DRIFT else ()
    return (((kind, 0), 1), *source)


def _square(one: Factor, other: Factor) -> Square:
    return (one, other) if _ALL.index(one) <= _ALL.index(other) else (other, one)


def _drifts(square: Square) -> int:
    return sum(kind == DRIFT for kind, _ in square)


def _derivative(square: Square, power: int) -> dict[tuple[Square, int], int]:
    """Return the derivative of ``x^power`` times a product of two factors."""
    found: dict[tuple[Square, int], int] = {}

    def add(key: tuple[Square, int], value: int) -> None:
        found[key] = found.get(key, 0) + value

    if power:
        add((square, power - 1), power)
    for i in (0, 1):
        for raised, value in _slope(square[i]):
            add((_square(raised, square[1 - i]), power), value)
    return found


@lru_cache(maxsize=16)
def square_primitive(square: Square, power: int) -> Mapping[tuple[Square, int], sp.Rational]:
    """Return what has ``x^power`` times a product of factors of one mode as its derivative.

    At ``B = B' = 1``: the coordinate x is then ``beta eta``, and the drift in units of B' / B.
    """
    total = square[0][1] + square[1][1] - power
    drifts = _drifts(square)
    squares = [(a, b) for i, a in enumerate(_ALL) for b in _ALL[i:] if _drifts((a, b)) <= drifts]
    # Whole periods of four derivatives are nothing: the parity of order less power is kept.
    unknowns = [
        (pair, n)
        for n in range(power + 4)
        for pair in squares
        if (pair[0][1] + pair[1][1] - n - total + 1) % 4 == 0
    ]
    rows: dict[tuple[Square, int], int] = {(square, power): 0}
    entries = [
        (rows.setdefault(key, len(rows)), column, value)
        for column, unknown in enumerate(unknowns)
        for key, value in _derivative(*unknown).items()
    ]
    matrix = sp.zeros(len(rows), len(unknowns) + 1)
    for row, column, value in entries:
        matrix[row, column] += value
    matrix[0, len(unknowns)] = 1
    reduced, pivots = DomainMatrix.from_Matrix(matrix).convert_to(sp.QQ).rref()
    if len(unknowns) in pivots:
        raise NoPrimitive(f"x^{power} {square}")
    column = reduced.to_Matrix()[:, len(unknowns)]
    return {unknowns[pivot]: column[i] for i, pivot in enumerate(pivots) if column[i] != 0}


def square_integral(one: Factor, other: Factor, power: int, ends: Ends) -> sp.Expr:
    """Return ``int eta^power`` times two factors of the same mode."""
    beta = ends.beta
    form = square_primitive(_square(one, other), power)
    drifts, orders = _drifts((one, other)), one[1] + other[1]
    total = sp.S.Zero
    for (pair, n), factor in form.items():
        # In x = beta eta: derivatives over powers of beta, drift over B' / B.
        lost = drifts - _drifts(pair)
        scale = beta ** (orders - pair[0][1] - pair[1][1] + n - power - 1)
        for where, sign in _SIGNS.items():
            values = sp.Mul(*(ends.at(where, kind, order) for kind, order in pair))
            if values != 0:
                at = _WHERE[where] ** n if n else sp.S.One
                total += sign * factor * scale * (4 * RATE) ** lost * at * values
    return sp.expand(total)
