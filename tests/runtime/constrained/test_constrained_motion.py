"""Motion of constrained systems: methods, constraints, guards, refusals."""

from dataclasses import replace
from functools import cache

import elastolink as el
import numpy as np
import pytest
from constrained_truth import LENGTHS, Circle, by_explicit_steps, driven_four_bar, unconstrained
from elastolink.runtime.constrained import consistent_state, constrained_motion
from elastolink.runtime.constrained.equations import Equations
from elastolink.runtime.core.errors import BadInput, LinearRangeWarning
from elastolink.runtime.core.families import Guard
from elastolink.runtime.systems import free_free_rod
from free_free_loads import ROD

CIRCLE = Circle(oblique=np.array([[1.0, 0.3], [0.0, 0.02]]), pivot=np.array([0.4, -0.2]), row=50.0)
TURNING = Circle(start=7.5)
SPEED = 6.0


@cache
def rod(modes: int = 2, ratio: float = 0.3, speed: float = 100.0, **changes):
    return free_free_rod(modes, crank_ratio=ratio, speed=speed, **ROD | changes)


@pytest.mark.smoke
@pytest.mark.parametrize("circle", [CIRCLE, TURNING])
def test_motion_follows_the_elliptic_functions(circle):
    found = constrained_motion(circle.system, *circle.state, 3.0, samples=24)
    q, qd = circle.exact(found.time)
    assert found.success
    found.require()
    actual = np.max(np.abs(found.q - q), axis=0)
    assert np.all(actual <= found.error)
    # The tolerance of a step is 1e-9.
    assert np.all(found.error <= 1e-6 * np.max(np.abs(q), axis=0))
    np.testing.assert_allclose(found.qd, qd, atol=1e-6 * np.max(np.abs(qd)))
    energy = circle.energy(found.q, found.qd, found.time)
    assert np.ptp(energy) < 1e-6 * np.max(np.abs(energy))
    angle, turning = np.array([circle.angle(t) for t in found.time]).T
    by_hand = circle.multiplier(angle, turning)
    np.testing.assert_allclose(
        found.multipliers[:, 0], by_hand, atol=1e-6 * np.max(np.abs(by_hand))
    )
    for norm in (found.position_norm, found.velocity_norm, found.acceleration_norm):
        assert norm.shape == found.time.shape
        assert np.max(norm) < 1e-14


def test_given_times_lie_on_the_motion_and_it_goes_on_from_its_end():
    times = np.array([0.13, 0.5, 0.52, 1.9])
    first = constrained_motion(CIRCLE.system, *CIRCLE.state, (0.0, 2.0), samples=times, rtol=1e-11)
    np.testing.assert_array_equal(first.time, [0.0, *times, 2.0])
    second = constrained_motion(CIRCLE.system, *first.at_end, (2.0, 3.0), rtol=1e-11)
    for found in (first, second):
        q, _ = CIRCLE.exact(found.time)
        np.testing.assert_allclose(found.q, q, atol=1e-8 * np.max(np.abs(q)))


def test_samples_do_not_change_the_motion():
    """Dense output of the windows: as many steps and the same end, however many times."""
    few = constrained_motion(CIRCLE.system, *CIRCLE.state, 3.0, samples=2)
    many = constrained_motion(CIRCLE.system, *CIRCLE.state, 3.0, samples=1000)
    assert few.steps == many.steps
    np.testing.assert_allclose(few.error, many.error, rtol=0.3)
    np.testing.assert_array_equal(few.q[-1], many.q[-1])
    np.testing.assert_allclose(few.q[1], many.q[500], atol=1e-15)
    assert np.max(many.position_norm) < 1e-15


def test_the_rod_moves_as_by_explicit_steps_and_windows_are_few():
    """From the system's reference motion over a part of its period, with its guards and watch."""
    found = constrained_motion(rod(), span=0.2 * rod().period, samples=10, rtol=1e-7)
    start = rod().reference(np.zeros(()))
    other, steps = by_explicit_steps(rod(), *start, found.time, 1e-9)
    assert np.all(np.max(np.abs(found.q - other), axis=0) <= found.error + 1e-9)
    assert {"linear range", "end reached"} <= set(found.checks)
    found.require()
    assert 10 * found.steps < steps


def test_differences_are_the_emitted_variations():
    """Where a system has no variations, against the derivatives of the Lagrangian."""
    motion = constrained_motion(rod(), span=0.02, samples=5, rtol=1e-6)
    lean = replace(rod(), variations=None)
    exact, found = (
        equations.linearised(
            motion.time, motion.q / equations.columns, motion.qd / equations.columns
        )
        for equations in (Equations(s, motion.q, motion.qd, motion.time) for s in (rod(), lean))
    )
    np.testing.assert_allclose(found.a, exact.a)
    for name in ("by_x", "by_v"):
        size = np.max(np.abs(getattr(exact, name)))
        np.testing.assert_allclose(getattr(found, name), getattr(exact, name), atol=1e-5 * size)
    one, other = (constrained_motion(s, span=0.02, samples=5) for s in (rod(), lean))
    assert np.all(np.max(np.abs(one.q - other.q), axis=0) <= one.error + other.error)


def test_a_driven_linkage_moves_as_its_kinematics():
    """As many constraints as coordinates: nothing is free, and all is to be met."""
    linkage = el.FourBar(**LENGTHS)
    at_start = linkage.motion(0.0, SPEED)
    system = driven_four_bar(SPEED)
    guess = np.zeros(9)
    guess[[5, 8]] = at_start.theta3, at_start.theta4
    start = consistent_state(system, guess, np.zeros(9))
    found = constrained_motion(system, start.q, start.qd, 2 * np.pi / SPEED, samples=36)
    assert found.success
    exact = linkage.motion(SPEED * found.time, SPEED)
    for place, angle, omega, alpha in (
        (5, exact.theta3, exact.omega3, exact.alpha3),
        (8, exact.theta4, exact.omega4, exact.alpha4),
    ):
        assert np.max(np.abs(np.exp(1j * (found.q[:, place] - angle)) - 1.0)) < 1e-12
        np.testing.assert_allclose(found.qd[:, place], omega, atol=1e-11)
        np.testing.assert_allclose(found.qdd[:, place], alpha, atol=1e-10)


def test_a_guard_stops_where_it_is_met():
    """The swinging bob is to stay left of x = 0.4: where sin(angle) = 0.4 it stops."""
    circle = Circle()
    guards = (
        Guard(lambda t, q, qd: 0.9 - q[0], "the bob struck the far wall"),
        (lambda t, q, qd: 0.4 - q[0], "the bob struck the wall"),
    )
    found = constrained_motion(
        circle.system, *circle.state, 5.0, samples=200, guards=guards, rtol=1e-10
    )
    assert found.status == 1
    assert not found.success
    assert not found.passed
    assert found.message.startswith("the bob struck the wall, at t = ")
    np.testing.assert_allclose(found.q[-1, 0], 0.4, atol=1e-9)
    angle, _ = circle.angle(found.time[-1])
    np.testing.assert_allclose(np.sin(angle), 0.4, atol=1e-7)
    assert np.all(np.diff(found.time) > 0)


def test_a_guard_that_is_met_and_left_inside_a_window_stops_the_motion():
    """A bob that passes the wall and swings back before the window ends."""
    circle = Circle(start=1.0)
    top = np.sin(2 * np.arcsin(0.5 / np.sqrt(10.0)))
    wall = (lambda t, q, qd: 0.7 * top - q[0], "the bob struck the wall")
    free = constrained_motion(circle.system, *circle.state, 3.0, rtol=1e-6)
    assert free.steps <= 3
    found = constrained_motion(circle.system, *circle.state, 3.0, rtol=1e-6, guards=(wall,))
    assert found.status == 1
    np.testing.assert_allclose(found.q[-1, 0], 0.7 * top, atol=1e-7)
    assert found.time[-1] < np.pi / np.sqrt(10.0)


def test_guards_broken_at_the_start_or_without_a_number_are_refused():
    for margin, words in (
        (-1.0, "the slider left the rod's end, at the start"),
        (np.nan, "guards"),
    ):
        guard = (lambda t, q, qd, margin=margin: margin, "the slider left the rod's end")
        with pytest.raises(BadInput, match=words):
            constrained_motion(CIRCLE.system, *CIRCLE.state, 1.0, guards=(guard,))


@pytest.mark.parametrize("rtol", [1e-4, 1e-9])
def test_the_block_that_passes_the_pin_closely_ends_alike_at_every_tolerance(rtol):
    """A crank of 0.99 of the base: the rod is flung round and bent beyond use at 0.157204 s."""
    with pytest.warns(LinearRangeWarning):
        found = constrained_motion(rod(2, 0.99, 20.0, length=1.3), rtol=rtol)
    assert found.message == "the deflection passed 0.5 of the rod's length, at t = 0.157204"


def test_a_span_of_too_many_vibrations_is_refused_beforehand():
    with pytest.raises(BadInput, match="rad of the fastest vibration"):
        constrained_motion(rod(speed=1e-6))


def test_the_linear_range_is_watched():
    circle = Circle(start=0.1)
    with pytest.warns(LinearRangeWarning, match=r"deflection reaches 0\.3"):
        watched = replace(circle.system, watch=lambda q, t: 10.0 * q[:, 0])
        found = constrained_motion(watched, *circle.state, 2.0)
    # The swing of a small pendulum is start / sqrt(gravity).
    expected = 10 * np.sin(2 * np.arcsin(0.05 / np.sqrt(10.0)))
    np.testing.assert_allclose(found.checks["linear range"].value, expected, rtol=1e-3)
    assert not found.passed
    watched = replace(circle.system, watch=lambda q, t: q[:, 0])
    calm = constrained_motion(watched, *circle.state, 2.0)
    assert calm.checks["linear range"].passed
    assert calm.passed


def test_divergence_is_named():
    """x = cosh(3 t)."""
    leaving = unconstrained(lambda q, qd: 9.0 * q)
    found = constrained_motion(leaving, [1.0], [0.0], 50.0, bound=1e6, samples=500)
    assert found.status == 1
    assert "diverged" in found.message
    stop = np.arccosh(1e6) / 3.0
    assert stop - 0.1 <= found.time[-1] <= stop + 1.0
    assert not found.checks["end reached"].passed
    assert np.all(np.diff(found.time) > 0)
    assert found.error[0] > 0


def test_an_escape_in_finite_time_ends_with_a_reason():
    """x'' = 2 x^3 leaves to infinity as 1/(1 - t)."""
    leaving = unconstrained(lambda q, qd: 2.0 * q**3)
    found = constrained_motion(leaving, [1.0], [1.0], 2.0, bound=1e300, samples=2000)
    assert not found.success
    assert "diverge" in found.message
    assert 0.99 < found.time[-1] <= 1.001
    assert np.isfinite(found.q).all()


def test_the_picture_names_the_coordinates():
    axes = constrained_motion(CIRCLE.system, *CIRCLE.state, 1.0, samples=20).plot()
    assert [line.get_label() for line in axes.get_lines()] == ["a", "b"]
