"""Motions of every linkage: continuity, ranges, refusals, the result.

Their values in 80 digits: ``tests/error_estimates/test_motion.py``.
"""

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank, classify
from elastolink.runtime.linkages.linkage import _checks
from refusals import refused

TURN = 2.0 * np.pi
LINKAGES = {
    "crank rocker": FourBar(5.0, 1.0, 4.5, 2.2),
    "crank rocker, crossed": FourBar(10.0, 8.0, 10.0, 10.0, "crossed"),
    "drag link": FourBar(1.0, 3.0, 2.5, 3.5),
    "drag link, crossed": FourBar(2.0, 4.0, 5.0, 4.5, "crossed"),
    "engine": SliderCrank(1.0, 3.5),
    "offset": SliderCrank(1.0, 3.5, 0.8),
    "offset, crossed": SliderCrank(1.0, 2.5, -1.2, "crossed"),
    "quick-return": QuickReturn(2.0, 1.0, 4.0),
    "Whitworth": QuickReturn(1.0, 2.5, 4.0),
}
EVERY = pytest.mark.parametrize("linkage", LINKAGES.values(), ids=LINKAGES)


def outputs(linkage):
    return (*linkage.moves.places, *linkage.moves.rates)


def place_rates(linkage):
    """Return pairs of names: what moves, and its rate."""
    rates = [name for name in linkage.moves.rates if name[:5] == "omega" or "velocity" in name]
    places = [name for name in linkage.moves.places if name != "transmission_angle"]
    second = [n.replace("omega", "alpha").replace("velocity", "acceleration") for n in rates]
    return [*zip(places, rates, strict=True), *zip(rates, second, strict=True)]


@pytest.mark.smoke
@EVERY
def test_angles_are_continuous_and_periodic_over_many_turns(linkage):
    steps = 720
    motion = linkage.motion(TURN * np.arange(-5 * steps, 5 * steps + 1) / steps)
    for name in outputs(linkage):
        value = getattr(motion, name)
        turns = np.rint((value[steps] - value[0]) / TURN) if name in ("theta3", "theta4") else 0.0
        back = value[steps:] - value[:-steps] - TURN * turns
        assert np.all(np.abs(back) <= 1e-12 * max(1.0, np.abs(value).max()))
    for name, rate in place_rates(linkage):
        jump = np.abs(np.diff(getattr(motion, name)))
        assert np.all(jump <= 1.05 * np.abs(getattr(motion, rate)).max() * TURN / steps + 1e-14)
    for name in set(outputs(linkage)) & {"theta3", "theta4"}:
        assert -np.pi < getattr(motion, name)[5 * steps] <= 1.5 * np.pi


@EVERY
def test_shapes_and_scales_do_not_matter(linkage):
    angle = np.linspace(0.0, 6.0, 12)
    base = linkage.motion(angle)
    shaped, listed = linkage.motion(angle.reshape(3, 2, 2)), linkage.motion(list(angle))
    single = linkage.motion(6.0)
    assert linkage.motion([]).error.shape == (0,)
    scaled = {
        scale: replace(linkage, **{k: scale * v for k, v in linkage.lengths.items()}).motion(angle)
        for scale in (2.0**-900, 2.0**-30, 2.0**1000)
    }
    for name in (*outputs(linkage), "error"):
        value = getattr(base, name)
        np.testing.assert_array_equal(getattr(shaped, name).ravel(), value)
        np.testing.assert_array_equal(getattr(listed, name), value)
        assert getattr(single, name).shape == ()
        assert getattr(single, name) == pytest.approx(value[-1], rel=1e-15)
        for scale, motion in scaled.items():
            factor = scale if name.startswith(("position", "slide")) else 1.0
            np.testing.assert_array_equal(getattr(motion, name), factor * value)


@pytest.mark.parametrize(
    ("linkage", "count"),
    [
        (FourBar(4.0, 3.0, 2.0, 2.0), 1),
        (FourBar(3.0, 2.0, 3.5, 1.2), 2),
        (FourBar(4.0, 1.0, 4.0, 1.0), 2),
        (FourBar(1.0, 2.0, 1.5, 3.5), 1),
        (FourBar(5.0, 1.0, 5.0, 2.0), 1),
        (SliderCrank(1.0, 1.2, -0.5, "crossed"), 1),
        (SliderCrank(1.0, 0.5, 0.2), 2),
        (SliderCrank(1.0, 0.5, 1.2), 1),
        (SliderCrank(1.0, 1.0, 0.0), 2),
        (SliderCrank(1.0, 3.0, 2.0), 1),
        (QuickReturn(2.0, 1.0, 2.5), 1),
        (QuickReturn(1.0, 1.0, 2.0), 1),
        (QuickReturn(1.0, 1.0, 1.5), 2),
    ],
)
def test_crank_ranges_hold_every_angle_that_is_reached_and_no_other(linkage, count):
    spans = linkage.crank_ranges()
    assert len(spans) == count
    for angle in np.linspace(-np.pi, np.pi, 61)[:-1] + 1e-4:
        inside = any((angle - low) % TURN < high - low for low, high in spans)
        if isinstance(linkage, FourBar):
            diagonal = abs(linkage.frame - linkage.crank * np.exp(1j * angle))
            reached = linkage.reach[0] < diagonal < linkage.reach[1]
        elif isinstance(linkage, SliderCrank):
            reached = abs(linkage.offset - linkage.crank * np.sin(angle)) < linkage.coupler
        else:
            reached = abs(linkage.frame + linkage.crank * np.exp(1j * angle)) < linkage.rod
        assert inside == reached
        if reached:
            assert linkage.motion(angle).passed
        else:
            with pytest.raises(BadInput, match="theta: found"):
                linkage.motion(angle)


def test_ends_of_ranges_by_hand():
    ((low, high),) = SliderCrank(1.0, 1.2, 0.5).crank_ranges()
    # 0.5 - sin(theta) = 1.2 at both ends.
    assert np.sin([low, high]) == pytest.approx([-0.7, -0.7], abs=1e-15)
    with pytest.raises(BadInput, match=r"a crank angle in \(-0.775397, 3.91699\) rad"):
        SliderCrank(1.0, 1.2, 0.5).motion(-1.0)
    with pytest.raises(BadInput, match=r"theta: found 1.5 rad; expected a diagonal BD between"):
        FourBar(4.0, 3.0, 2.0, 2.0).motion([0.1, 1.5, 0.2])


@pytest.mark.parametrize(
    ("linkage", "theta2", "folds"),
    [
        (FourBar(4.0, 1.0, 4.0, 1.0), np.linspace(0.1, 3.0, 12), 0),
        (FourBar(4.0, 1.0, 4.0, 1.0), np.linspace(3.2, 9.5, 12), 2),
        (FourBar(3.0, 2.0, 3.5, 1.2), [-1.0, 1.0], 2),
        (SliderCrank(1.0, 1.0), [1.4, 1.7], 1),
        (SliderCrank(1.0, 1.0), [-1.5, 0.3, 1.5], 0),
        (QuickReturn(1.0, 1.0, 3.0), [3.0, 3.3], 1),
        (QuickReturn(2.0, 1.0, 2.5), [1.3, 4.9 + TURN], 2),
    ],
)
def test_an_angle_range_across_a_change_point_fails_a_check(linkage, theta2, folds):
    motion = linkage.motion(theta2)
    assert motion.checks["folds within the angles"].value == folds
    assert motion.passed == (folds == 0)


def test_a_change_point_itself_is_no_motion_but_its_neighbours_are():
    for lengths in ((2.0, 1.0, 2.0, 1.0), (1.0, 1.0, 1.0, 1.0)):
        bar = FourBar(*lengths)
        assert not bar.crank_turns
        with pytest.raises(BadInput, match="or folds there"):
            bar.motion([0.7, 0.0])
        assert np.all(np.isfinite(bar.motion([1e-100, 0.7, np.pi]).theta4))
    # Frame and crank as long as coupler and follower: no double is the angle of this one.
    moved = FourBar(3.0, 1.0, 2.0, 2.0).motion(np.pi)
    assert moved.transmission_angle == pytest.approx(np.pi, abs=1e-15)
    assert not moved.checks["round-off of accelerations over their terms"].passed
    slider = SliderCrank(1.0, 1.0)
    with pytest.raises(BadInput, match="or folds there"):
        slider.motion(np.pi / 2)
    # Crank and coupler mirror each other: position 2 cos, theta3 = -theta2.
    motion = slider.motion([-1.0, 0.5])
    np.testing.assert_allclose(motion.position, 2 * np.cos([-1.0, 0.5]), rtol=1e-15)
    # With eps = 1 the rod's angle is half of the crank's, and jumps at the rod's pivot.
    motion = QuickReturn(1.0, 1.0, 3.0).motion([-3.0, 0.5, 3.0])
    np.testing.assert_allclose(motion.theta4, [-1.5, 0.25, 1.5], rtol=1e-15)
    np.testing.assert_array_equal(motion.alpha4, 0.0)
    with pytest.raises(BadInput, match=r"crank angle in \(-3.14159, 3.14159\) rad"):
        QuickReturn(1.0, 1.0, 3.0).motion(np.pi)


@pytest.mark.parametrize(
    ("linkage", "word"),
    [
        (FourBar(4.0, 3.0, 2.0, 2.0), "the crank cannot turn fully"),
        (SliderCrank(1.0, 1.0), "the crank cannot turn fully"),
        (QuickReturn(1.0, 1.0, 3.0), "eps = 1"),
        (QuickReturn(2.0, 1.0, 2.9), "at least 3, frame and crank"),
    ],
)
def test_a_crank_that_does_not_turn_is_named(linkage, word):
    assert not linkage.crank_turns
    with pytest.raises(BadInput, match=word):
        linkage.require_full_turn()


@pytest.mark.parametrize(
    ("linkage", "word"),
    [
        # 0.3 + 0.06 and 0.28 + 0.08 are equal but for the rounding of the four.
        (FourBar(0.3, 0.06, 0.28, 0.08), r"frame \+ crank = coupler \+ follower"),
        (FourBar(0.1, 0.3, 0.4, 0.2), r"frame \+ coupler = crank \+ follower"),
        (SliderCrank(0.1, 0.1 + 0.2, -0.2), r"coupler = crank \+ offset"),
        (QuickReturn(0.3, 0.1 + 0.2, 0.7), "eps = 1"),
    ],
)
def test_a_crank_that_turns_by_rounding_alone_is_refused(linkage, word):
    with pytest.raises(BadInput, match=word):
        linkage.require_full_turn()


def test_round_off_of_sums_decides_nothing():
    """As :func:`classify` has it, the lengths are what their doubles are."""
    # 0.3... + 0.1 + 0.3... exceeds 0.7... by less than the sum of the three is rounded.
    barely = FourBar(0.30000000000000004, 0.7000000000000001, 0.1, 0.30000000000000004)
    ((low, high),) = barely.crank_ranges()
    assert 0.0 < high < 1e-7 and low == -high
    turning = FourBar(1.0, 0.1, 0.30000000000000004, 0.8)
    assert turning.crank_turns
    assert turning.crank_ranges() == ((-np.pi, np.pi),)
    assert all(classify(bar).turns["crank"] == bar.crank_turns for bar in (barely, turning))
    # 0.2 + 0.1 is a little more than 0.3: a rod given as the sum of the two is long enough.
    assert QuickReturn(0.2, 0.1, 0.3).crank_turns


test_lengths_that_make_no_linkage_are_refused = refused(
    lambda kind, lengths: kind(*lengths),
    [
        (FourBar, (10.0, 1.0, 2.0, 3.0), r"frame: found 10; expected less than 6, the sum"),
        (FourBar, (1.0, 4.0, 1.0, 2.0), r"crank: found 4; expected less than 4"),
        (FourBar, (1.0, -1.0, 1.0, 1.0), r"crank: found -1.0; expected a positive finite length"),
        (FourBar, ("5 in", 1.0, 1.0, 1.0), r"frame: found '5 in'"),
        (SliderCrank, (1.0, 2.0, 3.0), r"offset: found 3; expected less than 3 in magnitude"),
        (SliderCrank, (1.0, 2.0, np.nan), r"offset: found nan; expected a finite length"),
        (SliderCrank, (1.0, 2.0, 0.0, "upside"), r"found 'upside'; expected 'open' or 'crossed'"),
        (QuickReturn, (2.0, 1.0, 0.9), "the rod never reaches the block"),
    ],
)


def test_all_problems_are_listed_at_once():
    with pytest.raises(BadInput) as refusal:
        FourBar(-1.0, np.nan, 1.0, 1.0, assembly="twisted")
    assert len(refusal.value.problems) == 3


@pytest.mark.parametrize(
    ("given", "word"),
    [
        ((np.nan,), "theta: found a value that is not finite"),
        (([[1.0], [1.0, 2.0]],), "theta: found"),
        ((1.0, "fast"), "speed: found"),
        ((1.0, 1.0, [np.inf]), "acceleration: found"),
        (([0.0, 1.0, 2.0], [1.0, 2.0]), "shapes that broadcast"),
    ],
)
def test_what_is_no_angle_and_no_drive_is_refused(given, word):
    with pytest.raises(BadInput, match=word):
        LINKAGES["engine"].motion(*given)
    motion = LINKAGES["crank rocker"].motion(1.0)
    with pytest.raises(BadInput, match="link: found 'rod'; expected one of crank, coupler, foll"):
        motion.link("rod")
    with pytest.raises(BadInput, match="along, across: found a value that is not finite"):
        motion.point("coupler", np.nan)


@EVERY
def test_result_carries_error_checks_and_picture(linkage, tmp_path):
    motion = linkage.motion(np.linspace(0.0, TURN, 91), speed=100.0, acceleration=5.0)
    motion.require()
    assert motion.error.shape == motion.theta2.shape
    axes = motion.plot()
    assert len(axes.lines) == (4 if isinstance(linkage, FourBar) else 3)
    assert "10^" in axes.get_legend().get_texts()[2].get_text()
    saved = json.loads(motion.save(tmp_path / "motion.json").read_text())
    assert set(outputs(linkage)) < set(saved) and saved["passed"] is True
    assert saved["linkage"]["crank"] == linkage.crank
    assert "theta2" in motion.save(tmp_path / "motion.csv").read_text().splitlines()[0]
    again = pickle.loads(pickle.dumps(motion))
    assert again.passed and again.linkage == linkage
    assert motion.provenance["links.crank"] == repr(linkage.crank)
    assert {"elastolink", "numpy"} <= set(motion.provenance)


def test_checks_see_a_rate_that_is_wrong():
    """The closure of speeds and accelerations is no empty promise."""
    slider = LINKAGES["offset"]
    motion = slider.motion([1.0, 2.0])
    m = {"theta2": motion.theta2, **{name: getattr(motion, name) for name in outputs(slider)}}
    for name in ("position", "slider_velocity", "slider_acceleration"):
        m[name] = m[name] * 2.0**slider.scale
    assert all(check.passed for check in _checks(slider, m).values())
    for name, which in (("omega3", "speeds"), ("slider_acceleration", "accelerations")):
        wrong = {**m, name: m[name] * (1 + 1e-13)}
        assert not _checks(slider, wrong)[f"closure of {which} over its error"].passed
