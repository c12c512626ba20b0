"""A beam clamped to a hub that circles and rocks, with a tip mass, on two or three polynomials.

The hub's centre is at ``radius (cos theta, sin theta)`` and the undeflected beam points in the
direction ``phi = rocking sin theta``.  Bending shortens the beam, which holds its tension.
"""

from __future__ import annotations

import sympy as sp
from elastolink.derive import authoring as au

GEOMETRY = (
    au.angle("theta", "Crank angle"),
    au.scalar("radius", "m", "Radius of the hub's circle"),
    au.scalar("rocking", "rad", "Amplitude of the beam's direction"),
    au.scalar("length", "m", "Length of the beam"),
)
PARAMETERS = (
    au.scalar("bending_stiffness", "N m^2", "EI"),
    au.scalar("mass_per_length", "kg/m", "mu"),
    au.scalar("damping", "N s/m^2", "Viscous damping per length"),
    au.scalar("tip_mass", "kg", "Mass at the free end"),
)
theta, radius, rocking, length = au.symbols(GEOMETRY)
stiffness, density, damping, tip_mass = au.symbols(PARAMETERS)
x, t, rate, acceleration = sp.symbols("x t theta_rate theta_acceleration", real=True)
phi, phi1, phi2 = sp.symbols("phi phi_speed phi_bend", real=True)
th, direction = (sp.Function(name)(t) for name in ("th", "direction"))
y, u, tension = (sp.Function(name)(x, t) for name in ("y", "u", "N"))


def _action(spec: au.ModelSpec) -> au.ActionDensity:
    hub = radius * sp.Matrix([sp.cos(th), sp.sin(th)]).diff(t)
    cos, sin = sp.cos(direction), sp.sin(direction)
    along = hub[0] * cos + hub[1] * sin + u.diff(t) - direction.diff(t) * y
    across = hub[1] * cos - hub[0] * sin + y.diff(t) + direction.diff(t) * (x + u)
    energy = (along**2 + across**2) / 2
    return au.ActionDensity(
        x=x,
        t=t,
        length=length,
        fields=(y, u, tension),
        density=density * energy
        - stiffness / 2 * y.diff(x, 2) ** 2
        - tension * (u.diff(x) + y.diff(x) ** 2 / 2),
        point_terms=(au.PointTerm(length, tip_mass * energy),),
        force_density={y: -damping * y.diff(t)},
        essential=tuple(
            au.Essential(sp.S.Zero, item, order) for item, order in ((y, 0), (y, 1), (u, 0))
        ),
        orders={y: 1, u: 2, tension: 0},
    )


def basis(modes: int) -> au.FiniteBasis:
    """Return ``length (x/length)^(k+1)``, k = 1, 2, ...: clamped at the hub."""
    shapes = tuple((x / length) ** (k + 2) for k in range(modes))
    return au.FiniteBasis(x, length, shapes, amplitude=length)


def _discretise(spec: au.ModelSpec, equations: au.FieldEquations) -> au.StagedSystem:
    orders = equations.action.orders
    at_tip = au.linearise(equations.condition(length, u, 0), orders, 0)
    value = au.solve_end_value(at_tip.subs(x, length), tension.subs(x, length))
    axial = au.linearise(equations.equations[u], orders, 0)
    held = au.solve_tension(axial, tension, x, length, value)
    quadratic = au.quadratic_action(equations.action, {tension: held}, (u,))
    crank = au.CrankMotion(theta, rate, acceleration, {phi: phi1, phi1: phi2})
    followers = {th: theta, direction: phi}
    system = au.project(au.hamilton(quadratic), y, basis(spec.modes), crank, followers=followers)
    steps = au.Steps(
        (
            (phi, rocking * sp.sin(theta)),
            (phi1, rocking * sp.cos(theta)),
            (phi2, -rocking * sp.sin(theta)),
        )
    )
    return au.StagedSystem(system, steps, au.symbols(PARAMETERS), au.symbols(GEOMETRY))


def _describe(spec: au.ModelSpec) -> au.Description:
    return au.Description(
        title=f"Beam on a moving hub, {spec.modes} polynomial modes",
        references=("Hamilton's principle",),
        arguments=GEOMETRY,
        parameters=PARAMETERS,
        notes=("Coordinates are q_k in y = length sum q_k (x/length)^(k+1).",),
    )


MODEL = au.Model(
    mechanism="carried_beam",
    formulations=("polynomial",),
    energies=_action,
    describe=_describe,
    discretise=_discretise,
    choices=au.Choices(flexible=("beam",)),
)
_TWO = au.ModelSpec("carried_beam", "polynomial", flexible=("beam",), modes=2)
SPECS = (_TWO, _TWO.with_(modes=3), _TWO.with_(outputs=("stability",)))
