"""Kinematics where formulas break: adversarial linkages, hairs' breadths, far scales and angles."""

import numpy as np
import pytest
from elastolink.generated import (
    four_bar_coupler_complete,
    four_bar_kinematics,
    quick_return_kinematics,
    slider_crank_kinematics,
)
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from judging import exact_at, judge, worst
from linkage_truth import OUTPUTS, Linkage, exact_near
from sliding_truth import ROD, SLIDER, Slider, rod_motion, rod_point, slider_motion

TURN = 2.0 * np.pi


def adversarial_linkage(random):
    """Return lengths over four decades, nearly equal, nearly parallel or nearly folding.

    The relative distance from equality is log-uniform down to a few round-offs.
    """
    while True:
        lengths = 10.0 ** random.uniform(-4.0, 0.0, 4)
        nudge = 1.0 + 10.0 ** random.uniform(-15.0, 0.0, 4) * random.choice([-1.0, 1.0], 4)
        kind = random.integers(4)
        if kind == 0:
            lengths = np.ones(4)
        elif kind == 1:
            lengths = lengths[[0, 1, 0, 1]]
        elif kind == 2:
            lengths[3] = lengths[0] + lengths[1] - lengths[2]
        frame, crank, coupler, follower = lengths * nudge
        turns = abs(frame - crank) > abs(coupler - follower) and frame + crank < coupler + follower
        if turns and min(lengths * nudge) > 0:
            sign = float(random.choice([-1.0, 1.0]))
            return Linkage(float(frame), float(crank), float(coupler), float(follower), sign)


def adversarial_angle(random):
    quarter = np.pi / 2 * random.integers(-4, 5)
    return float(
        random.choice(
            [
                random.uniform(-10.0, 10.0),
                10.0 ** random.uniform(-20.0, 0.0),
                quarter,
                quarter + 10.0 ** random.uniform(-15.0, 0.0),
            ]
        )
    )


def adversarial_slider(random):
    """Return lengths over eight decades, the coupler a log-uniform hair longer than it must be."""
    crank, offset, hair = 10.0 ** random.uniform((-4.0, -4.0, -15.0), (0.0, 0.0, 3.0))
    offset *= random.choice([-1.0, 0.0, 1.0])
    coupler = (crank + abs(offset)) * (1.0 + hair)
    sign = float(random.choice([-1.0, 1.0]))
    return Slider(float(crank), float(coupler), float(offset), sign)


def judged_four_bars(count, seed):
    random = np.random.default_rng(seed)
    functions = [n for n in four_bar_coupler_complete.RETURNS if n.endswith("_functions")]
    for i in range(count):
        point = adversarial_linkage(random).point(f"adversarial {i}", adversarial_angle(random))
        exact = exact_near(point)
        yield from judge(four_bar_kinematics.motion, OUTPUTS, exact)
        for name in functions:
            function = getattr(four_bar_coupler_complete, name)
            yield from judge(function, four_bar_coupler_complete.RETURNS[name], exact)


def judged_sliding(count, seed):
    random = np.random.default_rng(seed)
    for i in range(count):
        slider = adversarial_slider(random)
        if slider.coupler - slider.crank > abs(slider.offset):
            point = slider.point(f"adversarial {i}", adversarial_angle(random))
            exact = exact_at(slider_motion, point)
            yield from judge(slider_crank_kinematics.motion, SLIDER, exact)
        crank = 1.0 + 10.0 ** random.uniform(-15.0, 3.0) * random.choice([-0.9, 1.0])
        if 0 < crank != 1.0:
            point = rod_point(f"adversarial {i}", 1.0, crank, adversarial_angle(random))
            near = quick_return_kinematics.motion(**point.arguments)[0]
            exact = exact_at(lambda numbers, near=near: rod_motion(numbers, near), point)
            yield from judge(quick_return_kinematics.motion, ROD, exact)


@pytest.mark.parametrize(
    ("judged", "count", "seed"),
    [
        (judged_four_bars, 60, 41),
        (judged_sliding, 100, 43),
        pytest.param(judged_four_bars, 1000, 41, marks=pytest.mark.slow),
        pytest.param(judged_sliding, 2000, 43, marks=pytest.mark.slow),
    ],
)
def test_measure_at_adversarial_linkages(judged, count, seed):
    found = worst(judged(count, seed))
    assert not {name: (j.measure, j.point) for name, j in found.items() if not j.passed}


@pytest.mark.parametrize("ratio", 10.0 ** -np.arange(2, 15, 3.0))
def test_short_frame_makes_the_links_turn_with_the_crank(ratio):
    """Seen from the crank the frame is a short crank: accelerations keep their digits."""
    theta = np.linspace(0.1, TURN, 17)
    drag = FourBar(ratio, 1.0, 0.9, 0.7).motion(theta)
    # Inversion on the crank: frame and crank change places, the angle changes its sign.
    turned = FourBar(1.0, ratio, 0.9, 0.7, "open").motion(-theta)
    np.testing.assert_allclose(drag.omega3, 1.0 - turned.omega3, rtol=1e-12)
    for one, other in ((drag.alpha3, turned.alpha3), (drag.alpha4, turned.alpha4)):
        np.testing.assert_allclose(one, other, atol=1e-11 * np.abs(other).max())


@pytest.mark.parametrize("hair", [1e-2, 1e-8, 1e-15])
@pytest.mark.parametrize("kind", ["open", "crossed", "swinging", "turning"])
def test_motions_stay_in_one_piece_a_hair_from_the_change_point(kind, hair):
    """Coupler = crank + offset + hair, the crank straight down; crank = frame -+ hair, at pi."""
    if kind in ("open", "crossed"):
        linkage, middle = SliderCrank(1.0, 3.0 + hair, 2.0, kind), -np.pi / 2
    else:
        linkage, middle = QuickReturn(1.0, 1.0 + (hair if kind == "turning" else -hair), 3.0), np.pi
    near = np.geomspace(1e-17, np.pi, 4000)
    walk = linkage.motion(np.unique(middle + np.concatenate([-near[::-1], [0.0], near])))
    assert walk.passed
    if kind in ("open", "crossed"):
        assert np.abs(np.diff(walk.theta3)).max() < 0.1
    else:
        assert np.all(np.abs(walk.theta4 - walk.theta2 * (kind == "turning")) < np.pi)


@pytest.mark.parametrize("turns", [1, 1e3, 1e6, 1e9])
@pytest.mark.parametrize(
    "linkage",
    [
        FourBar(5.0, 1.0, 5.0, 2.0),
        FourBar(2.0, 4.0, 5.0, 4.5),
        SliderCrank(1.0, 3.0, 0.4),
        QuickReturn(1.0, 2.0, 3.0),
        QuickReturn(2.0, 1.0, 3.0),
    ],
)
def test_angles_far_out_lose_no_more_than_their_own_digits(linkage, turns):
    theta = np.array([0.3, 1.0, 2.5]) + turns * TURN
    moved, longest = linkage.motion(theta), max(linkage.lengths.values())
    if isinstance(linkage, QuickReturn):
        apart = moved.joints["B"] - moved.point("rod", moved.slide).position
    else:
        arm = getattr(linkage, "follower", 0.0)
        apart = moved.point(linkage.links[2], arm).position
        apart = apart - moved.point("coupler", linkage.coupler).position
    gap = np.hypot(*apart.T)
    assert np.all(gap < 8 * np.spacing(theta) * longest + 1e-14)
    # A loop that gapes by more than 1e-8 is no motion, even where the angle has no more digits.
    assert moved.passed == (gap.max() < 1e-8 * longest)


def test_extreme_ratios_stay_finite():
    theta = np.linspace(-4.0, 4.0, 33)
    lengths = ((1.0, 1e-100, 1.0, 0.5), (1e-100, 1.0, 1.0, 0.5))
    for linkage in (
        *(FourBar(*each, assembly) for each in lengths for assembly in ("open", "crossed")),
        SliderCrank(1e-100, 1.0, 0.3),
        SliderCrank(1e-100, 1.0),
        QuickReturn(1.0, 1e-100, 2.0),
        QuickReturn(1e-100, 1.0, 2.0),
    ):
        moved = linkage.motion(theta)
        assert moved.passed
        for name in (*moved.places, *moved.rates):
            assert np.all(np.isfinite(getattr(moved, name)))
