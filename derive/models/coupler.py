"""The flexible coupler of a four-bar linkage, from its action to the equations of its modes.

The coupler BC is a pinned beam that the crank pin carries along and the linkage turns; the inertia
of coupler and follower loads its end C.  Bending shortens the chord, ``u_x + y_x^2/2 = 0``, and the
multiplier N of that constraint is the tension in the beam: so the whole geometric stiffness
follows from the action.

Formulations differ in what is left out of the *energies*, before anything is derived:

complete
    nothing;
printed
    the coupler's own axial inertia along its length, so that N is the end load everywhere
    (what Smith 6.17 amounts to);
reduced
    also the energy ``mu omega3^2 y^2 / 2`` of the spin and the coupler's part of the end load
    (Smith 6.18).
"""

from __future__ import annotations

from functools import cache

import sympy as sp
from sympy.simplify.fu import TR8

from ..arrays import VECTORS, CrankMotion
from ..ir import Argument, Description
from ..lagrange import euler_lagrange
from ..pipeline import Model
from ..projection.bases import sine_basis
from ..projection.galerkin import project
from ..records import ActionDensity, EndForce, Essential, FieldEquations, Lagrangian
from ..separation import StagedSystem
from ..spec import ModelSpec
from ..variational import hamilton, quadratic_action, undeflected_tension
from . import four_bar
from .four_bar import ARGUMENTS, coupler, crank, follower, frame, theta2

DROPPED = {
    "complete": frozenset(),
    "printed": frozenset({"axial_inertia"}),
    "reduced": frozenset({"axial_inertia", "spin", "coupler_end_load"}),
}
TERMS = ("axial_inertia", "spin", "coupler_end_load", "follower_end_load")

x, t = sp.symbols("x t", real=True)
rate, acceleration = sp.symbols("theta2_rate theta2_acceleration", real=True)
stiffness, density, damping = sp.symbols("bending_stiffness mass_per_length damping", positive=True)
inertia3, moment3, inertia4 = sp.symbols(
    "coupler_inertia coupler_first_moment follower_inertia", positive=True
)
SIN23, COS23, COSINE_TRANSMISSION = sp.symbols("sin23 cos23 cosine_transmission", real=True)
_FORCE_X, _FORCE_Y = sp.symbols("X Y", real=True)
end_load = sp.Function("F_x")(t)
th2, th3, th4 = (sp.Function(f"th{i}")(t) for i in (2, 3, 4))
y, u, tension = (sp.Function(name)(x, t) for name in ("y", "u", "N"))


def dropped(spec: ModelSpec) -> frozenset[str]:
    """Return the names of the terms that a spec leaves out.

    Raises ``ValueError`` if the spec names a term that does not exist.
    """
    unknown = sorted(set(spec.drop) - set(TERMS))
    if unknown:
        raise ValueError(f"unknown terms {unknown}; expected some of {TERMS}")
    return DROPPED[spec.formulation] | set(spec.drop)


def action(spec: ModelSpec) -> ActionDensity:
    """Return the action of the coupler in axes that move with its chord (Smith Figs. 25, 26)."""
    without = dropped(spec)
    pin = (crank * th2.diff(t) * sp.sin(th3 - th2), crank * th2.diff(t) * sp.cos(th3 - th2))
    shift = sp.Integer(0) if "axial_inertia" in without else sp.Integer(1)
    along = pin[0] + shift * u.diff(t) - th3.diff(t) * y
    across = pin[1] + y.diff(t) + th3.diff(t) * (x + shift * u)
    square = along**2 + across**2
    if "spin" in without:
        # The square alone: its product with the motion of the pin belongs to the forcing.
        square -= (th3.diff(t) * y) ** 2
    return ActionDensity(
        x=x,
        t=t,
        length=coupler,
        fields=(y, u, tension),
        density=density / 2 * square
        - stiffness / 2 * y.diff(x, 2) ** 2
        - tension * (u.diff(x) + y.diff(x) ** 2 / 2),
        force_density={y: -damping * y.diff(t)},
        end_forces=(EndForce(coupler, u, 0, end_load),),
        essential=(
            Essential(sp.Integer(0), y, 0),
            Essential(coupler, y, 0),
            Essential(sp.Integer(0), u, 0),
        ),
        orders={y: 1, u: 2, tension: 0},
    )


@cache
def pin_force(spec: ModelSpec) -> tuple[sp.Expr, sp.Expr]:
    """Return the force of the follower on the coupler at C, along and across BC (Smith 6.14).

    The rigid coupler and follower, joined at C by a constraint whose multipliers are the force.

    Returns ``along, across``: in the kinematic symbols of :func:`four_bar.kinematics`,
    ``theta2_rate`` and ``theta2_acceleration``; tension is positive.
    """
    without = dropped(spec)
    k = four_bar.kinematics()
    offset = sp.Integer(0) if "coupler" in spec.balanced else moment3
    turning = inertia3 / 2 * th3.diff(t) ** 2
    carried = offset * crank * th2.diff(t) * th3.diff(t) * sp.cos(th3 - th2)
    energy = sp.Integer(0)
    if "coupler_end_load" not in without:
        energy += turning + carried
    if "follower_end_load" not in without:
        energy += inertia4 / 2 * th4.diff(t) ** 2
    loop = [
        crank * trig(th2) + coupler * trig(th3) - follower * trig(th4) - at
        for trig, at in ((sp.cos, frame), (sp.sin, 0))
    ]
    motion = euler_lagrange(
        Lagrangian(
            coordinates=(th3, th4),
            t=t,
            expression=energy,
            constraints=tuple(loop),
            multipliers=(_FORCE_X, _FORCE_Y),
        )
    )
    along, across = sp.symbols("along across", real=True)
    q3, q4 = motion.coordinates
    axes = {
        _FORCE_X: along * sp.cos(q3) - across * sp.sin(q3),
        _FORCE_Y: along * sp.sin(q3) + across * sp.cos(q3),
    }
    accelerations = sp.Matrix(
        [k.a3 * rate**2 + k.w3 * acceleration, k.a4 * rate**2 + k.w4 * acceleration]
    )
    force = sp.Matrix([_FORCE_X, _FORCE_Y])
    sides = motion.mass * accelerations + motion.rest - motion.jacobian.T * force - motion.forces
    values = _relative_angles(k, q3, q4) | dict(
        zip(motion.velocities, (k.w3 * rate, k.w4 * rate), strict=True)
    )
    rows = [TR8(sp.expand(side.subs(axes))).expand().subs(values).doit() for side in sides]
    matrix, right = sp.linear_eq_to_matrix(rows, (along, across))
    solved = matrix.LUsolve(right)
    return sp.expand(solved[0]), sp.expand(solved[1])


def _relative_angles(
    k: four_bar.Kinematics, q3: sp.Symbol, q4: sp.Symbol
) -> dict[sp.Expr, sp.Expr]:
    """Return symbols for the functions of ``theta2 - theta3`` and ``theta4 - theta3``."""
    return {
        sp.sin(th2 - q3): SIN23,
        sp.sin(q3 - th2): -SIN23,
        sp.cos(th2 - q3): COS23,
        sp.sin(q3 - q4): -k.sine_transmission,
        sp.cos(q3 - q4): COSINE_TRANSMISSION,
        th2.diff(t, 2): acceleration,
        th2.diff(t): rate,
    }


def tension_in(equations: FieldEquations) -> sp.Expr:
    """Return the tension along the undeflected coupler: its natural condition at C and ``N_x``."""
    return undeflected_tension(equations, u, tension)


def discretise(spec: ModelSpec, equations: FieldEquations) -> StagedSystem:
    """Project the linear equation of transverse motion on sine modes, mode coupling included.

    The coordinates are ``Y_m / l3`` with ``y = sum Y_m sin(m pi x / l3)``; the arrays are divided
    by the modal mass ``mu l3^3 / 2``, so that M is the identity.
    """
    k = four_bar.kinematics()
    theta3 = sp.Symbol("theta3", real=True)
    motion = CrankMotion(theta2, rate, acceleration, {theta3: k.w3, k.w3: k.a3})
    linear = hamilton(quadratic_action(equations.action, {tension: tension_in(equations)}, (u,)))
    load, loads = _named_load(pin_force(spec)[0])
    followers = {th2: theta2, th3: theta3, end_load: load}
    system = project(linear, y, sine_basis(x, coupler), motion, followers=followers)
    mass = density * coupler**3 / 2
    difference = {
        sp.sin(theta2 - theta3): SIN23,
        sp.cos(theta2 - theta3): COS23,
        sp.sin(theta3 - theta2): -SIN23,
    }
    wanted = set(spec.outputs) or {"stability", "forcing"}
    arrays = {
        name: entry.map(lambda e: sp.expand(sp.expand(e).xreplace(difference) / mass))
        for name, entry in system.arrays.items()
        if name not in VECTORS or "forcing" in wanted
    }
    steps = k.steps.then(*loads)
    parameters = (stiffness, density, damping, inertia3, moment3, inertia4)
    geometry = (theta2, frame, crank, coupler, follower, four_bar.assembly)
    return StagedSystem(system.with_(arrays=arrays), steps, parameters, geometry)


def _named_load(load: sp.Expr) -> tuple[sp.Expr, tuple[tuple[sp.Symbol, sp.Expr], ...]]:
    """Name the functions of angle in the end load: one for each inertia and power of the rates."""
    total, steps = sp.Integer(0), []
    for inertia in (inertia3, moment3, inertia4):
        for factor, word in ((rate**2, "speed"), (acceleration, "acceleration")):
            value = sp.expand(load).coeff(inertia).coeff(factor)
            if value != 0:
                name = sp.Symbol(f"end_load_{inertia.name}_{word}", real=True)
                steps.append((name, sp.factor_terms(value)))
                total += inertia * factor * name
    return total, tuple(steps)


def _describe(spec: ModelSpec) -> Description:
    left_out = sorted(dropped(spec))
    notes = [
        "Coordinates are Y_m / l3 in y = sum Y_m sin(m pi x / l3); arrays are divided by the modal "
        "mass mu l3^3 / 2."
    ]
    if left_out:
        notes.append("Left out of the energies: " + ", ".join(left_out) + ".")
    references = {"complete": "Smith (6.6), corrected", "printed": "Smith (6.17)"}
    parameters = [
        Argument("bending_stiffness", "float", "N m^2", "EI of the coupler"),
        Argument("mass_per_length", "float", "kg/m", "mu of the coupler"),
        Argument("damping", "float", "N s/m^2", "Viscous damping of the coupler per length"),
        Argument("coupler_inertia", "float", "kg m^2", "I3 of the coupler about the crank pin B"),
        Argument("coupler_first_moment", "float", "kg m", "m3 r3 of the coupler about B"),
        Argument("follower_inertia", "float", "kg m^2", "I4 of the follower about D"),
    ]
    return Description(
        title=f"Flexible coupler of a four-bar linkage, {spec.formulation} equation",
        references=("Smith (6.14)", references.get(spec.formulation, "Smith (6.18)")),
        arguments=ARGUMENTS,
        parameters=tuple(parameters),
        notes=tuple(notes),
    )


MODEL = Model(
    mechanism="four_bar",
    formulations=tuple(DROPPED),
    energies=action,
    describe=_describe,
    discretise=discretise,
    closed_in_modes=True,
)
