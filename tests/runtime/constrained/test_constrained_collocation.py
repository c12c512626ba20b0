"""Collocation over long windows: its slopes, its samples, how little it evaluates."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from constrained_truth import Circle
from elastolink.runtime.constrained import Guard, constrained_motion
from elastolink.runtime.constrained.batches import accelerations_with_slopes, nearest_states
from elastolink.runtime.constrained.equations import Equations, NoConvergence
from elastolink.runtime.constrained.steppers import collocation
from elastolink.runtime.constrained.steppers.gauss_window import nodes
from elastolink.runtime.constrained.steppers.protocol import Control, natural_scales
from elastolink.runtime.constrained.variational import linearised
from elastolink.runtime.systems.rod.constrained import free_free_rod, rigid_state

CIRCLE = Circle(oblique=np.array([[1.0, 0.3], [0.0, 0.02]]), pivot=np.array([0.4, -0.2]), row=50.0)


@cache
def rod(modes: int = 2):
    return free_free_rod(
        modes,
        crank_ratio=0.3,
        frame=0.59997,
        length=1.0,
        bending_stiffness=0.7e11 * 0.5208e-6,
        mass_per_length=7.15,
        speed=100.0,
    )


def some_states(count: int = 5):
    """States of the bent rod, on the constraints."""
    found = constrained_motion(
        rod(), *(x for x in rigid_state(rod(), 0.0)), rod().period, samples=count, rtol=1e-6
    )
    return found.time[1:], found.q[1:], found.qd[1:]


def test_slopes_are_those_of_the_emitted_variations():
    """Differences with accelerations held, against the derivatives of the Lagrangian."""
    t, q, qd = some_states()
    equations = Equations(rod(), q[0], qd[0], float(t[0]))
    unit = equations.columns
    found = accelerations_with_slopes(equations, t, q / unit, qd / unit, 0.01)
    exact = linearised(rod(), q, qd, t)
    np.testing.assert_allclose(found.accelerations * unit, exact.qdd, rtol=1e-12, atol=1e-9)
    for mine, theirs in ((found.by_place, exact.by_q), (found.by_speed, exact.by_qd)):
        scaled = theirs * unit / unit[:, None]
        np.testing.assert_allclose(mine, scaled, atol=1e-5 * np.max(np.abs(scaled)))


def test_states_together_are_the_states_one_by_one():
    t, q, qd = some_states()
    equations = Equations(rod(), q[0], qd[0], float(t[0]))
    rng = np.random.default_rng(0)
    q, qd = (x * (1.0 + 1e-4 * rng.standard_normal(x.shape)) for x in (q, qd))
    together = nearest_states(equations, t, q, qd)
    for i, state in enumerate(together):
        alone = equations.state(float(t[i]), q[i], qd[i])
        np.testing.assert_allclose(state.q, alone.q, atol=1e-13)
        np.testing.assert_allclose(state.qd, alone.qd, atol=1e-11)
        np.testing.assert_allclose(state.qdd, alone.qdd, rtol=1e-9, atol=1e-7)
    assert nearest_states(equations, t[:0], q[:0], qd[:0]) == []


def test_states_out_of_reach_are_refused():
    """A circle that was pulled away from its own plane: x^2 + y^2 = -3."""
    base = Circle().system

    def violation(q, t):
        found = dict(base.violation(q, t))
        found["constraints"] = found["constraints"] + 2.0
        return found

    equations = Equations(replace(base, violation=violation), *Circle().state, 0.0)
    q, qd = (np.array([x]) for x in Circle().state)
    with pytest.raises(NoConvergence):
        nearest_states(equations, np.zeros(1), q, qd)


@pytest.mark.parametrize("count", [6, 13, 24, 32])
def test_nodes_integrate_polynomials_twice(count):
    points = nodes(count)
    for power in range(count):
        values = points.c**power
        once, twice = power + 1.0, (power + 1.0) * (power + 2.0)
        np.testing.assert_allclose(points.once @ values, points.c ** (power + 1) / once, atol=1e-14)
        ahead = points.c ** (power + 2) / twice
        np.testing.assert_allclose(points.twice @ values, ahead, atol=1e-14)
        np.testing.assert_allclose(points.b @ values, 1.0 / once, atol=1e-14)
        np.testing.assert_allclose(points.back @ values, 1.0 / twice, atol=1e-14)
        x = np.array([0.0, 0.3, 1.0])
        series = points.series @ values
        by_series = [weights @ series for weights in points.at(x)]
        np.testing.assert_allclose(by_series[0], x ** (power + 2) / twice, atol=1e-13)
        np.testing.assert_allclose(by_series[1], x ** (power + 1) / once, atol=1e-13)
        np.testing.assert_allclose(points.values @ series, values, atol=1e-12)
        part = points.shortened(values, 0.4)
        np.testing.assert_allclose(part, (0.4 * points.c) ** power, atol=1e-13)


class Counted:
    """A system that counts how often it is evaluated."""

    def __init__(self, system) -> None:
        self.calls = 0

        def dynamics(*arguments):
            self.calls += 1
            return system.dynamics(*arguments)

        def violation(*arguments):
            self.calls += 1
            return system.violation(*arguments)

        own = {"dynamics": dynamics, "violation": violation}
        self.system = replace(system, **own)


def test_a_revolution_takes_few_evaluations():
    """At the same error, a twentieth of the calls of the explicit steps and their second run."""
    calls, errors = {}, {}
    start = rigid_state(rod(), 0.0)
    truth = constrained_motion(rod(), *start, rod().period, rtol=1e-13, method="projection")
    for method, rtol in (("collocation", 1e-9), ("projection", 1e-10)):
        counted = Counted(rod())
        found = constrained_motion(
            counted.system, *start, rod().period, method=method, rtol=rtol, samples=200
        )
        found.require()
        calls[method] = counted.calls
        errors[method] = np.max(np.abs(found.q - truth.q) / np.max(np.abs(truth.q), axis=0))
        assert np.all(np.max(np.abs(found.q - truth.q), axis=0) <= found.error + truth.error)
    assert errors["collocation"] < errors["projection"]
    assert 20 * calls["collocation"] < calls["projection"]


def test_samples_do_not_change_the_motion():
    """Dense output of the windows: as many steps and the same end, however many times."""
    few = constrained_motion(CIRCLE.system, *CIRCLE.state, 3.0, samples=2)
    many = constrained_motion(CIRCLE.system, *CIRCLE.state, 3.0, samples=1000)
    assert few.steps == many.steps
    np.testing.assert_array_equal(few.q[-1], many.q[-1])
    np.testing.assert_allclose(few.q[1], many.q[500], atol=1e-15)
    assert np.max(many.position_norm) < 1e-15


def test_a_guard_that_is_met_and_left_inside_a_window_stops_the_motion():
    """A bob that passes the wall and swings back before the window ends."""
    circle = Circle(start=1.0)
    top = np.sin(2 * np.arcsin(0.5 / np.sqrt(10.0)))
    wall = Guard(lambda t, q, qd: 0.7 * top - q[0], "the bob struck the wall")
    free = constrained_motion(circle.system, *circle.state, 3.0, rtol=1e-6)
    assert free.steps <= 3
    found = constrained_motion(circle.system, *circle.state, 3.0, rtol=1e-6, guards=(wall,))
    assert found.status == 1
    np.testing.assert_allclose(found.q[-1, 0], 0.7 * top, atol=1e-7)
    assert found.time[-1] < np.pi / np.sqrt(10.0)


def test_windows_meet_and_end_where_they_should():
    equations = Equations(CIRCLE.system, *CIRCLE.state, 0.0)
    start = equations.at(0.0, *CIRCLE.state)
    control = Control(1e-8, *natural_scales(start, equations.columns), longest=0.5)
    windows = list(collocation(equations, start, np.array([0.0, 3.0]), control))
    assert windows[-1].after.t == 3.0
    for before, after in pairwise(windows):
        assert before.after is after.before
    for window in windows:
        assert window.after.t - window.before.t <= 0.55 + 1e-12
        ends = np.array([window.before.t, window.after.t])
        q, qd, gap = window.samples(ends)
        np.testing.assert_allclose(q[0], window.before.q, atol=1e-14)
        np.testing.assert_allclose(q[1], window.after.q, atol=1e-9)
        np.testing.assert_allclose(qd[1], window.after.qd, atol=1e-7)
        assert np.all(gap >= 0.0)
