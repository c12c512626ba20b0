"""The derived kinematics of the four-bar linkage: exact identities, structure, namespaces."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.derive.models.four_bar import MODEL
from elastolink.derive.spec import ModelSpec
from elastolink.generated import four_bar_kinematics
from linkage_truth import OUTPUTS, Linkage, random_points

SPEC = ModelSpec("four_bar", "kinematics")
ROCKER = Linkage(5.0, 1.0, 5.0, 2.0, 1.0)


def motion(theta, linkage, **changes):
    arguments = {**linkage.point("", 0.0).arguments, "theta2": theta, **changes}
    return dict(zip(OUTPUTS, four_bar_kinematics.motion(**arguments), strict=True))


# ---------------------------------------------------------------- before lowering


def test_kinematics_needs_no_more_than_the_motion_uses():
    """Each step serves an output, so that nothing idle is emitted."""
    closed = MODEL.energies(SPEC)
    assert closed.steps == closed.steps.needed(value for _, value in closed.outputs)


# ---------------------------------------------------------------- the emitted function


def test_nothing_is_filled_in_place_and_scalars_work():
    theta = np.linspace(-1.0, 7.0, 9)
    theta.flags.writeable = False
    expected = motion(theta, ROCKER)
    for kind in (float, np.float64):
        for i, angle in enumerate(theta):
            for name, value in motion(kind(angle), ROCKER).items():
                assert value == pytest.approx(expected[name][i], rel=1e-15, abs=1e-15)
    whole = motion(3, ROCKER, frame=5, crank=1, coupler=5, follower=2, assembly=1, winding=0)
    assert whole == motion(3.0, ROCKER)
    shaped = motion(theta.reshape(3, 3), ROCKER)
    np.testing.assert_array_equal(shaped["alpha4"].ravel(), expected["alpha4"])


def test_lengths_broadcast_against_angles():
    theta, cranks = np.linspace(0.0, 6.0, 5), np.array([[0.5], [1.0], [1.5]])
    together = motion(theta, ROCKER, crank=cranks)
    for i, length in enumerate(cranks[:, 0]):
        alone = motion(theta, ROCKER, crank=float(length))
        for name, value in alone.items():
            np.testing.assert_allclose(together[name][i], value, rtol=1e-14, atol=1e-15)


def test_pythagoras_at_a_hand_case():
    """Frame 4, crank 3 at 90 deg: BD = 5; coupler 12 and follower 13 make BCD right-angled."""
    m = motion(np.pi / 2, Linkage(4.0, 3.0, 12.0, 13.0, 1.0))
    assert m["transmission_angle"] == pytest.approx(np.arctan2(5, 12), rel=1e-15)
    # BD points down by atan(3/4); CB is at right angles to it, C on the left: the open assembly.
    assert m["theta3"] == pytest.approx(np.pi / 2 - np.arctan2(3, 4), rel=1e-15)


def test_identities_of_the_emitted_numbers():
    """Smith (2.7): the speed ratio by the instant centres; rates sum up round the loop."""
    for point in random_points(40, seed=6):
        m = dict(zip(OUTPUTS, four_bar_kinematics.motion(**point.arguments), strict=True))
        n = point.arguments
        turn = n["theta2"] - m["theta3"]
        sine = np.sin(m["theta4"] - m["theta3"])
        ratio = n["crank"] * np.sin(turn) / (n["follower"] * sine)
        assert m["omega4"] == pytest.approx(ratio, rel=1e-10, abs=1e-11 / abs(sine))
        assert np.sign(sine) == n["assembly"]
        assert abs(np.sin(m["transmission_angle"])) == pytest.approx(abs(sine), abs=1e-11)
