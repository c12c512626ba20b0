"""A change of the Lagrangian alone moves equations, end conditions and matrices to a hand case."""

from __future__ import annotations

from dataclasses import dataclass, field

import mpmath
import pytest
import sympy as sp
from coupler_action import (
    CRANK,
    EI,
    PINNED,
    Fx,
    coupler,
    g,
    l3,
    mu,
    omega3,
    reduced,
    t,
    td,
    tdd,
    tension,
    th2,
    th3,
    theta,
    theta3,
    x,
    y,
    zero,
)
from elastolink.derive.arrays import DiscreteSystem
from elastolink.derive.lagrange import euler_lagrange, quadratic_form
from elastolink.derive.projection.bases import FiniteBasis, sine_basis
from elastolink.derive.projection.galerkin import mass_normalised, project
from elastolink.derive.records import ActionDensity, Essential, Lagrangian, PointTerm
from elastolink.derive.variational import hamilton

tip, k, a, beta = sp.symbols("tip k a beta", positive=True)
FOLLOWERS = {th2: theta, th3: theta3, Fx: sp.Symbol("F")}
TURNED = {**FOLLOWERS, Fx: 0, th3: theta}
CLAMPED = (Essential(0, y, 0), Essential(0, y, 1))
SINES = sine_basis(x, l3, sp.S.One)
UNIT = {mu: 1, EI: 1, l3: 1}


def clamped_polynomials(count: int) -> FiniteBasis:
    return FiniteBasis(x, l3, tuple((x / l3) ** (i + 2) for i in range(count)))


def beam(**changes: object) -> ActionDensity:
    density = mu / 2 * y.diff(t) ** 2 - EI / 2 * y.diff(x, 2) ** 2
    return ActionDensity(x, t, l3, (y,), density).with_(**changes)


# ---------------------------------------------------------------- beams at rest


@dataclass(frozen=True)
class Case:
    """Changes of a beam's action, and by hand what they add to what is derived from it."""

    changes: dict[str, object]
    essential: tuple[Essential, ...] = PINNED
    basis: object = SINES
    equation: sp.Expr = sp.S.Zero
    conditions: dict[int, sp.Expr] = field(default_factory=dict)  # at x = l3, by order
    jump: sp.Expr = sp.S.Zero  # force applied at x = a
    arrays: dict[str, sp.Matrix] = field(default_factory=dict)


def _growing_mass(i: int, j: int) -> sp.Expr:
    """Return ``int mu beta x/l3 sin sin dx``."""
    if i == j:
        return mu * l3 * beta / 4
    odd = 1 - (-1) ** (i + j)
    return -mu * l3 * beta * odd * sp.Rational(2 * i * j, (i**2 - j**2) ** 2) / sp.pi**2


TIP_MASS = (PointTerm(l3, tip / 2 * y.diff(t) ** 2),)
AT_A = sp.Matrix([sp.sin(i * sp.pi * a / l3) for i in (1, 2, 3)])
CASES = {
    "mass at the tip": Case(
        {"point_terms": TIP_MASS},
        CLAMPED,
        clamped_polynomials(3),
        conditions={0: -tip * y.diff(t, 2)},
        arrays={"M": tip * sp.ones(3, 3)},
    ),
    "spring at x = a": Case(
        {"point_terms": (PointTerm(a, -k / 2 * y**2),)},
        jump=-k * y,
        arrays={"K": k * AT_A * AT_A.T},
    ),
    "mass that grows along the beam": Case(
        {"density": beam().density + mu * beta * x / l3 / 2 * y.diff(t) ** 2},
        equation=-mu * beta * x / l3 * y.diff(t, 2),
        arrays={"M": sp.Matrix(3, 3, lambda i, j: _growing_mass(i + 1, j + 1))},
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_what_a_change_adds(name):
    case = CASES[name]
    before = hamilton(beam(essential=case.essential))
    after = hamilton(beam(essential=case.essential, **case.changes))
    assert zero(after.equations[y] - before.equations[y] - case.equation)
    for condition in before.natural:
        added = case.conditions.get(condition.order, 0) if condition.position == l3 else 0
        found = after.condition(condition.position, y, condition.order) - condition.expression
        assert zero(found - added)
    assert bool(after.jumps) == (case.jump != 0)
    for jump in after.jumps:
        applied = case.jump if jump.order == 0 else 0
        assert jump.position == a and zero(jump.applied - applied)
    one, other = (project(equations, y, case.basis, CRANK) for equations in (before, after))
    for array in ("M", "K"):
        added = case.arrays.get(array, sp.zeros(3, 3))
        difference = other.matrix(array, 3) - one.matrix(array, 3) - added
        assert difference.applyfunc(sp.simplify).is_zero_matrix, array


def frequencies(system: DiscreteSystem, values: dict[sp.Expr, float], spin: float = 0.0) -> list:
    """Natural frequencies [rad/s] of M and K + Kg - spin^2 B, in 40 digits, lowest first."""

    def number(name: str) -> mpmath.matrix:
        rows = system.matrix(name).subs(values).tolist()
        return mpmath.matrix([[mpmath.mpf(sp.N(entry, 40)) for entry in row] for row in rows])

    with mpmath.workdps(40):
        stiff = number("K") + number("Kg") - spin**2 * number("B")
        root = mpmath.inverse(mpmath.cholesky(number("M")))
        squares = mpmath.eigsy(root * stiff * root.T, eigvals_only=True)
        return sorted(mpmath.sqrt(value) for value in squares)


def test_tip_mass_frequencies_against_the_transcendental_equation():
    """1 + cos b cosh b + b (cos b sinh b - sin b cosh b) = 0, from the textbooks."""
    loaded = hamilton(beam(essential=CLAMPED, point_terms=TIP_MASS))
    system = project(loaded, y, clamped_polynomials(9), CRANK)
    found = frequencies(system, {**UNIT, tip: 1})

    def characteristic(b):
        bend = mpmath.cos(b) * mpmath.sinh(b) - mpmath.sin(b) * mpmath.cosh(b)
        return 1 + mpmath.cos(b) * mpmath.cosh(b) + b * bend

    for guess, frequency in zip((1.248, 4.031), found, strict=False):
        exact = mpmath.findroot(characteristic, guess) ** 2
        assert abs(frequency - exact) < 1e-6 * exact


# ---------------------------------------------------------------- rotation


def test_without_foreshortening_only_the_spin_softening_is_left():
    whole, kept = (
        mass_normalised(
            project(hamilton(reduced(one)), y, sine_basis(x, l3), CRANK, followers=FOLLOWERS)
        )
        for one in (coupler(), coupler(foreshortening=False))
    )
    assert sp.simplify(kept.matrix("B", 3) - omega3**2 * sp.eye(3)).is_zero_matrix
    assert not kept.has("S") and whole.has("S")
    load = sp.Symbol("F")
    assert whole.matrix("K", 3).has(load) and not kept.matrix("K", 3).has(load)
    assert kept.matrix("f", 3) == whole.matrix("f", 3)


@pytest.mark.parametrize(
    ("spin", "first"), [pytest.param(2, 4.1373, marks=pytest.mark.slow), (12, 13.1702)]
)
def test_rotating_cantilever_against_the_published_table(spin, first):
    """Flapping frequencies of Wright, Smith, Thresher and Wang (1982), given to 4 decimals."""
    flap, lag = (
        frequencies(
            project(
                hamilton(reduced(coupler(crank=0, essential=CLAMPED, out_of_plane=out))),
                y,
                clamped_polynomials(9),
                CRANK,
                followers=TURNED,
            ),
            UNIT,
            spin,
        )[0]
        for out in (True, False)
    )
    assert abs(flap - first) < 1e-4
    # in the plane of rotation the square is smaller by the square of the spin
    assert abs(lag**2 - (flap**2 - spin**2)) < 1e-12


def test_gravity_adds_a_load_and_a_tension_by_weight():
    plain, heavy = coupler(crank=0), coupler(crank=0, gravity=g)
    pull = -mu * g * (l3 - x) * sp.sin(th3)
    assert zero(tension(hamilton(heavy)) - tension(hamilton(plain)) - pull)
    loaded = hamilton(reduced(heavy))
    added = loaded.equations[y] - hamilton(reduced(plain)).equations[y]
    assert zero(added + mu * g * sp.cos(th3) - sp.diff(pull * y.diff(x), x))
    system = project(loaded, y, SINES, CRANK, followers=FOLLOWERS, geometric=(g,))
    assert sp.simplify(system.matrix("p", 1)[0] + 2 * mu * g * l3 * sp.cos(theta3) / sp.pi) == 0
    sag = system.matrix("Kg", 1)[0, 0]
    assert sp.simplify(sag + mu * g * sp.pi**2 * sp.sin(theta3) / 4) == 0


# ---------------------------------------------------------------- discrete systems


def test_a_shaken_pivot_becomes_a_mathieu_equation():
    """q'' + (g/l3 - td^2 cos(theta)/l3 ...) q = 0 for small angles, from the linear arrays."""
    angle = sp.Function("q")(t)
    lift = -sp.sin(theta) * td
    quadratic = tip / 2 * (l3**2 * angle.diff(t) ** 2 + 2 * l3 * lift * angle * angle.diff(t))
    system = quadratic_form(quadratic - tip * g * l3 * angle**2 / 2, (angle,), CRANK, t)
    array = {name: system.matrix(name)[0, 0] for name in ("M", "A", "B", "S", "K")}
    H = CRANK.derivative(array["A"]) - array["B"]
    E = array["A"] - array["S"]
    assert array["M"] == tip * l3**2
    assert sp.expand(H + tip * l3 * sp.cos(theta)) == 0
    assert sp.expand(E + tip * l3 * sp.sin(theta)) == 0
    assert array["K"] == tip * g * l3
    px, py = l3 * sp.sin(angle), sp.cos(th2) - l3 * sp.cos(angle)
    energy = tip / 2 * (px.diff(t) ** 2 + py.diff(t) ** 2) - tip * g * py
    full = euler_lagrange(Lagrangian((angle,), t, energy))
    (q,) = full.coordinates
    stiff = sp.diff(full.rest[0], q).subs(q, 0)
    rates = {th2.diff(t, 2): tdd, th2.diff(t): td, th2: theta}
    own = array["K"] + td**2 * H + tdd * E
    assert sp.simplify(stiff.subs(rates) - own) == 0
