"""Assumed modes: a continuum of several fields as a discrete Lagrangian in modal coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from ..records import ActionDensity, Lagrangian
from .bases import FiniteBasis
from .integrals import definite

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

    def along(expression: sp.Expr) -> sp.Expr:
        return _integral(expanded(expression), action)

    energy = along(action.density)
    for term in action.point_terms:
        energy += expanded(term.expression).subs(action.x, term.position)
    lost = along(action.dissipation)
    forces: _Table = {}
    for place, q in enumerate(coordinates):
        work = -sp.diff(lost, q.diff(action.t))
        for item in action.fields:
            weight = shapes[item][place]
            work += along(action.force_density.get(item, sp.S.Zero) * weight)
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


def _integral(expression: sp.Expr, action: ActionDensity) -> sp.Expr:
    """Integrate along the link, functions of time taken as plain symbols."""
    in_time = sorted(
        expression.atoms(sp.Derivative, sp.core.function.AppliedUndef), key=sp.default_sort_key
    )
    plain = {item: sp.Dummy(f"c{i}") for i, item in enumerate(in_time)}
    return definite(expression.xreplace(plain), action.x, sp.S.Zero, action.length).xreplace(
        {symbol: item for item, symbol in plain.items()}
    )


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
