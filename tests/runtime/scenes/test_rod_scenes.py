"""Scenes of the flexible rod: its numbers, its formulations, what is refused before any work."""

import math

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.systems.rod import OverhangBasis, rod_system
from free_free_loads import ROD
from refusals import refused

FLEXIBLE = "beale_1992_flexible_rod"
STIFF = "beale_1992_bahgat_willmert"
FREE = {"model.formulation": "free_free", "model.modes": 1}
LINEAR = ("overhang", "polynomial", "two_segment", "free_free_linear")
INCH, POUND, POUND_FORCE = 0.0254, 0.45359237, 4.4482216152605  # exact by definition


def test_numbers_of_the_flexible_rod():
    scene = el.load_scene(FLEXIBLE)
    assert scene["rod"]["bending_stiffness"] == pytest.approx(0.7e11 * 0.5208e-6, rel=1e-15)
    # Section 2.1 gives the crank itself, 0.0059997 m.
    assert scene["links"]["crank"] == pytest.approx(0.0059997, rel=1e-15)
    assert scene.mechanism().eps == pytest.approx(0.01, rel=1e-15)


def test_both_readings_of_the_stiff_rods_mass():
    light, heavy = (el.load_scene(name)["rod"] for name in (STIFF, f"{STIFF}_heavy"))
    assert light["bending_stiffness"] == pytest.approx(2.91992e6 * POUND_FORCE * INCH**2, rel=1e-12)
    assert light["mass_per_length"] == pytest.approx(0.1268 * POUND / INCH, rel=1e-12)
    # The other is that times standard gravity in in/s^2.
    heavier = 0.1268 * POUND_FORCE / INCH**2
    assert heavy["mass_per_length"] == pytest.approx(heavier, rel=1e-12)


@pytest.mark.parametrize("formulation", LINEAR)
def test_a_linear_formulation_is_its_basis(formulation):
    scene = el.load_scene(
        FLEXIBLE, {"model.formulation": formulation, "model.modes": 2, "links.crank_ratio": 0.15}
    )
    system = scene.system()
    assert isinstance(system, el.LinearPeriodic)
    direct = rod_system(formulation.removesuffix("_linear"), 2, crank_ratio=0.15, **ROD)
    theta = np.linspace(0.0, 6.0, 7)
    for name in "MABKf":
        np.testing.assert_allclose(
            system.array(name, theta), direct.array(name, theta), rtol=1e-12, atol=1e-14
        )
    assert system.provenance["scene"] == FLEXIBLE


def test_the_constrained_formulation():
    scene = el.load_scene(FLEXIBLE, {"model.formulation": "free_free", "model.modes": 2})
    system = scene.system()
    assert isinstance(system, el.Constrained)
    assert (system.size, system.constraints) == (5, 3)
    with pytest.raises(el.BadInput, match="constrained; expected a linear formulation"):
        scene.linear_system()


def test_as_printed_is_a_name_for_what_is_dropped():
    printed = {"model.drop": ["as_printed"]}
    assert el.load_scene(FLEXIBLE, printed).model_spec().drop == ("frame", "tension")
    free = {**printed, "model.formulation": "free_free"}
    assert el.load_scene(FLEXIBLE, free).model_spec().drop == ("tension",)
    # It matters: without the tension the first multipliers are others.
    found = [
        el.floquet_multipliers(
            el.load_scene(FLEXIBLE, {**drop, "links.crank_ratio": 0.2}).linear_system(), 300.0
        ).multipliers
        for drop in ({}, printed)
    ]
    assert np.max(np.abs(np.sort_complex(found[0]) - np.sort_complex(found[1]))) > 1e-2


@pytest.mark.parametrize("law", ["viscous", "internal", "modal"])
def test_a_damping_ratio_is_that_of_the_first_mode(law):
    """A crank of next to no length leaves the frozen rod: its first decay is the ratio asked."""
    scene = el.load_scene(
        FLEXIBLE,
        {
            "links.crank_ratio": 1e-9,
            "model.modes": 2,
            "rod.damping_ratio": 0.01,
            "rod.damping_law": law,
        },
    )
    speed = 3000.0
    found = el.floquet_multipliers(scene.linear_system(), speed).multipliers
    numbers = {name: value for name, value in ROD.items() if name != "frame"}
    first = OverhangBasis(1).frequencies(ROD["frame"], **numbers).frequencies[0, 0]
    # |rho| = exp(-zeta omega T), T one turn.
    wanted = math.exp(-0.01 * first * 2.0 * math.pi / speed)
    assert np.min(np.abs(np.abs(found) - wanted)) < 1e-9


test_impossible_rods_are_refused_in_words = refused(
    lambda overrides: el.load_scene(FLEXIBLE, overrides).system(),
    [
        ({"links.crank_ratio": 1.0}, "another length than frame"),
        ({"links.crank_ratio": 0.8}, "the block would leave the rod"),
        ({"links.crank": "0.1 m", "links.crank_ratio": 0.2}, "keep one"),
        ({"rod.modulus": None}, "bending_stiffness"),
        ({"rod.second_moment": None}, "no section"),
        ({"rod.second_moment": "1e-6 m**4", "rod.bending_stiffness": "3e4 N*m**2"}, "at most one"),
        ({"rod.mass_per_length": "-1 kg/m"}, "mass_per_length"),
        ({"rod.damping_ratio": 0.1, "rod.relaxation_time": "1 ms"}, "keep one"),
        ({"model.formulation": "overhung"}, "overhang"),
        ({"model.drop": ["gravity"]}, "gravity"),
        (FREE | {"rod.damping": 1.0}, "has no damping"),
        (FREE | {"operation.speed": None}, "crank speed"),
    ],
)


def test_stiffness_and_section_take_each_others_place():
    """What an override replaces goes, so that nothing given is ignored."""
    stiff = el.load_scene(FLEXIBLE, {"rod.bending_stiffness": "3e4 N*m**2"})
    assert stiff["rod"]["bending_stiffness"] == 3e4
    section = el.load_scene(FLEXIBLE, {"rod.second_moment": "1e-6 m**4"})
    np.testing.assert_allclose(section["rod"]["bending_stiffness"], 0.7e11 * 1e-6, rtol=1e-14)
    both = {"rod.modulus": "2e11 Pa", "rod.second_moment": "1e-6 m**4"}
    assert el.load_scene(STIFF, both)["rod"]["bending_stiffness"] == pytest.approx(2e5, rel=1e-14)
    # A section alone says no stiffness.
    with pytest.raises(el.BadInput, match="bending_stiffness"):
        el.load_scene(STIFF, {"rod.second_moment": "1e-6 m**4"})
