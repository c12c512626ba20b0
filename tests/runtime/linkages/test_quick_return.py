"""QuickReturn at run time: two routes to its motion, hand cases, time ratio, ranges, refusals."""

from __future__ import annotations

import json

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import QuickReturn, SliderCrank
from hypothesis import given, settings
from hypothesis import strategies as st
from sliding_truth import ROD, rod_motion

TURN = 2.0 * np.pi
SHAPES = {"swinging": (2.0, 1.0, 4.0), "turning": (1.0, 2.5, 3.5), "nearly one": (1.0, 0.99, 2.0)}


def exact(linkage, theta, near):
    """The motion in 30 digits, by another derivation."""
    with mpmath.workdps(30):
        numbers = {name: mpmath.mpf(value) for name, value in linkage.geometry.items()}
        found = [
            rod_motion({**numbers, "theta2": mpmath.mpf(float(t))}, mpmath.mpf(float(n)))
            for t, n in zip(theta, near, strict=True)
        ]
        return {name: np.array([float(f[name]) for f in found]) for name in ROD}


@pytest.mark.parametrize("shape", SHAPES)
def test_motion_against_complex_numbers_in_thirty_digits(shape):
    linkage, theta = QuickReturn(*SHAPES[shape]), np.linspace(-8.0, 8.0, 41)
    motion = linkage.motion(theta)
    truth = exact(linkage, theta, motion.theta4)
    for name in ROD:
        size = np.abs(truth[name]).max()
        np.testing.assert_allclose(getattr(motion, name), truth[name], rtol=0, atol=5e-15 * size)
    assert motion.passed


@pytest.mark.parametrize("shape", SHAPES)
def test_rates_are_spectral_derivatives(shape):
    linkage, count = QuickReturn(*SHAPES[shape]), 8192
    theta = TURN * np.arange(count) / count
    motion = linkage.motion(theta)
    growth = float(linkage.eps > 1)
    wave = np.fft.fftfreq(count, 1.0 / count) * 1j
    for value, slope in (
        (motion.theta4 - growth * theta, motion.omega4 - growth),
        (motion.omega4, motion.alpha4),
        (motion.slide, motion.slide_velocity),
        (motion.slide_velocity, motion.slide_acceleration),
    ):
        found = np.fft.ifft(wave * np.fft.fft(value)).real
        # Round-off of the values, times the highest wave number.
        allowed = motion.error.max() * count / 2 * max(1.0, np.abs(value).max())
        np.testing.assert_allclose(found, slope, rtol=0, atol=allowed)


@pytest.mark.parametrize("shape", SHAPES)
def test_the_rods_angle_is_continuous_over_many_turns(shape):
    linkage, steps = QuickReturn(*SHAPES[shape]), 3600
    theta = TURN * np.arange(-5 * steps, 5 * steps + 1) / steps
    motion = linkage.motion(theta)
    gain = TURN if linkage.eps > 1 else 0.0
    assert np.abs(np.diff(motion.theta4)).max() < 1.05 * np.abs(motion.omega4).max() * TURN / steps
    turned = motion.theta4[steps:] - motion.theta4[:-steps]
    assert np.all(np.abs(turned - gain) <= motion.error[steps:] + motion.error[:-steps])
    assert motion.theta4[5 * steps] == 0.0


def test_drive_speed_and_acceleration_against_the_chain_rule():
    linkage, t = QuickReturn(*SHAPES["swinging"]), 0.4
    angle = 3 * t + 2 * t**2
    motion = linkage.motion(angle, 3 + 4 * t, 4.0)
    with mpmath.workdps(40):
        numbers = {name: mpmath.mpf(value) for name, value in linkage.geometry.items()}

        def moved(name):
            def of_time(s):
                return rod_motion({**numbers, "theta2": 3 * s + 2 * s**2})[name]

            return [float(mpmath.diff(of_time, mpmath.mpf(t), n)) for n in (1, 2)]

        turned, slid = moved("theta4"), moved("slide")
    assert [motion.omega4, motion.alpha4] == pytest.approx(turned, rel=1e-13)
    assert [motion.slide_velocity, motion.slide_acceleration] == pytest.approx(slid, rel=1e-13)


# ---------------------------------------------------------------- hand cases


def test_extremes_by_hand():
    """Frame 2, crank 1: the rod swings 30 degrees to either side, 240 degrees of crank forward."""
    linkage = QuickReturn(2.0, 1.0, 4.0)
    assert linkage.eps == 0.5
    motion = linkage.motion([0.0, TURN / 3, -TURN / 3, np.pi])
    np.testing.assert_allclose(motion.theta4, [0.0, np.pi / 6, -np.pi / 6, 0.0], atol=1e-15)
    np.testing.assert_allclose(motion.slide, [3.0, np.sqrt(3.0), np.sqrt(3.0), 1.0], rtol=1e-15)
    np.testing.assert_allclose(motion.omega4, [1 / 3, 0.0, 0.0, -1.0], atol=1e-15)


def test_a_small_crank_swings_the_rod_in_proportion():
    """theta4 = eps sin - eps^2 sin(2 theta2) / 2 + ..., the expansion of the small-crank papers."""
    theta = np.linspace(0.0, TURN, 31)
    for eps in (1e-2, 1e-4, 1e-9):
        motion = QuickReturn(1.0, eps, 1.0 + eps).motion(theta)
        series = eps * np.sin(theta) - eps**2 / 2 * np.sin(2 * theta)
        np.testing.assert_allclose(motion.theta4, series, atol=eps**3 + 1e-16 * eps)
        np.testing.assert_allclose(
            motion.slide, 1 + eps * np.cos(theta), rtol=0, atol=eps**2 + 4e-16
        )


def test_frame_and_crank_change_places_in_the_inversion():
    """Seen from the crank: the angle between rod and crank is that of the other mechanism."""
    theta = np.linspace(-7.0, 7.0, 61)
    one, other = QuickReturn(1.0, 2.5, 3.5), QuickReturn(2.5, 1.0, 3.5)
    here, there = one.motion(theta), other.motion(-theta)
    np.testing.assert_allclose(theta - here.theta4, -there.theta4, atol=2e-15)
    np.testing.assert_allclose(here.slide, there.slide, rtol=1e-15)
    np.testing.assert_allclose(here.omega4, 1 - there.omega4, atol=2e-15)
    np.testing.assert_allclose(here.alpha4, there.alpha4, atol=2e-15)


def test_the_block_sees_a_slider_crank():
    """Held at the rod, the frame moves as the coupler of a slider-crank does: B = A + AB.

    In axes of the rod, D is fixed at 0, A runs round D with the frame, and B slides on the x axis:
    a slider-crank with crank = frame and coupler = crank, driven by -theta4.
    """
    linkage = QuickReturn(1.0, 2.5, 3.5)
    motion = linkage.motion(np.linspace(0.1, 6.0, 12))
    inverse = SliderCrank(1.0, 2.5).motion(-motion.theta4)
    np.testing.assert_allclose(inverse.position, motion.slide, rtol=1e-14)
    turned = np.exp(1j * inverse.theta3) / np.exp(1j * (motion.theta2 - motion.theta4))
    np.testing.assert_allclose(turned, 1.0, atol=3e-15)


# ---------------------------------------------------------------- ranges and refusals


@pytest.mark.parametrize(
    "lengths, count",
    [((2.0, 1.0, 2.5), 1), ((1.0, 2.0, 2.5), 1), ((1.0, 1.0, 2.0), 1), ((1.0, 1.0, 1.5), 2)],
)
def test_crank_ranges_hold_every_angle_that_is_reached_and_no_other(lengths, count):
    linkage = QuickReturn(*lengths)
    spans = linkage.crank_ranges()
    assert len(spans) == count and not linkage.crank_turns
    for theta in np.linspace(-np.pi, np.pi, 401)[:-1] + 1e-4:
        inside = any((theta - low) % TURN < high - low for low, high in spans)
        slide = abs(linkage.frame + linkage.crank * np.exp(1j * theta))
        assert inside == (slide < linkage.rod)
        if inside:
            assert linkage.motion(theta).passed
        else:
            with pytest.raises(BadInput, match="theta: found"):
                linkage.motion(theta)


def test_eps_of_one_is_a_change_point():
    """The rod's angle is half of the crank's, and jumps where the block passes the pivot."""
    linkage = QuickReturn(1.0, 1.0, 3.0)
    motion = linkage.motion([-3.0, 0.5, 3.0])
    assert motion.passed
    np.testing.assert_allclose(motion.theta4, [-1.5, 0.25, 1.5], rtol=1e-15)
    np.testing.assert_allclose(motion.omega4, 0.5, rtol=1e-14)
    np.testing.assert_array_equal(motion.alpha4, 0.0)
    with pytest.raises(BadInput, match=r"crank angle in \(-3.14159, 3.14159\) rad"):
        linkage.motion(np.pi)
    beyond = linkage.motion([3.0, 3.3])
    assert beyond.checks["folds within the angles"].value == 1 and not beyond.passed
    with pytest.raises(BadInput, match="eps = 1"):
        linkage.require_full_turn()


def test_a_short_rod_is_told():
    with pytest.raises(BadInput, match="at least 3, frame and crank"):
        QuickReturn(2.0, 1.0, 2.9).require_full_turn()
    with pytest.raises(BadInput, match="the rod never reaches the block"):
        QuickReturn(2.0, 1.0, 0.9)
    # 0.2 + 0.1 is a little more than 0.3.
    assert QuickReturn(0.2, 0.1, 0.3).crank_turns
    assert QuickReturn(0.2, 0.1, 0.3).motion(0.0).passed
    passing = QuickReturn(2.0, 1.0, 2.5).motion([1.3, 4.9 + TURN])
    assert passing.checks["folds within the angles"].value > 0


@pytest.mark.parametrize("lengths", [(0.0, 1.0, 1.0), (1.0, np.nan, 1.0), (1.0, 1.0, "long")])
def test_lengths_that_make_no_linkage_are_refused(lengths):
    with pytest.raises(BadInput, match="expected a positive finite length"):
        QuickReturn(*lengths)


LENGTH = st.floats(1e-3, 1e3)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(LENGTH, LENGTH, st.floats(0.5, 3.0), st.lists(st.floats(-1e4, 1e4), min_size=1))
def test_random_lengths_are_refused_or_close(frame, crank, share, theta):
    try:
        linkage = QuickReturn(frame, crank, share * (frame + crank))
        motion = linkage.motion(theta)
    except BadInput as refusal:
        assert "\n" not in str(refusal) and "found" in str(refusal)
        return
    chain = motion.slide * np.exp(1j * motion.theta4)
    gap = np.abs(chain - frame - crank * np.exp(1j * motion.theta2)) / (frame + crank)
    assert np.all(gap <= 1e-13 * np.maximum(1.0, np.abs(theta)))
    assert all(np.all(np.isfinite(getattr(motion, name))) for name in (*ROD, "error"))


def test_scales_do_not_matter():
    theta = np.linspace(0.0, 6.0, 12)
    base = QuickReturn(2.0, 1.0, 4.0).motion(theta)
    for scale in (2.0**-900, 2.0**-30, 2.0**1000):
        scaled = QuickReturn(2.0 * scale, scale, 4.0 * scale).motion(theta)
        for name in (*ROD, "error"):
            factor = scale if name.startswith("slide") else 1.0
            np.testing.assert_array_equal(getattr(scaled, name), factor * getattr(base, name))


def test_result_carries_figure_checks_and_picture(tmp_path):
    import matplotlib as mpl

    mpl.use("Agg")
    motion = QuickReturn(2.0, 1.0, 4.0).motion(np.linspace(0.0, TURN, 91))
    assert motion.passed and motion.relative
    assert motion.error.shape == motion.theta4.shape
    units = {"slide": "m", "omega4": "1", "slide_velocity": "m/rad"}
    assert {name: motion.unit(name) for name in units} == units
    assert len(motion.plot().lines) == 3
    saved = json.loads(motion.save(tmp_path / "motion.json").read_text())
    assert set(ROD) < set(saved) and saved["passed"] is True
    assert motion.provenance["links.rod"] == "4.0"


def test_figure_grows_where_the_block_comes_near_the_pivot():
    error = QuickReturn(1.0, 1.0 - 1e-9, 2.0).motion([0.5, np.pi - 1e-3, np.pi]).error
    assert error[0] < 1e-14 < 30 * error[0] < error[1] < error[2] < 1e-5
