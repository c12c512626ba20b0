"""Constrained motion of the sliding pendulum, against its equations without constraints."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.constrained import constrained_motion
from elastolink.runtime.core.families import Constrained
from pendulum_truth import NUMBERS, STROKE, cartesian, drives

DAMPED = NUMBERS | {"damping": 0.4}
DRIVE = 3.1  # rad/s
DRIVES = drives(DRIVE)


@pytest.fixture(scope="module")
def system(emit):
    def made(formulation: str, **changes) -> Constrained:
        found = emit("sliding_pendulum", ModelSpec("sliding_pendulum", formulation))
        external = DRIVES if formulation == "driven" else None
        return Constrained.from_module(found.module, DAMPED | changes, external=external)

    return made


def test_multipliers_and_motion_are_those_of_the_minimal_form(system):
    start = (0.05, 1.1, 0.0, 0.4)
    found = constrained_motion(
        system("multiplier"), *cartesian(*start), 2.0, samples=20, rtol=1e-10
    )
    minimal = constrained_motion(
        system("minimal"), start[:2], start[2:], 2.0, samples=20, rtol=1e-12
    )
    found.require()
    assert minimal.multipliers.shape == (21, 0)
    q, qd = cartesian(*minimal.q.T, *minimal.qd.T)
    gap = np.max(np.abs(found.q - q), axis=0)
    assert np.all(gap <= found.error + 2 * np.max(minimal.error))
    np.testing.assert_allclose(found.qd, qd, atol=3e-6)
    # Newton for the bob along the rod: pull = bob (g cos + rod turning^2 - s'' sin) = -2 rod lam
    angle, turning = minimal.q[:, 1], minimal.qd[:, 1]
    push = NUMBERS["gravity"] * np.cos(angle) + NUMBERS["rod"] * turning**2
    pull = NUMBERS["bob"] * (push - minimal.qdd[:, 0] * np.sin(angle))
    np.testing.assert_allclose(
        -2 * NUMBERS["rod"] * found.multipliers[:, 0], pull, atol=2e-6 * np.max(np.abs(pull))
    )


def test_the_drive_is_followed(system):
    q, qd = cartesian(0.0, 0.7, STROKE * DRIVE, 0.2)
    found = constrained_motion(system("driven"), q, qd, 3.0, samples=30)
    found.require()
    exact = STROKE * np.sin(DRIVE * found.time)
    np.testing.assert_allclose(found.q[:, 0], exact, atol=1e-15)
    # The multiplier of the drive is its force: block and bob by Newton.
    force = NUMBERS["block"] * found.qdd[:, 0] + NUMBERS["bob"] * found.qdd[:, 1]
    force += NUMBERS["spring"] * found.q[:, 0] + DAMPED["damping"] * found.qd[:, 0]
    np.testing.assert_allclose(found.multipliers[:, 1], force, atol=1e-10)


def test_a_stop_of_the_block(system):
    q, qd = cartesian(0.0, 0.3, 0.0, 0.0)
    ends = (lambda t, q, qd: 0.005 - abs(q[0]), "the block reached its stop")
    found = constrained_motion(system("multiplier"), q, qd, 5.0, guards=(ends,))
    assert found.status == 1
    assert "the block reached its stop" in found.message
    np.testing.assert_allclose(abs(found.q[-1, 0]), 0.005, atol=1e-12)
