"""The constrained family: a sliding pendulum with a multiplier, with none, and driven."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.constrained import constrained_motion
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import Constrained
from pendulum_truth import NUMBERS, STROKE, cartesian, drives

DRIVE = 3.1  # rad/s
DRIVES = drives(DRIVE)
DAMPED = {"damping": 0.4}


@pytest.fixture(scope="module")
def systems(emit):
    def system(formulation: str, **changes) -> Constrained:
        found = emit("sliding_pendulum", ModelSpec("sliding_pendulum", formulation))
        external = DRIVES if formulation == "driven" else None
        values = {**NUMBERS, **changes}
        return Constrained.from_module(
            found.module, values, external=external, provenance=found.provenance
        )

    return system


def test_redundant_and_minimal_coordinates_agree(systems):
    rng = np.random.default_rng(1)
    states = rng.normal(size=(4, 3, 50))
    q, qd = cartesian(*states)
    found, multipliers = systems("multiplier", damping=2.0).accelerations(q, qd)
    place, angle, speed, turning = states
    minimal, none = systems("minimal", damping=2.0).accelerations(
        np.stack([place, angle], axis=-1), np.stack([speed, turning], axis=-1)
    )
    assert found.shape == (3, 50, 3)
    assert multipliers.shape == (3, 50, 1)
    assert none.shape == (3, 50, 0)
    rod, bob = NUMBERS["rod"], NUMBERS["bob"]
    sin, cos = np.sin(angle), np.cos(angle)
    along = minimal[..., 0] + rod * (minimal[..., 1] * cos - turning**2 * sin)
    down = rod * (minimal[..., 1] * sin + turning**2 * cos)
    np.testing.assert_allclose(found[..., 0], minimal[..., 0], rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(found[..., 1], along, rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(found[..., 2], down, rtol=1e-11, atol=1e-11)
    # Newton for the bob along the rod: tension = bob (g cos + rod turning^2 - s'' sin)
    pull = bob * (NUMBERS["gravity"] * cos + rod * turning**2 - minimal[..., 0] * sin)
    np.testing.assert_allclose(-2 * rod * multipliers[..., 0], pull, rtol=1e-11, atol=1e-11)


def test_names_and_parameters(systems, emit):
    system = systems("multiplier")
    assert system.labels == ("s", "px", "py")
    assert system.provenance["module"] == "sliding_pendulum_multiplier"
    module = emit("sliding_pendulum", ModelSpec("sliding_pendulum", "driven")).module
    with pytest.raises(BadInput, match="drive_d1"):
        Constrained.from_module(module, NUMBERS, external={"drive": DRIVES["drive"]})
    with pytest.raises(BadInput, match="gravity"):
        Constrained.from_module(module, {"rod": 1.0}, external=DRIVES)


def test_the_drive_is_followed(systems):
    q, qd = cartesian(0.0, 0.7, STROKE * DRIVE, 0.2)
    found = constrained_motion(systems("driven", **DAMPED), q, qd, 3.0, samples=30)
    found.require()
    exact = STROKE * np.sin(DRIVE * found.time)
    np.testing.assert_allclose(found.q[:, 0], exact, atol=1e-15)
    # The multiplier of the drive is its force: block and bob by Newton.
    force = NUMBERS["block"] * found.qdd[:, 0] + NUMBERS["bob"] * found.qdd[:, 1]
    force += NUMBERS["spring"] * found.q[:, 0] + DAMPED["damping"] * found.qd[:, 0]
    np.testing.assert_allclose(found.multipliers[:, 1], force, atol=1e-10)
