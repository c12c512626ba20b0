"""Matrices of a beam element in a turning frame, by Hamilton's principle from the energies.

The element lies along the x axis of a frame that turns with ``turn(t)``; u and v are displacements
relative to it.  The frame's origin may move in any way: that adds only terms linear in u and v,
which follow from the mass matrix and the nodal values of the rigid acceleration.
"""

from __future__ import annotations

from functools import lru_cache

import sympy as sp

from ..arrays import CrankMotion, DiscreteSystem
from ..entries import MatrixForm
from ..ir import Argument, Description
from ..lagrange import quadratic_form
from ..pipeline import Model
from ..projection.assumed_modes import assumed_shapes
from ..records import ActionDensity, FieldEquations
from ..spec import ModelSpec
from ..staged import Steps
from ..variational import in_crank_angle
from .beam_shapes import (
    KINDS,
    bending,
    by_ratio,
    field_shapes,
    length,
    nodal_values,
    psi,
    shear,
    shear_steps,
    t,
    u,
    v,
    x,
)

density, axial, rotary = sp.symbols(
    "mass_per_length axial_stiffness rotary_inertia", real=True, positive=True
)
forces = sp.symbols("force_0:3", real=True)
loads = sp.symbols("px1 px2 py1 py2", real=True)
theta, rate, acceleration = sp.symbols("theta theta_rate theta_acceleration", real=True)
turn = sp.Function("turn")(t)


def beam_action(kind: str) -> ActionDensity:
    """Return the action of a beam in a frame that turns, under axial force and distributed load.

    ``kind``: one of ``KINDS``; Timoshenko's beam has shear and rotary inertia, the others have not.
    """
    spin, s = turn.diff(t), x / length
    along = u.diff(t) - spin * v
    across = v.diff(t) + spin * (x + u)
    kinetic = density * (along**2 + across**2) / 2
    strain = axial * u.diff(x) ** 2 / 2
    fields: tuple[sp.Expr, ...] = (u, v)
    if kind == "timoshenko":
        fields = (u, v, psi)
        kinetic += rotary * (spin + psi.diff(t)) ** 2 / 2
        strain += bending * psi.diff(x) ** 2 / 2 + shear * (v.diff(x) - psi) ** 2 / 2
    else:
        strain += bending * v.diff(x, 2) ** 2 / 2
    force = sp.Add(*(p * s**k for k, p in enumerate(forces)))
    strain += force * v.diff(x) ** 2 / 2
    return ActionDensity(
        x=x,
        t=t,
        length=length,
        fields=fields,
        density=kinetic - strain,
        force_density={
            u: loads[0] * (1 - s) + loads[1] * s,
            v: loads[2] * (1 - s) + loads[3] * s,
        },
    )


def element_system(action: ActionDensity, kind: str) -> DiscreteSystem:
    """Expand an action in the shape functions of an element.

    ``action``: in the fields of :func:`beam_action`; ``turn`` is the crank angle; ``kind``: whose
    shape functions. Result: arrays of the linear periodic family, the distributed load in p.
    """
    coordinates = tuple(sp.Function(value.label)(t) for value in nodal_values(kind))
    lagrangian = assumed_shapes(action, coordinates, field_shapes(kind))
    crank = CrankMotion(theta, rate, acceleration)
    return quadratic_form(
        in_crank_angle(lagrangian.expression, crank, t, {turn: theta}),
        lagrangian.coordinates,
        crank,
        t,
        forces=lagrangian.forces,
        geometric=forces,
    )


def element_matrices(system: DiscreteSystem) -> tuple[tuple[str, sp.ImmutableDenseMatrix], ...]:
    """Return the arrays of an element by name, each entry factored."""
    arrays = {
        "mass": system.matrix("M"),
        "coupling": system.matrix("A"),
        "centripetal": system.matrix("B"),
        "stiffness": system.matrix("K"),
    }
    geometric, load = system.matrix("Kg"), system.matrix("p")
    for k, force in enumerate(forces):
        arrays[f"geometric_{k}"] = geometric.diff(force)
    arrays["load"] = sp.ImmutableDenseMatrix.hstack(*(load.diff(p) for p in loads))
    (stiffness,) = sp.solve(by_ratio() - bending, shear)
    return tuple(
        (name, matrix.applyfunc(lambda e: _by_inertia(e.subs(shear, stiffness))))
        for name, matrix in arrays.items()
    )


@lru_cache(maxsize=512)
def _by_inertia(entry: sp.Expr) -> sp.Expr:
    """Return an entry with what each inertia contributes in a factored term of its own."""
    inertial = [sp.diff(entry, inertia) * inertia for inertia in (density, rotary)]
    rest = entry.subs({density: 0, rotary: 0})
    return sp.Add(*(sp.factor(part) for part in (rest, *inertial)))


def _action(spec: ModelSpec) -> ActionDensity:
    return beam_action(spec.formulation)


def _discretise(spec: ModelSpec, equations: FieldEquations) -> MatrixForm:
    arrays = element_matrices(element_system(equations.action, spec.formulation))
    return MatrixForm(arrays, shear_steps() if spec.formulation == "timoshenko" else Steps())


_NOTES = (
    "mass M, coupling W = int rho A N^T J N dx, J = [[0, -1], [1, 0]], stiffness K; centripetal "
    "is the mass matrix less rotary inertia. In a frame that turns at the rate w the element has "
    "M qdd + 2 w W qd + (K + Kg - w^2 centripetal + wd W) q.",
    "Axial force P = P0 + P1 s + P2 s^2, s = x/length, tension positive: Kg = P0 geometric_0 + P1 "
    "geometric_1 + P2 geometric_2. Load: nodal forces by the end values px1, px2, py1, py2 of a "
    "force per length along and across the element, linear between.",
)


def _describe(spec: ModelSpec) -> Description:
    parameters = [
        Argument("mass_per_length", "float", "kg/m", "rho A"),
        Argument("axial_stiffness", "float", "N", "EA"),
        Argument("bending_stiffness", "float", "N m^2", "EI"),
    ]
    if spec.formulation == "timoshenko":
        parameters.append(Argument("shear_stiffness", "float", "N", "k G A"))
        parameters.append(Argument("rotary_inertia", "float", "kg m", "rho I per length"))
    labels = ", ".join(value.label for value in nodal_values(spec.formulation))
    return Description(
        title=f"Beam element {spec.formulation} in a turning frame",
        references=("Aannaque (4.11)-(4.24), (4.38), (4.39), (A.3), (A.4), (A.7), (A.8)",),
        arguments=(Argument("length", "float", "m", "Length of the element"),),
        kernel="element",
        summary="Return the arrays of the element",
        parameters=tuple(parameters),
        notes=(f"Nodal values in order: {labels}.", *_NOTES),
    )


MODEL = Model(
    mechanism="beam_element",
    formulations=KINDS,
    energies=_action,
    describe=_describe,
    discretise=_discretise,
)
