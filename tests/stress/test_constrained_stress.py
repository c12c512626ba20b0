"""Ten thousand revolutions on the constraints: no drift, at any level."""

from __future__ import annotations

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from constrained_truth import Circle
from elastolink.runtime.constrained import (
    consistent_state,
    constrained_motion,
    constraint_norms,
    motion_with_variations,
    tangent_basis,
)
from elastolink.runtime.constrained.equations import Equations, State
from elastolink.runtime.constrained.steppers import lobatto, projection, unprojected
from elastolink.runtime.constrained.steppers.protocol import Control, natural_scales
from elastolink.runtime.core.errors import BadInput, RedundantConstraints
from elastolink.runtime.core.families import Constrained
from elastolink.runtime.systems.rod.constrained import free_free_rod, rigid_state

REVOLUTIONS = 10_000


class Watch:
    """The largest constraint norms at every so many steps."""

    def __init__(self, system) -> None:
        self.system, self.largest = system, np.zeros(3)

    def look(self, state: State) -> np.ndarray:
        arrays = (np.array([state.t]), state.q[None], state.qd[None], state.qdd[None])
        norms = np.array(constraint_norms(self.system, *arrays))[:, 0]
        self.largest = np.maximum(self.largest, norms)
        return norms


def rod():
    """The very flexible rod on one mode, fast enough for a smooth revolution."""
    return free_free_rod(
        1,
        crank_ratio=0.01,
        frame=0.59997,
        length=1.0,
        bending_stiffness=0.7e11 * 0.5208e-6,
        mass_per_length=7.15,
        speed=2000.0,
    )


def periodic_start(system, period):
    """Newton's iteration on the freedoms for the state that returns after a revolution."""
    start = rigid_state(system, 0.0)
    n = system.size
    state = consistent_state(system, start.q, start.qd)
    for _ in range(10):
        basis = tangent_basis(system, state.q, state.qd)
        back = np.linalg.pinv(basis)
        end = motion_with_variations(
            system, state.q, state.qd, (0.0, period), basis, steps=24, stages=6
        )
        gap = np.concatenate([end.q[-1] - state.q, end.qd[-1] - state.qd])
        if np.max(np.abs(gap[:n])) < 1e-14:
            return state, back @ end.columns
        turn = back @ end.columns - np.eye(basis.shape[1])
        change = -basis @ np.linalg.solve(turn, back @ gap)
        state = consistent_state(system, state.q + change[:n], state.qd + change[n:])
    raise AssertionError("no periodic orbit")


@pytest.mark.slow
def test_the_rod_returns_after_ten_thousand_revolutions():
    """From its periodic orbit, which is stable, it comes back to the start after each one."""
    system = rod()
    start, turn = periodic_start(system, system.period)
    np.testing.assert_allclose(np.abs(np.linalg.eigvals(turn)), 1.0, atol=1e-9)
    equations = Equations(system, start.q, start.qd, 0.0)
    state = State(0.0, start.q, start.qd, start.qdd, start.multipliers)
    scales = natural_scales(state, equations.columns)
    per = 3
    control = Control(1e-9, *scales, step=system.period / per)
    watch, gaps = Watch(system), []
    times = np.array([0.0, REVOLUTIONS * system.period])
    for i, step in enumerate(projection(equations, state, times, control), start=1):
        if i % (50 * per) == 0:
            watch.look(step.after)
            gaps.append(np.max(np.abs(step.after.q - start.q)))
    assert len(gaps) == REVOLUTIONS // 50
    assert np.max(watch.largest) < 2e-15
    # Steps of a third of a revolution shift the orbit by 1e-6 at most; it stays there.
    assert np.max(gaps[-50:]) < 1.5 * np.max(gaps[:50])
    assert np.max(gaps) < 1e-6


@pytest.mark.slow
def test_the_pendulum_turns_ten_thousand_times_as_its_elliptic_function():
    circle = Circle(gravity=1.0, start=20.0)
    rate = mpmath.mpf(20)
    period = float(4 * mpmath.ellipk(4 / rate**2) / rate)
    equations = Equations(circle.system, *circle.state, 0.0)
    state = equations.at(0.0, *circle.state)
    scales = natural_scales(state, equations.columns)
    control = Control(1e-9, *scales, step=period / 3, stages=8)
    times = np.linspace(0.0, REVOLUTIONS * period, 101)
    watch, energy, gaps = Watch(circle.system), [], []
    marks = set(times.tolist())
    for step in lobatto(equations, state, times, control):
        after = step.after
        if after.t in marks:
            watch.look(after)
            energy.append(circle.energy(after.q, after.qd, after.t))
            gaps.append(np.max(np.abs(after.q - circle.exact([after.t])[0][0])))
    assert len(energy) == 100
    assert np.max(watch.largest) < 2e-15
    # The symmetric steps keep the energy: what is lost is the rounding of each step, no more.
    held = np.abs(np.array(energy) - circle.energy(*circle.state, 0.0)) / energy[0]
    steps = 3 * REVOLUTIONS / 100 * np.arange(1, 101)
    assert np.max(held / steps) < 8 * np.finfo(float).eps
    # The phase is off by an even part of each revolution, 6e-11 rad, and no more than that.
    per_revolution = np.array(gaps) / (REVOLUTIONS / 100 * np.arange(1, 101))
    assert np.max(per_revolution) < 2e-10


@pytest.mark.parametrize(("rtol", "start"), [(1e-6, 20.0), (1e-12, 20.0), (1e-9, 1.9), (1e-9, 2.1)])
def test_windows_of_collocation_over_hundreds_of_turns(rtol, start):
    """Fast turns, and swings and turns that nearly stop at the top, which double errors often."""
    circle = Circle(gravity=1.0, start=start)
    span = 300 * 2 * np.pi / 20 if start == 20.0 else 50.0
    found = constrained_motion(circle.system, *circle.state, span, rtol=rtol, samples=40)
    found.require()
    q, _ = circle.exact(found.time)
    assert np.all(np.max(np.abs(found.q - q), axis=0) <= found.error)
    # The phase is off by a part of the tolerance in each window, and by no more.
    assert np.max(found.error) < 1e3 * found.steps * max(rtol, 1e-13)
    assert max(np.max(found.position_norm), np.max(found.velocity_norm)) < 2e-15


def test_a_stiff_relaxation_takes_few_windows():
    """Van der Pol's oscillator: explicit steps are bound to its fast decay, windows are not."""

    def dynamics(q, qd, t):
        batch = np.shape(q)[:-1]
        push = 50.0 * (1.0 - np.asarray(q) ** 2) * qd - q
        return {
            "mass": np.ones((*batch, 1, 1)),
            "rest": np.zeros((*batch, 1, 1)),
            "forces": push[..., None],
            "jacobian": np.zeros((*batch, 0, 1)),
            "velocity_rhs": np.zeros((*batch, 0, 1)),
            "gamma": np.zeros((*batch, 0, 1)),
        }

    def violation(q, t):
        batch = np.shape(q)[:-1]
        return {"constraints": np.zeros((*batch, 0, 1)), "jacobian": np.zeros((*batch, 0, 1))}

    system = Constrained(1, 0, dynamics, violation)
    found = constrained_motion(system, [2.0], [0.0], 30.0, rtol=1e-9, samples=20)
    other = constrained_motion(
        system, [2.0], [0.0], 30.0, rtol=1e-9, samples=20, method="projection"
    )
    found.require()
    assert 20 * found.steps < other.steps
    assert np.max(np.abs(found.q - other.q)) <= found.error[0] + other.error[0]


def test_without_projection_the_constraints_drift():
    """The negative control: the same steps, not projected, leave the constraints steadily."""
    system = rod()
    start = rigid_state(system, 0.0)
    equations = Equations(system, start.q, start.qd, 0.0)
    state = equations.at(0.0, start.q, start.qd)
    control = Control(1e-9, *natural_scales(state, equations.columns), step=system.period / 4)
    times = np.array([0.0, 200 * system.period])
    found = {}
    for name, method in (("kept", projection), ("left", unprojected)):
        watch = Watch(system)
        ends = list(method(equations, state, times, control))
        found[name] = [watch.look(ends[i].after)[0] for i in (199, -1)]
    assert max(found["kept"]) < 1e-15
    assert found["left"][0] > 1e-9
    assert found["left"][1] > 3 * found["left"][0]


def test_five_modes_are_stiff_and_stay_on_the_constraints():
    system = free_free_rod(
        5,
        crank_ratio=0.3,
        frame=0.59997,
        length=1.0,
        bending_stiffness=0.7e11 * 0.5208e-6,
        mass_per_length=7.15,
        speed=100.0,
    )
    start = rigid_state(system, 0.0)
    span = 0.05 * system.period
    ends = {}
    for method in ("collocation", "projection", "coordinate_partitioning", "lobatto"):
        found = constrained_motion(
            system, start.q, start.qd, span, method=method, samples=4, rtol=1e-8
        )
        found.require()
        ends[method] = found
        assert max(np.max(found.position_norm), np.max(found.velocity_norm)) < 1e-14
    for method, found in ends.items():
        gap = np.abs(found.q - ends["projection"].q)
        assert np.all(gap <= 1.01 * (found.error + ends["projection"].error)), method


@pytest.mark.parametrize("scale", [1e-12, 1e-6, 1e6, 1e12])
def test_units_do_not_matter(scale):
    """Rows and coordinates of any size: the same motion to round-off."""
    power = float(np.exp2(np.round(np.log2(scale))))
    plain = Circle(gravity=10.0, start=3.0, mass=1.0)
    other = Circle(
        gravity=10.0,
        start=3.0,
        mass=power,
        row=1.0 / power,
        oblique=np.diag([1.0, power]),
    )
    a = constrained_motion(plain.system, *plain.state, 1.0, samples=4)
    b = constrained_motion(other.system, *other.state, 1.0, samples=4)
    x = b.q @ other.oblique.T
    np.testing.assert_allclose(x, a.q, atol=1e-10)
    assert np.max(b.position_norm) < 1e-15


def test_a_hair_from_a_branching_point():
    """Near the centre the circle's row is short but has a direction; in it, it has none."""
    near = consistent_state(Circle().system, [1e-6, 0.0], [0.0, 1.0])
    np.testing.assert_allclose(np.hypot(*near.q), 1.0, rtol=1e-14)
    with pytest.raises(RedundantConstraints):
        consistent_state(Circle().system, [0.0, 0.0], [0.0, 1.0])


def test_no_state_anywhere_near():
    """A rod that would have to be longer than it can: no point, one line, no warning."""
    base = Circle().system

    def violation(q, t):
        found = dict(base.violation(q, t))
        # (x^2 + y^2 - 1)/2 + 2 has no zero.
        found["constraints"] = found["constraints"] + 2.0
        return found

    with pytest.raises(BadInput) as refusal:
        consistent_state(replace(base, violation=violation), [0.6, 0.8], [0.0, 0.0])
    assert "\n" not in str(refusal.value)
