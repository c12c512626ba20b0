"""Rigid linkages in redundant coordinates: Lagrange's equations with multipliers.

Each moving link has three coordinates, the place of its first joint and its angle, whatever the
joints.  Joints are constraints whose multipliers are the joint forces, and so is the drive: its
multiplier is the torque.  Nothing here knows the closed forms of the forces, so that the two
check each other; with the drive left out the same equations give the motion under a torque.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import sympy as sp

from ..entries import ConstrainedSystem
from ..ir import Argument, Description
from ..pipeline import Model
from ..records import EquationsOfMotion, Lagrangian
from ..spec import Choices, ModelSpec
from ..staged import vanishing
from .forces import LOAD_WORDS, MOMENT_WORDS
from .newton_euler import TORQUE
from .planar import FRAME, STRAIGHT, Body, Pin, PlanarLinkage, Slide, kinetic_energy

DRIVE = "drive"
CHOICES = Choices(drop=(STRAIGHT, DRIVE))


def free_bodies(linkage: PlanarLinkage) -> PlanarLinkage:
    """Return the linkage with coordinates of their own for each moving link."""
    t = linkage.t
    bodies = []
    for number, body in zip(linkage.numbers, linkage.bodies, strict=True):
        x, y, angle = (sp.Function(f"{name}{number}")(t) for name in ("x", "y", "angle"))
        bodies.append(replace(body, angle=angle, origin=(x, y)))
    return replace(linkage, bodies=tuple(bodies))


def constraints(linkage: PlanarLinkage) -> list[tuple[sp.Symbol, sp.Expr]]:
    """Return the joints' constraints, each with the name of its multiplier.

    Written as place on the second link less place on the first, so that multipliers are what the
    first link does to the second.

    ``linkage``: with free bodies.
    """
    found = []
    for joint in linkage.joints:
        pair = f"{joint.first}{joint.second}"
        if isinstance(joint, Pin):
            second = linkage.body(joint.second).place(*joint.on_second)
            first = linkage.body(joint.first).place(*joint.on_first)
            for axis, a, b in zip("xy", second, first, strict=True):
                found.append((sp.Symbol(f"{axis}{pair}", real=True), a - b))
        else:
            found += _of_slide(linkage, joint, pair)
    return found


def _of_slide(linkage: PlanarLinkage, joint: Slide, pair: str) -> list[tuple[sp.Symbol, sp.Expr]]:
    slider, guide = linkage.body(joint.slider), linkage.body(joint.guide)
    sign = 1 if joint.slider == joint.second else -1
    through, normal = guide.place(*joint.through), linkage.normal(joint)
    gap = sum(n * (a - b) for n, a, b in zip(normal, slider.origin, through, strict=True))
    names = sp.symbols(f"normal{pair} couple{pair}", real=True)
    return list(zip(names, (sign * gap, sign * (slider.angle - guide.angle)), strict=True))


def lagrangian(spec: ModelSpec, closed: PlanarLinkage) -> Lagrangian:
    """Return energies, constraints and loads of a linkage in redundant coordinates.

    ``spec``: ``drop`` may name the drive: then its torque is a load, and the crank is free;
    ``closed``: the linkage as its forces use it; its joints and masses are taken.
    """
    linkage = free_bodies(closed)
    energy = sp.Add(*(kinetic_energy(body, linkage.t) for body in linkage.bodies))
    coordinates: list[sp.Expr] = []
    loads: dict[sp.Expr, sp.Expr] = {}
    for number, body in zip(linkage.numbers, linkage.bodies, strict=True):
        own = (*body.origin, body.angle)
        coordinates += own
        for coordinate, (name, _, _) in zip(own, LOAD_WORDS, strict=True):
            loads[coordinate] = sp.Symbol(f"{name}{number}", real=True)
    conditions = constraints(linkage)
    driven = linkage.body(linkage.driven).angle
    if DRIVE in spec.drop:
        loads[driven] += TORQUE
    else:
        conditions.append((TORQUE, driven - sp.Function("drive")(linkage.t)))
    return Lagrangian(
        coordinates=tuple(coordinates),
        t=linkage.t,
        expression=energy,
        constraints=tuple(value for _, value in conditions),
        multipliers=tuple(name for name, _ in conditions),
        forces=loads,
    )


def _description(
    spec: ModelSpec, words: str, links: Sequence[Body], geometry: Sequence[Argument]
) -> Description:
    arguments, parameters = [], list(geometry)
    for number, body in enumerate(links, start=FRAME + 1):
        for name, unit, meaning in (
            ("x", "m", "Place of the first joint along x,"),
            ("y", "m", "Place of the first joint along y,"),
            ("angle", "rad", "Angle"),
        ):
            shape = "float or ndarray, shape (...)"
            arguments.append(
                Argument(f"{name}{number}", shape, unit, f"{meaning} of the {body.name}")
            )
    for number in range(FRAME + 1, FRAME + 1 + len(links)):
        parameters += [
            Argument(f"{name}{number}", "float or ndarray", unit, f"{meaning} {number}")
            for name, unit, meaning in (*MOMENT_WORDS, *LOAD_WORDS)
            if not (name == STRAIGHT and name in spec.drop)
        ]
    if DRIVE in spec.drop:
        parameters.append(Argument("torque", "float or ndarray", "N m", "Torque on the crank"))
    return Description(
        title=f"Equations of motion of {words} with a constraint for each joint",
        references=("Smith (4.4)-(4.6), by Lagrange's equations",),
        arguments=tuple(arguments),
        parameters=tuple(parameters),
        notes=(
            "Multipliers xij, yij, couple are the force and couple of link i on link j"
            + ("." if DRIVE in spec.drop else "; that of the drive is the torque, as couple2 is."),
        ),
    )


def multibody_model(
    mechanism: str,
    words: str,
    linkage: Callable[[ModelSpec], PlanarLinkage],
    geometry: Sequence[Argument],
) -> Model:
    """Return the model of a linkage in redundant coordinates.

    ``mechanism``, ``words``: name for specs, and in words; ``linkage``: ModelSpec to the linkage;
    ``geometry``: lengths.
    """

    def energies(spec: ModelSpec) -> Lagrangian:
        return lagrangian(spec, linkage(spec))

    def describe(spec: ModelSpec) -> Description:
        return _description(spec, words, linkage(spec).bodies, geometry)

    return Model(mechanism, ("multibody",), energies, describe, _discretise, choices=CHOICES)


def _discretise(spec: ModelSpec, equations: EquationsOfMotion) -> ConstrainedSystem:
    """Multiply the velocity terms out: in the moments about the first joints nothing is left."""
    rest = sp.ImmutableDenseMatrix(equations.rest.applyfunc(sp.expand))
    dropped = {}
    if not spec.drop:
        moments = equations.mass.free_symbols
        across = sorted(symbol.name for symbol in moments if symbol.name.startswith(STRAIGHT))
        dropped = vanishing({STRAIGHT: across, DRIVE: (TORQUE.name,)})
    return ConstrainedSystem(replace(equations, rest=rest), dropped=dropped)
