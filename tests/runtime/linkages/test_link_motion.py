"""Motion of links and of any point of them, for every linkage: differences in many digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from linkage_truth import motion as four_bar_motion
from sliding_truth import rod_motion, slider_motion

LINKAGES = {
    "rocker": FourBar(5.0, 1.0, 4.5, 2.2),
    "drag link": FourBar(2.0, 4.0, 5.0, 4.5, "crossed"),
    "slider-crank": SliderCrank(1.0, 3.5, 0.7),
    "slider-crank, crossed": SliderCrank(1.0, 3.5, -0.7, "crossed"),
    "quick-return": QuickReturn(2.0, 1.0, 4.0),
    "Whitworth": QuickReturn(1.0, 2.0, 4.0),
}
EVERY = [(name, link) for name, linkage in LINKAGES.items() for link in linkage.links]
# theta2 as a function of time, with its derivatives at T.
T = 0.4


def theta(t):
    return 3 * t + 2 * t**2


ANGLE, SPEED, ACCELERATION = theta(T), 3 + 4 * T, 4.0


def place(linkage, link, along, across, t):
    """Place of a point in the fixed frame at a time, as a complex mpmath number."""
    n = {name: mpmath.mpf(value) for name, value in linkage.geometry.items()}
    n["theta2"] = theta(t)
    pin = n["crank"] * mpmath.expj(n["theta2"])
    if link == "crank":
        start, angle = mpmath.mpf(0), n["theta2"]
    elif isinstance(linkage, FourBar):
        m = four_bar_motion(n)
        starts = {"coupler": (pin, m["theta3"]), "follower": (n["frame"], m["theta4"])}
        start, angle = starts[link]
    elif isinstance(linkage, SliderCrank):
        m = slider_motion(n)
        pinned = mpmath.mpc(m["position"], n["offset"])
        start, angle = {"coupler": (pin, m["theta3"]), "slider": (pinned, 0)}[link]
    else:
        m = rod_motion(n)
        start, angle = {"block": pin, "rod": -n["frame"]}[link], m["theta4"]
    return start + mpmath.mpc(along, across) * mpmath.expj(angle)


@pytest.mark.parametrize("name, link", EVERY)
@pytest.mark.parametrize("along, across", [(0.0, 0.0), (0.3, -0.8), (3.4, 0.2)])
def test_points_move_as_their_places_differentiated(name, link, along, across):
    linkage = LINKAGES[name]
    found = linkage.motion(ANGLE, SPEED, ACCELERATION).point(link, along, across)
    with mpmath.workdps(40):
        for order, vector in enumerate((found.position, found.velocity, found.acceleration)):

            def of_time(t):
                return place(linkage, link, along, across, t)

            truth = complex(mpmath.diff(of_time, mpmath.mpf(T), order) if order else of_time(T))
            size = 10.0 * max(1.0, abs(truth))
            assert vector == pytest.approx([truth.real, truth.imag], rel=0, abs=1e-14 * size)


@pytest.mark.parametrize("name", LINKAGES)
def test_joints_are_points_of_both_links_that_they_join(name):
    linkage = LINKAGES[name]
    theta2 = np.linspace(0.0, 6.0, 12).reshape(3, 4)
    motion = linkage.motion(theta2, SPEED, ACCELERATION)
    joints, lengths = motion.joints, linkage.lengths
    for link, letters in linkage.bars.items():
        np.testing.assert_array_equal(motion.link(link).origin, joints[letters[0]])
        if len(letters) == 2:
            end = motion.point(link, lengths[link]).position
            np.testing.assert_allclose(end, joints[letters[1]], rtol=0, atol=5e-15)
    assert all(value.shape == (3, 4, 2) for value in joints.values())
    np.testing.assert_array_equal(joints["A"], 0.0)


def test_the_coupler_ends_where_its_neighbour_is_to_the_last_digit():
    theta2 = np.linspace(0.0, 6.0, 25)
    bar = FourBar(5.0, 1.0, 4.5, 2.2).motion(theta2, 10.0, 3.0)
    one, other = bar.point("coupler", 4.5), bar.point("follower", 2.2)
    slide = SliderCrank(1.0, 3.5, 0.7).motion(theta2, 10.0, 3.0)
    end, pin = slide.point("coupler", 3.5), slide.point("slider", 0.0)
    for first, second in ((one, other), (end, pin)):
        np.testing.assert_array_equal(first.position, second.position)
        np.testing.assert_array_equal(first.velocity, second.velocity)
        np.testing.assert_array_equal(first.acceleration, second.acceleration)
    np.testing.assert_array_equal(end.position[..., 1], 0.7)
    np.testing.assert_array_equal(end.acceleration[..., 1], 0.0)


def test_points_and_drives_broadcast():
    bar = LINKAGES["rocker"]
    speeds = np.array([[1.0], [10.0]])
    motion = bar.motion(np.linspace(0.0, 6.0, 5), speeds)
    assert motion.theta3.shape == motion.omega4.shape == motion.error.shape == (2, 5)
    np.testing.assert_allclose(motion.alpha4[1], 100.0 * motion.alpha4[0], rtol=1e-15)
    along = np.linspace(0.0, 5.0, 5)
    together = motion.point("coupler", along, 0.1)
    assert together.position.shape == (2, 5, 2)
    for i, place_along in enumerate(along):
        alone = motion.point("coupler", place_along, 0.1)
        np.testing.assert_array_equal(alone.acceleration[:, i], together.acceleration[:, i])


def test_without_a_speed_rates_are_per_crank_angle():
    for linkage in LINKAGES.values():
        here = linkage.motion(1.0)
        assert here.relative and here.omega2 == 1.0 and here.alpha2 == 0.0
        there = linkage.motion(1.0, 7.0, 3.0)
        link = linkage.links[1]
        one, other = here.point(link, 0.3, 0.2), there.point(link, 0.3, 0.2)
        np.testing.assert_allclose(other.velocity, 7.0 * one.velocity, rtol=1e-14)
        expected = 49.0 * one.acceleration + 3.0 * one.velocity
        np.testing.assert_allclose(other.acceleration, expected, atol=1e-12)
        np.testing.assert_array_equal(one.position, other.position)
        assert not there.relative and set(there.places) | set(there.rates) <= set(vars(there))


def test_links_and_points_that_there_are_not_are_refused():
    motion = LINKAGES["rocker"].motion(1.0)
    with pytest.raises(BadInput, match="link: found 'rod'; expected one of crank, coupler, foll"):
        motion.link("rod")
    with pytest.raises(BadInput, match="along, across: found a value that is not finite"):
        motion.point("coupler", np.nan)


def test_crank_ranges_of_a_four_bar_hold_every_angle_that_is_reached_and_no_other():
    for lengths, count in (
        ((4.0, 3.0, 2.0, 2.0), 1),
        ((3.0, 2.0, 3.5, 1.2), 2),
        ((4.0, 1.0, 4.0, 1.0), 2),
        ((1.0, 2.0, 1.5, 3.5), 1),
        ((5.0, 1.0, 5.0, 2.0), 1),
        ((3.0, 1.0, 2.0, 2.0), 1),
    ):
        bar = FourBar(*lengths)
        spans = bar.crank_ranges()
        assert len(spans) == count
        for angle in np.linspace(-np.pi, np.pi, 301)[:-1] + 1e-4:
            inside = any((angle - low) % (2 * np.pi) < high - low for low, high in spans)
            diagonal = abs(bar.frame - bar.crank * np.exp(1j * angle))
            assert inside == (bar.reach[0] < diagonal < bar.reach[1])
            if inside:
                assert bar.motion(angle).passed
