"""Projection of a quadratic action on shapes that depend on the place of a moving support.

The field is ``v(x, t) = length sum_i q_i(t) e_i(eta; xi)`` with eta = x/length and
xi = s(t)/length, s the place of the support.  The shapes are not chosen here: by the chain rule

    v_t = length sum_i (qd_i e_i + td xi' q_i de_i/dxi),        ' = d/d theta,

every array becomes a sum of coefficients times integrals over the shapes and their derivatives by
eta and xi, which the caller passes in.  No second derivative by xi occurs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import sympy as sp

from ..arrays import BasisEntry, BasisIntegral, BasisProduct, CrankMotion, DiscreteSystem
from ..jets import linear_jets, quadratic_jets
from ..lagrange import NotRepresentable
from ..records import ActionDensity, PointTerm
from ..variational import drag_by_order
from .galerkin import ArraySum, tidy, vanishes

_Orders: TypeAlias = tuple[int, int]
# A jet of the field in the shapes: whether it goes with a rate, derivatives by eta and xi, factor.
_Part: TypeAlias = tuple[int, _Orders, sp.Expr]

# What integrals over deflection, slope and curvature are called.
_WORDS = {0: "overlap", 1: "tension", 2: "bending"}
_MOMENTS = {0: "mean", 1: "moment"}


@dataclass(frozen=True)
class MovingShapes:
    """Shapes ``e_i(eta; xi)`` with ``e_i(0) = e_i(xi) = 0``, continuous with their slopes.

    Attributes
    ----------
    length : Expr
        Of the link, and the unit of the field's coordinates.
    place : Expr
        xi, in symbols that follow the crank.
    eta : Symbol
        Name of x/length in the weights of the integrals.
    """

    length: sp.Expr
    place: sp.Expr
    eta: sp.Symbol


@dataclass(frozen=True)
class Moments:
    """A part of the Lagrangian that is quadratic in integrals of the field, by Hessian.

    Attributes
    ----------
    expression : Expr
        Lagrangian [J], quadratic in the symbols of ``weights``.
    weights : mapping
        Symbol to the polynomial w in x for which it stands, as ``int_0^length w v dx``.
    name : str
        Of the array that it gives.
    """

    expression: sp.Expr
    weights: Mapping[sp.Symbol, sp.Expr]
    name: str


def project_moving(
    action: ActionDensity,
    item: sp.Expr,
    shapes: MovingShapes,
    crank: CrankMotion,
    *,
    followers: Mapping[sp.Expr, sp.Expr] | None = None,
    moments: tuple[Moments, ...] = (),
) -> DiscreteSystem:
    """Substitute the expansion into a quadratic action and read off the arrays.

    Parameters
    ----------
    action : ActionDensity
        At most quadratic in the field, whose first time derivative is the highest; point terms
        stand at fixed places.
    item : Expr
        The field.
    shapes : MovingShapes
        What is known of the shapes.
    crank : CrankMotion
        Crank angle and rates; its chain knows how the place follows.
    followers : mapping, optional
        Applied function of time to its value in plain symbols.
    moments : tuple of Moments
        Further parts of the Lagrangian.

    Returns
    -------
    DiscreteSystem
        Of entries that are sums over integrals.

    Raises
    ------
    ValueError
        If the action is not quadratic, or the shapes do not vanish where the field is held.
    NotRepresentable
        If a term has no place in the family.
    """
    _check_held(action, item, shapes, followers or {})
    arrays = ArraySum(crank, action.t, followers or {}, ())
    side = _Moving(action, shapes, arrays)
    side.energy(*quadratic_jets(action.density, item), None)
    for point in action.point_terms:
        side.energy(*quadratic_jets(point.expression, item), side.fixed(point))
    for part in moments:
        side.products(part)
    if item in action.force_density:
        side.force(action.force_density[item], 0, item, None)
    for k, drag in drag_by_order(action, item):
        side.force(drag, k, item, None)
    for force in action.end_forces:
        if force.field == item:
            at = side.fixed(PointTerm(force.position, force.force))
            side.force(force.force, force.order, item, at)
    entries = {name: tidy(entry) for name, entry in arrays.entries.items()}
    kept = {name: entry for name, entry in entries.items() if not vanishes(entry)}
    return DiscreteSystem(crank, None, kept)


def _check_held(
    action: ActionDensity,
    item: sp.Expr,
    shapes: MovingShapes,
    followers: Mapping[sp.Expr, sp.Expr],
) -> None:
    zeros = (sp.S.Zero, sp.expand(shapes.place * shapes.length))
    for position, order in action.held(item):
        at = sp.expand(sp.sympify(position).xreplace(dict(followers)))
        if order or at not in zeros:
            raise ValueError(f"the shapes are not held at {position} (derivative {order})")


@dataclass
class _Moving:
    """Adds parts of the action to the arrays."""

    action: ActionDensity
    shapes: MovingShapes
    arrays: ArraySum

    def fixed(self, point: PointTerm) -> sp.Expr:
        """Return the place of a point term as a fraction of the length."""
        at = sp.sympify(point.position) / self.shapes.length
        if not at.is_number:
            raise NotRepresentable(f"a term at {point.position}, which is no fixed fraction")
        return at

    def energy(
        self,
        quadratic: Mapping[tuple[_Orders, _Orders], sp.Expr],
        linear: Mapping[_Orders, sp.Expr],
        at: sp.Expr | None,
    ) -> None:
        """Add a part of the Lagrangian, by its second and first derivatives by the jets."""
        for (first, second), coefficient in sorted(quadratic.items()):
            if max(first[1], second[1]) > 1:
                raise NotRepresentable("second time derivatives in the action")
            for left, row, factor in self._parts(first):
                for right, column, other in self._parts(second):
                    weight = coefficient * factor * other
                    if (left, right) == (0, 1):
                        continue  # the transposed of what (1, 0) has brought
                    self._quadratic(weight, (left, right), row, column, at)
        for order, coefficient in sorted(linear.items()):
            self._linear(coefficient, order, at)

    def _parts(self, order: _Orders) -> list[_Part]:
        """Return a jet in rates (1) and coordinates (0) by the chain rule."""
        k, j = order
        unit = self.shapes.length ** (1 - k)
        if j == 0:
            return [(0, (k, 0), unit)]
        crank = self.arrays.crank
        carried = unit * crank.rate * crank.derivative(self.shapes.place)
        return [(1, (k, 0), unit), (0, (k, 1), carried)]

    def _quadratic(
        self,
        weight: sp.Expr,
        rates: tuple[int, int],
        row: _Orders,
        column: _Orders,
        at: sp.Expr | None,
    ) -> None:
        for powers, value in self.arrays.by_powers(weight).items():
            if rates == (0, 0):
                targets = self.arrays.stiffness(value, powers)
            else:
                name = {((1, 1), (0, 0)): "M", ((1, 0), (1, 0)): "A"}.get((rates, powers))
                if name is None:
                    raise NotRepresentable(f"{value}: rates {rates} with rate powers {powers}")
                targets = [(name, value)]
            for name, part in targets:
                self.arrays.add(name, self._integrals(part, row, column, at))

    def _linear(self, coefficient: sp.Expr, order: _Orders, at: sp.Expr | None) -> None:
        """Add a linear term; of one with a rate, minus the rate of its coefficient is left.

        The momentum ``c int e_i`` changes with the shapes too, but what that brings is also what
        the coordinates find in ``c int v_t``; the two cancel.
        """
        k, j = order
        if j > 1 or (j == 1 and k > 1):
            raise NotRepresentable(f"{coefficient} times derivative {order} of the field")
        unit = self.shapes.length ** (1 - k)
        if j == 0:
            for powers, value in self.arrays.by_powers(unit * coefficient).items():
                name = self.arrays.forcing(powers, value)
                self.arrays.add(name, self._integrals(value, (k, 0), None, at))
            return
        crank = self.arrays.crank
        for powers, value in self.arrays.by_powers(unit * coefficient).items():
            if powers not in ((0, 0), (1, 0)):
                raise NotRepresentable(f"momentum {value} with rate powers {powers}")
            slope = -sp.expand(crank.derivative(value))
            name = "f" if powers[0] else "h"
            self.arrays.add(name, self._integrals(slope, (k, 0), None, at))
            if powers[0]:
                self.arrays.add("g", self._integrals(-value, (k, 0), None, at))

    def force(self, expression: sp.Expr, varied: int, item: sp.Expr, at: sp.Expr | None) -> None:
        """Add a force that works on derivative ``varied`` of the varied field."""
        unit = self.shapes.length ** (1 - varied)
        coefficients, rest = linear_jets(expression, item)
        for (k, j), coefficient in sorted(coefficients.items()):
            if j > 1:
                raise NotRepresentable(f"{expression} holds an acceleration")
            for rate, column, factor in self._parts((k, j)):
                weight = unit * factor * coefficient
                for powers, value in self.arrays.by_powers(weight).items():
                    for name, part in self._targets(value, rate, powers):
                        self.arrays.add(name, self._integrals(part, (varied, 0), column, at))
        for powers, value in self.arrays.by_powers(unit * rest).items():
            name = self.arrays.forcing(powers, value)
            self.arrays.add(name, self._integrals(value, (varied, 0), None, at))

    def _targets(
        self, value: sp.Expr, rate: int, powers: tuple[int, int]
    ) -> list[tuple[str, sp.Expr]]:
        if rate and powers == (0, 0):
            return [("C", -value)]
        if not rate and powers == (1, 0):
            return [("D", -value)]
        if not rate:
            return self.arrays.stiffness(value, powers)
        raise NotRepresentable(f"drag {value} with rate powers {powers}")

    def products(self, part: Moments) -> None:
        """Add a quadratic form in integrals of the field, by its Hessian."""
        symbols = sorted(part.weights, key=lambda s: s.name)
        rows: dict[sp.Symbol, sp.Symbol] = {}
        columns: dict[sp.Symbol, sp.Symbol] = {}
        form = sp.S.Zero
        vectors = {s: self._vector(part.weights[s]) for s in symbols}
        for s in symbols:
            vector = vectors[s][1]
            for table, end in ((rows, "row"), (columns, "column")):
                table[s] = sp.Symbol(f"{vector.name}_{end}")
        for s in symbols:
            for other in symbols:
                second = sp.expand(sp.diff(part.expression, s, other))
                if second.has(*symbols):
                    raise ValueError(f"{part.expression} is not quadratic in {symbols}")
                both = vectors[s][0] * vectors[other][0]
                form += both * second * rows[s] * columns[other]
        across = tuple(table[s] for table in (rows, columns) for s in symbols)
        for powers, value in self.arrays.by_powers(form).items():
            for name, signed in self.arrays.stiffness(value, powers):
                for factor, shape in _by_cofactor(signed, across).items():
                    product = BasisProduct(
                        part.name,
                        shape,
                        {rows[s]: vectors[s][1] for s in symbols},
                        {columns[s]: vectors[s][1] for s in symbols},
                    )
                    self.arrays.add(name, BasisEntry(((factor, product),)))

    def _vector(self, weight: sp.Expr) -> tuple[sp.Expr, BasisIntegral]:
        """Return ``int weight v dx`` as a factor and a vector of integrals."""
        entry = self._integrals(weight * self.shapes.length, (0, 0), None, None)
        if len(entry.terms) != 1:
            raise ValueError(f"weight {weight} is not one power of {self.action.x}")
        factor, vector = entry.terms[0]
        if not isinstance(vector, BasisIntegral):
            raise TypeError(f"{vector} is no integral")
        return factor, vector

    def _integrals(
        self, weight: sp.Expr, row: _Orders, column: _Orders | None, at: sp.Expr | None
    ) -> BasisEntry:
        """Return ``int weight ... dx`` as coefficients times integrals over eta."""
        eta, length = self.shapes.eta, self.shapes.length
        scaled = sp.sympify(weight).xreplace({self.action.x: length * eta})
        if at is not None:
            scaled = scaled.xreplace({eta: at})
        else:
            scaled *= length
        terms = []
        for factor, shape in _by_cofactor(sp.expand(scaled), (eta,)).items():
            outer, inner = (factor * shape, sp.S.One) if shape.is_number else (factor, shape)
            terms.append((outer, _named(inner, eta, row, column, at)))
        return BasisEntry(tuple(terms))


def _by_cofactor(expression: sp.Expr, inner: tuple[sp.Symbol, ...]) -> dict[sp.Expr, sp.Expr]:
    """Split into a sum of (factor free of the inner symbols) times (polynomial in them).

    Numbers stay with the polynomial, whose term of lowest degree is positive.
    """
    table: dict[sp.Expr, sp.Expr] = {}
    for term in sp.Add.make_args(sp.expand(expression)):
        outer, shape = term.as_independent(*inner, as_Add=False)
        number, outer = outer.as_coeff_Mul()
        table[outer] = table.get(outer, sp.S.Zero) + number * shape
    out: dict[sp.Expr, sp.Expr] = {}
    for outer, polynomial in table.items():
        if polynomial == 0:
            continue
        lowest = sp.Poly(polynomial, *inner).terms()[-1][1]
        sign = -1 if lowest < 0 else 1
        out[sign * outer] = sp.expand(sign * polynomial)
    return out


def _named(
    weight: sp.Expr,
    eta: sp.Symbol,
    row: _Orders,
    column: _Orders | None,
    at: sp.Expr | None,
) -> BasisIntegral:
    """Return an integral under the name by which the caller passes it in."""
    if column is None:
        degree = sp.degree(weight, eta) if weight.has(eta) else 0
        plain = row == (0, 0) and weight == eta**degree and degree in _MOMENTS and at is None
        name = _MOMENTS[degree] if plain else _factor_word(row) + _weight_word(weight)
    else:
        name = _pair_word(row, column)
        # A slope under a tension that is constant along the link would be another integral.
        expected = weight.has(eta) if row[0] == column[0] == 1 else weight == 1
        if not expected:
            name += _weight_word(weight)
    if at is not None:
        name += f"_at_{str(at).replace('/', '_over_')}"
    return BasisIntegral(name, weight, eta, row, column, at)


def _pair_word(row: _Orders, column: _Orders) -> str:
    """Return ``overlap``, ``drift`` (of the shapes along xi), ``bending_drift`` and the like."""
    if row[0] != column[0]:
        return f"{_factor_word(row)}_with_{_factor_word(column)}"
    word = "" if row[0] == 0 and row[1] + column[1] else _WORDS.get(row[0], f"order_{row[0]}")
    drifts = ["drift"] * (row[1] + column[1])
    if row[1] > column[1]:
        drifts.append("row")
    return "_".join([word, *drifts] if word else drifts)


def _factor_word(order: _Orders) -> str:
    word = {0: "shape", 1: "slope", 2: "curvature"}.get(order[0], f"order_{order[0]}")
    return word + "_drift" * order[1]


def _weight_word(weight: sp.Expr) -> str:
    """Return a word for a weight: its coefficients, from the constant one on."""
    if weight == 1:
        return ""
    symbols = sorted(weight.free_symbols, key=lambda s: s.name)
    coefficients = sp.Poly(weight, *symbols).all_coeffs()[::-1]
    words = [str(c).replace("-", "minus_").replace("/", "_over_") for c in coefficients]
    return "_weight_" + "_".join(words)
