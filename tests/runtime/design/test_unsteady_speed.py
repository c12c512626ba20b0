"""Motion while the crank speed changes: profiles, and marching against an independent equation."""

from functools import cache

import numpy as np
import pytest
from elastolink import BadInput, load_scene, steady_state
from elastolink.runtime.core.trigonometric import interpolated
from elastolink.runtime.design import SpeedProfile, run_through
from elastolink.runtime.design.transient import (
    ChangingLength,
    Drive,
    arrays_of,
    generator_of,
    march,
)
from periodic_systems import second_order, system_of, wave
from scipy.integrate import solve_ivp

STIFFNESS = np.array([[30.0, -8.0], [-8.0, 50.0]])
RIG = "smith_1972_5152_sixteenth_inch"
LONGER = {"frame": (0.58, 0.547)}


def summed(constant, cosine, sine=0.0):
    """Return the parts of an array: c0 + c1 cos + c2 sin of the crank angle."""
    parts = (np.broadcast_to(part, np.shape(constant)) for part in (cosine, sine))
    return [np.array(constant), *map(wave, parts, (1, 1), (0.0, -np.pi / 2))]


SYSTEM = system_of(
    M=summed([[2, 0.3], [0.3, 1]], [[0.3, 0.1], [0.1, 0]], [[0, 0.2], [0.2, 0.1]]),
    A=summed([[0.1, 0.4], [-0.2, 0.0]], [[0, 0.3], [0.1, 0]]),
    B=summed([[0.5, 0.1], [0.1, 0.3]], [[0.1, 0], [0, 0.2]]),
    S=summed([[0.2, 0.05], [0.05, 0.1]], 0.0, [[0.1, 0], [0, 0]]),
    K=STIFFNESS,
    C=np.array([[0.3, 0.1], [0.1, 0.2]]),
    D=np.array([[0.05, 0.0], [0.02, 0.04]]),
    Kg=(None, 0.1 * STIFFNESS, 2),
    f=summed([1.0, 0.2], [0.3, -0.4], [0.1, 0.6]),
    g=summed([0.3, -0.2], [0.2, 0.1], [0.0, 0.5]),
)
START = np.array([0.05, -0.02, 0.1, 0.03])
TABLE = "aannaque_1996_table_4_1"
PROFILE = SpeedProfile(times=(0.0, 1.0, 2.5, 4.0), speeds=(0.5, 3.0, 2.0, 4.0))


def by_second_order(time):
    """Integrate the family's second-order equation by SciPy."""

    def slope(t, y):
        at = np.array([t])
        drive = PROFILE.speed(at), PROFILE.acceleration(at)
        parts = second_order(SYSTEM, PROFILE.angle(at), *drive)
        stiffness, damping, mass, force = (part[0] for part in parts)
        rest = force - damping @ y[2:] - stiffness @ y[:2]
        return np.concatenate([y[2:], np.linalg.solve(mass, rest)])

    return solve_ivp(slope, (0, 4), START, "DOP853", rtol=1e-12, atol=1e-14, t_eval=time).y.T


def marched(steps, stages):
    def generator(time):
        drive = Drive.of(PROFILE, time)
        return generator_of(arrays_of(SYSTEM, drive), drive)

    drive = Drive.of(PROFILE, np.zeros(1))
    arrays = arrays_of(SYSTEM, drive)
    momentum = arrays["M"][0] @ START[2:] + drive.speed[0] * arrays["A"][0] @ START[:2]
    time = np.linspace(0.0, 4.0, steps + 1)
    return time, march(generator, time, np.concatenate([START[:2], momentum, [1.0]]), stages)


def test_marching_solves_the_second_order_equation_with_order_six():
    # DOP853 at 1e-12; steps end where the profile's cubics meet: 4, 2.5 and 1 s are halves.
    time, states = marched(128, 3)
    truth = by_second_order(time)
    gap = np.abs(states[:, :2] - truth[:, :2])
    assert np.max(gap) < 2e-7 * np.max(np.abs(truth))
    errors = [np.max(np.abs(marched(n, 3)[1][-1, :2] - truth[-1, :2])) for n in (32, 64)]
    slopes = -np.diff(np.log2([*errors, np.max(gap[-1])]))
    assert np.all(slopes > 5.5), (slopes, errors)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"times": (0.0, 0.0), "speeds": (1.0, 2.0)}, "increasing times"),
        ({"times": (0.0, 1.0), "speeds": (1.0, -2.0)}, "speeds from 0"),
        ({"times": (0.0, 1.0), "speeds": (1.0,)}, "2 finite numbers or more"),
        ({"times": (0.0, 1.0), "speeds": (1.0, np.nan)}, "finite numbers"),
        ({"times": (0.0, 1.0, 2.0), "speeds": (1.0, 2.0)}, "as many as times"),
        ({"times": ("a", "b"), "speeds": (1.0, 2.0)}, "2 finite numbers or more"),
    ],
)
def test_impossible_profiles_are_refused(values, words):
    with pytest.raises(BadInput, match=words):
        SpeedProfile(**values)


@cache
def system(**more):
    return load_scene(TABLE, overrides={"mesh.elements": 1, **more}).system()


@pytest.mark.parametrize(
    ("geometry", "given", "words"),
    [
        (LONGER, {}, "None where a length changes"),
        (LONGER, {"system": load_scene(RIG).system()}, "no linkage of beams"),
        ({"crank": (0.17, 0.16)}, {"modes": None}, "the length of a beam"),
        ({}, {"profile": "fast"}, "a SpeedProfile"),
        ({}, {"stations": 0}, "stations"),
    ],
)
def test_what_cannot_be_run_through_is_refused(geometry, given, words):
    profile = SpeedProfile(times=(0.0, 0.1), speeds=(20.0, 22.0), geometry=geometry)
    given = {"system": system(), "profile": profile, **given}
    with pytest.raises(BadInput, match=words):
        run_through(given.pop("system"), given.pop("profile"), **given)


def test_at_constant_speed_the_steady_motion_stays():
    profile = SpeedProfile(times=(0.0, 0.1), speeds=(20.0, 20.0))
    found = run_through(system(), profile, modes=None, rtol=1e-3)
    steady = steady_state(system(), 20.0, method="harmonic_balance")
    expected = interpolated(steady.q, steady.period)(found.angle)
    peak = np.max(np.abs(expected), axis=0)
    assert np.max(np.abs(found.q - expected) / peak) < 1e-3
    assert found.passed


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::elastolink.LinearRangeWarning")
def test_fast_run_ups_stress_less_than_steady_running_at_a_critical_speed():
    # The fifth part of the first mean frequency, 36.8 rad/s, with one element per link.
    slow = run_through(system(), SpeedProfile.ramp(34.0, 39.0, 2.0))
    fast = run_through(system(), SpeedProfile.ramp(34.0, 39.0, 0.4))
    assert slow.checks["converged"].passed and fast.checks["converged"].passed
    assert fast.largest["follower"] < slow.largest["follower"]


@pytest.mark.slow
def test_the_length_at_the_end_is_the_one_that_acts():
    # After the length has come to rest the motion tends to the steady one of that length.
    damped = system(**{"damping.ratio": 0.3})
    profile = SpeedProfile(
        times=(0.0, 0.3, 1.2), speeds=(20.0, 20.0, 20.0), geometry={"frame": (0.6, 0.547, 0.547)}
    )
    found = run_through(damped, profile, modes=None, rtol=0.02)
    steady = steady_state(damped, 20.0, method="harmonic_balance")
    assert found.passed
    late = found.time > 0.9
    expected = interpolated(steady.q, steady.period)(found.angle[late])
    peak = np.max(np.abs(steady.q), axis=0)
    # With 30 % of damping what the change left has gone down by exp(-0.3 * 184 * 0.6).
    assert np.max(np.abs(found.q[late] - expected) / peak) < 5e-3


def test_a_length_is_taken_at_as_many_levels_as_it_needs():
    # With 17 levels, one doubling of the nine, the error is 3.4 of what is asked.
    profile = SpeedProfile(times=(0.0, 0.02), speeds=(20.0, 20.0), geometry={"frame": (0.66, 0.5)})
    found = run_through(system(), profile, modes=None, rtol=1e-3, start="rest")
    assert found.checks["converged"].passed
    looser = run_through(system(), profile, modes=None, rtol=2e-2, start="rest")
    gap = np.abs(np.array(list(looser.largest.values())) / list(found.largest.values()) - 1.0)
    assert np.all(gap <= looser.error + found.error)


def test_a_changing_length_is_that_of_its_time():
    # Between the levels, against the structure made there: arrays, directions and deflections.
    profile = SpeedProfile(times=(0.0, 0.4), speeds=(20.0, 20.0), geometry={"frame": (0.62, 0.547)})
    changing = ChangingLength(system(), profile, "frame", 17)
    for when in (0.013, 0.2, 0.311):
        time = np.array([when])
        there = system().with_geometry(frame=float(profile.lengths("frame", time)[0]))
        drive = Drive.of(profile, time)
        found, expected = changing.arrays(drive, time), arrays_of(there, drive)
        assert set(found) == set(expected)
        for name, value in expected.items():
            # The stiffness along a link is 1e5 of that across: 1e-8 of it is 0.1 %.
            share = 2e-8 if name == "K" else 2e-6
            np.testing.assert_allclose(found[name], value, atol=share * np.max(np.abs(value)))
        squares = [
            np.sort(np.linalg.eigvals(np.linalg.solve(a["M"][0], a["K"][0])).real)[:4]
            for a in (found, expected)
        ]
        np.testing.assert_allclose(squares[0], squares[1], rtol=1e-3)
        rows = changing.deflections(drive.angle, time)
        np.testing.assert_allclose(rows, there.relative_deflection(drive.angle), atol=1e-6)


@pytest.mark.slow
def test_a_length_that_stays_gives_the_stresses_of_that_length():
    drive = {"times": (0.0, 0.2), "speeds": (20.0, 22.0)}
    expected = run_through(system().with_geometry(frame=0.62), SpeedProfile(**drive), modes=None)
    # Held, and hardly changed.
    for end, rtol in ((0.62, 1e-12), (0.6201, 2e-3)):
        profile = SpeedProfile(**drive, geometry={"frame": (0.62, end)})
        found = run_through(system(), profile, modes=None)
        assert found.largest == pytest.approx(expected.largest, rel=rtol)
