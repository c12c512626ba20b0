"""Matrices of a beam element that turns about an axis across it: stretch, lag and flap.

The element lies along a radius and begins at distance ``inner`` from the axis; u is along it, v
across it in the plane of rotation, w along the axis.  Its tension in steady rotation and under
gravity is passed in as ``tension_0 + tension_1 s + tension_2 s^2``, s = x/length, so that one set
of matrices serves every load that varies no faster than that.
"""

from __future__ import annotations

import sympy as sp
from elastolink.derive import authoring as au

ARGUMENTS = (
    au.scalar("length", "m", "Length of the element"),
    au.scalar("inner", "m", "Distance of its inner end from the axis"),
    au.scalar("tension_0", "N", "Tension at the inner end"),
    au.scalar("tension_1", "N", "Linear part of the tension"),
    au.scalar("tension_2", "N", "Quadratic part of the tension"),
)
PARAMETERS = (
    au.scalar("mass_per_length", "kg/m", "mu"),
    au.scalar("axial_stiffness", "N", "EA"),
    au.scalar("lag_stiffness", "N m^2", "EI for bending in the plane of rotation"),
    au.scalar("flap_stiffness", "N m^2", "EI for bending out of the plane of rotation"),
    au.scalar("damping", "N s/m^2", "Viscous damping per length, relative to the turning frame"),
)
length, inner, tension_0, tension_1, tension_2 = au.symbols(ARGUMENTS)
density, axial, lag, flap, damping = au.symbols(PARAMETERS)
x, t, theta, rate, acceleration = sp.symbols("x t theta theta_rate theta_acceleration", real=True)
turn = sp.Function("turn")(t)
u, v, w = (sp.Function(name)(x, t) for name in ("u", "v", "w"))


def _action(spec: au.ModelSpec) -> au.ActionDensity:
    spin, s = turn.diff(t), x / length
    radial = u.diff(t) - spin * v
    across = v.diff(t) + spin * (inner + x + u)
    tension = tension_0 + tension_1 * s + tension_2 * s**2
    kinetic = density / 2 * (radial**2 + across**2 + w.diff(t) ** 2)
    elastic = axial * u.diff(x) ** 2 + lag * v.diff(x, 2) ** 2 + flap * w.diff(x, 2) ** 2
    stress = tension * (v.diff(x) ** 2 + w.diff(x) ** 2)
    return au.ActionDensity(
        x=x,
        t=t,
        length=length,
        fields=(u, v, w),
        density=kinetic - elastic / 2 - stress / 2,
        force_density={item: -damping * item.diff(t) for item in (u, v, w)},
    )


def _nodal(names: str, degree: int) -> au.FiniteBasis:
    """Return the polynomials whose end values (and end slopes, from degree 3 on) are 1 in turn."""
    powers = [x**k for k in range(degree + 1)]
    values = [
        [sp.diff(power, x, order).subs(x, at) for power in powers]
        for at in (sp.S.Zero, length)
        for order in range((degree + 1) // 2)
    ]
    shapes = sp.Matrix([powers]) * sp.Matrix(values).inv()
    return au.FiniteBasis(x, length, tuple(sp.expand(shape) for shape in shapes))


def _discretise(spec: au.ModelSpec, equations: au.FieldEquations) -> au.MatrixForm:
    bases = {u: _nodal("u", 1), v: _nodal("v", 3), w: _nodal("w", 3)}
    lagrangian = au.assumed_modes(equations.action, bases)
    crank = au.CrankMotion(theta, rate, acceleration)
    system = au.quadratic_form(
        au.in_crank_angle(lagrangian.expression, crank, t, {turn: theta}),
        lagrangian.coordinates,
        crank,
        t,
        forces=lagrangian.forces,
        geometric=(tension_0, tension_1, tension_2),
    )
    return au.MatrixForm(tuple((name, system.matrix(name)) for name in system.arrays))


def _describe(spec: au.ModelSpec) -> au.Description:
    return au.Description(
        title="Rotating beam element",
        references=("Hamilton's principle",),
        arguments=ARGUMENTS,
        kernel="element",
        summary="Return the arrays of the element",
        parameters=PARAMETERS,
        notes=(
            "Degrees of freedom: u at the ends; v and its slope at the inner, then at the outer "
            "end; w and its slope likewise.",
        ),
    )


MODEL = au.Model(
    mechanism="rotating_beam",
    formulations=("element",),
    energies=_action,
    describe=_describe,
    discretise=_discretise,
)
SPECS = (au.ModelSpec("rotating_beam", "element"),)
