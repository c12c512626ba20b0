"""Scenes of rigid linkages: every way to give a mass, loads and springs by name, clear refusals."""

import json
import math

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.rigid import Load, Spring, TorsionSpring
from elastolink.runtime.scenes import load_scene

SMITH = "smith_1972_12_6_12_12"
STEEL = "aannaque_1996_table_3_2"
ENGINE = "slider_crank_example"
SHAPER = "quick_return_example"


def test_masses_of_a_section_of_a_slider_and_of_a_rig():
    bar = load_scene(STEEL).machine().masses["follower"]
    assert bar.mass == pytest.approx(7850 * 0.025 * 0.00315 * 0.525, rel=1e-14)
    assert bar.inertia == pytest.approx(bar.mass * 0.525**2 / 3, rel=1e-14)
    # A slider has its mass at the pin.
    slider = load_scene(ENGINE).machine().masses["slider"]
    assert (slider.mass, slider.along, slider.inertia) == (0.45, 0.0, 0.0)
    rig = load_scene("smith_1972_5152_sixteenth_inch").machine()
    assert set(rig.masses) == {"coupler", "follower"} and rig.masses["coupler"].mass > 0
    with pytest.raises(BadInput, match="no mass"):
        load_scene("smith_1972_10_8_10_10").machine()


@pytest.mark.parametrize("name", [SMITH, STEEL, ENGINE, SHAPER])
def test_linkage_and_machine_of_each_rigid_scene(name):
    scene = load_scene(name)
    linkage, machine = scene.mechanism(), scene.machine()
    assert machine.linkage == linkage
    assert set(machine.masses) <= set(linkage.links)
    assert linkage.lengths == {key: scene["links"][key] for key in linkage.lengths}
    assert linkage.motion(np.linspace(0.0, 6.0, 7)).passed
    with pytest.raises(BadInput, match="in which nothing vibrates"):
        scene.system()


def test_centre_and_inertia_about_it_move_to_the_first_joint():
    given = {
        "coupler.mass": "2 kg",
        "coupler.centre_along": "30 mm",
        "coupler.centre_across": "-10 mm",
        "coupler.inertia_about_centre": "0.004 kg*m**2",
    }
    bar = load_scene(ENGINE, given).machine().masses["coupler"]
    assert (bar.along, bar.across) == pytest.approx((0.06, -0.02), rel=1e-14)
    assert bar.inertia == pytest.approx(0.004 + 2 * (0.03**2 + 0.01**2), rel=1e-14)
    assert bar.inertia_about_centre == pytest.approx(0.004, rel=1e-13)
    # An override replaces what says the same.
    scene = load_scene(ENGINE, {"coupler.first_moment": 0.01})
    assert "centre_along" not in scene["coupler"]
    assert scene.machine().masses["coupler"].along == 0.01


def test_gravity_pulls_only_where_it_has_a_direction():
    assert load_scene(ENGINE).machine().gravity == (0.0, 0.0)
    down = load_scene(ENGINE, {"gravity.direction": "-90 deg"}).machine().gravity
    assert down == pytest.approx((0.0, -9.80665), abs=1e-15)


def test_loads_and_springs_by_name():
    given = {
        "loads.tool.force": ["3 N", "-4 N"],
        "loads.tool.along": "0.4 m",
        "springs.back.first": "frame",
        "springs.back.first_at": ["-0.5 m", "0.1 m"],
        "springs.back.second": "rod",
        "springs.back.second_at": ["0.3 m", "0 m"],
        "springs.back.stiffness": "200 N/m",
        "springs.back.free_length": "0.1 m",
        "torsion_springs.hinge.first": "frame",
        "torsion_springs.hinge.second": "rod",
        "torsion_springs.hinge.stiffness": "3 N*m/rad",
        "torsion_springs.hinge.free_angle": "10 deg",
    }
    scene = load_scene(SHAPER, given)
    machine = scene.machine()
    assert machine.loads == (Load("rod", (3.0, -4.0), -20.0, along=0.4),)
    spring = Spring(("frame", -0.5, 0.1), ("rod", 0.3, 0.0), stiffness=200.0, free_length=0.1)
    torsion = TorsionSpring("frame", "rod", stiffness=3.0, free_angle=math.radians(10.0))
    assert machine.springs == (spring, torsion)
    assert scene.get("loads.tool.couple") == -20.0
    assert scene.dimension("loads.tool.couple") == "moment"
    json.dumps(scene.to_dict())
    assert scene.digest() != load_scene(SHAPER).digest()
    # Overrides leave the document as it was.
    load_scene(SHAPER, {"loads.tool.couple": -1.0})
    assert load_scene(SHAPER).get("loads.tool.couple") == -20.0


@pytest.mark.parametrize(
    ("name", "overrides", "said"),
    [
        (SHAPER, {"loads.tool.cuple": 1.0}, "did you mean couple"),
        (SHAPER, {"loads.tool.link": "coupler"}, "loads.tool.link: found 'coupler'"),
        (SHAPER, {"loads.tool": 3.0}, "write [loads.NAME] above the keys"),
        (SHAPER, {"springs.back.stiffness": 3.0}, "springs.back.first: found nothing"),
        (SHAPER, {"links.crank": "0.25 m"}, "would pass the rod's pivot"),
        (ENGINE, {"links.offset": "0.3 m"}, "the slider's line is out of reach"),
        (ENGINE, {"coupler.density": 7850}, "width and thickness beside it"),
        (ENGINE, {"slider.mass": None, "slider.centre_along": 0.1}, "mass, weight or density"),
        (SMITH, {"coupler.first_moment": 0.2}, "no body has these three"),
        (ENGINE, {"model.balanced": ["coupler"]}, "0, since model.balanced names this link"),
    ],
)
def test_refusals_say_what_is_wrong(name, overrides, said):
    with pytest.raises(BadInput) as refusal:
        load_scene(name, overrides)
    assert said in str(refusal.value)
