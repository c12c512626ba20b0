"""Slider-crank and quick-return where formulas break: hairs' breadths, far scales and angles."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.generated import quick_return_kinematics, slider_crank_kinematics
from elastolink.runtime.linkages import QuickReturn, SliderCrank
from judging import exact_at, judge, worst
from sliding_truth import ROD, SLIDER, Slider, rod_motion, rod_point, slider_motion

TURN = 2.0 * np.pi


def adversarial_angle(random):
    quarter = np.pi / 2 * random.integers(-4, 5)
    choices = (
        random.uniform(-10.0, 10.0),
        10.0 ** random.uniform(-20.0, 0.0),
        quarter,
        quarter + 10.0 ** random.uniform(-15.0, 0.0),
    )
    return float(random.choice(choices))


def adversarial_slider(random):
    """Return lengths over eight decades, the coupler a log-uniform hair longer than it must be."""
    crank, offset, hair = 10.0 ** random.uniform((-4.0, -4.0, -15.0), (0.0, 0.0, 3.0))
    offset *= random.choice([-1.0, 0.0, 1.0])
    coupler = (crank + abs(offset)) * (1.0 + hair)
    sign = float(random.choice([-1.0, 1.0]))
    return Slider(float(crank), float(coupler), float(offset), sign)


def judged(count, seed):
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


@pytest.mark.parametrize("count", [100, pytest.param(2000, marks=pytest.mark.slow)])
def test_measure_at_adversarial_linkages(count):
    beyond = {k: (j.measure, j.point) for k, j in worst(judged(count, 43)).items() if not j.passed}
    assert not beyond


@pytest.mark.parametrize("turns", [1, 1e3, 1e6])
def test_angles_far_out_lose_no_more_than_their_own_digits(turns):
    theta = np.array([0.3, 1.0, 2.5]) + turns * TURN
    slider = SliderCrank(1.0, 3.0, 0.4).motion(theta)
    chain = np.exp(1j * theta) + 3.0 * np.exp(1j * slider.theta3) - slider.position - 0.4j
    assert np.all(np.abs(chain) < 8 * np.spacing(theta) * 3.0 + 1e-14)
    for linkage in (QuickReturn(1.0, 2.0, 3.0), QuickReturn(2.0, 1.0, 3.0)):
        rod = linkage.motion(theta)
        chain = rod.slide * np.exp(1j * rod.theta4) - linkage.frame
        gap = np.abs(chain - linkage.crank * np.exp(1j * theta))
        assert np.all(gap < 8 * np.spacing(theta) * 3.0 + 1e-14)
        assert rod.passed and slider.passed


@pytest.mark.parametrize("exponent", (2, 8, 15))
@pytest.mark.parametrize("assembly", ["open", "crossed"])
def test_slider_crank_a_hair_from_its_change_point(exponent, assembly):
    """Coupler = crank + offset + h, the crank straight down: the coupler stands across the guide.

    Its length along the guide there is sqrt(h (2 coupler - h)), by Pythagoras.
    """
    hair = 2.0 ** -round(exponent * np.log2(10.0))
    slider = SliderCrank(1.0, 3.0 + hair, 2.0, assembly)
    motion = slider.motion(-np.pi / 2)
    along = np.sqrt(hair * (2.0 * slider.coupler - hair))
    # The angle of the double -pi/2 is off by 6e-17.
    assert motion.position * slider.branch == pytest.approx(along, rel=1e-14 + 1e-30 / hair)
    # The pin moves along the guide with the crank's length, and the coupler passes it on.
    assert motion.slider_velocity == pytest.approx(1.0, rel=1e-6)
    assert motion.alpha3 * slider.branch == pytest.approx(-1.0 / along, rel=1e-6)
    assert motion.passed
    near = np.geomspace(1e-14, np.pi, 2000)
    walk = slider.motion(-np.pi / 2 + np.concatenate([-near[::-1], [0.0], near]))
    assert np.abs(np.diff(walk.theta3)).max() < 0.1
    assert walk.passed


@pytest.mark.parametrize("exponent", (2, 8, 15))
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_quick_return_a_hair_from_its_change_point(exponent, sign):
    """Crank = frame (1 -+ h): at theta2 = pi the rod turns by -crank / (frame - crank)."""
    hair = sign * 2.0 ** -round(exponent * np.log2(10.0))
    linkage = QuickReturn(1.0, 1.0 + hair, 3.0)
    motion = linkage.motion(np.pi)
    assert motion.slide == pytest.approx(abs(hair), rel=1e-1)
    if abs(hair) > 1e-12:
        assert motion.omega4 == pytest.approx(linkage.crank / hair, rel=1e-6)
    near = np.geomspace(1e-17, np.pi, 4000)
    walk = linkage.motion(np.unique(np.pi + np.concatenate([-near[::-1], [0.0], near])))
    assert np.all(np.abs(walk.theta4 - walk.theta2 * (sign > 0)) < np.pi)
    assert walk.passed


def test_extreme_scales_and_ratios_stay_finite():
    theta = np.linspace(-4.0, 4.0, 33)
    for linkage in (
        SliderCrank(1e-300, 3e-300, 1e-301),
        SliderCrank(1e300, 3e300, -1e299),
        SliderCrank(1e-100, 1.0, 0.3),
        SliderCrank(1e-100, 1.0),
        QuickReturn(1e-300, 2e-300, 4e-300),
        QuickReturn(1e300, 2e299, 2e300),
        QuickReturn(1.0, 1e-100, 2.0),
        QuickReturn(1e-100, 1.0, 2.0),
    ):
        moved = linkage.motion(theta)
        assert moved.passed
        for name in (*moved.places, *moved.rates):
            assert np.all(np.isfinite(getattr(moved, name)))
