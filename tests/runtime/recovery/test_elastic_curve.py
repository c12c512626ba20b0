"""Curves of points of elastic links beside the rigid ones."""

import numpy as np
import pytest
from beam_motions import FOUR_BAR, cantilever, four_bar, periodic_motion
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.recovery import elastic_coupler_curve

LENGTH = FOUR_BAR.lengths["coupler"]


@pytest.fixture(scope="module")
def running():
    system = four_bar(2)
    return system, periodic_motion(system, 20.0)


def test_ends_of_the_coupler_move_as_their_joints(running):
    system, motion = running
    for along, letter in ((0.0, "B"), (LENGTH, "C")):
        found = elastic_coupler_curve(system, motion, along)
        own = [system.labels.index(f"{letter}.{part}") for part in "xy"]
        np.testing.assert_allclose(found.displacement, motion.q[:, own], atol=1e-14)
        rigid = FOUR_BAR.motion(motion.theta).joints[letter]
        np.testing.assert_allclose(found.rigid, rigid, atol=1e-14)


def test_point_off_the_axis_is_carried_by_its_section(running):
    # Rigid-body rule for the section at C: the displacement of C and the turn of the coupler there.
    system, motion = running
    beyond, off = 0.05, 0.03
    found = elastic_coupler_curve(system, motion, LENGTH + beyond, off)
    place = system.labels.index("C.coupler")
    turn = motion.q[:, place]
    angle = FOUR_BAR.motion(motion.theta).link("coupler").angle
    arm = (beyond + 1j * off) * np.exp(1j * angle) * 1j * turn
    own = [system.labels.index(f"C.{part}") for part in "xy"]
    expected = motion.q[:, own] + np.stack([arm.real, arm.imag], axis=-1)
    np.testing.assert_allclose(found.displacement, expected, atol=1e-14)


def test_curve_of_stiff_links_is_the_rigid_one(running):
    system, motion = running
    stiff = system.with_parameters(elasticity=1e6)
    found = elastic_coupler_curve(stiff, periodic_motion(stiff, 20.0))
    soft = elastic_coupler_curve(system, motion)
    assert soft.largest > 1e-4
    assert found.largest < 1e-5 * soft.largest
    ax = soft.plot()
    assert [t.get_text() for t in ax.get_legend().get_texts()] == ["rigid", "elastic"]


def test_unusable_arguments_are_refused(running):
    with pytest.raises(BadInput, match="beam"):
        elastic_coupler_curve(*running, 0.1, link="rod")
    with pytest.raises(BadInput, match="stands still"):
        elastic_coupler_curve(cantilever(), None, link="bar")
