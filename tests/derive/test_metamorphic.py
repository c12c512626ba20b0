"""A change of the Lagrangian alone moves equations, end conditions and matrices to a hand case."""

from __future__ import annotations

import itertools

import mpmath
import pytest
import sympy as sp
from coupler_action import zero
from elastolink.derive.arrays import CrankMotion, DiscreteSystem
from elastolink.derive.lagrange import euler_lagrange, quadratic_form
from elastolink.derive.projection.bases import FiniteBasis, sine_basis
from elastolink.derive.projection.galerkin import mass_normalised, project
from elastolink.derive.records import ActionDensity, EndForce, Essential, Lagrangian, PointTerm
from elastolink.derive.variational import (
    hamilton,
    order_part,
    quadratic_action,
    solve_end_value,
    solve_tension,
)

x, t = sp.symbols("x t")
L, mu, EI, tip, k, a, g, l2 = sp.symbols("L mu EI tip k a g l2", positive=True)
beta = sp.Symbol("beta")
theta, theta3, omega3, alpha3, td, tdd = sp.symbols("theta theta3 omega3 alpha3 td tdd")
y, u, N = (sp.Function(name)(x, t) for name in ("y", "u", "N"))
th2, th3, Fx = (sp.Function(name)(t) for name in ("th2", "th3", "Fx"))
CRANK = CrankMotion(theta, td, tdd, {theta3: omega3, omega3: alpha3})
FOLLOWERS = {th2: theta, th3: theta3, Fx: sp.Symbol("F")}
CLAMPED = (Essential(0, y, 0), Essential(0, y, 1))
PINNED = (Essential(0, y, 0), Essential(L, y, 0))
TURNED = {**FOLLOWERS, Fx: 0, th3: theta}


def beam(**changes: object) -> ActionDensity:
    density = mu / 2 * y.diff(t) ** 2 - EI / 2 * y.diff(x, 2) ** 2
    return ActionDensity(x, t, L, (y,), density).with_(**changes)


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


UNIT = {mu: 1, EI: 1, L: 1}


def clamped_polynomials(count: int) -> FiniteBasis:
    return FiniteBasis(x, L, tuple((x / L) ** (i + 2) for i in range(count)))


# ---------------------------------------------------------------- tip mass


def tip_massed() -> ActionDensity:
    return beam(essential=CLAMPED, point_terms=(PointTerm(L, tip / 2 * y.diff(t) ** 2),))


def test_tip_mass_changes_only_the_shear_condition_and_the_mass_matrix():
    plain, loaded = hamilton(beam(essential=CLAMPED)), hamilton(tip_massed())
    assert loaded.equations[y] == plain.equations[y]
    moved = loaded.condition(L, y, 0) - plain.condition(L, y, 0)
    assert zero(moved + tip * y.diff(t, 2))
    assert zero(loaded.condition(L, y, 1) - plain.condition(L, y, 1))
    basis = clamped_polynomials(3)
    before = project(plain, y, basis, CRANK)
    after = project(loaded, y, basis, CRANK)
    assert after.matrix("M") - before.matrix("M") == tip * sp.ones(3, 3)
    assert after.matrix("K") == before.matrix("K")
    assert before.matrix("M")[0, 1] == mu * L / 6
    assert before.matrix("K")[0, 1] == 6 * EI / L**3


def test_tip_mass_frequencies_against_the_transcendental_equation():
    """1 + cos b cosh b + b (cos b sinh b - sin b cosh b) = 0, from the textbooks."""
    system = project(hamilton(tip_massed()), y, clamped_polynomials(9), CRANK)
    found = frequencies(system, {**UNIT, tip: 1})

    def characteristic(b):
        bend = mpmath.cos(b) * mpmath.sinh(b) - mpmath.sin(b) * mpmath.cosh(b)
        return 1 + mpmath.cos(b) * mpmath.cosh(b) + b * bend

    for guess, frequency in zip((1.248, 4.031), found, strict=False):
        exact = mpmath.findroot(characteristic, guess) ** 2
        assert abs(frequency - exact) < 1e-6 * exact


# ---------------------------------------------------------------- spring at x = a


def test_spring_at_an_interior_point():
    sprung = beam(essential=PINNED, point_terms=(PointTerm(a, -k / 2 * y**2),))
    equations = hamilton(sprung)
    assert equations.equations[y] == hamilton(beam(essential=PINNED)).equations[y]
    shear = next(j for j in equations.jumps if j.order == 0)
    assert zero(shear.value - EI * y.diff(x, 3))
    assert zero(shear.applied + k * y)
    basis = sine_basis(x, L, sp.S.One)
    before = project(hamilton(beam(essential=PINNED)), y, basis, CRANK)
    after = project(equations, y, basis, CRANK)
    added = after.matrix("K", 3) - before.matrix("K", 3)
    shape = sp.Matrix([sp.sin(i * sp.pi * a / L) for i in (1, 2, 3)])
    assert sp.simplify(added - k * shape * shape.T).is_zero_matrix
    assert after.matrix("M", 3) == before.matrix("M", 3)
    odd = added.subs(a, L / 2)
    assert (odd[0, 0], odd[0, 1], odd[0, 2]) == (k, 0, -k)


# ---------------------------------------------------------------- varying mass per length


def test_varying_mass_per_length():
    linear = mu * (1 + beta * x / L)
    tapered = beam(
        essential=PINNED, density=linear / 2 * y.diff(t) ** 2 - EI / 2 * y.diff(x, 2) ** 2
    )
    equations = hamilton(tapered)
    assert zero(equations.equations[y] + linear * y.diff(t, 2) + EI * y.diff(x, 4))
    system = project(equations, y, sine_basis(x, L, sp.S.One), CRANK)
    mass = system.matrix("M", 3)
    for i, j in itertools.product((1, 2, 3), repeat=2):
        if i == j:
            by_hand = mu * L / 2 * (1 + beta / 2)
        else:
            odd = 1 - (-1) ** (i + j)
            by_hand = -mu * L * beta * odd * sp.Rational(2 * i * j, (i**2 - j**2) ** 2) / sp.pi**2
        assert sp.simplify(mass[i - 1, j - 1] - by_hand) == 0
    plain = project(hamilton(beam(essential=PINNED)), y, sine_basis(x, L, sp.S.One), CRANK)
    assert system.matrix("K", 3) == plain.matrix("K", 3)


# ---------------------------------------------------------------- rotation


def rotating(
    *,
    mass: sp.Expr = mu,
    foreshortening: bool = True,
    crank: bool = True,
    gravity: bool = False,
    tip_mass: sp.Expr = sp.S.Zero,
    essential: tuple[Essential, ...] = PINNED,
    out_of_plane: bool = False,
) -> tuple[sp.Expr, ActionDensity]:
    """Tension and quadratic action of a beam that turns with th3 and rides on a crank pin."""
    w2, w3 = (th2.diff(t) if crank else sp.S.Zero), th3.diff(t)
    along = l2 * w2 * sp.sin(th3 - th2) + u.diff(t)
    across = l2 * w2 * sp.cos(th3 - th2) + w3 * (x + u)
    if not out_of_plane:
        along, across = along - w3 * y, across + y.diff(t)
    kinetic = along**2 + across**2 + (y.diff(t) ** 2 if out_of_plane else 0)
    density = mass / 2 * kinetic - EI / 2 * y.diff(x, 2) ** 2
    if gravity:
        density -= mass * g * ((x + u) * sp.sin(th3) + y * sp.cos(th3))
    shortening = y.diff(x) ** 2 / 2 if foreshortening else 0
    density -= N * (u.diff(x) + shortening)
    at_end = (along**2 + across**2) * tip_mass / 2
    action = ActionDensity(
        x,
        t,
        L,
        (u, y, N),
        density,
        point_terms=(PointTerm(L, at_end),) if tip_mass != 0 else (),
        end_forces=(EndForce(L, u, 0, Fx),),
        essential=(Essential(0, u, 0), *essential),
        orders={u: 2, y: 1, N: 0},
    )
    equations = hamilton(action)
    end = order_part(equations.condition(L, u, 0), action.orders, 0)
    leading = order_part(equations.equations[u], action.orders, 0)
    force = solve_tension(leading, N, x, L, solve_end_value(end, N))
    return force, quadratic_action(action, {N: force}, (u,))


def test_without_foreshortening_only_the_spin_softening_is_left():
    _, full = rotating()
    _, none = rotating(foreshortening=False)
    basis = sine_basis(x, L)
    kept = mass_normalised(project(hamilton(none), y, basis, CRANK, followers=FOLLOWERS))
    whole = mass_normalised(project(hamilton(full), y, basis, CRANK, followers=FOLLOWERS))
    assert sp.simplify(kept.matrix("B", 3) - omega3**2 * sp.eye(3)).is_zero_matrix
    assert not kept.has("S")
    assert not kept.matrix("K", 3).has(sp.Symbol("F"))
    assert whole.has("S")
    assert whole.matrix("K", 3).has(sp.Symbol("F"))
    assert kept.matrix("f", 3) == whole.matrix("f", 3)
    y_equation = hamilton(none).equations[y]
    assert not y_equation.has(y.diff(x), y.diff(x, 2))


@pytest.mark.parametrize(
    ("spin", "first"), [pytest.param(2, 4.1373, marks=pytest.mark.slow), (12, 13.1702)]
)
def test_rotating_cantilever_against_the_published_table(spin, first):
    """Flapping frequencies of Wright, Smith, Thresher and Wang (1982), given to 4 decimals."""
    _, action = rotating(crank=False, essential=CLAMPED, out_of_plane=True)
    system = project(hamilton(action), y, clamped_polynomials(9), CRANK, followers=TURNED)
    flap = frequencies(system, UNIT, spin)[0]
    assert abs(flap - first) < 1e-4
    # in the plane of rotation the square is smaller by the square of the spin
    _, action = rotating(crank=False, essential=CLAMPED)
    system = project(hamilton(action), y, clamped_polynomials(9), CRANK, followers=TURNED)
    lag = frequencies(system, UNIT, spin)[0]
    assert abs(lag**2 - (flap**2 - spin**2)) < 1e-12


def test_gravity_adds_a_load_and_a_tension_by_weight():
    force, action = rotating(gravity=True, crank=False)
    plain_force, plain = rotating(crank=False)
    assert zero(force - plain_force + mu * g * (L - x) * sp.sin(th3))
    added = hamilton(action).equations[y] - hamilton(plain).equations[y]
    weight = -mu * g * sp.cos(th3) - sp.diff(mu * g * (L - x) * sp.sin(th3) * y.diff(x), x)
    assert zero(added - weight)
    options = {"followers": FOLLOWERS, "geometric": (g,)}
    system = project(hamilton(action), y, sine_basis(x, L, sp.S.One), CRANK, **options)
    assert sp.simplify(system.matrix("p", 1)[0] + 2 * mu * g * L * sp.cos(theta3) / sp.pi) == 0
    sag = system.matrix("Kg", 1)[0, 0]
    assert sp.simplify(sag + mu * g * sp.pi**2 * sp.sin(theta3) / 4) == 0


# ---------------------------------------------------------------- discrete systems


def pendulum(*, spring: bool = False, vibrating: bool = False) -> Lagrangian:
    angle = sp.Function("q")(t)
    lift = sp.cos(th2) if vibrating else sp.S.Zero
    px, py = L * sp.sin(angle), lift - L * sp.cos(angle)
    energy = tip / 2 * (px.diff(t) ** 2 + py.diff(t) ** 2) - tip * g * py
    return Lagrangian((angle,), t, energy - (k / 2 * angle**2 if spring else 0))


def test_a_shaken_pivot_becomes_a_mathieu_equation():
    """q'' + (g/L - td^2 cos(theta)/L ...) q = 0 for small angles, from the linear arrays."""
    angle = sp.Function("q")(t)
    lift = -sp.sin(theta) * td
    quadratic = tip / 2 * (L**2 * angle.diff(t) ** 2 + 2 * L * lift * angle * angle.diff(t))
    system = quadratic_form(quadratic - tip * g * L * angle**2 / 2, (angle,), CRANK, t)
    array = {name: system.matrix(name)[0, 0] for name in ("M", "A", "B", "S", "K")}
    H = CRANK.derivative(array["A"]) - array["B"]
    E = array["A"] - array["S"]
    assert array["M"] == tip * L**2
    assert sp.expand(H + tip * L * sp.cos(theta)) == 0
    assert sp.expand(E + tip * L * sp.sin(theta)) == 0
    assert array["K"] == tip * g * L
    full = euler_lagrange(pendulum(vibrating=True))
    (q,) = full.coordinates
    stiff = sp.diff(full.rest[0], q).subs(q, 0)
    rates = {th2.diff(t, 2): tdd, th2.diff(t): td, th2: theta}
    own = array["K"] + td**2 * H + tdd * E
    assert sp.simplify(stiff.subs(rates) - own) == 0
