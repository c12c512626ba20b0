"""A bead on a cycloid, pulled along it: nonlinear in its coordinates, linear along the arc.

With the arc length s from the lowest point, ``mass (s'' + gravity/(4 radius) s) + drag s' =
force cos(speed t)`` for every amplitude: motion and multipliers are known in closed form.  The
rolling angle has no mass.
"""

from __future__ import annotations

import sympy as sp
from elastolink.derive import authoring as au

t = sp.Symbol("t", real=True)
mass, radius, gravity, drag, force, speed = sp.symbols(
    "mass radius gravity drag force speed", positive=True
)
x, y, roll = (sp.Function(name)(t) for name in ("x", "y", "roll"))


def _energies(spec: au.ModelSpec) -> au.Lagrangian:
    pull = force * sp.cos(speed * t)
    energy = mass / 2 * (x.diff(t) ** 2 + y.diff(t) ** 2) - mass * gravity * y
    held = (x - radius * (roll + sp.sin(roll)), y - radius * (1 - sp.cos(roll)))
    forces = {
        x: pull * sp.cos(roll / 2) - drag * x.diff(t),
        y: pull * sp.sin(roll / 2) - drag * y.diff(t),
    }
    return au.Lagrangian((x, y, roll), t, energy, held, forces=forces)


def _discretise(spec: au.ModelSpec, equations: au.EquationsOfMotion) -> au.ConstrainedSystem:
    return au.ConstrainedSystem(equations, au.variational_equations(equations))


def _describe(spec: au.ModelSpec) -> au.Description:
    return au.Description(
        title="Bead on a cycloid",
        references=("textbook",),
        parameters=(
            au.scalar("mass", "kg", "Mass of the bead"),
            au.scalar("radius", "m", "Radius of the rolling circle"),
            au.scalar("gravity", "m/s^2", "Gravity"),
            au.scalar("drag", "N s/m", "Viscous drag"),
            au.scalar("force", "N", "Amplitude of the pull along the curve"),
            au.scalar("speed", "rad/s", "Angular frequency of the pull"),
        ),
    )


MODEL = au.Model(
    mechanism="cycloid",
    formulations=("multiplier",),
    energies=_energies,
    describe=_describe,
    discretise=_discretise,
)
SPECS = (au.ModelSpec(MODEL.mechanism, "multiplier"),)
