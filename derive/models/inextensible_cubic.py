"""The inextensible coupler to third order in the amplitudes of its tangent's angle.

The energies of :mod:`.inextensible_coupler` up to fourth order in the amplitudes q_k, with closed
integrals along the coupler.  In axes along the chord from B to C the tangent has the angle
``sum q_k cos k pi s - chi``, with chi such that its mean lies along the chord; this mean is the
chord's length over the coupler's, ``1 + u``.  Chord and follower (or slider) stand as in the rigid
linkage whose coupler is as long as the chord; their places are expanded in u by differentiating
the closure of the loop.  So no constraints are left, and no coordinates but q_k.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import sympy as sp
from sympy.simplify.fu import TR6

from ..amplitudes import SMALL, Harmonics, composed, kept, product, tangent
from ..entries import ConstrainedSystem
from ..ir import Argument, Description
from ..lagrange import variational_equations
from ..pipeline import Model
from ..records import EquationsOfMotion, Lagrangian
from ..safe import UnsafeRewriting
from ..spec import Choices, ModelSpec
from ..staged import Step, Steps
from . import four_bar, slider_crank
from .beam_tangent_harmonics import integral
from .inextensible_coupler import (
    COUPLER,
    DAMPING,
    DENSITY,
    PIN,
    PULL,
    STIFFNESS,
    THETA,
    Driven,
    T,
    described,
    driven,
)

TURNED = sp.Function("theta3")(T)
# What acts at each mass of the coupler, along the straight coupler and across it: gravity less the
# acceleration of the pin B.
ALONG, ACROSS = (sp.Function(name)(T) for name in ("along", "across"))
_BOW = sp.Symbol("bow", real=True)


def by_u(coordinate: sp.Expr, times: int = 1) -> sp.Expr:
    """Return a coordinate's derivative by u as a function of time."""
    return sp.Function(f"{coordinate.func.__name__}_by_{'u' * times}")(T)


def _moved(coordinate: sp.Expr, u: sp.Expr) -> sp.Expr:
    """Return by how much a coordinate of the rigid linkage changes with the chord's length."""
    return u * by_u(coordinate) + product(u, u) * by_u(coordinate, 2) / 2


def _rate(function: sp.Expr) -> sp.Expr:
    return function.diff(T)


def _moment(values: Harmonics) -> sp.Expr:
    """Return ``int (1 - s) f ds``."""
    return sp.Add(*(value * integral("moment", n) for n, value in values.items()))


def _inertia(values: Harmonics) -> sp.Expr:
    """Return ``int (int f)^2 ds``."""
    mean = values.get(sp.S.Zero, sp.S.Zero)
    alone = (product(v, v) * integral("inertia", n) for n, v in values.items())
    beside = (2 * product(mean, v) * integral("beside_mean", n) for n, v in values.items() if n)
    return sp.Add(*alone, *beside)


def along_chord(angle: Harmonics) -> tuple[Harmonics, Harmonics]:
    """Return the tangent's components along the chord and across it."""
    cosine, sine = tangent(angle)
    chi = sine.get(sp.S.Zero, sp.S.Zero)
    numbers = {**cosine, **sine}
    along = {n: cosine.get(n, 0) + product(chi, sine.get(n, 0)) for n in numbers}
    across = {n: sine.get(n, 0) - product(chi, cosine.get(n, 0)) for n in numbers}
    if across[sp.S.Zero] != 0:
        raise UnsafeRewriting("the tangent has a mean across the chord")
    return along, across


def energies(end: Driven, angle: Harmonics) -> sp.Expr:
    """Return the Lagrangian without bending, in functions of time, but for total derivatives.

    ``angle``: harmonics of the angle of the coupler's tangent, without their mean.
    """
    along, across = along_chord(angle)
    u = along[sp.S.Zero] - 1
    turned, driven_by = _moved(TURNED, u), _moved(end.coordinate, u)
    turning = _rate(TURNED + turned)
    kinetic = _inertia({n: _rate(along[n]) - product(turning, across[n]) for n in along})
    kinetic += _inertia({n: _rate(across[n]) + product(turning, along[n]) for n in along})
    angle3 = sp.Dummy("theta3")
    pulls = (
        ALONG * sp.cos(angle3) + ACROSS * sp.sin(angle3),
        ACROSS * sp.cos(angle3) - ALONG * sp.sin(angle3),
    )
    acting = (composed(pull, {angle3: turned}).subs(angle3, 0) for pull in pulls)
    work = sp.Add(
        *(product(pull, _moment(v)) for pull, v in zip(acting, (along, across), strict=True))
    )
    coupler = DENSITY * COUPLER * (kinetic * COUPLER**2 / 2 + work * COUPLER)
    changes = {end.coordinate: driven_by, _rate(end.coordinate): _rate(driven_by)}
    return kept(coupler + composed(end.energy, changes))


def _amplitudes(spec: ModelSpec) -> dict[sp.Expr, sp.Expr]:
    return {sp.Integer(k): sp.Function(f"q{k}")(T) for k in range(1, (spec.modes or 1) + 1)}


def _energies(spec: ModelSpec) -> Lagrangian:
    q = _amplitudes(spec)
    unbent = energies(driven(spec.mechanism), {n: SMALL * angle for n, angle in q.items()})
    # A bow b sin(pi s) has the slope (pi b / l3) cos(pi s).
    bent = {n: angle - (sp.pi * _BOW / COUPLER if n == 1 else 0) for n, angle in q.items()}
    strain = sp.Add(*(integral("bending", n) * angle**2 / 2 for n, angle in bent.items()))
    drag = {angle: integral("inertia", n) * _rate(angle) for n, angle in q.items()}
    return Lagrangian(
        coordinates=tuple(q.values()),
        t=T,
        expression=(unbent - unbent.subs(SMALL, 0)).subs(SMALL, 1) - STIFFNESS / COUPLER * strain,
        forces={angle: -DAMPING * COUPLER**3 * force for angle, force in drag.items()},
    )


@dataclass(frozen=True)
class RigidLinkage:
    """The rigid linkage: its end, solved kinematics, and rates by the crank angle.

    ``rates``: coordinate to its first and second derivative; ``turned``: angles to others, all
    turned alike, under which the closure's derivatives by the chord read shortest; ``names``: sines
    and cosines to symbols.
    """

    end: Driven
    solved: four_bar.Kinematics | slider_crank.Kinematics
    rates: dict[sp.Expr, tuple[sp.Expr, sp.Expr]]
    turned: dict[sp.Expr, sp.Expr]
    names: dict[sp.Expr, sp.Symbol]


def rigid_linkage(mechanism: str) -> RigidLinkage:
    """Return the solved linkage whose coupler stays straight."""
    end = driven(mechanism)
    if mechanism == "slider_crank":
        s = slider_crank.kinematics()
        rates = {TURNED: (s.w3, s.a3), end.coordinate: (s.v4, s.a4)}
        names = {sp.sin(TURNED): s.sin3, sp.cos(TURNED): s.cos3}
        return RigidLinkage(end, s, rates, {}, names)
    k = four_bar.kinematics()
    rates, transmission = {TURNED: (k.w3, k.a3), end.coordinate: (k.w4, k.a4)}, sp.Dummy("gamma")
    names = {
        sp.sin(end.coordinate): k.sin4,
        sp.cos(end.coordinate): k.cos4,
        sp.sin(transmission): k.sine_transmission,
        sp.cos(transmission): k.cosine_transmission,
    }
    turned = {TURNED: sp.S.Zero, end.coordinate: transmission}
    return RigidLinkage(end, k, rates, turned, names)


_ORDERS = {"by_u": (1, 0), "by_u_speed": (1, 1), "by_u_bend": (1, 2), "by_uu": (2, 0)}


def closure_by_chord(linkage: RigidLinkage) -> Iterator[Step]:
    """Yield the derivatives of chord angle and driven coordinate by u and the crank angle.

    The closure of the loop, its coupler ``1 + u`` times as long, is differentiated by u and the
    crank angle at ``u = 0``, and solved for the highest derivatives.
    """
    a, u = sp.Dummy("crank_angle"), sp.Dummy("u")
    moving = {f: f.func(a, u) for f in linkage.rates}
    back = {g: f for f, g in moving.items()}
    chord = COUPLER * (1 + u)
    loop = [
        (PIN[axis] + chord * trig(TURNED) - linkage.end.place[axis]).xreplace({**moving, THETA: a})
        for axis, trig in ((0, sp.cos), (1, sp.sin))
    ]
    known = {
        moving[f].diff((a, i)): rates[i - 1] for f, rates in linkage.rates.items() for i in (1, 2)
    }
    for name, (by_u, by_a) in _ORDERS.items():
        wanted = {
            g.diff((u, by_u), (a, by_a)): sp.Symbol(f"{f.func.__name__}_{name}", real=True)
            for f, g in moving.items()
        }
        known |= wanted
        rows = [part.diff((u, by_u), (a, by_a)).xreplace(known).xreplace(back) for part in loop]
        rows = [row.subs(u, 0).subs(linkage.turned) for row in rows]
        matrix, right = sp.linear_eq_to_matrix(rows, list(wanted.values()))
        below = TR6(sp.expand(matrix.det()))
        for symbol, above in zip(wanted.values(), matrix.adjugate() * right, strict=True):
            solved = sp.cancel((TR6(sp.expand(above)) / below).xreplace(linkage.names))
            yield symbol, sp.factor_terms(solved)


def _in_time(linkage: RigidLinkage) -> tuple[dict[sp.Expr, sp.Expr], list[Step]]:
    """Return symbols for the functions of time in the equations, and the steps that define them."""
    k = linkage.solved
    steps = [*k.steps.steps, *closure_by_chord(linkage)]
    steps = [(symbol, value.subs(four_bar.theta2, THETA)) for symbol, value in steps]
    table: dict[sp.Expr, sp.Expr] = dict(linkage.names)
    rates = dict(linkage.rates)
    for f in linkage.rates:
        name = f.func.__name__
        once, speed, bend, twice = (sp.Symbol(f"{name}_{word}", real=True) for word in _ORDERS)
        table |= {by_u(f): once, by_u(f, 2): twice}
        rates[by_u(f)] = speed, bend
    for f, (speed, bend) in rates.items():
        first, second = (sp.Symbol(f"{f.func.__name__}_d{i}", real=True) for i in (1, 2))
        table |= {_rate(f): first, _rate(_rate(f)): second}
        steps.append((first, speed * _rate(THETA)))
        steps.append((second, bend * _rate(THETA) ** 2 + speed * _rate(_rate(THETA))))
    # Axes along the straight coupler and across it; the acceleration of B as seen in them.
    seen = sp.Function("theta23")(T)
    names = {sp.sin(seen): k.sin23, sp.cos(seen): k.cos23}
    names |= {seen.diff((T, i)): THETA.diff((T, i)) for i in (1, 2)}
    for f, pull, place in (
        (ALONG, PULL[0] * k.cos3 + PULL[1] * k.sin3, PIN[0]),
        (ACROSS, PULL[1] * k.cos3 - PULL[0] * k.sin3, PIN[1]),
    ):
        table[f] = sp.Symbol(f.func.__name__, real=True)
        acceleration = _rate(_rate(place.xreplace({THETA: seen}))).xreplace(names)
        steps.append((table[f], pull - acceleration))
    return table, steps


def _discretise(spec: ModelSpec, equations: EquationsOfMotion) -> ConstrainedSystem:
    """Name the coefficients of the polynomials in amplitudes and their rates."""
    table, steps = _in_time(rigid_linkage(spec.mechanism))
    variables = (*equations.coordinates, *equations.velocities)
    names: dict[sp.Expr, sp.Symbol] = {}

    def named(place: str, entry: sp.Expr) -> sp.Expr:
        total = sp.S.Zero
        for powers, value in sp.Poly(sp.expand(entry), *variables).terms():
            number, plain = sp.expand(value.xreplace(table)).as_content_primitive()
            factors = [v for v, n in zip(variables, powers, strict=True) for _ in range(n)]
            symbol = sp.Symbol("_".join([place, *(factor.name for factor in factors)]))
            total += sp.Mul(number, names.setdefault(plain, symbol), *factors)
        return total

    size = range(len(equations.coordinates))
    mass = [[named(f"mass{i + 1}{j + 1}", equations.mass[i, j]) for j in size] for i in size]
    rest = [named(f"rest{i + 1}", equations.rest[i]) for i in size]
    changed = replace(
        equations, mass=sp.ImmutableDenseMatrix(mass), rest=sp.ImmutableDenseMatrix(rest)
    )
    coefficients = ((symbol, sp.factor_terms(value)) for value, symbol in names.items())
    return ConstrainedSystem(
        changed, variational_equations(changed), steps=Steps((*steps, *coefficients))
    )


def _describe(spec: ModelSpec) -> Description:
    shape = "float or ndarray, shape (...)"
    amplitudes = [
        Argument(f.func.__name__, shape, "rad", f"Amplitude of cos({n} pi s)")
        for n, f in _amplitudes(spec).items()
    ]
    kinematics = slider_crank if spec.mechanism == "slider_crank" else four_bar
    found = described(spec.mechanism, "to third order in its amplitudes", amplitudes, shape)
    return replace(
        found,
        parameters=(
            *found.parameters,
            Argument("bow", "float", "m", "Deflection of the unloaded coupler's middle"),
            *(a for a in kinematics.ARGUMENTS if a.name == "assembly"),
        ),
        notes=(
            "Angle of the coupler's tangent: a mean and sum q_k cos(k pi s), s from 0 at the crank "
            "to 1.  Derivatives by_u are those by the chord's length over the coupler's.",
        ),
    )


def _model(mechanism: str) -> Model:
    return Model(
        mechanism=mechanism,
        formulations=("inextensible_cubic",),
        energies=_energies,
        describe=_describe,
        discretise=_discretise,
        choices=Choices(flexible=("coupler",)),
    )


FOUR_BAR = _model("four_bar")
SLIDER_CRANK = _model("slider_crank")
