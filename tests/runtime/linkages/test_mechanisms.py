"""FourBar at run time: exact positions over many turns, symmetry, refusals, the motion's figure."""

from __future__ import annotations

import json
from fractions import Fraction

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank, classify
from hypothesis import given, settings
from hypothesis import strategies as st
from linkage_truth import OUTPUTS

TURN = 2.0 * np.pi
SHAPES = {
    "crank rocker": (5.0, 1.0, 5.0, 2.0),
    "long crank": (10.0, 8.0, 10.0, 10.0),
    "drag link": (2.0, 4.0, 5.0, 4.5),
    "drag link, unlike links": (1.0, 3.0, 2.5, 3.5),
}
ASSEMBLIES = ("open", "crossed")
EVERY = [(shape, assembly) for shape in SHAPES for assembly in ASSEMBLIES]


def linkage(shape, assembly="open"):
    return FourBar(*SHAPES[shape], assembly)


def gap(bar, motion, theta):
    """Distance by which the loop fails to close, over the longest link."""
    chain = bar.crank * np.exp(1j * theta) + bar.coupler * np.exp(1j * motion.theta3)
    ends = bar.frame + bar.follower * np.exp(1j * motion.theta4)
    return np.abs(chain - ends) / max(bar.lengths.values())


# ---------------------------------------------------------------- positions


@pytest.mark.parametrize("shape, assembly", EVERY)
def test_half_turns_over_a_thousand_turns(shape, assembly):
    """Where sin(theta2) = 0 the diagonal lies along the frame: hand geometry, Smith (2.2)."""
    bar = linkage(shape, assembly)
    halves = np.arange(-2000, 2001)
    theta = halves * np.pi
    motion = bar.motion(theta)
    allowed = 1e-13 * np.maximum(1.0, np.abs(theta))
    assert np.all(gap(bar, motion, theta) <= allowed)
    diagonal = np.where(halves % 2 == 0, bar.frame - bar.crank, bar.frame + bar.crank)
    # Triangle BCD by the law of cosines; a negative diagonal points backwards, and turns C over.
    cosine = (bar.coupler**2 - bar.follower**2 + diagonal**2) / (2 * bar.coupler * diagonal)
    expected = bar.branch * np.sign(diagonal) * np.arccos(cosine)
    apart = np.abs(np.exp(1j * motion.theta3) - np.exp(1j * expected))
    assert np.all(apart <= allowed)
    between = np.arccos(
        (bar.coupler**2 + bar.follower**2 - diagonal**2) / (2 * bar.coupler * bar.follower)
    )
    np.testing.assert_allclose(motion.transmission_angle, between, rtol=1e-13)


@pytest.mark.parametrize("shape, assembly", EVERY)
def test_angles_are_continuous_and_periodic_over_many_turns(shape, assembly):
    bar = linkage(shape, assembly)
    steps = 720
    theta = TURN * np.arange(-5 * steps, 5 * steps + 1) / steps
    motion = bar.motion(theta)
    drag = bar.crank > bar.frame
    for angle, speed in ((motion.theta3, motion.omega3), (motion.theta4, motion.omega4)):
        jump = np.diff(angle)
        assert np.all(np.abs(jump) <= 1.05 * np.abs(speed).max() * TURN / steps)
        np.testing.assert_allclose(
            angle[steps:] - angle[:-steps], TURN if drag else 0.0, rtol=0, atol=1e-12
        )
        start = angle[5 * steps]
        assert -np.pi < start <= np.pi
    for name in OUTPUTS[2:]:
        value = getattr(motion, name)
        scale = np.abs(value).max()
        np.testing.assert_allclose(value[steps:], value[:-steps], rtol=0, atol=1e-12 * scale)


@pytest.mark.parametrize("assembly", ASSEMBLIES)
@pytest.mark.parametrize(
    "lengths",
    [
        (3.0, 1.0, 2.0 + 1e-13, 2.0),
        (2.0, 1.0, 2.0 + 5e-13, 1.0 + 1e-12),
        (1.0, 2.0, 2.0 + 5e-13, 1.0 + 1e-12),
        (1.0 + 3e-10, 1.0, 1.0 + 1e-10, 1.0 + 3e-10),
        (1e-6, 1.0, 1.0, 0.5),
    ],
)
def test_angles_stay_continuous_a_hair_from_folding(lengths, assembly):
    """Walking with steps refined towards each dead centre, no branch is changed."""
    bar = FourBar(*lengths, assembly)
    near = np.geomspace(1e-14, np.pi / 2, 4000)
    half = np.concatenate([-near[::-1], [0.0], near])
    theta = np.concatenate([half + k * np.pi for k in range(-4, 5)])
    motion = bar.motion(np.unique(theta))
    for angle in (motion.theta3, motion.theta4):
        assert np.abs(np.diff(angle)).max() < 0.5
    assert np.all(gap(bar, motion, motion.theta2) < 1e-13)


@pytest.mark.parametrize("shape", SHAPES)
def test_mirror_swaps_the_assemblies(shape):
    """Turned over about the frame, open becomes crossed and every angle changes its sign."""
    theta = np.linspace(-9.0, 9.0, 401)
    one, other = (linkage(shape, a).motion(s * theta) for a, s in (("open", 1), ("crossed", -1)))
    for name in ("theta3", "theta4", "alpha3", "alpha4"):
        np.testing.assert_array_equal(getattr(one, name), -getattr(other, name))
    for name in ("omega3", "omega4", "transmission_angle"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))


@pytest.mark.parametrize("shape, assembly", EVERY)
def test_assembly_and_transmission_angle(shape, assembly):
    bar = linkage(shape, assembly)
    motion = bar.motion(np.linspace(-7.0, 7.0, 301))
    between = motion.theta4 - motion.theta3
    assert np.all(np.sign(np.sin(between)) == bar.branch)
    np.testing.assert_allclose(np.cos(motion.transmission_angle), np.cos(between), atol=1e-14)
    assert np.all((motion.transmission_angle > 0) & (motion.transmission_angle < np.pi))


@pytest.mark.parametrize("shape, assembly", EVERY)
def test_rates_are_derivatives_of_the_angles(shape, assembly):
    """Spectral differentiation of one turn, an independent route to 1e-9."""
    bar, count = linkage(shape, assembly), 2048
    theta = TURN * np.arange(count) / count
    motion = bar.motion(theta)
    wave = np.fft.fftfreq(count, 1.0 / count) * 1j
    for angle, speed, acceleration in (
        (motion.theta3, motion.omega3, motion.alpha3),
        (motion.theta4, motion.omega4, motion.alpha4),
    ):
        growth = float(bar.crank > bar.frame)
        spectrum = np.fft.fft(angle - growth * theta)
        found = np.fft.ifft(wave * spectrum).real + growth
        np.testing.assert_allclose(found, speed, atol=1e-11 * np.abs(speed).max() * count / 100)
        again = np.fft.ifft(wave * np.fft.fft(speed)).real
        scale = np.abs(acceleration).max()
        np.testing.assert_allclose(again, acceleration, atol=1e-10 * scale)


def test_parallelogram_is_known_by_hand():
    """Away from its change points theta3 = 0 and theta4 = theta2."""
    bar = FourBar(2.0, 1.0, 2.0, 1.0)
    assert not bar.crank_turns
    theta = np.array([0.3, 1.0, 2.0, 3.0])
    motion = bar.motion(theta)
    np.testing.assert_allclose(motion.theta3, 0.0, atol=1e-14)
    np.testing.assert_allclose(motion.theta4, theta, rtol=1e-14)
    np.testing.assert_allclose(motion.omega4, 1.0, rtol=1e-14)
    np.testing.assert_allclose(motion.alpha4, 0.0, atol=1e-12)


def test_shapes_and_units_do_not_matter():
    theta = np.linspace(0.0, 6.0, 12)
    base = linkage("drag link").motion(theta)
    shaped = linkage("drag link").motion(theta.reshape(3, 2, 2))
    listed = linkage("drag link").motion(list(theta))
    single = linkage("drag link").motion(6.0)
    for name in (*OUTPUTS, "error"):
        value = getattr(base, name)
        np.testing.assert_array_equal(getattr(shaped, name).ravel(), value)
        np.testing.assert_array_equal(getattr(listed, name), value)
        assert getattr(single, name).shape == ()
        assert getattr(single, name) == pytest.approx(value[-1], rel=1e-15)
    assert linkage("drag link").motion([]).theta3.shape == (0,)
    for scale in (2.0**-900, 2.0**-30, 2.0**1000):
        scaled = FourBar(*(scale * length for length in SHAPES["drag link"])).motion(theta)
        for name in (*OUTPUTS, "error"):
            np.testing.assert_array_equal(getattr(scaled, name), getattr(base, name))


# ---------------------------------------------------------------- random lengths

LENGTH = st.floats(1e-3, 1e3)
ANGLE = st.floats(-1e4, 1e4)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(LENGTH, LENGTH, LENGTH, LENGTH, st.sampled_from(ASSEMBLIES), st.lists(ANGLE, min_size=1))
def test_random_lengths_are_refused_or_close(frame, crank, coupler, follower, assembly, theta):
    try:
        bar = FourBar(frame, crank, coupler, follower, assembly)
        motion = bar.motion(theta)
    except BadInput as refusal:
        assert "\n" not in str(refusal) and "found" in str(refusal)
        return
    angles = np.asarray(theta)
    assert np.all(gap(bar, motion, angles) <= 1e-13 * np.maximum(1.0, np.abs(angles)))
    assert all(np.all(np.isfinite(getattr(motion, name))) for name in (*OUTPUTS, "error"))
    assert np.all(np.sign(np.sin(motion.theta4 - motion.theta3)) * bar.branch >= -1e-12)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(LENGTH, LENGTH, LENGTH, LENGTH)
def test_a_crank_that_turns_reaches_every_angle(frame, crank, coupler, follower):
    try:
        bar = FourBar(frame, crank, coupler, follower)
    except BadInput:
        return
    if bar.crank_turns:
        bar.require_full_turn()
        motion = bar.motion(np.linspace(0.0, TURN, 33))
        assert motion.passed
    else:
        with pytest.raises(BadInput, match="the crank cannot turn fully"):
            bar.require_full_turn()
        with pytest.raises(BadInput, match="theta: found"):
            bar.motion([0.0, np.pi])


# ---------------------------------------------------------------- refusals


@pytest.mark.parametrize(
    "lengths, word",
    [
        ((10.0, 1.0, 2.0, 3.0), r"FourBar.frame: found 10; expected less than 6, the sum"),
        ((1.0, 4.0, 1.0, 2.0), r"FourBar.crank: found 4; expected less than 4"),
        ((1.0, -1.0, 1.0, 1.0), r"FourBar.crank: found -1.0; expected a positive finite length"),
        ((1.0, 0.0, 1.0, 1.0), r"FourBar.crank: found 0.0"),
        ((np.nan, 1.0, 1.0, 1.0), r"FourBar.frame: found nan"),
        ((np.inf, 1.0, 1.0, 1.0), r"FourBar.frame: found inf"),
        (("5 in", 1.0, 1.0, 1.0), r"FourBar.frame: found '5 in'"),
        ((None, 1.0, 1.0, 1.0), r"FourBar.frame: found None"),
        ((1j, 1.0, 1.0, 1.0), r"FourBar.frame: found 1j"),
    ],
)
def test_lengths_that_make_no_linkage_are_refused(lengths, word):
    with pytest.raises(BadInput, match=word):
        FourBar(*lengths)


def test_round_off_of_sums_decides_nothing():
    """As :func:`classify` has it, the lengths are what their doubles are."""
    # 0.3... + 0.1 + 0.3... exceeds 0.7... by less than the sum of the three is rounded.
    barely = FourBar(0.30000000000000004, 0.7000000000000001, 0.1, 0.30000000000000004)
    ((low, high),) = barely.crank_ranges()
    assert 0.0 < high < 1e-7
    assert low == -high
    turning = FourBar(1.0, 0.1, 0.30000000000000004, 0.8)
    assert turning.crank_turns
    assert turning.crank_ranges() == ((-np.pi, np.pi),)
    assert all(classify(bar).turns["crank"] == bar.crank_turns for bar in (barely, turning))


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.lists(st.integers(1, 12), min_size=4, max_size=4))
def test_tenths_are_as_their_class_says(tenths):
    """Lengths of tenths lie on change points, or a round-off beside them."""
    lengths = [0.1 * n for n in tenths]
    excess = 2 * max(map(Fraction, lengths)) - sum(map(Fraction, lengths))
    if excess >= 0:
        with pytest.raises(BadInput, match="cannot close"):
            FourBar(*lengths)
        return
    bar = FourBar(*lengths)
    frame, crank, coupler, follower = map(Fraction, lengths)
    turns = abs(frame - crank) > abs(coupler - follower) and frame + crank < coupler + follower
    assert bar.crank_turns == turns
    if turns:
        assert bar.crank_ranges() == ((-np.pi, np.pi),)
    else:  # at a change point with frame and crank in line the end is at pi, a fold
        assert bar._folds(np.array([-0.1, 6.0])) > 0


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.integers(1, 12), st.integers(1, 12), st.integers(-12, 12))
def test_slider_cranks_and_quick_returns_of_tenths(one, two, three):
    first, second, third = 0.1 * one, 0.1 * two, 0.1 * three
    exact = Fraction(first), Fraction(second), abs(Fraction(third))
    if exact[2] >= exact[0] + exact[1]:
        with pytest.raises(BadInput, match="guide"):
            SliderCrank(first, second, third)
    else:
        slider = SliderCrank(first, second, third)
        assert slider.crank_turns == (exact[1] - exact[0] > exact[2])
        if slider.crank_turns:
            assert slider.crank_ranges() == ((-np.pi, np.pi),)
    if three > 0:
        if exact[2] <= abs(exact[0] - exact[1]):
            with pytest.raises(BadInput, match="rod"):
                QuickReturn(first, second, third)
        else:
            assert QuickReturn(first, second, third).crank_ranges()


def test_all_problems_are_told_at_once():
    with pytest.raises(BadInput) as refusal:
        FourBar(-1.0, np.nan, 1.0, 1.0, assembly="twisted")
    assert len(refusal.value.problems) == 3
    assert "'twisted'; expected 'open' or 'crossed'" in str(refusal.value)


@pytest.mark.parametrize("theta", [np.nan, np.inf, [0.0, -np.inf]])
def test_angles_that_are_not_finite_are_refused(theta):
    with pytest.raises(BadInput, match="theta: found a value that is not finite"):
        linkage("crank rocker").motion(theta)


@pytest.mark.parametrize("theta", ["north", [[1.0], [1.0, 2.0]], 1j, None])
def test_what_is_no_angle_is_refused(theta):
    with pytest.raises(BadInput, match="theta: found"):
        linkage("crank rocker").motion(theta)


def test_an_angle_out_of_reach_is_named():
    bar = FourBar(4.0, 3.0, 2.0, 2.0)
    assert not bar.crank_turns
    assert bar.reach == (0.0, 4.0)
    with pytest.raises(BadInput, match=r"theta: found 1.5 rad; expected a diagonal BD between"):
        bar.motion([0.1, 1.5, 0.2])
    edge = np.arccos((16 + 9 - 16) / 24)
    inside = bar.motion(np.linspace(-edge, edge, 50)[1:-1])
    assert inside.passed and np.all(gap(bar, inside, inside.theta2) < 1e-13)


def test_a_change_point_itself_is_no_motion_but_its_neighbours_are():
    for lengths in ((2.0, 1.0, 2.0, 1.0), (1.0, 1.0, 1.0, 1.0)):
        bar = FourBar(*lengths)
        assert not bar.crank_turns
        with pytest.raises(BadInput, match="or folds there"):
            bar.motion([0.7, 0.0])
        assert np.all(np.isfinite(bar.motion([1e-100, 0.7, np.pi]).theta4))
    # Frame and crank as long as coupler and follower: no double is the angle of this one.
    bar = FourBar(3.0, 1.0, 2.0, 2.0)
    assert not bar.crank_turns
    moved = bar.motion(np.pi)
    assert moved.passed and moved.transmission_angle == pytest.approx(np.pi, abs=1e-15)


# ---------------------------------------------------------------- the result


def test_result_carries_figure_checks_and_picture(tmp_path):
    import matplotlib as mpl

    mpl.use("Agg")
    motion = linkage("crank rocker").motion(np.linspace(0.0, TURN, 91))
    assert motion.passed and motion.method == "closed form"
    assert motion.error.shape == motion.theta3.shape
    assert "theta3 and theta4" in motion.error_norm
    motion.require()
    assert len(motion.plot().lines) == 4
    saved = json.loads(motion.save(tmp_path / "motion.json").read_text())
    assert set(OUTPUTS) <= set(saved) and saved["passed"] is True


def test_figure_grows_towards_a_dead_centre_and_with_the_turns():
    bar = FourBar(3.0, 1.0, 2.0 + 1e-9, 2.0)
    error = bar.motion([np.pi / 2, np.pi - 1e-3, np.pi]).error
    assert error[0] < 1e-14 < 30 * error[0] < error[1] < error[2] < 1e-8
    early, late = linkage("drag link").motion([1.0, 1.0 + 1000 * TURN]).error
    assert late > 50 * early


@pytest.mark.parametrize(
    "theta, folds", [((0.1, 6.0), 1), ((0.1, 3.0), 0), ((-0.1, 0.1), 1), ((3.2, 9.5), 2)]
)
def test_an_angle_range_across_a_change_point_fails_a_check(theta, folds):
    motion = FourBar(4.0, 1.0, 4.0, 1.0).motion(np.linspace(*theta, 12))
    check = motion.checks["folds within the angles"]
    assert check.value == folds and motion.passed == (folds == 0)


def test_two_ranges_of_a_rocker_are_not_one_motion():
    bar = FourBar(3.0, 2.0, 3.5, 1.2)
    assert not bar.crank_turns
    reached = [t for t in np.linspace(-np.pi, np.pi, 41) if _moves(bar, t)]
    one_side = [t for t in reached if t > 0]
    assert bar.motion(one_side).passed
    assert not bar.motion([-one_side[0], one_side[0]]).passed


def _moves(bar, theta):
    try:
        bar.motion(theta)
    except BadInput:
        return False
    return True


def test_the_closure_limit_stays_small_at_huge_angles():
    motion = FourBar(5.0, 1.0, 5.0, 2.0).motion([1e15])
    assert motion.checks["loop closure over longest link"].limit <= 1e-8


def test_provenance_tells_lengths_assembly_and_versions():
    found = FourBar(5.0, 1.0, 5.0, 2.0, "crossed").motion(1.0).provenance
    assert found["links.frame"] == "5.0" and found["links.assembly"] == "crossed"
    assert {"elastolink", "numpy"} <= set(found)
