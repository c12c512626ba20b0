"""Galerkin projection: the action itself agrees, and hand cases come out."""

from __future__ import annotations

import pytest
import sympy as sp
from coupler_action import EI, PINNED, Fx, N, coupler, l2, l3, mu, t, tension, th2, th3, u, x, y
from elastolink.derive.arrays import CrankMotion, DiscreteSystem
from elastolink.derive.lagrange import NotRepresentable, quadratic_form
from elastolink.derive.projection.assumed_modes import assumed_modes
from elastolink.derive.projection.bases import FiniteBasis, sine_basis
from elastolink.derive.projection.galerkin import mass_normalised, project
from elastolink.derive.records import ActionDensity, EndForce, Essential, PointTerm, Support
from elastolink.derive.variational import (
    hamilton,
    in_crank_angle,
    quadratic_action,
)

c, tip, k, T = sp.symbols("c tip k T", positive=True)
theta, theta3, omega3, alpha3, td, tdd = sp.symbols("theta theta3 omega3 alpha3 td tdd")
push, load = sp.symbols("push load")
CRANK = CrankMotion(theta, td, tdd, {theta3: omega3, omega3: alpha3})
FOLLOWERS = {th2: theta, th3: theta3, Fx: push * td**2 + load}


def reduced_coupler() -> ActionDensity:
    """Quadratic action of the rotating, translating pinned beam with end load and damping."""
    action = coupler(force_density={y: -c * y.diff(t)})
    force = tension(hamilton(action))
    return quadratic_action(action, {N: force}, (u,))


def expanded(action: ActionDensity, basis: FiniteBasis, followers=FOLLOWERS) -> DiscreteSystem:
    """Return the arrays by the other route: the expansion put into the action, and read off."""
    found = assumed_modes(action, {y: basis})

    def plain(expression):
        return in_crank_angle(expression, CRANK, t, followers)

    forces = {q: plain(force) for q, force in found.forces.items()}
    return quadratic_form(plain(found.expression), found.coordinates, CRANK, t, forces=forces)


def second_order(system: DiscreteSystem, modes: int) -> dict[str, sp.Matrix]:
    """Return what does not depend on the gauge of A: arrays of the second-order form."""
    arrays = {name: system.matrix(name, modes) for name in ("M", "A", "B", "S", "C", "D")}
    arrays |= {name: system.matrix(name, modes) for name in ("f", "h", "g", "p")}
    skew, slope = arrays.pop("A"), system.matrix("A", modes).applyfunc(CRANK.derivative)
    arrays["G"], arrays["S"] = skew - skew.T, skew - arrays["S"]
    arrays["B"] = slope - arrays["B"]
    arrays["K"] = system.matrix("K", modes) + system.matrix("Kg", modes)
    return arrays


def same(first: DiscreteSystem, second: DiscreteSystem, modes: int) -> bool:
    one, other = second_order(first, modes), second_order(second, modes)
    return all(sp.simplify(one[name] - other[name]).is_zero_matrix for name in one)


def test_a_finite_basis_gives_the_entries_of_the_indexed_one():
    action = reduced_coupler()
    shapes = tuple(sp.sin(i * sp.pi * x / l3) for i in (1, 2))
    basis = FiniteBasis(x, l3, shapes, l3)
    finite = project(hamilton(action), y, basis, CRANK, followers=FOLLOWERS)
    indexed = project(hamilton(action), y, sine_basis(x, l3), CRANK, followers=FOLLOWERS)
    assert finite.modes == 2
    assert finite.labels == ("q1", "q2")
    assert same(finite, indexed, 2)


def beam_with_everything() -> ActionDensity:
    """Clamped beam whose polynomial basis violates every natural condition."""
    R = sp.Symbol("R")
    return ActionDensity(
        x,
        t,
        l3,
        (y,),
        mu / 2 * (1 + x / l3) * y.diff(t) ** 2
        + mu / 7 * y.diff(x, t) ** 2
        - EI / 2 * (2 - x / l3) * y.diff(x, 2) ** 2,
        point_terms=(
            PointTerm(l3, tip / 2 * (y.diff(t) + l2 * th2.diff(t)) ** 2 - k / 2 * y.diff(x) ** 2),
            PointTerm(l3 / 3, tip / 3 * y.diff(t) ** 2 - k / 5 * y**2),
        ),
        force_density={y: -c * y.diff(t) + push * th2.diff(t) ** 2},
        end_forces=(
            EndForce(l3, y, 1, load - c * y.diff(x, t)),
            EndForce(l3 / 4, y, 0, Fx),
        ),
        essential=(Essential(0, y, 0), Essential(0, y, 1)),
        supports=(Support(l3 / 2, y, R),),
    )


def test_two_routes_agree_where_the_basis_violates_natural_conditions():
    action = beam_with_everything()
    half = l3 / 2
    shapes = tuple(x ** (2 + i) * (x - half) for i in range(2))
    basis = FiniteBasis(x, l3, shapes)
    strong = project(hamilton(action), y, basis, CRANK, followers=FOLLOWERS)
    assert same(strong, expanded(action, basis), 2)
    assert {"M", "C", "K", "f", "g", "p"} <= set(strong.arrays)


def test_two_routes_agree_for_a_travelling_string():
    """Coriolis terms: A is not zero, and follows the crank."""
    speed = sp.Function("v")(t)
    action = ActionDensity(
        x,
        t,
        l3,
        (y,),
        mu / 2 * (1 + x / l3) * (y.diff(t) + speed * y.diff(x)) ** 2 - T / 2 * y.diff(x) ** 2,
        essential=PINNED,
    )
    gear = sp.Symbol("gear") * sp.sin(theta)
    # the speed is the rate of a position that follows the crank
    position = sp.Function("s")(t)
    moved = action.with_(density=action.density.subs(speed, position.diff(t)))
    followers = {position: -sp.Symbol("gear") * sp.cos(theta)}
    strong = project(hamilton(moved), y, sine_basis(x, l3), CRANK, followers=followers)
    shapes = tuple(sp.sin(i * sp.pi * x / l3) for i in (1, 2))
    weak = expanded(moved, FiniteBasis(x, l3, shapes, l3), followers)
    assert same(strong, weak, 2)
    skew = strong.matrix("A", 3)
    assert sp.simplify(skew + skew.T).is_zero_matrix
    direct = weak.matrix("A")[0, 1]
    by_hand = sp.integrate(
        mu * (1 + x / l3) * sp.sin(sp.pi * x / l3) * sp.diff(sp.sin(2 * sp.pi * x / l3), x),
        (x, 0, l3),
    )
    assert sp.simplify(direct - by_hand * gear * l3**2) == 0


def test_basis_must_satisfy_essential_conditions():
    action = beam_with_everything()
    with pytest.raises(ValueError, match="does not vanish at l3/2"):
        project(hamilton(action), y, FiniteBasis(x, l3, (x**2,)), CRANK, followers=FOLLOWERS)
    with pytest.raises(ValueError, match="derivative 1"):
        project(hamilton(action), y, sine_basis(x, l3), CRANK, followers=FOLLOWERS)


def test_terms_outside_the_family_are_errors():
    basis = sine_basis(x, l3)
    base = mu / 2 * y.diff(t) ** 2
    for density in (base + sp.Symbol("td") ** 3 * y**2, base + sp.sqrt(td) * y):
        action = ActionDensity(x, t, l3, (y,), density, essential=PINNED)
        with pytest.raises(NotRepresentable):
            project(hamilton(action), y, basis, CRANK)
    cubic = ActionDensity(x, t, l3, (y,), base - k * y**4, essential=PINNED)
    with pytest.raises(ValueError, match="not linear"):
        project(hamilton(cubic), y, basis, CRANK)


def test_mass_normalisation_needs_equal_modal_masses():
    action = ActionDensity(x, t, l3, (y,), mu * x * y.diff(t) ** 2, essential=PINNED)
    system = project(hamilton(action), y, sine_basis(x, l3), CRANK)
    with pytest.raises(ValueError, match="not a multiple of the identity"):
        mass_normalised(system)
