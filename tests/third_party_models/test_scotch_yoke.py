"""The closed-form family: a Scotch yoke against its closed form by hand, whole and in part."""

import numpy as np
from elastolink.derive.spec import ModelSpec

SPEC = ModelSpec("scotch_yoke", "kinematics")
THETA, CRANK, LEAN = np.linspace(-7.0, 7.0, 29), 0.11, 0.3


def test_motion_by_hand(emit):
    """The slot cuts the slide at crank cos(theta - lean)/cos(lean)."""
    module = emit("scotch_yoke", SPEC).module
    assert module.RETURNS["motion"] == ("position", "speed", "acceleration")
    turned, size = THETA - LEAN, CRANK / np.cos(LEAN)
    expected = size * np.array([np.cos(turned), -np.sin(turned), -np.cos(turned)])
    np.testing.assert_allclose(module.motion(THETA, CRANK, LEAN), expected, atol=2e-16)


def test_only_what_is_wanted_is_emitted(emit):
    lean = emit("scotch_yoke", SPEC.with_(outputs=("position",))).module
    assert lean.RETURNS["motion"] == ("position",)
    whole = emit("scotch_yoke", SPEC).module.motion(THETA, CRANK, LEAN)
    np.testing.assert_allclose(lean.motion(THETA, CRANK, LEAN), whole[0], atol=3e-17)
