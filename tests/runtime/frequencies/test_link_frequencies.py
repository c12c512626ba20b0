"""Frequencies against one link's length or section: weight, parameters and geometry stay."""

from dataclasses import replace

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.frequencies import link_frequencies

LINKS = el.FourBar(crank=0.170, coupler=0.328, follower=0.525, frame=0.547)
BAR = el.Section.rectangle(0.025, 0.003, modulus=210e9, density=7850.0)
BARS = dict.fromkeys(("crank", "coupler", "follower"), BAR)
# A hundred times the earth's: weight is felt, and the links hang stiff.
WEIGHT = (0.0, -981.0)
CHANGES = {"elasticity": 1.7, "distributed_mass": 0.8, "lumped_mass": 2.0}


def _system(sections=None, linkage=LINKS, **options):
    given = {"joint_masses": {"B": 0.1, "C": 0.2}, "elements": 1, "gravity": WEIGHT, **options}
    return el.linkage_system(linkage, sections or BARS, **given)


def _mean(system, count=2):
    return el.natural_frequencies(system, [0.0], count).branch_mean


def _agrees(found, system):
    """The study's one mean is that of a system made directly, to the errors of both."""
    own = el.natural_frequencies(system, [0.0], 2)
    allowed = found.error[0] + own.mean_error + 1e-12 * own.mean
    assert np.all(np.abs(found.mean[0] - own.mean) <= allowed)


def test_weight_stiffens_whatever_varies():
    system, light = _system(), _system(gravity=(0.0, 0.0))
    found = link_frequencies(system, "coupler", "width", [1.0], count=2)
    _agrees(found, system)
    without = link_frequencies(light, "coupler", "width", [1.0], count=2)
    assert np.all(np.abs(found.mean - without.mean) > 1e-3 * without.mean)


@pytest.mark.parametrize(
    ("quantity", "power"), [("thickness", 3), pytest.param("width", 1, marks=pytest.mark.slow)]
)
def test_parameters_stay_and_a_changed_section_is_that_section(quantity, power):
    system = _system().with_parameters(**CHANGES)
    found = link_frequencies(system, "follower", quantity, [1.3], count=2)
    thicker = replace(BAR, area=1.3 * BAR.area, second_moment=1.3**power * BAR.second_moment)
    other = _system({**BARS, "follower": thicker}).with_parameters(**CHANGES)
    _agrees(found, other)
    assert np.all(np.abs(found.mean - _mean(_system())) > 0.05 * found.mean)
    # A beam's own frequency goes with the root of modulus over density.
    root = np.sqrt(1.7 / 0.8 * thicker.bending_stiffness / thicker.mass_per_length)
    alone = (np.pi / LINKS.lengths["follower"]) ** 2 * root
    assert found.pinned[0, 2] == pytest.approx(alone, rel=1e-14)


def test_lengths_parameters_damping_and_loads_stay():
    nodes = {"C": {"force": (400.0, 150.0)}}
    system = el.with_modal_damping(_system(nodes=nodes), 0.02)
    system = system.with_geometry(coupler=0.4).with_parameters(elasticity=1.4)
    longer = el.FourBar(crank=0.170, coupler=0.4, follower=0.525, frame=0.547)
    other = _system(linkage=longer, nodes=nodes).with_parameters(elasticity=1.4)
    _agrees(link_frequencies(system, "crank", "thickness", [1.0], count=2), other)
    _agrees(link_frequencies(system, "frame", "length", [0.547], count=2), other)


def test_a_system_that_cannot_be_made_anew_is_refused():
    alone = replace(_system(), remesh=None)
    with pytest.raises(el.BadInput, match="linkage_system"):
        link_frequencies(alone, "coupler", "thickness", [1.1])
