"""Transmission angle, dead centres and mechanical advantage against swept motions."""

import math

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from elastolink.runtime.linkages.transmission import transmission_angle
from refusals import refused

ROCKERS = [(12, 6, 12, 12), (5, 1, 5, 2), (0.547, 0.170, 0.328, 0.525), (10, 1, 10, 4)]
SLIDERS = [(1.0, 3.0, 0.3), (1.0, 3.0, -0.3), (1.0, 2.0, 0.0)]
SWEPT = [*((FourBar, sizes) for sizes in ROCKERS), *((SliderCrank, sizes) for sizes in SLIDERS)]
OUTPUTS = {
    FourBar: ("theta4", "omega4", 1e-13),
    SliderCrank: ("position", "slider_velocity", 1e-14),
}


@pytest.mark.parametrize(("kind", "sizes"), SWEPT)
@pytest.mark.parametrize("assembly", ["open", "crossed"])
def test_extremes_stroke_and_dead_centres_against_a_sweep(kind, sizes, assembly):
    linkage = kind(*sizes, assembly=assembly)
    output, rate, rounding = OUTPUTS[kind]
    found = transmission_angle(linkage)
    swept = linkage.motion(np.linspace(0.0, 2.0 * np.pi, 7201))
    places = getattr(swept, output)
    # Next to an extreme the swept values differ in the second order of half a step.
    assert swept.transmission_angle.min() == pytest.approx(found.least, abs=1e-6)
    assert swept.transmission_angle.max() == pytest.approx(found.greatest, abs=1e-6)
    assert np.ptp(places) == pytest.approx(found.swing, abs=1e-6)
    assert found.passed
    for name, angle in found.dead_centres.items():
        at = linkage.motion(angle)
        assert abs(getattr(at, rate)) < rounding
        gap = getattr(at, output) - found.output_at_dead_centres[name]
        assert np.sin(gap / 2.0) == pytest.approx(0.0, abs=1e-12)
    if kind is SliderCrank:
        assert (places.min(), places.max()) == pytest.approx(found.output_range, abs=1e-6)
        assert (found.time_ratio > 1.0) == (linkage.offset != 0.0)


def test_folds_of_a_triple_rocker_bound_its_crank():
    bar = FourBar(5.0, 4.0, 3.5, 3.0)
    found = transmission_angle(bar)
    assert found.greatest == math.pi
    assert [*found.toggles["extended"]] == [*found.at_greatest]
    inside, beyond = 1 - 1e-9, 1 + 1e-9
    bar.motion(found.at_greatest * inside)
    with pytest.raises(BadInput):
        bar.motion(found.at_greatest * beyond)


def test_strokes_by_hand():
    # 3-4-5 and 5-12-13: outer 13, inner 5 with offset 3; stroke 12.649... - 4.
    offset = transmission_angle(SliderCrank(4.0, 9.0, 3.0))
    assert offset.swing == pytest.approx(np.sqrt(160.0) - 4.0, rel=1e-15)
    assert transmission_angle(SliderCrank(1.0, 3.0)).swing == pytest.approx(2.0, rel=1e-15)
    found = transmission_angle(QuickReturn(2.0, 1.0, 4.0))
    ends = found.dead_centres["upper"], found.dead_centres["lower"]
    assert ends == pytest.approx((2 * np.pi / 3, -2 * np.pi / 3), rel=1e-15)
    assert found.time_ratio == pytest.approx(2.0, rel=1e-15)
    assert found.swing == pytest.approx(math.pi / 3, rel=1e-15)
    assert found.least == found.greatest == math.pi / 2
    assert transmission_angle(QuickReturn(1.0, 2.0, 4.0)).swing is None


def test_mechanical_advantage_is_the_corrected_formula():
    """follower sin(gamma)/(crank sin(beta)); printed (3.1) has the frame for the crank."""
    bar = FourBar(5.0, 1.0, 4.0, 3.0)
    theta = np.linspace(0.1, 6.0, 17)
    moved = bar.motion(theta)
    beta = np.sin(theta - moved.theta3)
    formula = 3.0 * np.sin(moved.theta4 - moved.theta3) / beta
    found = transmission_angle(bar).mechanical_advantage(theta)
    np.testing.assert_allclose(found.advantage, formula, rtol=1e-12)
    pole = transmission_angle(bar).dead_centres["extended"]
    assert abs(transmission_angle(bar).mechanical_advantage(pole).advantage) > 1e13
    rod = transmission_angle(QuickReturn(2.0, 1.0, 4.0))
    assert not np.isnan(rod.mechanical_advantage(theta).advantage).any()


test_bad_bands_are_refused = refused(
    lambda band: transmission_angle(FourBar(5, 1, 5, 2), band),
    [(band, "band: found") for band in ((2.0, 1.0), (-1.0, 1.0), (0.0, 4.0), 3.0, ("a", "b"))],
)
