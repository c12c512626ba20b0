"""Error figures of constrained motions and consistent states against elliptic functions."""

from __future__ import annotations

import numpy as np
import pytest
from constrained_truth import random_circle
from elastolink.runtime.constrained import consistent_state, constrained_motion

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


@pytest.mark.slow
def test_projection_under_a_tolerance():
    check(ratios(SCENES, 1, rtol=lambda rng, span: 10.0 ** rng.uniform(-12, -4)))


@pytest.mark.slow
def test_projection_with_fixed_steps():
    check(ratios(SCENES, 4, step=lambda rng, span: span / int(rng.integers(5, 25))))


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
