"""Assumed modes: a continuum of several fields as a discrete Lagrangian in modal coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from itertools import product
from operator import mul
from typing import Any

import sympy as sp

from ..integrals import definite
from ..jets import Jet, JetSpace
from ..records import ActionDensity, Lagrangian
from .bases import FiniteBasis

_Table = dict[sp.Expr, sp.Expr]


def assumed_modes(action: ActionDensity, bases: Mapping[sp.Expr, FiniteBasis]) -> Lagrangian:
    """Expand every field of an action in shape functions and integrate along the link.

    Parameters
    ----------
    action : ActionDensity
        Its density a polynomial in the fields.
    bases : mapping
        Field to shape functions; one for each field.

    Returns
    -------
    Lagrangian
        The coordinates of the field ``v`` are ``v1(t), v2(t), ...``, in the order of the action's
        fields.  :func:`.lagrange.quadratic_form` reads the linear periodic arrays off it.

    Raises
    ------
    ValueError
        If a field has no basis, or a basis violates an essential condition.
    """
    without = [str(item) for item in action.fields if item not in bases]
    if without:
        raise ValueError(f"no basis for the fields {without}")
    own: list[tuple[sp.Expr, sp.Expr, sp.Expr]] = []
    for item in action.fields:
        basis = bases[item]
        for i, shape in enumerate(basis.shapes):
            coordinate = sp.Function(f"{item.func.__name__}{i + 1}")(action.t)
            own.append((item, coordinate, basis.amplitude * shape))
    shapes = {
        item: tuple(shape if field == item else sp.S.Zero for field, _, shape in own)
        for item in action.fields
    }
    return assumed_shapes(action, tuple(coordinate for _, coordinate, _ in own), shapes)


def assumed_shapes(
    action: ActionDensity,
    coordinates: Sequence[sp.Expr],
    shapes: Mapping[sp.Expr, Sequence[sp.Expr]],
) -> Lagrangian:
    """Expand the fields of an action in coordinates that they share, and integrate.

    Parameters
    ----------
    action : ActionDensity
        Its density a polynomial in the fields.
    coordinates : sequence of Expr
        Applied functions of time.
    shapes : mapping
        Field to its shape functions, one per coordinate: ``field = sum q_i shape_i(x)``.

    Returns
    -------
    Lagrangian
        In these coordinates.

    Raises
    ------
    ValueError
        If a field has another number of shapes, or a shape violates an essential condition.
    """
    for item in action.fields:
        if len(shapes[item]) != len(coordinates):
            raise ValueError(
                f"{len(shapes[item])} shapes of {item} for {len(coordinates)} unknowns"
            )
    _check_essential(action, shapes)
    expansion: _Table = {
        item: sp.Add(*(q * shape for q, shape in zip(coordinates, shapes[item], strict=True)))
        for item in action.fields
    }

    def expanded(expression: sp.Expr) -> sp.Expr:
        return sp.sympify(expression).subs(expansion).doit(integrals=False)

    integrals = _Integrals(action, coordinates, shapes)
    along = integrals.along
    energy = along(action.density)
    for term in action.point_terms:
        energy += expanded(term.expression).subs(action.x, term.position)
    lost = along(action.dissipation)
    forces: _Table = {}
    for place, q in enumerate(coordinates):
        work = -sp.diff(lost, q.diff(action.t))
        for item in action.fields:
            weight = shapes[item][place]
            work += along(action.force_density.get(item, sp.S.Zero), weight)
            for push in action.end_forces:
                if push.field == item:
                    moved = expanded(push.force) * sp.diff(weight, action.x, push.order)
                    work += moved.subs(action.x, push.position)
        forces[q] = work
    return Lagrangian(
        tuple(coordinates),
        action.t,
        energy,
        forces={q: work for q, work in forces.items() if work != 0},
    )


class _Integrals:
    """Integrals along the link of polynomials in the fields, each product of shapes once."""

    def __init__(
        self,
        action: ActionDensity,
        coordinates: Sequence[sp.Expr],
        shapes: Mapping[sp.Expr, Sequence[sp.Expr]],
    ) -> None:
        self._action, self._coordinates, self._shapes = action, coordinates, shapes
        self._known: dict[tuple[Any, ...], sp.Expr] = {}
        self._parts: dict[sp.Expr, tuple[sp.Poly | None, sp.Expr]] = {}
        self._derived: dict[tuple[sp.Expr, int], tuple[sp.Expr, ...]] = {}

    def along(self, expression: sp.Expr, weight: sp.Expr = sp.S.One) -> sp.Expr:
        """Return the integral of an expression times a weight in the coordinates.

        Raises ``ValueError`` if the expression is no polynomial in the fields.
        """
        space = JetSpace(self._action.fields)
        entered = sp.expand(space.enter(expression))
        jets = dict(space.present(entered))
        total = sp.S.Zero
        for term in sp.Add.make_args(entered):
            held: list[Jet] = []
            rest = []
            for factor in sp.Mul.make_args(term):
                base, power = factor.as_base_exp()
                if base in jets and power.is_Integer and power > 0:
                    held += [jets[base]] * int(power)
                elif factor.free_symbols & set(jets):
                    raise ValueError(f"{term} is no polynomial in the fields")
                else:
                    rest.append(factor)
            outside, inside = sp.Mul(*rest).as_independent(self._action.x, as_Add=False)
            total += outside * self._of_shapes(inside * weight, held)
        return total

    def _of_shapes(self, inside: sp.Expr, held: Sequence[Jet]) -> sp.Expr:
        """Return the integral of a product of derivatives of fields, each a sum of shapes."""
        t = self._action.t
        sums = [
            [
                (sp.Derivative(q, t, jet.j) if jet.j else q, (str(jet.field), jet.k, i), shape)
                for i, (q, shape) in enumerate(
                    zip(self._coordinates, self._slopes(jet), strict=True)
                )
                if shape != 0
            ]
            for jet in held
        ]
        total = []
        for chosen in product(*sums):
            key = (inside, *sorted(place for _, place, _ in chosen))
            if key not in self._known:
                self._known[key] = self._integral([inside, *(shape for *_, shape in chosen)])
            total.append(sp.Mul(*(q for q, *_ in chosen), self._known[key]))
        return sp.Add(*total)

    def _slopes(self, jet: Jet) -> tuple[sp.Expr, ...]:
        """Return a derivative along the link of the shapes of a field."""
        key = (jet.field, jet.k)
        if key not in self._derived:
            shapes = self._shapes[jet.field]
            self._derived[key] = tuple(sp.diff(shape, self._action.x, jet.k) for shape in shapes)
        return self._derived[key]

    def _integral(self, factors: Sequence[sp.Expr]) -> sp.Expr:
        """Integrate a product along the link, functions of time taken as plain symbols."""
        x, length = self._action.x, self._action.length
        parts = [self._polynomial(factor) for factor in factors]
        polynomials = [above for above, _ in parts if above is not None]
        if len(polynomials) == len(parts):
            whole = reduce(mul, polynomials).integrate(x)
            below = sp.Mul(*(below for _, below in parts))
            return (whole.eval(length) - whole.eval(0)) / below
        integrand = sp.Mul(*factors)
        in_time = sorted(
            integrand.atoms(sp.Derivative, sp.core.function.AppliedUndef), key=sp.default_sort_key
        )
        plain = {item: sp.Dummy(f"c{i}") for i, item in enumerate(in_time)}
        back = {symbol: item for item, symbol in plain.items()}
        return definite(integrand.xreplace(plain), x, sp.S.Zero, length).xreplace(back)

    def _polynomial(self, factor: sp.Expr) -> tuple[sp.Poly | None, sp.Expr]:
        """Return a factor as a polynomial over a number, where it is one."""
        if factor not in self._parts:
            above, below = sp.fraction(sp.together(factor))
            x = self._action.x
            plain = above.is_polynomial(x) and not below.has(x)
            self._parts[factor] = (sp.Poly(above, x) if plain else None, below)
        return self._parts[factor]


def _check_essential(action: ActionDensity, shapes: Mapping[sp.Expr, Sequence[sp.Expr]]) -> None:
    held = [(item.position, item.field, item.order) for item in action.essential]
    held += [(item.position, item.field, 0) for item in action.supports]
    for position, item, order in held:
        for shape in shapes[item]:
            if sp.expand(sp.diff(shape, action.x, order).subs(action.x, position)) != 0:
                raise ValueError(
                    f"{shape} of {item.func.__name__} does not vanish at {position} "
                    f"(derivative {order})"
                )
