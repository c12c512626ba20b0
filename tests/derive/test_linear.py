"""Linear periodic arrays read off equations of motion, against Lagrangians and by hand."""

from __future__ import annotations

import pytest
import sympy as sp
from elastolink.derive.arrays import CrankMotion, DiscreteSystem
from elastolink.derive.lagrange import NotRepresentable, euler_lagrange, quadratic_form
from elastolink.derive.linear import linear_periodic
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


def turning_mass() -> sp.Expr:
    """A mass on springs in a frame that turns about a point beside its rest position."""
    spin = turn.diff(t)
    energy = m / 2 * ((x.diff(t) - spin * y) ** 2 + (y.diff(t) + spin * (x + p)) ** 2)
    return energy - k / 2 * (x**2 + 3 * y**2) - load * sp.cos(turn) * x * y


def test_agrees_with_the_quadratic_form_of_the_lagrangian():
    """Two routes, with a mass matrix and a coupling that vary with the angle."""
    energy = turning_mass()
    energy += (
        m / 4 * sp.cos(turn) * x.diff(t) ** 2 + m * sp.sin(turn) * turn.diff(t) * x.diff(t) * y
    )
    forces = {x: -c * (x.diff(t) - y.diff(t)), y: p * sp.sin(turn)}
    one = second_order(linear_periodic(equations(energy, forces=forces), CRANK, followers=ANGLE))
    plain_forces = {item: force.subs(PLAIN) for item, force in forces.items()}
    other = second_order(quadratic_form(energy.subs(PLAIN), (x, y), CRANK, t, forces=plain_forces))
    for name, matrix in one.items():
        assert (matrix - other[name]).applyfunc(sp.expand) == sp.zeros(*matrix.shape), name


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
