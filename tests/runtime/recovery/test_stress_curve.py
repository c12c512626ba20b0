"""The stress curve: the same answer in any order, against stress(), refusals."""

import elastolink as el
import numpy as np
import pytest

SPEEDS = np.linspace(18.0, 35.0, 60)


@pytest.fixture(scope="module")
def system():
    overrides = {"mesh.elements": 1, "damping.ratio": 0.02}
    return el.load_scene("aannaque_1996_table_4_1", overrides=overrides).system()


@pytest.fixture(scope="module")
def curve(system):
    return el.stress_curve(system, SPEEDS, stations=5)


def test_it_passes_its_own_checks_whatever_the_order(system, curve, tmp_path):
    assert set(curve.checks) == {"converged", "equation", "linear range"}
    assert curve.checks["equation"].passed
    assert curve.maximum.shape == curve.error.shape == (60, 3)
    assert curve.links == ("crank", "coupler", "follower")
    assert len(curve.plot().lines) == 3
    text = curve.save(tmp_path / "curve.csv").read_text()
    assert text.startswith("speed [rad/s],links,maximum [Pa]") and len(text.splitlines()) > 180
    given = [*SPEEDS[::-3], SPEEDS[0], SPEEDS[-1]]
    turned = el.stress_curve(system, given, stations=5, stability=False)
    assert np.array_equal(turned.maximum[0], turned.maximum[-1])
    assert turned.stable is None and turned.unstable_ranges == ()
    gap = np.abs(turned.maximum[:20] / curve.maximum[::-3] - 1.0)
    assert np.all(gap <= turned.error[:20] + curve.error[::-3])


@pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
def test_it_agrees_with_stress_of_a_steady_state(system, curve):
    """Another solver of the motion, and the recovery itself: maxima, places and angles."""
    for k in (3, 50):
        found = el.stress(system, el.steady_state(system, float(SPEEDS[k])), stations=5)
        for n, link in enumerate(curve.links):
            peak = found.maxima[link]
            # stress() looks at eight times its angles, without a parabola: 1e-5 of a maximum.
            assert abs(peak.value) == pytest.approx(curve.maximum[k, n], rel=1e-4)
            assert peak.place == curve.place[k, n]
            assert np.cos(peak.theta - curve.theta[k, n]) > 0.999
            assert peak.fibre == ("positive" if curve.fibre[k, n] > 0 else "negative")


def test_stability_is_that_of_the_multipliers(system):
    """Stable below 86.9 rad/s and unstable above, by the full system's own multipliers."""
    speeds = [80.0, 86.0, 90.0]
    found = el.stress_curve(system, speeds, rtol=1e-2, stations=3)
    whole = el.floquet_multipliers(system, speeds, rtol=1e-6)
    largest = np.max(np.abs(whole.multipliers), axis=1)
    assert np.all(np.abs(found.multiplier - largest) <= found.multiplier_error)
    assert found.stable.tolist() == whole.stable.tolist() == [True, True, False]
    assert found.unstable_ranges == ((86.0, 90.0),)
    assert "unstable" in [text.get_text() for text in found.plot().get_legend().get_texts()]


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"speeds": [0.0, 10.0]}, "speeds"),
        ({"speeds": []}, "speeds"),
        ({"speeds": ["fast"]}, "speeds"),
        ({"rtol": 0.5}, "rtol"),
        ({"method": "guess"}, "method"),
        ({"stations": {"crank": [2.0]}}, "crank"),
        ({"system": el.load_scene("smith_1972_5152_sixteenth_inch").system()}, "beams"),
    ],
)
def test_bad_input_is_one_clear_line(system, change, match):
    given = {"system": system, "speeds": [20.0, 30.0], **change}
    with pytest.raises(el.BadInput, match=match):
        el.stress_curve(**given)
    with pytest.raises(el.BadInput, match="damping"):
        el.stress_curve(system.with_parameters(damping_ratio=0.0), [20.0])
