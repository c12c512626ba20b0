"""Mechanisms that a crank drives completely: motion and forces against other routes."""

from __future__ import annotations

import numpy as np
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


def test_a_slider_crank_agrees_with_differences_of_its_closed_form():
    angle = sp.Function("angle")(t)
    energy = m * x.diff(t) ** 2 / 2
    loop = (
        r * sp.cos(th) + rod * sp.cos(angle) - x,
        r * sp.sin(th) + rod * sp.sin(angle),
    )
    motion = driven_motion(euler_lagrange(Lagrangian((angle, x), t, energy, loop)), th, CRANK)
    values = {r: 0.4, rod: 1.0, m: 2.0}
    crank = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
    lean = -np.arcsin(0.4 * np.sin(crank))
    slider = 0.4 * np.cos(crank) + np.cos(lean)
    wave = 1j * np.fft.fftfreq(64, 1.0 / 64.0)
    q = sp.Symbol("angle")
    found = {}
    for name in ("angle_speed", "angle_bend", "x_speed", "x_bend"):
        expression = motion.steps.inline(sp.Symbol(name)).subs(values)
        found[name] = sp.lambdify((theta, q), expression)(crank, lean)
    for name, series in (("angle", lean), ("x", slider)):
        spectrum = np.fft.fft(series)
        assert found[f"{name}_speed"] == pytest.approx(np.fft.ifft(wave * spectrum).real, abs=1e-9)
        bend = np.fft.ifft(wave**2 * spectrum).real
        assert found[f"{name}_bend"] == pytest.approx(bend, abs=1e-8)
    # The force along the guide accelerates the slider; the massless rod carries force along itself.
    steady = {rate: 3.0, acceleration: 0.0}
    forces = [
        sp.lambdify((theta, q), motion.steps.inline(f).subs(values).subs(steady))(crank, lean)
        for f in motion.forces
    ]
    assert forces[0] == pytest.approx(-2.0 * 9.0 * found["x_bend"], rel=1e-12)
    assert forces[1] == pytest.approx(forces[0] * np.tan(lean), abs=1e-10)


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
