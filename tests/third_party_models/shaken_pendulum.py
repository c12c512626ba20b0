"""A pendulum whose pivot a crank shakes up and down: an equation of one's own, any amplitude."""

from __future__ import annotations

import sympy as sp
from elastolink.derive import authoring as au

t = sp.Symbol("t", real=True)
rod, bob, gravity = sp.symbols("rod bob gravity", positive=True)
stroke, friction = sp.symbols("stroke friction", nonnegative=True)
angle, theta = (sp.Function(name)(t) for name in ("angle", "theta"))


def _energies(spec: au.ModelSpec) -> au.Lagrangian:
    place = (rod * sp.sin(angle), stroke * sp.cos(theta) - rod * sp.cos(angle))
    energy = sum(bob / 2 * part.diff(t) ** 2 for part in place) - bob * gravity * place[1]
    return au.Lagrangian((angle,), t, energy, forces={angle: -friction * angle.diff(t)})


def _discretise(spec: au.ModelSpec, equations: au.EquationsOfMotion) -> au.ConstrainedSystem:
    return au.ConstrainedSystem(equations, au.variational_equations(equations))


def _describe(spec: au.ModelSpec) -> au.Description:
    shape = "float or ndarray, shape (...)"
    return au.Description(
        title="Pendulum on a shaken pivot",
        references=("textbook",),
        arguments=(
            au.Argument("angle", shape, "rad", "Angle of the rod from the vertical"),
            au.Argument("theta", shape, "rad", "Angle of the crank that shakes the pivot"),
            au.Argument("theta_d1", shape, "rad/s", "Its speed"),
            au.Argument("theta_d2", shape, "rad/s^2", "Its acceleration"),
        ),
        parameters=(
            au.scalar("rod", "m", "Length of the rod"),
            au.scalar("bob", "kg", "Mass of the bob"),
            au.scalar("gravity", "m/s^2", "Gravity"),
            au.scalar("stroke", "m", "Half of the way of the pivot"),
            au.scalar("friction", "N m s", "Viscous friction of the joint"),
        ),
    )


MODEL = au.Model(
    mechanism="shaken_pendulum",
    formulations=("minimal",),
    energies=_energies,
    describe=_describe,
    discretise=_discretise,
)
SPECS = (au.ModelSpec("shaken_pendulum", "minimal"),)
