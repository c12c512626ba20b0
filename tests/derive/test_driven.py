"""Mechanisms that a crank drives completely: motion and forces against other routes."""

import pytest
import sympy as sp
from elastolink.derive.arrays import CrankMotion
from elastolink.derive.driven import driven_motion
from elastolink.derive.lagrange import euler_lagrange
from elastolink.derive.records import Lagrangian

t = sp.Symbol("t", real=True)
theta, rate, acceleration = sp.symbols("theta rate acceleration", real=True)
th, x, y = (sp.Function(name)(t) for name in ("th", "x", "y"))
CRANK = CrankMotion(theta, rate, acceleration)
r, rod, m = sp.symbols("r rod m", positive=True)


def test_a_scotch_yoke_moves_and_pulls_as_a_cosine():
    """x = r cos th: force m x'' on the slider, whatever the crank does."""
    energy = m * x.diff(t) ** 2 / 2
    motion = driven_motion(
        euler_lagrange(Lagrangian((x,), t, energy, (x - r * sp.cos(th),))), th, CRANK
    )
    speed, bend = (motion.steps.inline(value) for value in sp.symbols("x_speed x_bend"))
    assert sp.simplify(speed + r * sp.sin(theta)) == 0
    assert sp.simplify(bend + r * sp.cos(theta)) == 0
    force = motion.steps.inline(motion.forces[0])
    expected = -m * r * (sp.cos(theta) * rate**2 + sp.sin(theta) * acceleration)
    assert sp.simplify(force - expected) == 0


def test_the_chain_differentiates_along_the_motion():
    equations = euler_lagrange(Lagrangian((x,), t, x.diff(t) ** 2, (x - r * sp.cos(th),)))
    crank = driven_motion(equations, th, CRANK).crank
    slope, bend, place = sp.symbols("x_speed x_bend x")
    assert crank.derivative(place**2) == 2 * place * slope
    assert crank.derivative(slope) == bend
    with pytest.raises(ValueError, match="x_bend"):
        crank.derivative(bend)


def test_a_mechanism_that_the_crank_does_not_fix_is_refused():
    equations = euler_lagrange(Lagrangian((x, y), t, x.diff(t) ** 2, (x - r * sp.cos(th),)))
    with pytest.raises(ValueError, match=r"1 constraints do not fix the coordinates \['x', 'y'\]"):
        driven_motion(equations, th, CRANK)
