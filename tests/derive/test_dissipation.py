"""Rayleigh's dissipation in an action, and drag that turns with a frame: arrays C and D."""

from __future__ import annotations

import sympy as sp
from elastolink.derive.arrays import CrankMotion
from elastolink.derive.lagrange import (
    euler_lagrange,
    linear_periodic,
    quadratic_form,
)
from elastolink.derive.projection.assumed_modes import assumed_modes
from elastolink.derive.projection.bases import FiniteBasis, sine_basis
from elastolink.derive.projection.galerkin import project
from elastolink.derive.records import ActionDensity, Essential, Lagrangian
from elastolink.derive.variational import hamilton

x, t = sp.symbols("x t", real=True)
theta, td, tdd = sp.symbols("theta td tdd", real=True)
L, c, inner, mass, EI = sp.symbols("L c c_i m EI", positive=True)
CRANK = CrankMotion(theta, td, tdd)
y = sp.Function("y")(x, t)
BEAM = ActionDensity(
    x=x,
    t=t,
    length=L,
    fields=(y,),
    density=mass / 2 * y.diff(t) ** 2 - EI / 2 * y.diff(x, 2) ** 2,
    essential=(Essential(sp.Integer(0), y, 0), Essential(L, y, 0)),
    dissipation=c / 2 * y.diff(t) ** 2 + inner / 2 * y.diff(x, 2, t) ** 2,
)


def test_two_routes_give_the_damping_of_a_beam():
    """Strong form, assumed modes: (c + c_i (m pi/L)^4) L/2 for sine modes."""
    by_hand = sp.diag(*((c + inner * (m * sp.pi / L) ** 4) * L / 2 for m in (1, 2, 3)))
    basis = sine_basis(x, L, sp.Integer(1))
    system = project(hamilton(BEAM), y, basis, CRANK)
    assert (system.matrix("C", 3) - by_hand).applyfunc(sp.simplify) == sp.zeros(3, 3)
    finite = FiniteBasis(x, L, tuple(sp.sin(m * sp.pi * x / L) for m in (1, 2, 3)))
    discrete = assumed_modes(BEAM, {y: finite})
    system = quadratic_form(
        discrete.expression, discrete.coordinates, CRANK, t, forces=discrete.forces
    )
    assert (system.matrix("C") - by_hand).applyfunc(sp.simplify) == sp.zeros(3, 3)


def test_a_clamp_that_dissipates_is_no_natural_condition():
    """Kelvin-Voigt bending: the end is free of the whole moment, the viscous part included."""
    moment = hamilton(BEAM).condition(L, y, 1)
    expected = -EI * y.diff(x, 2) - inner * y.diff(x, 2, t)
    assert sp.expand(moment - expected).doit() == 0


q1, q2, turn = (sp.Function(name)(t) for name in ("q1", "q2", "turn"))


def test_drag_of_what_stands_still_goes_to_c_and_d_in_turning_axes():
    spin = turn.diff(t)
    energy = mass / 2 * ((q1.diff(t) - spin * q2) ** 2 + (q2.diff(t) + spin * q1) ** 2)
    forces = {q1: -c * (q1.diff(t) - spin * q2), q2: -c * (q2.diff(t) + spin * q1)}
    equations = euler_lagrange(Lagrangian((q1, q2), t, energy, forces=forces))
    from_equations = linear_periodic(equations, CRANK, followers={turn: theta})
    plain = {turn.diff(t): td}
    from_energy = quadratic_form(
        energy.subs(plain), (q1, q2), CRANK, t, forces={k: v.subs(plain) for k, v in forces.items()}
    )
    for system in (from_equations, from_energy):
        assert system.matrix("C") == c * sp.eye(2)
        assert system.matrix("D") == c * sp.Matrix([[0, -1], [1, 0]])
