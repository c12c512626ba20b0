"""Error estimates of constrained motions and consistent states against exact motions.

An estimate covers the error in 99 of 100 cases and is within a factor of 100 of it in the median.
"""

from dataclasses import replace

import numpy as np
import pytest
from constrained_truth import random_circle, unconstrained
from elastolink.runtime.constrained import consistent_state, constrained_motion
from elastolink.runtime.systems import free_free_rod
from honesty import over_scenes


@over_scenes(1, few=10, many=100)
def test_pendulums_at_any_tolerance(rng):
    """Swinging or turning in any units and oblique coordinates, by elliptic functions."""
    circle = random_circle(rng)
    span = rng.uniform(0.3, 5.0) / np.sqrt(circle.gravity)
    rtol = 10.0 ** rng.uniform(-13.0, -1.1)
    motion = constrained_motion(circle.system, *circle.state, span, samples=3, rtol=rtol)
    assert motion.success
    return motion.error, np.max(np.abs(motion.q - circle.exact(motion.time)[0]), axis=0)


@over_scenes(2, few=6, many=60)
@pytest.mark.parametrize("rtol", [1e-4, 1e-6, 1e-9])
def test_stiff_rods(rng, rtol):
    """Some hundred radians of the fastest vibration; the truth is a run at 1e-12."""
    modes, ratio, speed = int(rng.integers(1, 6)), rng.uniform(0.05, 0.6), rng.uniform(3, 200)
    length = 0.6 * (1 + ratio) * rng.uniform(1.02, 1.5)
    stiffness, mass = 36456 * 10 ** rng.uniform(-1, 1.5), 7.15 * 10 ** rng.uniform(-0.5, 0.5)
    rod = free_free_rod(
        modes,
        crank_ratio=ratio,
        frame=0.6,
        length=length,
        bending_stiffness=stiffness,
        mass_per_length=mass,
        speed=speed,
    )
    fastest = (4.73 * modes / length) ** 2 * np.sqrt(stiffness / mass)
    span = min(0.3 * rod.period, 400.0 / fastest)
    truth, motion = (
        constrained_motion(replace(rod, watch=None), span=span, samples=8, rtol=r, guards=())
        for r in (1e-12, rtol)
    )
    away = np.max(np.abs(motion.q - truth.q), axis=0)
    known = away > 3.0 * truth.error
    if not known.any():
        return None
    # The largest error over the sizes decides: that of a coordinate hardly moved may be less.
    size = np.max(np.abs(truth.q), axis=0)
    estimate, actual = np.max((motion.error / size)[known]), np.max((away / size)[known])
    assert np.all(motion.error[known] >= 0.3 * away[known])
    assert estimate <= 1e3 * actual
    return estimate, actual


@over_scenes(9, few=5, many=40)
def test_forces_that_jump(rng):
    """A mass on a spring with a force of constant size towards the middle: arcs of cosines."""
    force, span = rng.uniform(0.1, 2.0), rng.uniform(2.0, 12.0)
    rtol = 10.0 ** rng.uniform(-10, -4)
    pulled = unconstrained(lambda q, qd: -q - force * np.sign(q))
    motion = constrained_motion(pulled, [1.0], [0.0], span, samples=5, rtol=rtol)
    # To the middle x + force = (1 + force) cos t; from there on mirrored.
    quarter = np.arccos(force / (1.0 + force))
    phase = np.mod(motion.time, 4 * quarter)
    half = np.minimum(phase, 4 * quarter - phase)
    side = np.where(half > quarter, -1.0, 1.0)
    part = np.minimum(half, 2 * quarter - half)
    exact = side * ((1.0 + force) * np.cos(part) - force)
    return motion.error[0], np.max(np.abs(motion.q[:, 0] - exact))


@pytest.mark.parametrize("span", [0.3, 2.0])
def test_a_motion_that_is_lost_does_not_pass(span):
    """exp(-20 t), beside which exp(20 t) grows from what the steps miss."""
    motion = constrained_motion(
        unconstrained(lambda q, qd: 400.0 * q), [1.0], [-20.0], span, samples=20, rtol=1e-4
    )
    away = np.max(np.abs(motion.q[:, 0] - np.exp(-20.0 * motion.time)))
    assert away <= motion.error[0] <= 1e3 * away
    assert motion.checks["accuracy"].passed == (span < 1.0)
    assert (away < 0.01) == (span < 1.0)


@pytest.mark.parametrize("scenes", [10, pytest.param(100, marks=pytest.mark.slow)])
def test_consistent_states(scenes):
    """The defect that is left is an estimate of the scaled distance from the constraints."""
    rng = np.random.default_rng(6)
    for _ in range(scenes):
        circle = random_circle(rng)
        q, qd = circle.state
        off = 0.1 * rng.standard_normal(2)
        found = consistent_state(circle.system, q + np.linalg.solve(circle.oblique, off), qd)
        # Distance from the circle by hand, over the size of the coordinates.
        assert abs(np.hypot(*(circle.oblique @ found.q)) - 1.0) < 1e-12
        assert found.error < 1e-13
