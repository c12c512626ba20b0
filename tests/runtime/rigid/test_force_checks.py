"""Checks, files and pictures of rigid forces: at single angles, along a guide."""

from __future__ import annotations

import json

import numpy as np
import pytest
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from elastolink.runtime.rigid import (
    Load,
    Machine,
    MassDistribution,
    Spring,
    driving_torque,
    rigid_forces,
    shaking_force,
)
from elastolink.runtime.rigid.force_errors import checks

LINKAGES = [
    FourBar(0.3, 0.1, 0.28, 0.25),
    FourBar(0.3, 0.1, 0.28, 0.25, "crossed"),
    SliderCrank(0.1, 0.35, 0.04),
    QuickReturn(0.3, 0.1, 0.6),
]
EVERY = pytest.mark.parametrize("linkage", LINKAGES, ids=lambda item: type(item).__name__)


def machine_of(linkage):
    masses = {link: MassDistribution.about_centre(0.5, 0.08, 0.03, 0.01) for link in linkage.links}
    last = linkage.links[2]
    return Machine(
        linkage,
        masses,
        (0.3, -9.81),
        (Load(last, (3.0, -2.0), 0.5, 0.1),),
        (Spring(("frame", 0.1, 0.5), (last, 0.05, 0.02), 300.0, 0.1, 5.0),),
    )


@EVERY
def test_a_single_angle_has_checks_and_a_file(linkage, tmp_path) -> None:
    found = rigid_forces(machine_of(linkage), 1.0, 5.0, 2.0)
    assert found.passed
    told = json.loads(found.save(tmp_path / "f.json").read_text())
    assert told["torque"] == float(found.torque)
    assert told["passed"]
    assert shaking_force(machine_of(linkage), 1.0, 5.0).passed


@EVERY
@pytest.mark.parametrize("name", ["x12", "y23", "x34", "y41", "torque"])
def test_a_wrong_force_is_out_of_balance(linkage, name) -> None:
    machine, theta = machine_of(linkage), np.linspace(0.1, 6.0, 9)
    given = (machine, theta, np.full(9, 5.0), np.zeros(9))
    values = dict(rigid_forces(machine, theta, 5.0).values)
    assert all(check.passed for check in checks(*given, values).values())
    values[name] = values[name] + 1e-9
    assert not checks(*given, values)["equilibrium of the links over its error"].passed


def test_a_peak_between_the_places_is_looked_at() -> None:
    """One angle among a thousand beside a fold."""
    linkage = FourBar(0.3, 0.25, 0.1, 0.1)
    low, high = linkage.crank_ranges()[0]
    theta = np.full(1000, 0.5 * (low + high))
    theta[517] = high
    coupler = MassDistribution.uniform_bar(1.0, 0.1)
    assert not driving_torque(Machine(linkage, {"coupler": coupler}), theta, 1.0).passed


def test_a_force_along_one_axis_is_drawn_over_the_turn() -> None:
    found = rigid_forces(machine_of(LINKAGES[2]), np.linspace(0.0, 6.0, 61), 5.0)
    axes = found.plot(joint="41")
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), found["y41"])
    assert axes.get_xlabel() == "crank angle [deg]"
    assert axes.get_ylabel() == "pin force 41, Y [N]"
    assert found.plot(joint="34").get_xlabel() == "X [N]"


def test_rates_over_the_crank_speed_name_their_units() -> None:
    motion = LINKAGES[2].motion(np.linspace(0.0, 6.0, 61))
    axes = motion.plot()
    words = [text.get_text() for text in axes.get_legend().get_texts()]
    assert words == ["position [m]", "velocity [m/rad]", "acceleration [m/rad^2]"]
    assert axes.get_ylabel() == "m, m/rad, m/rad^2"
    assert LINKAGES[2].motion(0.3, 2.0).unit("slider_velocity") == "m/s"
