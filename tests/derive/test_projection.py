"""Galerkin projection: the action itself agrees, and hand cases come out."""

import pytest
import sympy as sp
from coupler_action import (
    CRANK,
    EI,
    PINNED,
    Fx,
    coupler,
    g,
    l2,
    l3,
    mu,
    reduced,
    t,
    td,
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
from elastolink.derive.lagrange import NotRepresentable, quadratic_form
from elastolink.derive.projection.assumed_modes import assumed_modes
from elastolink.derive.projection.bases import FiniteBasis, sine_basis
from elastolink.derive.projection.galerkin import mass_normalised, project
from elastolink.derive.records import ActionDensity, EndForce, Essential, PointTerm, Support
from elastolink.derive.variational import hamilton, in_crank_angle

c, tip, k, T = sp.symbols("c tip k T", positive=True)
push, load, gear = sp.symbols("push load gear")
place = sp.Function("s")(t)
FOLLOWERS = {th2: theta, th3: theta3, Fx: push * td**2 + load, place: -gear * sp.cos(theta)}


def expanded(action: ActionDensity, basis: FiniteBasis) -> DiscreteSystem:
    """Return the arrays by the other route: the expansion put into the action, and read off."""
    found = assumed_modes(action, {y: basis})

    def plain(expression):
        return in_crank_angle(expression, CRANK, t, FOLLOWERS)

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
        end_forces=(EndForce(l3, y, 1, load - c * y.diff(x, t)), EndForce(l3 / 4, y, 0, Fx)),
        essential=(Essential(0, y, 0), Essential(0, y, 1)),
        supports=(Support(l3 / 2, y, R),),
        dissipation=c / 3 * y.diff(t) ** 2 + k / 7 * y.diff(x, 2, t) ** 2,
    )


def travelling_string() -> ActionDensity:
    """A string whose speed is the rate of a place that follows the crank: A is not zero."""
    speed = place.diff(t)
    density = mu / 2 * (1 + x / l3) * (y.diff(t) + speed * y.diff(x)) ** 2
    return ActionDensity(x, t, l3, (y,), density - T / 2 * y.diff(x) ** 2, essential=PINNED)


TWO_SINES = FiniteBasis(x, l3, tuple(sp.sin(i * sp.pi * x / l3) for i in (1, 2)), l3)
POLYNOMIALS = FiniteBasis(x, l3, tuple(x ** (2 + i) * (x - l3 / 2) for i in range(2)))
# Bases of the strong form and of the expansion; that of the beam violates natural conditions.
CASES = {
    "coupler": (
        lambda: reduced(coupler(force_density={y: -c * y.diff(t)})),
        sine_basis(x, l3),
        TWO_SINES,
    ),
    "beam with everything": (beam_with_everything, POLYNOMIALS, POLYNOMIALS),
    "travelling string": (travelling_string, sine_basis(x, l3), TWO_SINES),
}


@pytest.mark.parametrize("name", CASES)
def test_two_routes_agree(name):
    """The strong form on a basis, and the expansion put into the action and read off."""
    make, basis, finite = CASES[name]
    action = make()
    strong = project(hamilton(action), y, basis, CRANK, followers=FOLLOWERS)
    weak = expanded(action, finite)
    one, other = second_order(strong, 2), second_order(weak, 2)
    for array in one:
        assert sp.simplify(one[array] - other[array]).is_zero_matrix, array
    if name == "travelling string":
        skew = strong.matrix("A", 3)
        assert sp.simplify(skew + skew.T).is_zero_matrix
        shape, slope = sp.sin(sp.pi * x / l3), sp.diff(sp.sin(2 * sp.pi * x / l3), x)
        by_hand = sp.integrate(mu * (1 + x / l3) * shape * slope, (x, 0, l3))
        assert sp.simplify(weak.matrix("A")[0, 1] - by_hand * gear * sp.sin(theta) * l3**2) == 0


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


def test_gravity_adds_a_load_and_a_tension_by_weight():
    """A change of the action alone moves tension, equation and arrays to a hand case."""
    plain, heavy = coupler(crank=0), coupler(crank=0, gravity=g)
    pull = -mu * g * (l3 - x) * sp.sin(th3)
    assert zero(tension(hamilton(heavy)) - tension(hamilton(plain)) - pull)
    loaded = hamilton(reduced(heavy))
    added = loaded.equations[y] - hamilton(reduced(plain)).equations[y]
    assert zero(added + mu * g * sp.cos(th3) - sp.diff(pull * y.diff(x), x))
    sines = sine_basis(x, l3, sp.S.One)
    system = project(loaded, y, sines, CRANK, followers=FOLLOWERS, geometric=(g,))
    assert sp.simplify(system.matrix("p", 1)[0] + 2 * mu * g * l3 * sp.cos(theta3) / sp.pi) == 0
    sag = system.matrix("Kg", 1)[0, 0]
    assert sp.simplify(sag + mu * g * sp.pi**2 * sp.sin(theta3) / 4) == 0
