"""SliderCrank at run time: two routes to its motion, hand cases, limits, ranges, refusals."""

from __future__ import annotations

import json
import pickle

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, SliderCrank
from hypothesis import given, settings
from hypothesis import strategies as st
from sliding_truth import SLIDER, slider_motion

TURN = 2.0 * np.pi
SHAPES = {
    "engine": (1.0, 3.5, 0.0),
    "offset": (1.0, 3.5, 0.8),
    "offset below": (1.0, 2.5, -1.2),
}
ASSEMBLIES = ("open", "crossed")
EVERY = [(shape, assembly) for shape in SHAPES for assembly in ASSEMBLIES]


def linkage(shape, assembly="open"):
    return SliderCrank(*SHAPES[shape], assembly)


def exact(slider, theta):
    """The motion in 30 digits, by another derivation."""
    with mpmath.workdps(30):
        numbers = {name: mpmath.mpf(value) for name, value in slider.geometry.items()}
        found = [slider_motion({**numbers, "theta2": mpmath.mpf(float(t))}) for t in theta]
        return {name: np.array([float(f[name]) for f in found]) for name in SLIDER}


# ---------------------------------------------------------------- two routes


@pytest.mark.parametrize("shape, assembly", EVERY)
def test_motion_against_the_closure_in_thirty_digits(shape, assembly):
    slider, theta = linkage(shape, assembly), np.linspace(-8.0, 8.0, 41)
    motion, truth = slider.motion(theta), exact(linkage(shape, assembly), theta)
    for name in SLIDER:
        size = np.abs(truth[name]).max()
        np.testing.assert_allclose(getattr(motion, name), truth[name], rtol=0, atol=5e-15 * size)
    assert motion.passed


@pytest.mark.parametrize("shape, assembly", EVERY)
def test_rates_are_spectral_derivatives(shape, assembly):
    slider, count = linkage(shape, assembly), 512
    motion = slider.motion(TURN * np.arange(count) / count)
    wave = np.fft.fftfreq(count, 1.0 / count) * 1j
    for value, slope in (
        ("theta3", "omega3"),
        ("omega3", "alpha3"),
        ("position", "slider_velocity"),
        ("slider_velocity", "slider_acceleration"),
    ):
        found = np.fft.ifft(wave * np.fft.fft(getattr(motion, value))).real
        expected = getattr(motion, slope)
        # The transform's round-off, times the highest wave number.
        allowed = 1e-15 * count / 2 * np.abs(getattr(motion, value)).max()
        np.testing.assert_allclose(found, expected, rtol=0, atol=allowed)


def test_drive_speed_and_acceleration_against_the_chain_rule():
    """theta2 = 3 t + 2 t^2 + 0.7 sin(5 t), differentiated in many digits."""
    slider, t = linkage("offset"), 0.4
    angle = 3 * t + 2 * t**2 + 0.7 * np.sin(5 * t)
    speed, acceleration = 3 + 4 * t + 3.5 * np.cos(5 * t), 4 - 17.5 * np.sin(5 * t)
    motion = slider.motion(angle, speed, acceleration)
    with mpmath.workdps(40):
        numbers = {name: mpmath.mpf(value) for name, value in slider.geometry.items()}

        def moved(name):
            def of_time(s):
                theta = 3 * s + 2 * s**2 + mpmath.mpf(0.7) * mpmath.sin(5 * s)
                return slider_motion({**numbers, "theta2": theta})[name]

            return [float(mpmath.diff(of_time, mpmath.mpf(t), n)) for n in (1, 2)]

        turned, slid = moved("theta3"), moved("position")
    assert [motion.omega3, motion.alpha3] == pytest.approx(turned, rel=1e-13)
    assert [motion.slider_velocity, motion.slider_acceleration] == pytest.approx(slid, rel=1e-13)


# ---------------------------------------------------------------- hand cases and limits


@pytest.mark.parametrize("shape", SHAPES)
def test_mirror_about_the_cranks_vertical_swaps_the_assemblies(shape):
    theta = np.linspace(-7.0, 7.0, 101)
    one = linkage(shape).motion(theta)
    other = linkage(shape, "crossed").motion(np.pi - theta)
    np.testing.assert_allclose(one.position, -other.position, rtol=1e-14)
    np.testing.assert_allclose(one.theta3, np.pi - other.theta3, atol=1e-14)
    np.testing.assert_allclose(one.slider_velocity, other.slider_velocity, atol=2e-14)
    np.testing.assert_allclose(one.slider_acceleration, -other.slider_acceleration, atol=2e-14)


def test_mirror_about_the_guide_turns_the_offset_over():
    theta = np.linspace(-7.0, 7.0, 101)
    one, other = (SliderCrank(1.0, 3.0, s * 0.7).motion(s * theta) for s in (1.0, -1.0))
    np.testing.assert_allclose(one.theta3, -other.theta3, atol=3e-16)
    np.testing.assert_allclose(one.position, other.position, rtol=1e-15)
    np.testing.assert_allclose(one.slider_acceleration, other.slider_acceleration, atol=3e-15)


@pytest.mark.parametrize("ratio", [1e2, 1e4, 1e8])
def test_a_long_coupler_moves_the_slider_as_a_cosine(ratio):
    """position - coupler = crank cos(theta2) - crank^2 sin^2(theta2) / (2 coupler) + ..."""
    theta = np.linspace(0.0, TURN, 41)
    motion = SliderCrank(1.0, ratio).motion(theta)
    allowed = 0.6 / ratio + 4e-16 * ratio
    np.testing.assert_allclose(motion.position - ratio, np.cos(theta), rtol=0, atol=allowed)
    for name, expected in (
        ("slider_velocity", -np.sin(theta) - np.sin(2 * theta) / (2 * ratio)),
        ("slider_acceleration", -np.cos(theta) - np.cos(2 * theta) / ratio),
    ):
        np.testing.assert_allclose(getattr(motion, name), expected, atol=2 / ratio**2 + 1e-15)


@pytest.mark.parametrize("assembly", ASSEMBLIES)
@pytest.mark.parametrize("height", [1e3, 1e5, 1e7])
def test_a_slider_crank_is_a_four_bar_with_a_long_follower(height, assembly):
    """The follower's pivot a height h below the guide: its tip leaves the guide by s^2 / 2 h.

    The frame then leans by atan2(-(h - offset), 0): the four-bar's angles are turned by it.
    """
    crank, coupler, offset = 1.0, 3.0, 0.4
    slider = SliderCrank(crank, coupler, offset, assembly)
    theta = np.linspace(0.3, 6.0, 9)
    place = slider.motion(theta)
    # Pivot straight below the middle of the stroke.
    middle = 0.5 * (place.position.min() + place.position.max())
    pivot = middle + 1j * (offset - height)
    lean = np.angle(pivot)
    bar = FourBar(abs(pivot), crank, coupler, height, assembly)
    moved = bar.motion(theta - lean)
    apart = np.exp(1j * (moved.theta3 + lean)) - np.exp(1j * place.theta3)
    assert np.abs(apart).max() < 2.0 / height + 4e-16 * height
    np.testing.assert_allclose(moved.omega3, place.omega3, atol=2.0 / height + 1e-14 * height)
    # The follower stands upright: its tip moves to the left as it turns anticlockwise.
    found = -height * moved.omega4
    np.testing.assert_allclose(found, place.slider_velocity, atol=2.0 / height + 1e-14 * height)


# ---------------------------------------------------------------- ranges


@pytest.mark.parametrize(
    "lengths, count",
    [
        ((1.0, 3.0, 0.5), 1),
        ((1.0, 1.2, 0.5), 1),
        ((1.0, 1.2, -0.5), 1),
        ((1.0, 0.5, 0.2), 2),
        ((1.0, 0.5, 1.2), 1),
        ((1.0, 0.5, -1.2), 1),
        ((1.0, 1.0, 0.0), 2),
        ((1.0, 3.0, 2.0), 1),
    ],
)
@pytest.mark.parametrize("assembly", ASSEMBLIES)
def test_crank_ranges_hold_every_angle_that_is_reached_and_no_other(lengths, count, assembly):
    slider = SliderCrank(*lengths, assembly)
    spans = slider.crank_ranges()
    assert len(spans) == count
    for theta in np.linspace(-np.pi, np.pi, 401)[:-1] + 1e-4:
        inside = any((theta - low) % TURN < high - low for low, high in spans)
        reached = abs(slider.offset - slider.crank * np.sin(theta)) < slider.coupler
        assert inside == reached
        if reached:
            assert slider.motion(theta).passed
        else:
            with pytest.raises(BadInput, match="theta: found"):
                slider.motion(theta)


def test_ranges_end_where_the_coupler_stands_across_the_guide():
    slider = SliderCrank(1.0, 1.2, 0.5)
    ((low, high),) = slider.crank_ranges()
    # 0.5 - sin(theta) = 1.2 at both ends.
    assert np.sin([low, high]) == pytest.approx([-0.7, -0.7], abs=1e-15)
    inside = slider.motion([low + 1e-6, high - 1e-6])
    np.testing.assert_allclose(np.abs(inside.omega3), np.abs(inside.omega3[0]), rtol=1e-6)
    assert np.all(np.abs(inside.omega3) > 100)
    with pytest.raises(BadInput, match=r"a crank angle in \(-0.775397, 3.91699\) rad"):
        slider.motion(-1.0)


def test_change_points_are_refused_and_passing_them_is_told():
    slider = SliderCrank(1.0, 1.0)
    assert not slider.crank_turns
    with pytest.raises(BadInput, match="or folds there"):
        slider.motion(np.pi / 2)
    assert slider.motion([-1.5, 0.3, 1.5]).passed
    passed = slider.motion([1.4, 1.7])
    assert passed.checks["folds within the angles"].value == 1 and not passed.passed
    with pytest.raises(BadInput, match="the crank cannot turn fully"):
        slider.require_full_turn()
    # Within a range crank and coupler mirror each other: position 2 cos, theta3 = -theta2.
    motion = slider.motion([-1.0, 0.5])
    np.testing.assert_allclose(motion.position, 2 * np.cos([-1.0, 0.5]), rtol=1e-15)
    np.testing.assert_allclose(motion.omega3, -1.0, rtol=1e-15)


LENGTH = st.floats(1e-3, 1e3)
ANGLE = st.floats(-1e4, 1e4)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(
    LENGTH, LENGTH, st.floats(-1e3, 1e3), st.sampled_from(ASSEMBLIES), st.lists(ANGLE, min_size=1)
)
def test_random_lengths_are_refused_or_close(crank, coupler, offset, assembly, theta):
    try:
        slider = SliderCrank(crank, coupler, offset, assembly)
        motion = slider.motion(theta)
    except BadInput as refusal:
        assert "\n" not in str(refusal) and "found" in str(refusal)
        return
    chain = crank * np.exp(1j * motion.theta2) + coupler * np.exp(1j * motion.theta3)
    gap = np.abs(chain - motion.position - 1j * offset) / max(crank, coupler, abs(offset))
    assert np.all(gap <= 1e-13 * np.maximum(1.0, np.abs(theta)))
    assert all(np.all(np.isfinite(getattr(motion, name))) for name in (*SLIDER, "error"))
    assert np.all(np.cos(motion.theta3) * slider.branch >= -1e-12)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(LENGTH, LENGTH, st.floats(-1e3, 1e3))
def test_a_crank_that_turns_reaches_every_angle(crank, coupler, offset):
    try:
        slider = SliderCrank(crank, coupler, offset)
    except BadInput:
        return
    if slider.crank_turns:
        slider.require_full_turn()
        assert slider.motion(np.linspace(0.0, TURN, 33)).passed
    else:
        with pytest.raises(BadInput, match="theta: found"):
            slider.motion(np.linspace(0.0, TURN, 5))


# ---------------------------------------------------------------- refusals and the result


@pytest.mark.parametrize(
    "lengths, word",
    [
        ((1.0, 2.0, 3.0), r"SliderCrank.offset: found 3; expected less than 3 in magnitude"),
        ((1.0, 2.0, -4.0), r"SliderCrank.offset: found -4"),
        ((0.0, 2.0), r"SliderCrank.crank: found 0.0; expected a positive finite length"),
        ((1.0, -2.0), r"SliderCrank.coupler: found -2.0"),
        ((1.0, np.inf), r"SliderCrank.coupler: found inf"),
        ((1.0, 2.0, np.nan), r"SliderCrank.offset: found nan; expected a finite length"),
        ((1.0, 2.0, "1 in"), r"SliderCrank.offset: found '1 in'"),
        ((1.0, 2.0, 0.0, "upside"), r"found 'upside'; expected 'open' or 'crossed'"),
    ],
)
def test_lengths_that_make_no_linkage_are_refused(lengths, word):
    with pytest.raises(BadInput, match=word):
        SliderCrank(*lengths)


def test_what_is_no_drive_is_refused():
    slider = linkage("engine")
    for drive in ({"speed": np.nan}, {"acceleration": [np.inf]}, {"speed": "fast"}):
        with pytest.raises(BadInput, match=f"{next(iter(drive))}: found"):
            slider.motion(1.0, **drive)
    with pytest.raises(BadInput, match="shapes that broadcast"):
        slider.motion([0.0, 1.0, 2.0], speed=[1.0, 2.0])


def test_scales_do_not_matter():
    theta = np.linspace(0.0, 6.0, 12)
    base = linkage("offset").motion(theta)
    for scale in (2.0**-900, 2.0**-30, 2.0**1000):
        scaled = SliderCrank(*(scale * length for length in SHAPES["offset"])).motion(theta)
        for name in (*SLIDER, "error"):
            factor = scale if name.startswith(("position", "slider")) else 1.0
            np.testing.assert_array_equal(getattr(scaled, name), factor * getattr(base, name))


def test_result_carries_figure_checks_and_picture(tmp_path):
    import matplotlib as mpl

    mpl.use("Agg")
    motion = linkage("offset").motion(np.linspace(0.0, TURN, 91), speed=100.0, acceleration=5.0)
    assert motion.passed and motion.method == "closed form"
    assert motion.error.shape == motion.theta3.shape
    axes = motion.plot()
    assert len(axes.lines) == 3
    words = [text.get_text() for text in axes.get_legend().get_texts()]
    assert words[2] == "acceleration [$10^{4}$ m/s^2]"
    saved = json.loads(motion.save(tmp_path / "motion.json").read_text())
    assert set(SLIDER) < set(saved) and saved["passed"] is True
    assert saved["linkage"]["offset"] == 0.8
    assert "slider_velocity" in motion.save(tmp_path / "motion.csv").read_text().splitlines()[0]
    again = pickle.loads(pickle.dumps(motion))
    assert again.passed and again.linkage == motion.linkage


def test_checks_see_a_rate_that_is_wrong():
    """The closure of speeds and accelerations is no empty promise."""
    from elastolink.runtime.linkages.linkage import _checks

    slider = linkage("offset")
    motion = slider.motion([1.0, 2.0])
    m = {"theta2": motion.theta2, **{name: getattr(motion, name) for name in SLIDER}}
    scale = 2.0**slider.scale
    for name in ("position", "slider_velocity", "slider_acceleration"):
        m[name] = m[name] * scale
    assert all(check.passed for check in _checks(slider, m, motion.error).values())
    for name, told in (("omega3", "speeds"), ("slider_acceleration", "accelerations")):
        wrong = {**m, name: m[name] * (1 + 1e-13)}
        checks = _checks(slider, wrong, motion.error)
        assert not checks[f"closure of {told} over the figure"].passed
