"""The flexible rod of a quick-return mechanism, from its action to arrays on a moving basis.

The rod is pinned at D and slides through the block, which holds it at the distance ``slide`` on the
line DB; it bends to both sides of the block.  Deflections v are measured from that line, which
turns by phi(t).  Bending shortens the rod along the line, ``u_x + v_x^2/2 = 0``, and the multiplier
N of that constraint is the tension in the rod.

Terms that may be dropped, before anything is derived:

tension
    the tension's work on the deflection from Buckens' frame, the straight line that follows the
    rod best (mean deflection and mean moment of the deflection vanish);
frame
    the tension's work on the small rotation of that frame out of the line DB.

The two add up to the tension's whole work; without both the rod does not shorten at all, as in
Beale & Scott (16).
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ..arrays import CrankMotion, DiscreteSystem
from ..integrals import definite
from ..ir import Argument, Description
from ..jets import JetSpace, linear_jets, quadratic_jets
from ..pipeline import Model
from ..projection.moving_basis import Moments, MovingShapes, project_moving
from ..records import ActionDensity, Essential, FieldEquations, Support
from ..separation import StagedSystem
from ..spec import Choices, ModelSpec
from ..variational import hamilton, quadratic_action, undeflected_tension
from . import quick_return
from .quick_return import ARGUMENTS, crank, frame, theta2

TERMS = ("frame", "tension")

x, t = sp.symbols("x t", real=True)
eta, place, sliding, theta4 = sp.symbols("eta place sliding theta4", real=True)
rate, acceleration = sp.symbols("theta2_rate theta2_acceleration", real=True)
length, stiffness, density = sp.symbols("length bending_stiffness mass_per_length", positive=True)
damping, internal = sp.symbols("damping internal_damping", nonnegative=True)
reaction = sp.Symbol("block_force", real=True)
phi, block = (sp.Function(name)(t) for name in ("phi", "x1"))
v, u, tension = (sp.Function(name)(x, t) for name in ("v", "u", "N"))


def dropped(spec: ModelSpec) -> frozenset[str]:
    """Return the names of the terms that a spec leaves out.

    Raises ``ValueError`` if the spec names a term that does not exist.
    """
    unknown = sorted(set(spec.drop) - set(TERMS))
    if unknown:
        raise ValueError(f"unknown terms {unknown}; expected some of {TERMS}")
    return frozenset(spec.drop)


def action(spec: ModelSpec) -> ActionDensity:
    """Return the action of the rod, held at the pin and at the moving block.

    A point of the rod stands at ``(x + u) e1 + v e2`` from the pin, e1 along the line DB at the
    angle phi; x is measured along the undeflected rod.
    """
    taut = "tension" not in dropped(spec)
    along = x + u if taut else x
    position = sp.Matrix(
        [
            along * sp.cos(phi) - v * sp.sin(phi),
            along * sp.sin(phi) + v * sp.cos(phi),
        ]
    )
    velocity = position.diff(t)
    square = sp.expand(velocity.dot(velocity)).subs(sp.sin(phi) ** 2, 1 - sp.cos(phi) ** 2)
    kinetic = density / 2 * sp.expand(square)
    bending = stiffness / 2 * v.diff(x, 2) ** 2
    held = tension * (u.diff(x) + v.diff(x) ** 2 / 2) if taut else sp.Integer(0)
    pins = (Essential(sp.Integer(0), v, 0),)
    return ActionDensity(
        x=x,
        t=t,
        length=length,
        fields=(v, u, tension) if taut else (v,),
        density=sp.expand(kinetic) - bending - held,
        dissipation=damping / 2 * v.diff(t) ** 2 + internal / 2 * v.diff(x, 2, t) ** 2,
        essential=(*pins, Essential(sp.Integer(0), u, 0)) if taut else pins,
        supports=(Support(block, v, reaction),),
        orders={v: 1, u: 2, tension: 0} if taut else {v: 1},
    )


def tension_in(equations: FieldEquations) -> sp.Expr:
    """Return the tension in the undeflected rod, from its slope and the condition at the tip."""
    return undeflected_tension(equations, u, tension)


@dataclass(frozen=True)
class FloatingFrame:
    """Buckens' frame of the rod, by integrals of the deflection from the line DB.

    ``weights``: symbol to the power of x that weighs the deflection in the integral it stands for;
    ``rotation``, ``offset``: small angle of the frame from the line DB, and deflection of the pin
    from the frame.
    """

    weights: dict[sp.Symbol, sp.Expr]
    rotation: sp.Expr
    offset: sp.Expr


def buckens_frame() -> FloatingFrame:
    """Solve ``int u dx = int (x - L/2) u dx = 0`` for the frame, u the deflection from it."""
    turn, start, shape = sp.symbols("turn start shape", real=True)
    deflection = shape - x * turn + start
    weights, conditions = {}, []
    for test in (sp.Integer(1), x - length / 2):
        total = sp.Integer(0)
        for (power, held), coefficient in sp.Poly(deflection * test, x, shape).terms():
            if held:
                weights[_moment(power)] = x**power
                total += coefficient * _moment(power)
            else:
                total += definite(coefficient * x**power, x, sp.Integer(0), length)
        conditions.append(total)
    (solved,) = sp.linsolve(conditions, turn, start)
    return FloatingFrame(weights, *(sp.expand(value) for value in solved))


def frame_part(force: sp.Expr) -> Moments:
    """Return what the frame's rotation adds to the Lagrangian of the tension ``-N v_x^2/2``.

    ``force``: the tension N(x), which vanishes at the tip.
    """
    frame_ = buckens_frame()
    turn = sp.Symbol("turn", real=True)
    work = -force * v.diff(x) ** 2 / 2
    without = -force * (v.diff(x) - turn) ** 2 / 2
    quadratic, _ = quadratic_jets(sp.expand(work - without), v)
    coefficients, rest = linear_jets(sp.expand(work - without), v)
    if quadratic or set(coefficients) != {(1, 0)}:
        raise ValueError(f"{work - without} is not linear in the slope")
    # The slope is integrated by parts; the pin holds v, the tension ends at the tip.
    lowered, fluxes, _ = JetSpace([v]).parts(coefficients)
    if sp.expand(fluxes[0, 0].subs(x, length)) != 0:
        raise ValueError(f"the tension {force} does not vanish at the tip")
    total = definite(sp.expand(rest), x, sp.Integer(0), length)
    weights = dict(frame_.weights)
    for (power,), coefficient in sp.Poly(lowered, x).terms():
        symbol = _moment(power)
        weights[symbol] = x**power
        total += coefficient * symbol
    return Moments(sp.expand(total.subs(turn, frame_.rotation)), weights, "frame")


def _moment(power: int) -> sp.Symbol:
    return sp.Symbol(f"moment_{power}", real=True)


def quadratic(
    spec: ModelSpec, equations: FieldEquations
) -> tuple[ActionDensity, tuple[Moments, ...]]:
    """Return the action of small deflections, and the part of it that is made of integrals."""
    without = dropped(spec)
    given = equations.action
    if u in given.fields:
        force = tension_in(equations)
        given = quadratic_action(given, {tension: force}, (u,))
    if without in (frozenset(), frozenset(TERMS)):
        return given, ()
    whole = equations if u in equations.action.fields else hamilton(action(spec.with_(drop=())))
    part = frame_part(tension_in(whole))
    sign = 1 if "tension" in without else -1
    return given, (Moments(sign * part.expression, part.weights, part.name),)


def discretise(spec: ModelSpec, equations: FieldEquations) -> StagedSystem:
    """Project the action of small deflections on shapes that follow the block.

    The arrays are divided by m L^3, so that the mass matrix is the overlap of the shapes.
    """
    k = quick_return.kinematics()
    dropped = {}
    if not spec.drop:
        for terms in (*((term,) for term in TERMS), TERMS):
            left = spec.with_(drop=terms)
            dropped[left.drop] = _projected(left, hamilton(action(left)), k)
    return StagedSystem(
        _projected(spec, equations, k),
        k.steps.then((place, k.slide / length), (sliding, k.v3 / length)),
        (stiffness, density, damping, internal, length),
        (theta2, frame, crank, length),
        place=place,
        dropped=dropped,
    )


def _projected(
    spec: ModelSpec, equations: FieldEquations, k: quick_return.Kinematics
) -> DiscreteSystem:
    chain = {theta4: k.w4, k.w4: k.a4, place: sliding}
    given, moments = quadratic(spec, equations)
    system = project_moving(
        given,
        v,
        MovingShapes(length, place, eta),
        CrankMotion(theta2, rate, acceleration, chain),
        followers={phi: theta4, block: length * place},
        moments=moments,
    )
    mass = density * length**3
    arrays = {
        name: entry.map(lambda e: sp.expand(e / mass)) for name, entry in system.arrays.items()
    }
    return system.with_(arrays=arrays)


def _describe(spec: ModelSpec) -> Description:
    left_out = sorted(dropped(spec))
    notes = [
        "Coordinates are q_i in v = L sum q_i e_i(eta; xi), v the deflection from the line DB, "
        "eta = x/L, xi the place of the block; arrays are divided by m L^3.",
    ]
    if left_out:
        notes.append("Left out of the energies: " + ", ".join(left_out) + ".")
    return Description(
        title="Flexible rod of a quick-return mechanism, on shapes that follow the block",
        references=("Beale & Scott (1)-(4)", "Beale & Scott (16)", "Beale & Scott (18)"),
        arguments=(
            *ARGUMENTS,
            Argument("length", "float", "m", "Length of the rod from D to its tip"),
        ),
        parameters=(
            Argument("bending_stiffness", "float", "N m^2", "EI of the rod"),
            Argument("mass_per_length", "float", "kg/m", "m of the rod"),
            Argument("damping", "float", "N s/m^2", "Viscous damping of the rod per length"),
            Argument(
                "internal_damping",
                "float",
                "N m^2 s",
                "Moment per rate of curvature (Kelvin-Voigt)",
            ),
        ),
        notes=tuple(notes),
    )


MODEL = Model(
    mechanism="quick_return",
    formulations=("moving_basis",),
    energies=action,
    describe=_describe,
    discretise=discretise,
    closed_in_modes=True,
    choices=Choices(flexible=("rod",), drop=TERMS),
)
