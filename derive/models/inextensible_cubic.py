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

from ..amplitudes import Expansion, Harmonics, added, composed, each, scaled, tangent
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
    driven,
    parameters,
)

TURNED = sp.Function("theta3")(T)
# What acts at each mass of the coupler, along the straight coupler and across it: gravity less the
# acceleration of the pin B.
ALONG, ACROSS = (sp.Function(name)(T) for name in ("along", "across"))
_BOW = sp.Symbol("bow", real=True)


def by_u(coordinate: sp.Expr, times: int = 1) -> sp.Expr:
    """Return a coordinate's derivative by u as a function of time."""
    return sp.Function(f"{coordinate.func.__name__}_by_{'u' * times}")(T)


def _moved(coordinate: sp.Expr, u: Expansion) -> Expansion:
    """Return by how much a coordinate of the rigid linkage changes with the chord's length."""
    return u * by_u(coordinate) + u * u * (by_u(coordinate, 2) / 2)


def _rate(part: sp.Expr) -> sp.Expr:
    return part.diff(T)


def _moment(values: Harmonics) -> Expansion:
    """Return ``int (1 - s) f ds``."""
    return Expansion.sum(value * integral("moment", n) for n, value in values.items())


def _inertia(values: Harmonics) -> Expansion:
    """Return ``int (int f)^2 ds``."""
    mean = values.get(sp.S.Zero, Expansion())
    found = [value * value * integral("inertia", n) for n, value in values.items()]
    found += [mean * v * (2 * integral("beside_mean", n)) for n, v in values.items() if n != 0]
    return Expansion.sum(found)


def along_chord(angle: Harmonics) -> tuple[Harmonics, Harmonics]:
    """Return the tangent's components along the chord and across it."""
    cosine, sine = tangent(angle)
    chi = sine.get(sp.S.Zero, Expansion())
    along = each(added(cosine, scaled(sine, chi)), sp.expand)
    across = each(added(sine, scaled(cosine, -chi)), sp.expand)
    if across.pop(sp.S.Zero, Expansion()).whole() != 0:
        raise UnsafeRewriting("the tangent has a mean across the chord")
    return along, across


def energies(end: Driven, angle: Harmonics) -> Expansion:
    """Return the Lagrangian without bending, in functions of time, but for total derivatives.

    ``angle``: harmonics of the angle of the coupler's tangent, without their mean.
    """
    along, across = along_chord(angle)
    u = along[sp.S.Zero] + Expansion((sp.S.NegativeOne,))
    turned, driven_by = _moved(TURNED, u), _moved(end.coordinate, u)
    turning = Expansion((_rate(TURNED),)) + turned.each(_rate)
    kinetic = _inertia(added(each(along, _rate), scaled(across, -turning)))
    kinetic += _inertia(added(each(across, _rate), scaled(along, turning)))
    angle3 = sp.Dummy("theta3")
    straight = {angle3: sp.S.Zero}
    work = Expansion()
    for pull, values in (
        (ALONG * sp.cos(angle3) + ACROSS * sp.sin(angle3), along),
        (ACROSS * sp.cos(angle3) - ALONG * sp.sin(angle3), across),
    ):
        acting = composed(pull, {angle3: turned}).each(lambda part: part.subs(straight))
        work += acting * _moment(values)
    changes = {end.coordinate: driven_by, _rate(end.coordinate): driven_by.each(_rate)}
    coupler = kinetic * (COUPLER**2 / 2) + work * COUPLER
    return coupler * (DENSITY * COUPLER) + composed(end.energy, changes)


def _amplitudes(spec: ModelSpec) -> dict[sp.Expr, sp.Expr]:
    return {sp.Integer(k): sp.Function(f"q{k}")(T) for k in range(1, (spec.modes or 1) + 1)}


def _energies(spec: ModelSpec) -> Lagrangian:
    q = _amplitudes(spec)
    unbent = energies(driven(spec.mechanism), {n: Expansion((sp.S.Zero, a)) for n, a in q.items()})
    # A bow b sin(pi s) has the slope (pi b / l3) cos(pi s).
    bent = {n: a - (sp.pi * _BOW / COUPLER if n == 1 else 0) for n, a in q.items()}
    strain = sp.Add(*(integral("bending", n) * angle**2 / 2 for n, angle in bent.items()))
    drag = {a: integral("inertia", n) * _rate(a) for n, a in q.items()}
    moving = replace(unbent, parts=(sp.S.Zero, *unbent.parts[1:]))
    return Lagrangian(
        coordinates=tuple(q.values()),
        t=T,
        expression=sp.expand(moving.whole() - STIFFNESS / COUPLER * strain),
        forces={a: -DAMPING * COUPLER**3 * force for a, force in drag.items()},
    )


@dataclass(frozen=True)
class RigidLinkage:
    """The rigid linkage: its end, solved kinematics, and rates by the crank angle.

    ``rates``: coordinate to its first and second derivative; ``turned``: angles to others, all
    turned alike, under which the closure's derivatives by the chord read shortest; ``names``: sines
    and cosines to symbols; ``circle``: the square of a cosine there to one less that of the sine.
    """

    end: Driven
    solved: four_bar.Kinematics | slider_crank.Kinematics
    rates: dict[sp.Expr, tuple[sp.Expr, sp.Expr]]
    turned: dict[sp.Expr, sp.Expr]
    names: dict[sp.Expr, sp.Symbol]
    circle: dict[sp.Expr, sp.Expr]


def rigid_linkage(mechanism: str) -> RigidLinkage:
    """Return the solved linkage whose coupler stays straight."""
    end = driven(mechanism)
    if mechanism == "slider_crank":
        s = slider_crank.kinematics()
        rates = {TURNED: (s.w3, s.a3), end.coordinate: (s.v4, s.a4)}
        names = {sp.sin(TURNED): s.sin3, sp.cos(TURNED): s.cos3}
        return RigidLinkage(end, s, rates, {}, names, {s.cos3**2: 1 - s.sin3**2})
    k = four_bar.kinematics()
    rates, transmission = {TURNED: (k.w3, k.a3), end.coordinate: (k.w4, k.a4)}, sp.Dummy("gamma")
    names = {
        sp.sin(end.coordinate): k.sin4,
        sp.cos(end.coordinate): k.cos4,
        sp.sin(transmission): k.sine_transmission,
        sp.cos(transmission): k.cosine_transmission,
    }
    turned = {TURNED: sp.S.Zero, end.coordinate: transmission}
    circle = {k.cosine_transmission**2: 1 - k.sine_transmission**2}
    return RigidLinkage(end, k, rates, turned, names, circle)


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
        rows = [row.subs(u, 0).subs(linkage.turned).xreplace(linkage.names) for row in rows]
        matrix, right = sp.linear_eq_to_matrix(rows, list(wanted.values()))
        for symbol, above in zip(wanted.values(), matrix.adjugate() * right, strict=True):
            above, below = (sp.expand(e).subs(linkage.circle) for e in (above, matrix.det()))
            yield symbol, sp.factor_terms(sp.cancel(sp.expand(above) / sp.expand(below)))


def _in_time(linkage: RigidLinkage) -> tuple[dict[sp.Expr, sp.Expr], list[Step]]:
    """Return symbols for the functions of time in the equations, and the steps that define them."""
    k = linkage.solved
    steps = [*k.steps.steps, *closure_by_chord(linkage)]
    steps = [(symbol, value.subs(four_bar.theta2, THETA)) for symbol, value in steps]
    table: dict[sp.Expr, sp.Expr] = dict(linkage.names)
    rates = dict(linkage.rates)
    for f in linkage.rates:
        name = f.func.__name__
        by_u, speed, bend, by_uu = (sp.Symbol(f"{name}_{word}", real=True) for word in _ORDERS)
        table |= {by_u(f): by_u, by_u(f, 2): by_uu}
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


class _Coefficients:
    """Names for the coefficients of polynomials in coordinates and velocities."""

    def __init__(self, table: dict[sp.Expr, sp.Expr], variables: tuple[sp.Symbol, ...]) -> None:
        self._table, self._variables = table, variables
        self._names: dict[sp.Expr, sp.Symbol] = {}

    @property
    def steps(self) -> list[Step]:
        """The coefficients."""
        return [(symbol, sp.factor_terms(value)) for value, symbol in self._names.items()]

    def named(self, name: str, matrix: sp.ImmutableDenseMatrix) -> sp.ImmutableDenseMatrix:
        """Return a matrix of polynomials with a symbol for each coefficient."""

        def entry(i: int, j: int) -> sp.Expr:
            terms = sp.Poly(sp.expand(matrix[i, j]), *self._variables).terms()
            place = f"{name}{i + 1}{j + 1 if matrix.cols > 1 else ''}"
            return sp.Add(*(self._term(place, powers, value) for powers, value in terms))

        return sp.ImmutableDenseMatrix(*matrix.shape, entry)

    def _term(self, place: str, powers: tuple[int, ...], value: sp.Expr) -> sp.Expr:
        number, plain = sp.expand(value.xreplace(self._table)).as_content_primitive()
        monomial = [v for v, n in zip(self._variables, powers, strict=True) for _ in range(n)]
        called = "_".join([place, *(variable.name for variable in monomial)])
        symbol = self._names.setdefault(plain, sp.Symbol(called))
        return sp.Mul(number, symbol, *monomial)


def _discretise(spec: ModelSpec, equations: EquationsOfMotion) -> ConstrainedSystem:
    table, steps = _in_time(rigid_linkage(spec.mechanism))
    coefficients = _Coefficients(table, (*equations.coordinates, *equations.velocities))
    named = replace(
        equations,
        mass=coefficients.named("mass", equations.mass),
        rest=coefficients.named("rest", equations.rest),
    )
    return ConstrainedSystem(
        named, variational_equations(named), steps=Steps((*steps, *coefficients.steps))
    )


def _describe(spec: ModelSpec) -> Description:
    shape = "float or ndarray, shape (...)"
    arguments = [
        Argument(f.func.__name__, shape, "rad", f"Amplitude of cos({n} pi s)")
        for n, f in _amplitudes(spec).items()
    ]
    arguments += [
        Argument("theta", shape, "rad", "Crank angle"),
        Argument("theta_d1", shape, "rad/s", "Crank speed"),
        Argument("theta_d2", shape, "rad/s^2", "Crank acceleration"),
    ]
    name = "slider-crank" if spec.mechanism == "slider_crank" else "four-bar linkage"
    kinematics = slider_crank if spec.mechanism == "slider_crank" else four_bar
    return Description(
        title=f"Inextensible flexible coupler of a {name}, to third order in its amplitudes",
        references=("Smith 9.6, further work 2",),
        arguments=tuple(arguments),
        parameters=(
            *parameters(spec.mechanism),
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
