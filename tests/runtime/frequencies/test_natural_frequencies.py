"""Natural frequencies over the crank angle: modes, veerings, buckling, pictures, bad input."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.beams import linear_system
from elastolink.runtime.frequencies import (
    buckling_speed,
    draw_mode,
    draw_modes,
    link_frequencies,
)
from periodic_systems import system_of


def _linkage(elements=1, formulation="cubic_beams"):
    overrides = {"mesh.elements": elements, "model.formulation": formulation}
    return el.load_scene("aannaque_1996_table_4_1", overrides=overrides).system()


@pytest.fixture(scope="module")
def linkage():
    return _linkage()


def test_shapes_are_modes_of_unit_mass(linkage):
    theta = np.linspace(0.0, 2 * np.pi, 13)
    found = el.natural_frequencies(linkage, theta, 4)
    mass, stiffness = linkage.array("M", theta), linkage.array("K", theta)
    unit = np.einsum("tik,tij,tjl->tkl", found.shape, mass, found.shape)
    np.testing.assert_allclose(unit, np.broadcast_to(np.eye(4), unit.shape), atol=1e-10)
    strain = np.einsum("tik,tij,tjk->tk", found.shape, stiffness, found.shape)
    np.testing.assert_allclose(np.sqrt(strain), found.tracked, rtol=1e-10)
    # A whole turn later the mechanism stands as it stood, and so do its modes.
    np.testing.assert_allclose(found.mac[-1], 1.0, rtol=1e-9)
    assert list(found.closure) == [1, 2, 3, 4]


def test_the_linkage_has_a_veering_of_modes_two_and_three(linkage):
    found = el.natural_frequencies(linkage, count=3)
    assert [(one.kind, one.lower) for one in found.encounters] == [("veering", 2)]
    veering = found.encounters[0]
    told = found.to_dict()
    assert told["encounter_rank"] == [2] and told["encounter_width"] == [veering.width]
    # Two modes that trade with each other alone: 2 coupling width = 1.
    assert veering.trade == pytest.approx(1.0, abs=0.05)
    dense = veering.angle + np.linspace(-0.02, 0.02, 401)
    gap = np.diff(el.natural_frequencies(linkage, dense, 3).frequency[:, 1:], axis=1)[:, 0]
    assert abs(gap.min() - veering.gap) < 1e-4 * veering.gap
    assert abs(dense[int(np.argmin(gap))] - veering.angle) <= 1e-4


def test_a_standing_frame_has_the_same_frequencies_at_every_angle():
    bar = el.Section.rectangle(0.02, 0.01, modulus=210e9, density=7850.0)
    beam = el.frame(
        {"A": (0.2, 0.1), "B": (0.2 + 0.6, 0.1 + 0.8)},
        {"bar": ("A", "B")},
        bar,
        supports={"A": ("x", "y", "rotation")},
        elements=6,
        kind="internal_node",
    )
    system = linear_system(beam)
    assert all(term.constant for term in system.terms)
    found = el.natural_frequencies(system, np.array([0.0, 1.0]), 2)
    # First root of cos x cosh x = -1, to 16 digits.
    exact = 1.875104068711961**2 * np.sqrt(bar.bending_stiffness / bar.mass_per_length)
    assert found.mean[0] == pytest.approx(exact, rel=1e-7)
    np.testing.assert_allclose(found.frequency[0], found.frequency[1], rtol=1e-14)
    assert np.all(found.mean_error <= 1e-9 * found.mean) and not found.encounters


def test_axial_forces_of_the_speed_until_the_linkage_buckles(linkage):
    limit = buckling_speed(linkage)
    square = []
    for part in (0.99, 1.0 - 1e-6, 1.0 + 1e-6):
        stiffness = linkage.array("K", [limit.angle]) + linkage.array(
            "Kg", [limit.angle], part * limit.speed
        )
        square.append(np.linalg.eigvalsh(stiffness[0])[0])
    assert square[0] > square[1] > 0 > square[2]
    with pytest.raises(el.BadInput, match="buckled"):
        el.natural_frequencies(linkage, limit.angle, 1, speed=1.001 * limit.speed)
    rest = el.natural_frequencies(linkage, 0.0, 2)
    assert el.natural_frequencies(linkage, 0.0, 2, speed=30.0).mean[0] > rest.mean[0]


def test_buckling_at_the_worse_of_summits_that_samples_take_for_the_lower():
    """1.5 + 2e-5 midway between 256 angles, beside 1.5 - 1e-5 at one of them."""
    place = 2.0 * np.pi / 3.0

    def softening(theta):
        size = 1.0 + 0.5 * np.cos(3.0 * theta) + 2e-5 * np.cos(theta - place)
        return -size[:, None, None] * np.eye(1)

    still = system_of(M=np.eye(1), K=600.0 * np.eye(1))
    found = buckling_speed(still.with_terms(el.Term("Kg", None, softening, power=2)))
    assert found.speed == pytest.approx(np.sqrt(600.0 / 1.50002), rel=1e-12)
    assert found.angle == pytest.approx(place, abs=6e-6)
    buckled = system_of(M=np.eye(1), K=-np.eye(1))
    with pytest.raises(el.BadInput, match="buckled"):
        buckling_speed(buckled.with_terms(el.Term("Kg", None, softening, power=2)))


def test_the_first_mean_follows_the_softer_of_two_links():
    system = _linkage(2)
    found = link_frequencies(system, "coupler", "length", [0.328, 0.636])
    assert found.mean[0, 0] == pytest.approx(found.pinned[0, 2], rel=0.02)
    assert found.mean[1, 0] == pytest.approx(found.pinned[1, 1], rel=0.02)
    structure = system.structure
    beam = structure.beam("follower")
    section = beam.section
    root = np.sqrt(section.bending_stiffness / section.mass_per_length)
    assert found.pinned[0, 2] == pytest.approx((np.pi / beam.length) ** 2 * root, rel=1e-15)
    assert found.plot().get_xlabel() == "length of the coupler [m]"


def test_modes_are_drawn(linkage):
    assert "mode 2" in draw_mode(linkage, 0.3, 2).get_title()
    assert len(draw_modes(linkage, [0.0, 1.0], 2).axes) == 4
    assert el.natural_frequencies(linkage, count=3).plot().get_ylim()[0] == 0.0


@pytest.mark.parametrize(
    ("call", "given", "message"),
    [
        (el.natural_frequencies, {"count": 0}, "from 1 to 9"),
        (el.natural_frequencies, {"theta": []}, "theta"),
        (el.natural_frequencies, {"count": 10}, "from 1 to 9"),
        (el.natural_frequencies, {"speed": -1.0}, "0 or more"),
        (el.natural_frequencies, {"mass": 2.0}, "mass"),
        (link_frequencies, {"link": "rod", "quantity": "length", "value": 1.0}, "one of"),
        (link_frequencies, {"link": "coupler", "quantity": "colour", "value": 1.0}, "one of"),
        (link_frequencies, {"link": "coupler", "quantity": "length", "value": -1.0}, "positive"),
        (draw_mode, {"theta": 0.0, "mode": 10}, "mode"),
    ],
)
def test_bad_input_is_refused(linkage, call, given, message):
    with pytest.raises(el.BadInput, match=message):
        call(linkage, **given)
    with pytest.raises(el.BadInput, match="beams"):
        draw_modes(system_of(M=np.eye(1), K=np.eye(1)))
    with pytest.raises(el.BadInput, match="no natural frequency"):
        el.natural_frequencies(system_of(M=np.eye(1), K=-np.eye(1)))
