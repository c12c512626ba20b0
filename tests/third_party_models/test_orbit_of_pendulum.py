"""Periodic orbits of a driven pendulum with multipliers, against its one angle."""

import numpy as np
import pytest
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.constrained import orbit_multipliers, periodic_orbit
from elastolink.runtime.core.errors import BadInput, SelfCheckFailed
from elastolink.runtime.core.families import Constrained
from pendulum_truth import NUMBERS, ROD, STROKE, drives
from scipy.integrate import solve_ivp

GRAVITY, DRIVE = NUMBERS["gravity"], 6.1
PERIOD = 2 * np.pi / DRIVE
DRIVES = drives(DRIVE)
START = [0.0, 0.0, -ROD], [STROKE * DRIVE, STROKE * DRIVE, 0.0]


@pytest.fixture(scope="module")
def pendulum(emit):
    found = emit("sliding_pendulum", ModelSpec("sliding_pendulum", "driven"))
    return Constrained.from_module(
        found.module, NUMBERS, external=DRIVES, provenance=found.provenance
    )


@pytest.fixture(scope="module")
def free(emit):
    found = emit("sliding_pendulum", ModelSpec("sliding_pendulum", "multiplier"))
    return Constrained.from_module(found.module, NUMBERS)


def beginning(orbit):
    """Return angle and angular speed of the rod at the start of an orbit."""
    angle = np.arctan2(orbit.q[0, 1] - orbit.q[0, 0], -orbit.q[0, 2])
    return angle, (orbit.qd[0, 1] - orbit.qd[0, 0]) / (ROD * np.cos(angle))


def squares_at_rest():
    """Return the squares of the natural frequencies of the pendulum on its spring."""
    # By hand: total s'' + bob rod a'' + spring s = 0,  s'' + rod a'' + gravity a = 0.
    bob, total = NUMBERS["bob"], NUMBERS["bob"] + NUMBERS["block"]
    mass = np.array([[total, bob * ROD], [1.0, ROD]])
    return np.linalg.eigvals(np.linalg.solve(mass, np.diag([NUMBERS["spring"], GRAVITY])))


def one_turn(angle, turning):
    """Follow angle and variations of the pendulum on a moving pivot for a period."""

    def rate(t, y):
        lift = -STROKE * DRIVE**2 * np.sin(DRIVE * t)
        push = -(GRAVITY * np.sin(y[0]) + lift * np.cos(y[0])) / ROD
        stiff = -(GRAVITY * np.cos(y[0]) - lift * np.sin(y[0])) / ROD
        return [y[1], push, y[3], stiff * y[2], y[5], stiff * y[4]]

    start = [angle, turning, 1.0, 0.0, 0.0, 1.0]
    run = solve_ivp(rate, (0.0, PERIOD), start, "DOP853", rtol=1e-13, atol=1e-14)
    end = run.y[:, -1]
    return end[:2], np.array([[end[2], end[4]], [end[3], end[5]]])


def test_orbit_and_multipliers_are_those_of_the_angle(pendulum):
    orbit = periodic_orbit(pendulum, PERIOD, *START)
    orbit.require()
    angle, turning = beginning(orbit)
    end, matrix = one_turn(angle, turning)
    np.testing.assert_allclose(end, [angle, turning], atol=1e-11)
    found = orbit_multipliers(orbit)
    found.require()
    exact = np.linalg.eigvals(matrix)
    gap = np.min(np.abs(found.physical[:, None] - exact), axis=1)
    assert np.max(gap) < 1e-11  # what is left of 1e-13 a step of the reference
    assert {"symplectic", "reciprocal pairs", "liouville"} <= set(found.checks)
    assert found.stable


def test_the_rod_upside_down_is_unstable(pendulum):
    t = np.arange(32) * (PERIOD / 32)
    place, speed = STROKE * np.sin(DRIVE * t), STROKE * DRIVE * np.cos(DRIVE * t)
    q = np.stack([place, place, np.full(32, ROD)], axis=1)
    orbit = periodic_orbit(pendulum, PERIOD, q, np.stack([speed, speed, 0 * t], axis=1))
    orbit.require()
    angle, turning = beginning(orbit)
    exact = np.sort(np.linalg.eigvals(one_turn(angle, turning)[1]).real)
    found = orbit_multipliers(orbit)
    found.require()
    np.testing.assert_allclose(np.sort(found.physical.real), exact, rtol=1e-10)
    assert not found.stable
    assert found.largest > 20.0


def test_a_period_that_the_drive_has_not_is_refused(pendulum):
    with pytest.raises(BadInput, match="repeats after the period"):
        periodic_orbit(pendulum, 0.5 * PERIOD, *START)
    # Twice the period is a period too.
    twice = orbit_multipliers(periodic_orbit(pendulum, 2 * PERIOD, *START))
    once = orbit_multipliers(periodic_orbit(pendulum, PERIOD, *START))
    np.testing.assert_allclose(
        np.sort_complex(twice.physical), np.sort_complex(once.physical**2), atol=1e-12
    )


def test_rest_has_the_multipliers_of_its_vibrations(free):
    period = 1.7
    orbit = periodic_orbit(free, period, [0.02, 0.1, -ROD], np.zeros(3))
    np.testing.assert_allclose(orbit.q, np.tile([0.0, 0.0, -ROD], (len(orbit.t), 1)), atol=1e-12)
    multipliers = orbit_multipliers(orbit)
    multipliers.require()
    squares = squares_at_rest()
    exact = np.exp(1j * np.sqrt(squares) * period)
    gap = np.abs(multipliers.physical[:, None] - np.concatenate([exact, exact.conj()]))
    assert multipliers.physical.shape == (4,)
    assert multipliers.others.shape == (2,)
    assert np.max(np.min(gap, axis=0)) < 1e-13


def test_where_a_multiplier_of_the_motion_is_one_nothing_is_called_stable(free):
    squares = squares_at_rest()
    # Of the rod at rest every small vibration of this period is periodic too.
    period = float(2 * np.pi / np.sqrt(np.min(squares.real)))
    orbit = periodic_orbit(free, period, [0.0, 0.0, -ROD], np.zeros(3))
    assert orbit.converged and not orbit.checks["accuracy"].passed
    multipliers = orbit_multipliers(orbit)
    assert not multipliers.stable
    assert multipliers.checks["orbit"] == orbit.checks["accuracy"]
    with pytest.raises(SelfCheckFailed, match="orbit"):
        multipliers.require()
    # About the same motion over another period they are known, and it is stable.
    aside = orbit_multipliers(periodic_orbit(free, 0.8 * period, [0.0, 0.0, -ROD], np.zeros(3)))
    aside.require()
    assert aside.stable
