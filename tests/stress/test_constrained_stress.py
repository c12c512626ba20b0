"""Constrained motion over thousands of revolutions, stiff, in any units: no drift, at any level."""

import elastolink as el
import free_free_loads
import mpmath
import numpy as np
import pytest
from constrained_truth import Circle, by_explicit_steps, unconstrained
from elastolink.runtime.core.errors import RedundantConstraints
from elastolink.runtime.systems import free_free_rod


def rod(modes: int = 1, crank_ratio: float = 0.01, speed: float = 2000.0):
    """The very flexible rod; on one mode fast enough for a smooth revolution."""
    return free_free_loads.rod(modes, crank_ratio, speed)


def norms(found):
    return max(np.max(found.position_norm), np.max(found.velocity_norm))


@pytest.mark.parametrize("revolutions", [40, pytest.param(2_000, marks=pytest.mark.slow)])
def test_the_rod_returns_after_each_revolution(revolutions):
    """From its periodic orbit, which is stable, it comes back to the start."""
    system = rod()
    orbit = el.periodic_orbit(system)
    assert el.orbit_multipliers(orbit).stable
    times = np.linspace(0.0, revolutions * system.period, 11)
    found = el.constrained_motion(
        system, orbit.q[0], orbit.qd[0], times[-1], samples=times[1:], rtol=1e-9, guards=()
    )
    assert found.success
    gaps = np.max(np.abs(found.q - orbit.q[0]), axis=0)
    assert np.all(gaps <= found.error)
    assert np.max(gaps) < 1e-7
    assert norms(found) < 2e-15


@pytest.mark.parametrize("turns", [40, pytest.param(1000, marks=pytest.mark.slow)])
def test_the_pendulum_turns_as_its_elliptic_function(turns):
    circle = Circle(gravity=1.0, start=20.0)
    rate = mpmath.mpf(20)
    period = float(4 * mpmath.ellipk(4 / rate**2) / rate)
    found = el.constrained_motion(
        circle.system, *circle.state, turns * period, rtol=1e-12, samples=100
    )
    found.require()
    assert norms(found) < 2e-15
    gap = np.max(np.abs(found.q - circle.exact(found.time)[0]), axis=0)
    assert np.all(gap <= found.error)
    # Some ten roundings a window of 2 pi rad, all one way: the phase goes with their sum.
    energy = circle.energy(found.q, found.qd, found.time)
    assert np.max(np.abs(energy / energy[0] - 1.0)) < 32 * found.steps * np.finfo(float).eps
    assert np.max(gap) < 1e-14 * turns**2


@pytest.mark.parametrize(("rtol", "start"), [(1e-6, 20.0), (1e-9, 1.9), (1e-9, 2.1)])
def test_windows_of_collocation_over_hundreds_of_turns(rtol, start):
    """Fast turns, and swings and turns that nearly stop at the top, which double errors often."""
    circle = Circle(gravity=1.0, start=start)
    span = 300 * 2 * np.pi / 20 if start == 20.0 else 50.0
    found = el.constrained_motion(circle.system, *circle.state, span, rtol=rtol, samples=40)
    found.require()
    q, _ = circle.exact(found.time)
    assert np.all(np.max(np.abs(found.q - q), axis=0) <= found.error)
    # The phase is off by a part of the tolerance in each window, and by no more.
    assert np.max(found.error) < 1e3 * found.steps * max(rtol, 1e-13)
    assert norms(found) < 2e-15


def test_a_stiff_relaxation_takes_few_windows():
    """Van der Pol's oscillator: explicit steps are bound to its fast decay, windows are not."""
    system = unconstrained(lambda q, qd: 50.0 * (1.0 - q**2) * qd - q)
    found = el.constrained_motion(system, [2.0], [0.0], 30.0, rtol=1e-8, samples=20)
    other, steps = by_explicit_steps(system, [2.0], [0.0], found.time, 1e-9)
    found.require()
    assert 20 * found.steps < steps
    assert np.max(np.abs(found.q - other)) <= found.error[0] + 1e-8


@pytest.mark.parametrize("scale", [1e-12, 1e-6, 1e6, 1e12])
def test_units_do_not_matter(scale):
    """Rows and coordinates of any size: the same motion to round-off."""
    power = float(np.exp2(np.round(np.log2(scale))))
    plain = Circle(gravity=10.0, start=3.0, mass=1.0)
    other = Circle(
        gravity=10.0, start=3.0, mass=power, row=1.0 / power, oblique=np.diag([1.0, power])
    )
    a = el.constrained_motion(plain.system, *plain.state, 1.0, samples=4)
    b = el.constrained_motion(other.system, *other.state, 1.0, samples=4)
    x = b.q @ other.oblique.T
    np.testing.assert_allclose(x, a.q, atol=1e-10)
    assert np.max(b.position_norm) < 1e-15


def test_a_hair_from_a_branching_point():
    """Near the centre the circle's row is short but has a direction; in it, it has none."""
    near = el.consistent_state(Circle().system, [1e-6, 0.0], [0.0, 1.0])
    np.testing.assert_allclose(np.hypot(*near.q), 1.0, rtol=1e-14)
    with pytest.raises(RedundantConstraints):
        el.consistent_state(Circle().system, [0.0, 0.0], [0.0, 1.0])


@pytest.mark.slow
def test_a_motion_whose_steps_collapse_is_given_up():
    """The block all but passes the rod's pivot: the rod is struck a million times as fast."""
    long = {**free_free_loads.ROD, "length": 1.3}
    found = el.constrained_motion(free_free_rod(2, crank_ratio=0.999999, speed=20.0, **long))
    assert found.status == 2 and "steps away" in found.message
    assert 0.15 < found.time[-1] < 0.158 and np.all(np.isfinite(found.q))
