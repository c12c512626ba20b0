"""Margins against ends of regions computed anew; a diagnosis in words."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.families import Term
from elastolink.runtime.design import diagnose, margins
from refusals import refused

COUPLER = "smith_1972_5152_sixteenth_inch"
RPM = np.pi / 30.0


def coupler(**overrides):
    return el.load_scene(COUPLER, overrides)


@pytest.mark.parametrize(
    ("damping", "speed", "name"),
    [(0.0, 765.0, "links.coupler"), (0.0, 700.0, "coupler.natural_frequency")],
)
def test_a_change_brings_the_end_of_the_region_to_the_speed(damping, speed, name):
    scene = coupler(**{"coupler.damping": damping})
    found = margins(scene, speed * RPM, [name])
    assert found.passed and np.isfinite(found.change[0, 0])
    value = scene.get(name) * (1.0 + found.change[0, 0])
    changed = coupler(**{"coupler.damping": damping, name: value}).system()
    edges = el.stability_edges(changed, (0.9 * speed * RPM, 1.1 * speed * RPM))
    ends = np.concatenate([edges.lower, edges.upper])
    assert np.min(np.abs(ends - speed * RPM)) < 1e-7


def test_a_speed_within_a_region_has_a_negative_distance_and_grows():
    found = margins(coupler(), 765.0 * RPM, ["links.coupler"])
    assert not found.stable and found.growth > 0.1
    assert found.region[0] == "region 4 of mode 1" and found.distance[0] < 0.0 < found.distance[1]
    assert found.region[1:] == ("region 5 of mode 1", "region 3 of mode 1")


def test_where_damping_closes_a_region_no_change_is_named():
    scene = coupler(**{"coupler.damping": 0.3})
    found = margins(scene, 700.0 * RPM, ["coupler.natural_frequency"])
    assert np.all(np.isnan(found.change))
    # The largest growth on the way: it stays below 0.
    value = scene.get("coupler.natural_frequency")
    for part in np.linspace(-0.1, -0.06, 21):
        both = {"coupler.damping": 0.3, "coupler.natural_frequency": value * (1.0 + part)}
        at = el.floquet_multipliers(coupler(**both).system(), 700.0 * RPM)
        assert np.max(np.abs(at.multipliers)) < 1.0


def test_the_term_that_feeds_a_region_is_named():
    def wave(theta):
        return 0.2 * np.cos(2.0 * theta)[:, None, None]

    still = (Term("M", None, np.eye(1)), Term("K", "k", np.eye(1)))
    for array, words in (("K", "stiffness that"), ("M", "inertia that"), ("B", "centrifugal")):
        terms = (*still, Term(array, None, wave))
        system = el.LinearPeriodic(1, terms, {"k": 1.0}, lambda values: {"k": values["k"]})
        found = margins(system, 1.35, ["k"])
        assert words in found.feeding[0]


@pytest.mark.parametrize("rpm", [765.0, 700.0])
def test_a_diagnosis_says_what_lies_near_and_what_helps(rpm):
    found = diagnose(coupler(), rpm * RPM)
    assert found.passed
    text = "\n".join(found.lines)
    assert len(found.lines) <= 10
    assert "region 4 of mode 1" in text and "rpm wide" in text and " with one of" in text
    if rpm == 765.0:
        assert "is unstable" in found.lines[0] and "grow 1.14-fold" in found.lines[0]
        assert not found.stable and np.isnan(found.deflection)
    else:
        assert "nothing damps it" in found.lines[0] and found.stable
        assert f"{100.0 * found.deflection:.2g} % of its length" in text


def test_what_a_diagnosis_proposes_helps():
    """The first change that it names takes the machine out of the region."""
    scene = coupler()
    found = diagnose(scene, 765.0 * RPM)
    name, percent = found.lines[-1].split(": ")[1].split(", ")[0].rsplit(" ", 2)[:2]
    value = scene.get(name) * (1.0 + float(percent) / 100.0)
    changed = coupler(**{name: value}).system()
    assert el.floquet_multipliers(changed, 765.0 * RPM).stable


def test_a_linkage_of_beams_is_told_its_stress():
    found = diagnose(el.load_scene("aannaque_1996_table_4_1"), 30.0)
    assert "MPa" in "\n".join(found.lines) and found.largest_stress > 1e6
    assert found.nearest is None and "were not looked for" in "\n".join(found.lines)


ROD = el.load_scene("beale_1992_flexible_rod")
test_refusals = refused(
    margins,
    [
        (coupler(), -1.0, ["links.crank"], "speed"),
        (coupler(), 80.0, ["links.crnk"], "by"),
        (ROD, 100.0, ["rod.bending_stiffness"], "times per revolution"),
    ],
)


def test_a_picture_of_a_machine_without_regions_says_so():
    near, none = (
        diagnose(coupler(**{"coupler.damping": damping}), 700.0 * RPM) for damping in (0.0, 3.0)
    )
    assert none.stable and not none.nearest.region and not near.plot().texts
    ax = none.plot()
    assert [one.get_text() for one in ax.texts] == ["no unstable region in this range"]
    assert ax.get_xlim() == pytest.approx((490.0, 910.0))
