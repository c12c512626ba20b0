"""A continuum of several fields on shape functions, against hand results and the projection."""

import pytest
import sympy as sp
from elastolink.derive import authoring as au

x, t = sp.symbols("x t", real=True)
length, mu, ea, ei, c, tip, push = sp.symbols("length mu EA EI c tip push", positive=True)
theta, td, tdd = sp.symbols("theta td tdd", real=True)
CRANK = au.CrankMotion(theta, td, tdd)
u, v = (sp.Function(name)(x, t) for name in ("u", "v"))
spin = sp.Function("turn")(t).diff(t)
BASES = {u: au.FiniteBasis(x, length, (x,)), v: au.FiniteBasis(x, length, (x**2,))}


def arm(**changes: object) -> au.ActionDensity:
    """A turning arm that stretches (u) and bends (v), with a mass and a force at its tip."""
    kinetic = (u.diff(t) - spin * v) ** 2 + (v.diff(t) + spin * (x + u)) ** 2
    elastic = ea * u.diff(x) ** 2 + ei * v.diff(x, 2) ** 2
    values = {
        "density": mu / 2 * kinetic - elastic / 2,
        "point_terms": (au.PointTerm(length, tip / 2 * kinetic),),
        "force_density": {v: -c * v.diff(t)},
        "end_forces": (au.EndForce(length, v, 0, push),),
        "essential": (au.Essential(0, u, 0), au.Essential(0, v, 0), au.Essential(0, v, 1)),
        **changes,
    }
    return au.ActionDensity(x, t, length, (u, v), **values)


def arrays(action: au.ActionDensity, bases: dict) -> au.DiscreteSystem:
    lagrangian = au.assumed_modes(action, bases)
    energy = au.in_crank_angle(lagrangian.expression, CRANK, t, {sp.Function("turn")(t): theta})
    return au.quadratic_form(energy, lagrangian.coordinates, CRANK, t, forces=lagrangian.forces)


def test_turning_arm_by_hand():
    found = arrays(arm(), BASES)
    assert found.labels == ("u1", "v1")
    mass = sp.diag(mu * length**3 / 3 + tip * length**2, mu * length**5 / 5 + tip * length**4)
    coupling = mu * length**4 / 4 + tip * length**3
    assert found.matrix("M") == mass
    assert found.matrix("K") == sp.diag(ea * length, 4 * ei * length)
    assert found.matrix("B") == mass
    assert found.matrix("A") == coupling * sp.Matrix([[0, -1], [1, 0]])
    assert found.matrix("C") == sp.diag(0, c * length**5 / 5)
    assert found.matrix("f") == sp.Matrix([mu * length**3 / 3 + tip * length**2, 0])
    assert found.matrix("g") == sp.Matrix([0, -coupling])
    assert found.matrix("p") == sp.Matrix([0, push * length**2])


def test_bases_that_do_not_fit_are_refused():
    with pytest.raises(ValueError, match=r"no basis for the fields \['v\(x, t\)'\]"):
        au.assumed_modes(arm(), {u: BASES[u]})
    loose = au.FiniteBasis(x, length, (x, x**2))
    with pytest.raises(ValueError, match=r"x of v does not vanish at 0 \(derivative 1\)"):
        au.assumed_modes(arm(), {u: BASES[u], v: loose})


def test_fields_that_share_their_coordinates():
    """A beam that shears: the deflection x^2 and the rotation x go with one coordinate."""
    psi = sp.Function("psi")(x, t)
    ga = sp.Symbol("GA", positive=True)
    strain = ei * psi.diff(x) ** 2 + ga * (v.diff(x) - psi) ** 2
    action = au.ActionDensity(x, t, length, (v, psi), mu / 2 * v.diff(t) ** 2 - strain / 2)
    q = sp.Function("q")(t)
    found = au.assumed_shapes(action, (q,), {v: (x**2,), psi: (x,)}).expression
    # By hand: int x^4 dx, int 1 dx, int (2x - x)^2 dx.
    kinetic, stored = mu * length**5 / 10 * q.diff(t) ** 2, (ei * length + ga * length**3 / 3) / 2
    assert sp.expand(found - kinetic + stored * q**2) == 0
    with pytest.raises(ValueError, match="1 shapes of psi"):
        au.assumed_shapes(action, (q, q), {v: (x**2, x**3), psi: (x,)})
