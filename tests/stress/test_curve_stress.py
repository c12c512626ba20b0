"""Coupler curves and harmonics where it is hard: random scenes, near change points, wild points."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from elastolink.runtime.linkages.curves import coupler_curve
from elastolink.runtime.linkages.harmonic_analysis import harmonics
from hypothesis import given, settings
from hypothesis import strategies as st

size = st.floats(0.01, 100.0)
share = st.floats(-5.0, 5.0)


def no_nan(result):
    for name, value in result.arrays().items():
        assert not np.any(np.isnan(value)), name


linkages = st.one_of(
    st.tuples(
        st.tuples(st.just(FourBar), size, size, size, size),
        st.sampled_from(["coupler", "crank", "follower"]),
    ),
    st.tuples(st.tuples(st.just(SliderCrank), size, size, st.floats(-50, 50)), st.just("coupler")),
    st.tuples(st.tuples(st.just(QuickReturn), size, size, size), st.sampled_from(["block", "rod"])),
)


@settings(max_examples=26, deadline=None, derandomize=True)
@given(linkages, share, share, st.integers(0, 1))
def test_any_linkage_is_traced_or_refused(drawn, along, across, circuit):
    (kind, *lengths), link = drawn
    try:
        curve = coupler_curve(kind(*lengths), along, across, link=link, points=64, circuit=circuit)
    except BadInput as refusal:
        assert "\n" not in str(refusal) or len(refusal.problems) > 1
        return
    no_nan(curve)
    curve.require()
    assert curve.length > 0


@pytest.mark.parametrize("off", [1e-3, 1e-12])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_hair_from_a_change_point(off, sign):
    # The parallelogram's neighbours: the circuits nearly meet, and the path nearly has corners.
    linkage = FourBar(2.0, 1.0, 2.0 + sign * off, 1.0)
    curve = coupler_curve(linkage, 1.0, 0.5)
    no_nan(curve)
    assert curve.passed
    # Half of the parallelogram's circle, of radius 1, and more.
    assert 3.0 < curve.length < 15.0
    assert curve.length_error < 1e-6


@pytest.mark.parametrize("far", [1e3, 1e5])
def test_a_point_far_out(far):
    linkage = FourBar(2.0, 1.0, 2.0, 2.0)
    curve = coupler_curve(linkage, far, far / 2)
    no_nan(curve)
    curve.require()
    swing = np.ptp(linkage.motion(np.linspace(0, 2 * np.pi, 20001)).theta3)
    assert curve.length == pytest.approx(2 * swing * np.hypot(far, far / 2), rel=5 / far)


@pytest.mark.parametrize("near", [1e-3, 1e-6, 1e-9])
def test_a_point_beside_a_joint(near):
    linkage = FourBar(2.0, 1.0, 2.0, 2.0)
    beside_pin = coupler_curve(linkage, near, near)
    assert beside_pin.length == pytest.approx(2 * np.pi, rel=3 * near)
    arc = coupler_curve(linkage, 2.0, link="follower").length
    beside_c = coupler_curve(linkage, 2.0 + near, near)
    assert beside_c.length == pytest.approx(arc, rel=10 * near)
    assert len(beside_c.double_theta2) <= 3
    # The cognates of a nearer point are a million times smaller than it is far off.
    for cognate in beside_pin.cognates() if near > 1e-7 else ():
        assert cognate.curve().length == pytest.approx(beside_pin.length, rel=1e-6)


@pytest.mark.parametrize(("ratio", "reached"), [(0.99, True), (0.999, True), (0.9999, False)])
def test_harmonics_near_a_change_point(ratio, reached):
    # The series falls like ratio^m: 131072 angles do not show the end of the last one.
    linkage = FourBar(10.0, 10.0 * ratio, 10.0, 10.0)
    found = harmonics((linkage, "theta4"), order=12)
    m = np.arange(1, 13)
    assert found.passed == reached
    assert found.b[1:] == pytest.approx(-(ratio**m) / m, abs=float(found.error))


def test_harmonics_of_a_high_order():
    found = harmonics((FourBar(2.0, 1.0, 2.0, 2.0), "omega4"), order=4096)
    assert found.passed
    assert float(found.error) < 1e-13
