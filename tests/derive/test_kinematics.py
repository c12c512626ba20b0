"""The derived kinematics of the three linkages: structure of the steps, hand cases, broadcasting.

The digits of every output are those of ``emitted_accuracy``, against the closed loops.
"""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.derive.models import four_bar, quick_return, slider_crank
from elastolink.derive.safe import UnsafeRewriting
from elastolink.derive.spec import ModelSpec
from elastolink.generated import (
    four_bar_kinematics,
    quick_return_kinematics,
    slider_crank_kinematics,
)
from linkage_truth import OUTPUTS, Linkage
from sliding_truth import ROD, SLIDER

MODELS = {"four_bar": four_bar, "slider_crank": slider_crank, "quick_return": quick_return}
ROCKER = Linkage(5.0, 1.0, 5.0, 2.0, 1.0)


def motion(theta, linkage, **changes):
    arguments = {**linkage.point("", 0.0).arguments, "theta2": theta, **changes}
    return dict(zip(OUTPUTS, four_bar_kinematics.motion(**arguments), strict=True))


@pytest.mark.parametrize("name", MODELS)
def test_each_step_serves_an_output(name):
    """So that nothing idle is emitted; the forces use the sines and cosines that are left over."""
    closed = MODELS[name].MODEL.energies(ModelSpec(name, "kinematics"))
    assert closed.steps == closed.steps.needed(value for _, value in closed.outputs)


def test_a_rewriting_that_does_not_hold_is_refused():
    k = slider_crank.kinematics()
    with pytest.raises(UnsafeRewriting):
        slider_crank._by_ends(k, k.sin2**2)


def test_lengths_broadcast_against_angles_and_scalars_work():
    theta, cranks = np.linspace(0.0, 6.0, 5), np.array([[0.5], [1.0], [1.5]])
    theta.flags.writeable = False  # nothing is filled in place
    together = motion(theta, ROCKER, crank=cranks)
    for i, length in enumerate(cranks[:, 0]):
        for j, angle in enumerate(theta):
            alone = motion(float(angle), ROCKER, crank=float(length))
            for name, value in alone.items():
                assert together[name][i, j] == pytest.approx(value, rel=1e-14, abs=1e-15)
    whole = motion(3, ROCKER, frame=5, crank=1, coupler=5, follower=2, assembly=1, winding=0)
    assert whole == motion(3.0, ROCKER)


@pytest.mark.smoke
def test_hand_cases():
    """Right angles by Pythagoras, the crank upright."""
    # Frame 4, crank 3: BD = 5; coupler 12 and follower 13 make BCD right-angled.
    m = motion(np.pi / 2, Linkage(4.0, 3.0, 12.0, 13.0, 1.0))
    assert m["transmission_angle"] == pytest.approx(np.arctan2(5, 12), rel=1e-15)
    # BD points down by atan(3/4); CB is at right angles to it, C on the left: the open assembly.
    assert m["theta3"] == pytest.approx(np.pi / 2 - np.arctan2(3, 4), rel=1e-15)
    values = slider_crank_kinematics.motion(np.pi / 2, 3.0, 5.0, 0.0, 1.0)
    m = dict(zip(SLIDER, values, strict=True))
    assert m["position"] == pytest.approx(4.0, rel=1e-15)
    assert m["theta3"] == pytest.approx(-np.arctan2(3, 4), rel=1e-15)
    assert m["omega3"] == pytest.approx(0.0, abs=1e-15)  # pi/2 is off by 6e-17
    # The pin's velocity is along the guide, and so is the slider's.
    assert m["slider_velocity"] == pytest.approx(-3.0, rel=1e-15)
    assert m["alpha3"] == pytest.approx(3.0 / 4.0, rel=1e-15)
    values = quick_return_kinematics.motion(np.pi / 2, 4.0, 3.0, 0.0)
    m = dict(zip(ROD, values, strict=True))
    assert m["slide"] == pytest.approx(5.0, rel=1e-15)
    assert m["theta4"] == pytest.approx(np.arctan2(3, 4), rel=1e-15)
    # The pin moves to the left with 3: 3 * 3/5 across the rod, -3 * 4/5 along it.
    assert m["omega4"] == pytest.approx(9.0 / 25.0, rel=1e-15)
    assert m["slide_velocity"] == pytest.approx(-12.0 / 5.0, rel=1e-15)
