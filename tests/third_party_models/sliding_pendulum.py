"""A block on a horizontal line, held by a spring, with a bob on a rod: three formulations.

multiplier
    block and bob in Cartesian coordinates, the rod's length a constraint;
minimal
    place of the block and angle of the rod, no constraint;
driven
    as multiplier, the block moved by a prescribed function of time that is passed in.
"""

from __future__ import annotations

import sympy as sp
from elastolink.derive import authoring as au

t = sp.Symbol("t", real=True)
block, bob, rod, spring, damping, gravity = sp.symbols(
    "block bob rod spring damping gravity", positive=True
)
s, px, py, angle = (sp.Function(name)(t) for name in ("s", "px", "py", "angle"))
drive = sp.Function("drive")(t)


def _energies(spec: au.ModelSpec) -> au.Lagrangian:
    place = (px, py)
    if spec.formulation == "minimal":
        place = (s + rod * sp.sin(angle), -rod * sp.cos(angle))
    speed = [coordinate.diff(t) for coordinate in (s, *place)]
    energy = block / 2 * speed[0] ** 2 + bob / 2 * (speed[1] ** 2 + speed[2] ** 2)
    energy += -spring / 2 * s**2 - bob * gravity * place[1]
    forces = {s: -damping * s.diff(t)}
    if spec.formulation == "minimal":
        return au.Lagrangian((s, angle), t, energy, forces=forces)
    length = (px - s) ** 2 + py**2 - rod**2
    held = (length, s - drive) if spec.formulation == "driven" else (length,)
    return au.Lagrangian((s, px, py), t, energy, held, forces=forces)


def _discretise(spec: au.ModelSpec, equations: au.EquationsOfMotion) -> au.ConstrainedSystem:
    return au.ConstrainedSystem(equations, au.variational_equations(equations))


def _describe(spec: au.ModelSpec) -> au.Description:
    shape = "float or ndarray, shape (...)"
    return au.Description(
        title=f"Sliding pendulum, {spec.formulation} formulation",
        references=("textbook",),
        arguments=(
            au.Argument("s", shape, "m", "Place of the block"),
            au.Argument("px", shape, "m", "Horizontal place of the bob"),
            au.Argument("py", shape, "m", "Height of the bob"),
            au.Argument("angle", shape, "rad", "Angle of the rod from the vertical"),
        ),
        parameters=(
            au.scalar("block", "kg", "Mass of the block"),
            au.scalar("bob", "kg", "Mass of the bob"),
            au.scalar("rod", "m", "Length of the rod"),
            au.scalar("spring", "N/m", "Stiffness of the spring"),
            au.scalar("damping", "N s/m", "Viscous friction of the block"),
            au.scalar("gravity", "m/s^2", "Gravity"),
        ),
    )


MODEL = au.Model(
    mechanism="sliding_pendulum",
    formulations=("multiplier", "minimal", "driven"),
    energies=_energies,
    describe=_describe,
    discretise=_discretise,
)
SPECS = tuple(au.ModelSpec(MODEL.mechanism, name) for name in MODEL.formulations)
