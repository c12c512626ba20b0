"""Assumed modes: a continuum of several fields as a discrete Lagrangian in modal coordinates."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from .bases import FiniteBasis
from .integrals import definite
from .records import ActionDensity, Lagrangian

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
    _check_essential(action, bases)
    coordinates: dict[sp.Expr, list[sp.Expr]] = {}
    expansion: _Table = {}
    for item in action.fields:
        basis = bases[item]
        names = [f"{item.func.__name__}{i + 1}" for i in range(len(basis.shapes))]
        coordinates[item] = [sp.Function(name)(action.t) for name in names]
        shapes = (basis.amplitude * shape for shape in basis.shapes)
        expansion[item] = sp.Add(
            *(q * shape for q, shape in zip(coordinates[item], shapes, strict=True))
        )

    def expanded(expression: sp.Expr) -> sp.Expr:
        return sp.sympify(expression).subs(expansion).doit(integrals=False)

    def along(expression: sp.Expr) -> sp.Expr:
        return _integral(expanded(expression), action)

    energy = along(action.density)
    for term in action.point_terms:
        energy += expanded(term.expression).subs(action.x, term.position)
    lost = along(action.dissipation)
    forces: _Table = {}
    for item, unknowns in coordinates.items():
        for q, shape in zip(unknowns, bases[item].shapes, strict=True):
            weight = bases[item].amplitude * shape
            work = along(action.force_density.get(item, sp.S.Zero) * weight)
            work -= sp.diff(lost, q.diff(action.t))
            for push in action.end_forces:
                if push.field == item:
                    moved = expanded(push.force) * sp.diff(weight, action.x, push.order)
                    work += moved.subs(action.x, push.position)
            forces[q] = work
    every = tuple(q for unknowns in coordinates.values() for q in unknowns)
    return Lagrangian(
        every, action.t, energy, forces={q: work for q, work in forces.items() if work != 0}
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


def _check_essential(action: ActionDensity, bases: Mapping[sp.Expr, FiniteBasis]) -> None:
    held = [(item.position, item.field, item.order) for item in action.essential]
    held += [(item.position, item.field, 0) for item in action.supports]
    for position, item, order in held:
        for shape in bases[item].shapes:
            if sp.expand(sp.diff(shape, action.x, order).subs(action.x, position)) != 0:
                raise ValueError(
                    f"{shape} of {item.func.__name__} does not vanish at {position} "
                    f"(derivative {order})"
                )
