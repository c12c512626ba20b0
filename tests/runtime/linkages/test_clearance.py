"""Clearance: exact ranges against trial of the pins and many digits, folds, extremes, refusals."""

import itertools
import json
import pickle

import numpy as np
import pytest
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from elastolink.runtime.linkages.clearance import clearance_range
from refusals import refused

TURN = 2.0 * np.pi
LONG_CRANK = (10.0, 8.0, 10.0, 10.0)  # Smith's Fig. 10
FOUR_BARS = (LONG_CRANK, (5.0, 1.0, 5.0, 2.0), (10.0, 3.0, 6.0, 8.0), (3.0, 10.0, 9.0, 8.0))
ANGLES = np.linspace(0.0, TURN, 25)
JOINTS = ("12", "23", "34", "41")


def trial_sides(linkage, theta, plays, link, exact, count):
    """How far a link falls and rises with every pin on the rim of its hole or in the middle."""
    l1, l2, l3, l4 = linkage.lengths.values()
    rim = np.append(np.exp(1j * np.linspace(0.0, TURN, count, endpoint=False)), 0.0)
    discs = [plays[joint] / 2 * rim if joint in plays else np.zeros(1) for joint in JOINTS]
    a, b, c, d = np.meshgrid(*discs, sparse=True)
    pin, pivot = a + l2 * np.exp(1j * theta) + b, l1 + d - c
    span = pivot - pin
    cosine = (np.abs(span) ** 2 + l3**2 - l4**2) / (2 * np.abs(span) * l3)
    with np.errstate(invalid="ignore"):
        angle = np.angle(span) + linkage.branch * np.arccos(cosine)
    if link == "follower":
        angle = np.angle(pin + l3 * np.exp(1j * angle) - pivot)
    tried = np.angle(np.exp(1j * (angle[np.isfinite(angle)] - exact.nominal)))
    return -tried.min(), tried.max()


@pytest.mark.parametrize("link", ["follower", "coupler"])
@pytest.mark.parametrize("assembly", ["open", "crossed"])
@pytest.mark.parametrize("lengths", FOUR_BARS)
def test_all_pins_by_trial(lengths, assembly, link):
    linkage = FourBar(*lengths, assembly)
    plays = {"12": 0.01, "23": 0.02, "34": 0.015, "41": 0.025}
    plays = {joint: size * lengths[1] / 8 for joint, size in plays.items()}
    for theta in (0.3, 2.1, 4.4):
        exact = clearance_range(linkage, plays, theta, link=link)
        tried = trial_sides(linkage, theta, plays, link, exact, 12)
        # Never beyond; short of it by no more than 12 places of each pin allow, 1 - cos(15 deg).
        for reached, end in zip(tried, (exact.below, exact.above), strict=True):
            assert 0.96 * end <= reached <= end * (1 + 1e-9)
        inner = clearance_range(linkage, {"12": 0.0, "41": 0.0}, theta, link=link)
        assert inner.width == 0.0


@pytest.mark.parametrize("link", ["follower", "coupler"])
def test_the_joint_does_not_matter(link):
    for lengths in FOUR_BARS:
        linkage = FourBar(*lengths)
        found = [clearance_range(linkage, 0.02, ANGLES, joint=j, link=link) for j in JOINTS]
        assert all(np.array_equal(found[0].lower, other.lower) for other in found)
        split = clearance_range(linkage, dict.fromkeys(JOINTS, 0.005), ANGLES, link=link)
        assert split.width == pytest.approx(found[0].width, rel=1e-13)


def test_first_order_is_that_of_the_transmission_angle():
    for linkage in (FourBar(*lengths) for lengths in FOUR_BARS):
        motion = linkage.motion(ANGLES)
        found = clearance_range(linkage, 1e-3, ANGLES)
        sine = np.sin(motion.transmission_angle)
        assert found.small == pytest.approx(1e-3 / (linkage.follower * sine), rel=1e-11)
        # Far below the round-off of the angles the first order is exact.
        least = clearance_range(linkage, 1e-200, ANGLES)
        assert least.width == pytest.approx(least.small, rel=1e-14)


def test_a_follower_without_any_limit():
    found = clearance_range(FourBar(2.0, 1.0, 1.2, 0.3), 1.0, [0.473])
    assert found.free.all() and found.width == pytest.approx(TURN)
    assert found.passed


LINKAGES = (
    *(FourBar(*lengths) for lengths in FOUR_BARS),
    FourBar(10.0, 8.0, 4.0, 10.0),
    FourBar(15.0, 8.0, 10.0, 10.0, "crossed"),
    FourBar(10.0, 8.0, 2.0, 3.0),
    *(SliderCrank(1.0, 3.0, offset, "open") for offset in (0.0, 0.4, -1.5)),
    SliderCrank(2.0, 1.2, 0.3, "crossed"),
    QuickReturn(3.0, 1.0, 5.0),
    QuickReturn(1.0, 2.0, 5.0),
)


@pytest.mark.parametrize("play", [1e-3, 0.05, 0.6])
@pytest.mark.parametrize("linkage", LINKAGES, ids=str)
def test_extremes_over_the_cycle_against_a_scan(linkage, play):
    ranges = ((0.0, TURN),) if linkage.crank_turns else linkage.crank_ranges()
    # Close to the ends, where a fold begins, the steps are 1/200 of the way from the end.
    way = np.geomspace(1e-9, 0.5, 4001)
    theta = np.concatenate([low + (high - low) * np.append(way, 1 - way) for low, high in ranges])
    sliding = {SliderCrank: "41", QuickReturn: "34"}.get(type(linkage), "34")
    for link in (None, "coupler"):
        if link and isinstance(linkage, QuickReturn):
            continue
        found = clearance_range(linkage, {"23": play, sliding: play / 3}, theta, link=link)
        assert found.passed
        width, great, least = found.width, found.greatest, found.least
        assert np.max(width) <= great.width * (1 + 1e-9)
        assert np.min(width) >= least.width * (1 - 1e-9)
        # A jump, or a root at a fold, is steep: the scan comes as near as its step allows.
        assert np.max(width) >= great.width * (1 - 0.02)
        assert np.min(width) <= least.width * (1 + 1e-3)
        if linkage.crank_turns:
            at = [great.theta2, least.theta2]
            there = clearance_range(linkage, {"23": play, sliding: play / 3}, at, link=link)
            if not there.folds.any():
                assert there.width == pytest.approx([great.width, least.width], rel=1e-12)


@pytest.mark.parametrize("assembly", ["open", "crossed"])
def test_slider_by_trial(assembly):
    linkage = SliderCrank(1.0, 3.0, 0.4, assembly)
    plays = {"12": 0.02, "23": 0.03, "34": 0.01, "41": 0.05}
    rim = np.exp(1j * np.linspace(0.0, TURN, 721))
    for theta in np.linspace(0.1, TURN, 9):
        found = clearance_range(linkage, plays, theta)
        turned = clearance_range(linkage, plays, theta, link="coupler")
        # The three pins add up to one disc; the guide is tried across.
        pin = np.exp(1j * theta) + 0.03 * rim[:, None]
        gap = 0.4 + np.linspace(-0.025, 0.025, 101) - pin.imag
        along = pin.real + linkage.branch * np.sqrt(9.0 - gap**2)
        assert [along.min(), along.max()] == pytest.approx([found.lower, found.upper], abs=3e-6)
        angle = np.arcsin(gap / 3.0)
        angle = angle if assembly == "open" else np.pi - angle
        assert [angle.min(), angle.max()] == pytest.approx([turned.lower, turned.upper], abs=1e-6)
        assert found.nominal == pytest.approx(linkage.motion(theta).position, abs=1e-14)
        assert turned.nominal == pytest.approx(linkage.motion(theta).theta3, abs=1e-14)


def test_nominal_is_that_of_the_motion_over_many_turns():
    theta = np.linspace(-20.0, 20.0, 101)
    for lengths, assembly in itertools.product(FOUR_BARS, ("open", "crossed")):
        linkage = FourBar(*lengths, assembly)
        motion = linkage.motion(theta)
        for link, angle in (("follower", motion.theta4), ("coupler", motion.theta3)):
            found = clearance_range(linkage, 0.01, theta, link=link)
            assert found.nominal == pytest.approx(angle, abs=1e-13)
            assert found.passed


@pytest.mark.smoke
def test_scale_changes_nothing():
    ones = clearance_range(FourBar(*LONG_CRANK), 0.3, ANGLES)
    for power in (-900, 900):
        lengths = np.ldexp(LONG_CRANK, power)
        other = clearance_range(FourBar(*map(float, lengths)), float(np.ldexp(0.3, power)), ANGLES)
        assert np.array_equal(ones.width, other.width)
    small = clearance_range(SliderCrank(1.0, 3.0, 0.4), 0.1, ANGLES)
    large = clearance_range(SliderCrank(1024.0, 3072.0, 409.6), 102.4, ANGLES)
    assert large.width == pytest.approx(1024.0 * small.width, rel=1e-13)
    assert large.greatest.width == pytest.approx(1024.0 * small.greatest.width, rel=1e-13)


def test_picture_has_a_curve_for_each_clearance():
    ax = None
    for c in (0.01, 0.1, 0.5):
        ax = clearance_range(FourBar(*LONG_CRANK), c, ANGLES).plot(ax)
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels == ["c34 = 0.01", "c34 = 0.1", "c34 = 0.5"]
    assert ax.lines[0].get_ydata()[0] == pytest.approx(0.287922, abs=1e-6)
    ax = clearance_range(FourBar(10.0, 8.0, 4.0, 10.0), 0.1, [-1.0, -0.9, 0.9, 1.0]).plot()
    assert [len(line.get_xdata()) for line in ax.lines[:4]] == [2, 2, 2, 2]


SOUND = {"linkage": FourBar(*LONG_CRANK), "clearances": 0.1, "theta": 0.0}

test_refusals = refused(
    lambda changed: clearance_range(**SOUND | changed),
    [
        ({"clearances": -0.1}, "clearance"),
        ({"clearances": np.nan}, "clearance"),
        ({"clearances": 11.0}, "longest"),
        ({"clearances": "0.1"}, "clearance"),
        ({"clearances": {"55": 0.1}}, "one of 12"),
        ({"clearances": {"34": 0.1}, "joint": "23"}, "leave it out"),
        ({"theta": [np.inf]}, "finite"),
        ({"theta": "x"}, "theta"),
        ({"link": "rod"}, "follower, coupler"),
        ({"linkage": "linkage"}, "QuickReturn"),
        ({"linkage": FourBar(10.0, 8.0, 4.0, 10.0)}, "cannot reach"),
        ({"linkage": FourBar(2.0, 2.0, 3.0, 3.0)}, "cannot reach"),
    ],
)


def test_shapes_and_export(tmp_path):
    found = clearance_range(FourBar(*LONG_CRANK), 0.1, np.zeros((2, 3)))
    assert found.width.shape == (2, 3) == found.error.shape
    assert clearance_range(FourBar(*LONG_CRANK), 0.1, []).width.shape == (0,)
    saved = json.loads(found.save(tmp_path / "play.json").read_text())
    assert saved["greatest"]["theta2"] == 0.0 and saved["clearances"] == {"34": 0.1}
    rows = found.save(tmp_path / "play.csv").read_text().splitlines()
    assert len(rows) == 7


@pytest.mark.parametrize(
    "linkage", [FourBar(*LONG_CRANK), SliderCrank(0.1, 0.3), QuickReturn(0.3, 0.1, 0.6)]
)
def test_errors_and_checks_to_be_bear_pickling(linkage):
    found = clearance_range(linkage, 1e-3, ANGLES)
    copied = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(copied.error, found.error)
    assert copied.passed
