"""A heavy beam clamped to a turning hub, on polynomials: a module for each number of them."""

from __future__ import annotations

import sympy as sp
from elastolink.derive import authoring as au

GEOMETRY = (
    au.angle("theta", "Crank angle"),
    au.scalar("radius", "m", "Radius of the hub"),
    au.scalar("length", "m", "Length of the beam"),
)
PARAMETERS = (
    au.scalar("bending_stiffness", "N m^2", "EI"),
    au.scalar("mass_per_length", "kg/m", "mu"),
    au.scalar("gravity", "m/s^2", "Gravity"),
)
theta, radius, length = au.symbols(GEOMETRY)
stiffness, density, gravity = au.symbols(PARAMETERS)
x, t, rate, acceleration = sp.symbols("x t theta_rate theta_acceleration", real=True)
th, y = sp.Function("th")(t), sp.Function("y")(x, t)


def _action(spec: au.ModelSpec) -> au.ActionDensity:
    """Bending shortens the beam, which the centrifugal force of its outer part resists."""
    spin = th.diff(t)
    energy = ((y.diff(t) + spin * (radius + x)) ** 2 + spin**2 * y**2) / 2
    tension = density * spin**2 * ((radius + length) ** 2 - (radius + x) ** 2) / 2
    return au.ActionDensity(
        x=x,
        t=t,
        length=length,
        fields=(y,),
        density=density * (energy - gravity * y * sp.cos(th))
        - stiffness / 2 * y.diff(x, 2) ** 2
        - tension / 2 * y.diff(x) ** 2,
        essential=(au.Essential(sp.S.Zero, y, 0), au.Essential(sp.S.Zero, y, 1)),
    )


def _discretise(spec: au.ModelSpec, equations: au.FieldEquations) -> au.StagedSystem:
    shapes = tuple((x / length) ** (k + 2) for k in range(spec.modes))
    basis = au.FiniteBasis(x, length, shapes, amplitude=length)
    crank = au.CrankMotion(theta, rate, acceleration)
    system = au.project(equations, y, basis, crank, followers={th: theta})
    return au.StagedSystem(system, au.Steps(), au.symbols(PARAMETERS), au.symbols(GEOMETRY))


def _describe(spec: au.ModelSpec) -> au.Description:
    return au.Description(
        title=f"Beam on a turning hub, {spec.modes} polynomial modes",
        references=("Hamilton's principle",),
        arguments=GEOMETRY,
        parameters=PARAMETERS,
        notes=("Coordinates are q_k in y = length sum q_k (x/length)^(k+1).",),
    )


MODEL = au.Model(
    mechanism="turning_beam",
    formulations=("polynomial",),
    energies=_action,
    describe=_describe,
    discretise=_discretise,
    choices=au.Choices(flexible=("beam",)),
)
_TWO = au.ModelSpec("turning_beam", "polynomial", flexible=("beam",), modes=2)
SPECS = (_TWO, _TWO.with_(modes=3), _TWO.with_(outputs=("stability",)))
