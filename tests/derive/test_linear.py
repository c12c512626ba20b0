"""Linear periodic arrays read off equations of motion, against Lagrangians and by hand."""

from __future__ import annotations

import pytest
import sympy as sp
from elastolink.derive.arrays import CrankMotion, DiscreteSystem
from elastolink.derive.lagrange import (
    NotRepresentable,
    euler_lagrange,
    linear_periodic,
    quadratic_form,
)
from elastolink.derive.records import EquationsOfMotion, Lagrangian

t = sp.Symbol("t", real=True)
theta, td, tdd = sp.symbols("theta td tdd", real=True)
m, k, c, p, load = sp.symbols("m k c p load", positive=True)
CRANK = CrankMotion(theta, td, tdd)
x, y = (sp.Function(name)(t) for name in ("x", "y"))
turn = sp.Function("turn")(t)
ANGLE = {turn: theta}
PLAIN = {turn.diff(t): td, turn: theta}


def equations(energy: sp.Expr, coordinates=(x, y), forces=None) -> EquationsOfMotion:
    return euler_lagrange(Lagrangian(coordinates, t, energy, forces=forces or {}))


def second_order(system: DiscreteSystem) -> dict[str, sp.Matrix]:
    """M, C + td G, and everything that multiplies q, and the force."""
    slope = CRANK.derivative
    arrays = {name: system.matrix(name) for name in ("M", "A", "B", "S", "C", "K", "Kg")}
    gyro = arrays["M"].applyfunc(slope) + arrays["A"] - arrays["A"].T
    stiffness = arrays["K"] + arrays["Kg"]
    stiffness += td**2 * (arrays["A"].applyfunc(slope) - arrays["B"])
    stiffness += tdd * (arrays["A"] - arrays["S"])
    force = td**2 * system.matrix("f") + td * system.matrix("h") + tdd * system.matrix("g")
    return {
        "M": arrays["M"],
        "first": arrays["C"] + td * gyro,
        "zeroth": stiffness,
        "force": force + system.matrix("p"),
    }


def energy(th: sp.Expr, rate: sp.Expr, acceleration: sp.Expr) -> sp.Expr:
    """Every kind of term that the family has, its arrays varying with the angle."""
    xd, yd = x.diff(t), y.diff(t)
    kinetic = m / 2 * (2 + sp.cos(th)) * xd**2 + m * sp.sin(th) * xd * yd + 3 * m * yd**2
    gyro = rate * (sp.cos(th) * xd * y + 2 * sp.sin(2 * th) * yd * y + xd * x)
    frame = rate**2 * (sp.sin(th) * x**2 + x * y) + acceleration * sp.cos(th) * y**2
    linear = rate * sp.sin(th) * xd + rate**2 * sp.cos(th) * y + acceleration * p * x
    linear += sp.cos(3 * th) * yd + rate * load * y + p * sp.sin(th) * x
    return kinetic + gyro + frame + linear - k / 2 * (x - sp.cos(th) * y) ** 2


def test_equations_and_the_quadratic_lagrangian_give_the_same_arrays():
    """Two routes: read off the derived equations, and off the energy."""
    rate = turn.diff(t)
    forces = {x: -c * x.diff(t) + k * y * rate**2 + p, y: turn.diff(t, 2) * sp.sin(turn) * x}
    derived = equations(energy(turn, rate, turn.diff(t, 2)), forces=forces)
    one = second_order(linear_periodic(derived, CRANK, followers=ANGLE))
    plain = {turn.diff(t, 2): tdd, **PLAIN}
    plain_forces = {item: force.subs(plain) for item, force in forces.items()}
    found = quadratic_form(energy(theta, td, tdd), (x, y), CRANK, t, forces=plain_forces)
    for name, matrix in second_order(found).items():
        assert (matrix - one[name]).applyfunc(sp.expand) == sp.zeros(*matrix.shape), name


def test_constraints_are_refused():
    found = euler_lagrange(Lagrangian((x, y), t, m * x.diff(t) ** 2 / 2, (x - y,)))
    with pytest.raises(NotRepresentable, match="constrained"):
        linear_periodic(found, CRANK)


@pytest.mark.parametrize(
    ("term", "shown"),
    [
        (x**3, "x"),
        (td**3 * x, "td"),
        (x.diff(t) ** 2 * y, "x_dot"),
    ],
)
def test_what_has_no_place_is_refused(term, shown):
    with pytest.raises(NotRepresentable, match=shown):
        linear_periodic(equations(m / 2 * (x.diff(t) ** 2 + y.diff(t) ** 2) + term), CRANK)
