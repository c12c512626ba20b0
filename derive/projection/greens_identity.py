"""Green's identity by machine: integrals of beam modes from their end values, no quadrature.

Modes solve ``y'''' = b y`` with a constant b of their own.  A polynomial weight times derivatives
of one or two modes is then the derivative of a form in the modes' jets (y, y', y'', y''') with
polynomial coefficients; the form is found by linear algebra, and its end values are the integral.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from itertools import product
from types import MappingProxyType

import sympy as sp
from sympy.polys.matrices import DomainMatrix

_JET = range(4)
Place = tuple[int, ...]


class NoPrimitive(ValueError):  # noqa: N818 - reads as what it is
    """No form in the jets has the wanted derivative."""


@cache
def primitive(
    weight: sp.Expr, x: sp.Symbol, orders: tuple[int, ...], constants: tuple[sp.Symbol, ...]
) -> Mapping[Place, sp.Expr]:
    """Return the form whose derivative is ``weight`` times derivatives of modes.

    ``weight``: polynomial in x; ``x``: running coordinate; ``orders``: order of the derivative (0
    to 3) of each mode in the product; one or two modes; ``constants``: the constant b of each mode;
    the same symbol twice for the product of a mode with itself. Result: orders of the derivatives
    to their coefficient, a polynomial in x.
    """
    places = list(product(_JET, repeat=len(orders)))
    same = len(constants) == 2 and constants[0] == constants[1]
    solve = _solve_together if same else _solve_by_parts
    coefficients = solve(sp.Poly(weight, x), x, places, orders, constants)
    form = {place: sp.factor(value) for place, value in coefficients.items() if value != 0}
    left = derivative(form, x, constants)
    left[orders] = left.get(orders, sp.S.Zero) - weight
    if same:  # y' y'' and y'' y' are one
        for place in [place for place in left if place[0] > place[1]]:
            left[place[::-1]] = left.get(place[::-1], sp.S.Zero) + left.pop(place)
    if any(sp.cancel(value) != 0 for value in left.values()):
        raise NoPrimitive(f"{weight} times derivatives {orders}")
    return MappingProxyType(form)


def derivative(
    form: Mapping[Place, sp.Expr], x: sp.Symbol, constants: tuple[sp.Symbol, ...]
) -> dict[Place, sp.Expr]:
    """Return the derivative of a form along x, the fourth derivatives replaced."""
    found: dict[Place, sp.Expr] = {}

    def add(place: Place, value: sp.Expr) -> None:
        found[place] = found.get(place, sp.S.Zero) + value

    for place, value in form.items():
        add(place, sp.diff(value, x))
        for raised, factor in _raised(place, constants):
            add(raised, factor * value)
    return found


def _raised(place: Place, constants: tuple[sp.Symbol, ...]) -> list[tuple[Place, sp.Expr]]:
    """Return the product rule of one product of derivatives."""
    found = []
    for i, (order, constant) in enumerate(zip(place, constants, strict=True)):
        last = order == _JET[-1]
        raised = (*place[:i], 0 if last else order + 1, *place[i + 1 :])
        found.append((raised, constant if last else sp.S.One))
    return found


def _raising(places: list[Place], constants: tuple[sp.Symbol, ...]) -> sp.Matrix:
    """Return the product rule as a matrix on constant coefficients."""
    matrix = sp.zeros(len(places), len(places))
    for column, place in enumerate(places):
        for raised, factor in _raised(place, constants):
            matrix[places.index(raised), column] += factor
    return matrix


@cache
def _lowering(constants: tuple[sp.Symbol, ...]) -> DomainMatrix:
    """Return the inverse of the product rule."""
    places = list(product(_JET, repeat=len(constants)))
    domain = sp.QQ.frac_field(*dict.fromkeys(constants))
    return DomainMatrix.from_Matrix(_raising(places, constants)).convert_to(domain).inv()


def _solve_by_parts(
    weight: sp.Poly,
    x: sp.Symbol,
    places: list[Place],
    orders: tuple[int, ...],
    constants: tuple[sp.Symbol, ...],
) -> dict[Place, sp.Expr]:
    """Integrate by parts until the polynomial is gone: ``sum (-1)^k N^-(k+1) w^(k)``."""
    inverse = _lowering(constants)
    unit = sp.zeros(len(places), 1)
    unit[places.index(orders)] = 1
    column = DomainMatrix.from_Matrix(unit).convert_to(inverse.domain)
    total, sign = sp.zeros(len(places), 1), 1
    while not weight.is_zero:
        column = inverse * column
        total += sign * weight.as_expr() * column.to_Matrix()
        weight, sign = weight.diff(x), -sign
    return dict(zip(places, total, strict=True))


def _solve_together(
    weight: sp.Poly,
    x: sp.Symbol,
    places: list[Place],
    orders: tuple[int, ...],
    constants: tuple[sp.Symbol, ...],
) -> dict[Place, sp.Expr]:
    """Solve for symmetric coefficients up to one degree more than the weight's."""
    pairs = [place for place in places if place[0] <= place[1]]
    degrees = range(weight.degree() + 2)
    unknowns = [(pair, degree) for pair in pairs for degree in degrees]
    rows = {key: i for i, key in enumerate(product(pairs, range(weight.degree() + 3)))}
    matrix = sp.zeros(len(rows), len(unknowns) + 1)
    for column, (pair, degree) in enumerate(unknowns):
        for place, value in derivative({pair: x**degree}, x, constants).items():
            for (power,), factor in sp.Poly(value, x).terms():
                matrix[rows[_sorted(place), power], column] += factor
    for (power,), factor in weight.terms():
        matrix[rows[_sorted(orders), power], len(unknowns)] += factor
    domain = sp.QQ.frac_field(constants[0])
    reduced, pivots = DomainMatrix.from_Matrix(matrix).convert_to(domain).rref()
    if len(unknowns) in pivots:
        raise NoPrimitive(f"{weight.as_expr()} times derivatives {orders}")
    values = reduced.to_Matrix()[:, len(unknowns)]
    found = dict.fromkeys(pairs, sp.S.Zero)
    for row, pivot in enumerate(pivots):
        pair, degree = unknowns[pivot]
        found[pair] += values[row] * x**degree
    return found


def _sorted(place: Place) -> Place:
    return (min(place), max(place))


def integral(
    form: Mapping[Place, sp.Expr],
    x: sp.Symbol,
    ends: tuple[sp.Expr, sp.Expr],
    values: Callable[[int, int, sp.Expr], sp.Expr],
) -> sp.Expr:
    """Return the difference of a form's end values.

    ``form``: as :func:`primitive` returns it; ``x``: running coordinate; ``ends``: from where to
    where; ``values``: ``(mode, order, end)`` to the derivative of that order of mode 0 or 1 there.
    """
    total = sp.S.Zero
    for sign, end in zip((-1, 1), ends, strict=True):
        for place, coefficient in form.items():
            factors = (values(mode, order, end) for mode, order in enumerate(place))
            total += sign * coefficient.subs(x, end) * sp.Mul(*factors)
    return total
