"""Error figures of constrained motions and consistent states against elliptic functions."""

from __future__ import annotations

import numpy as np
import pytest
from constrained_truth import random_circle
from elastolink.runtime.constrained import consistent_state, constrained_motion
from elastolink.runtime.core.families import Constrained

SCENES = 200


def ratios(scenes: int, seed: int, **named):
    """Actual errors over the figures, of all coordinates of random pendulums."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(scenes):
        circle = random_circle(rng)
        span = rng.uniform(0.3, 1.0) / np.sqrt(circle.gravity)
        chosen = {name: value(rng, span) for name, value in named.items()}
        motion = constrained_motion(circle.system, *circle.state, span, samples=3, **chosen)
        assert motion.success
        q, _ = circle.exact(motion.time)
        found.append(np.max(np.abs(motion.q - q), axis=0) / motion.error)
    return np.concatenate(found)


def check(found):
    assert np.mean(found <= 1.0) >= 0.99
    assert 1.0 / np.median(found) <= 1e3


def collocation(rng, span):
    return "collocation"


def projection(rng, span):
    return "projection"


def test_collocation_under_a_tolerance():
    """By default, at any tolerance that is allowed."""
    check(ratios(SCENES, 1, rtol=lambda rng, span: 10.0 ** rng.uniform(-13, -1.1)))


@pytest.mark.slow
def test_collocation_with_any_number_of_nodes():
    check(
        ratios(
            SCENES,
            7,
            method=collocation,
            rtol=lambda rng, span: 10.0 ** rng.uniform(-9, -3),
            stages=lambda rng, span: int(rng.integers(6, 29)),
        )
    )


@pytest.mark.slow
def test_collocation_with_fixed_windows():
    check(ratios(SCENES, 8, method=collocation, step=lambda rng, s: s / int(rng.integers(1, 8))))


@pytest.mark.slow
def test_collocation_where_the_force_jumps():
    """A mass on a spring with a force of constant size towards the middle: arcs of cosines."""
    rng = np.random.default_rng(9)
    found = []
    for _ in range(60):
        force, span = rng.uniform(0.1, 2.0), rng.uniform(2.0, 12.0)
        motion = constrained_motion(
            towards_the_middle(force),
            [1.0],
            [0.0],
            span,
            samples=5,
            rtol=10.0 ** rng.uniform(-10, -4),
        )
        # To the middle x + force = (1 + force) cos t; from there on mirrored.
        quarter = np.arccos(force / (1.0 + force))
        phase = np.mod(motion.time, 4 * quarter)
        half = np.minimum(phase, 4 * quarter - phase)
        side = np.where(half > quarter, -1.0, 1.0)
        part = np.minimum(half, 2 * quarter - half)
        exact = side * ((1.0 + force) * np.cos(part) - force)
        found.append(np.max(np.abs(motion.q[:, 0] - exact)) / motion.error[0])
    check(np.array(found))


def towards_the_middle(force):
    """One free coordinate, x'' = -x - force sign(x)."""

    def dynamics(q, qd, t):
        q = np.asarray(q)
        batch = q.shape[:-1]
        return {
            "mass": np.ones((*batch, 1, 1)),
            "rest": np.zeros((*batch, 1, 1)),
            "forces": (-q - force * np.sign(q))[..., None],
            "jacobian": np.zeros((*batch, 0, 1)),
            "velocity_rhs": np.zeros((*batch, 0, 1)),
            "gamma": np.zeros((*batch, 0, 1)),
        }

    def violation(q, t):
        batch = np.shape(q)[:-1]
        return {"constraints": np.zeros((*batch, 0, 1)), "jacobian": np.zeros((*batch, 0, 1))}

    return Constrained(1, 0, dynamics, violation)


@pytest.mark.slow
def test_projection_under_a_tolerance():
    check(ratios(SCENES, 1, method=projection, rtol=lambda rng, s: 10.0 ** rng.uniform(-12, -4)))


@pytest.mark.slow
def test_projection_with_fixed_steps():
    check(ratios(SCENES, 4, method=projection, step=lambda rng, s: s / int(rng.integers(5, 25))))


@pytest.mark.slow
def test_coordinate_partitioning_under_a_tolerance():
    check(
        ratios(
            SCENES,
            2,
            method=lambda rng, span: "coordinate_partitioning",
            rtol=lambda rng, span: 10.0 ** rng.uniform(-7, -4),
        )
    )


@pytest.mark.slow
def test_lobatto_with_steps_of_any_length():
    check(
        ratios(
            SCENES,
            3,
            method=lambda rng, span: "lobatto",
            stages=lambda rng, span: int(rng.integers(2, 7)),
            step=lambda rng, span: span / int(rng.integers(5, 25)),
        )
    )


@pytest.mark.slow
def test_gear_gupta_leimkuhler_under_a_tolerance():
    pytest.importorskip("sksundae")
    check(
        ratios(
            SCENES,
            5,
            method=lambda rng, span: "gear_gupta_leimkuhler",
            rtol=lambda rng, span: 10.0 ** rng.uniform(-7, -4),
        )
    )


def test_consistent_states():
    """The defect that is left is a figure of the scaled distance from the constraints."""
    rng = np.random.default_rng(6)
    met = []
    for _ in range(SCENES):
        circle = random_circle(rng)
        q, qd = circle.state
        off = 0.1 * rng.standard_normal(2)
        found = consistent_state(circle.system, q + np.linalg.solve(circle.oblique, off), qd)
        # Distance from the circle by hand, over the size of the coordinates.
        x = circle.oblique @ found.q
        met.append(abs(np.hypot(*x) - 1.0))
        assert found.error < 1e-13
    assert np.max(met) < 1e-12
