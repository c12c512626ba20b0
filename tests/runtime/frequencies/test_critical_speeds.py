"""Critical speeds: constant systems on which every method must agree, varying ones, bad input."""

from dataclasses import replace

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic
from elastolink.runtime.frequencies import critical_speeds
from periodic_systems import system_of, wave
from refusals import refused

FREQUENCY = np.array([30.0, 71.0])


def _system(damping=0.6, softening=0.0, varying=0.0, shape=True) -> LinearPeriodic:
    """Two oscillators, each forced by all harmonics."""
    made = system_of(
        M=np.eye(2),
        K=[np.diag(FREQUENCY**2), wave(np.diag([varying, 0.0]))],
        Kg=(None, -softening * np.eye(2), 2),
        C=damping * np.eye(2),
        p=lambda t: np.outer(1.0 / (1.2 - np.cos(t)), [1.0, 3.0]),
    )
    return replace(made, shape=(lambda x: 1e-6 * np.stack([x, x], axis=1)) if shape else None)


def _expected(low, high):
    """Return speed, mode and order of the fractions within a range, by rising speed."""
    return sorted(
        (float(value / n), mode, n)
        for mode, value in enumerate(FREQUENCY, 1)
        for n in range(1, 40)
        if low <= value / n <= high
    )


def test_mean_frequencies_are_divided():
    found = critical_speeds(_system(), (9.0, 40.0))
    expected = _expected(9.0, 40.0)
    np.testing.assert_allclose(found.speed, [row[0] for row in expected], rtol=1e-12)
    assert found.labels == tuple((mode, n) for _, mode, n in expected)
    assert np.all(np.abs(found.speed - [row[0] for row in expected]) <= found.error + 1e-14)
    np.testing.assert_allclose(found.ratio, 1.0, rtol=1e-12)


def test_axial_forces_of_the_speed_by_hand():
    # omega^2 - s w^2 = n^2 w^2: w = omega/sqrt(n^2 + s); buckled from 30/sqrt(0.5) = 42.4 on.
    found = critical_speeds(_system(0.0, 0.5), (9.0, 60.0), method="running_mean")
    expected = FREQUENCY[found.mode - 1] / np.sqrt(found.order**2 + 0.5)
    assert np.all(np.abs(found.speed - expected) <= found.error)
    assert np.max(found.error) < 2e-2 and np.max(found.speed) < 42.4
    assert {(1, 1), (1, 2), (2, 2)} <= set(found.labels)


def test_maxima_of_the_response_are_near_the_fractions():
    found = critical_speeds(_system(), (13.0, 40.0), method="response", speeds=120)
    expected = {(mode, n): w for w, mode, n in _expected(13.0, 40.0)}
    assert set(found.labels) <= set(expected) and {(1, 1), (2, 2), (2, 3)} <= set(found.labels)
    for speed, label in zip(found.speed, found.labels, strict=True):
        # Damping and the other oscillator move a maximum by parts of its width, 0.3/n.
        assert speed == pytest.approx(expected[label], abs=0.1)
    assert found.passed and np.all(np.isfinite(found.height))
    assert found.plot().get_ylabel() == found.quantity


def test_the_place_of_a_maximum_to_its_error():
    # One harmonic alone, one coordinate: amplitude 1/|k - w^2 + i w c|, greatest at k - c^2/2.
    c = 3.0
    unit = np.eye(1)
    made = system_of(M=unit, K=900.0 * unit, C=c * unit, p=wave([1.0]))
    system = replace(made, shape=lambda x: 1e-6 * x[:, None])
    found = critical_speeds(system, (20.0, 40.0), method="response", speeds=31)
    assert len(found.speed) == 1
    assert abs(found.speed[0] - np.sqrt(900.0 - c**2 / 2)) <= found.error[0] < 1e-2


@pytest.mark.smoke
def test_all_methods_agree_on_a_constant_system():
    """Each of the three labels once by each method."""
    system, methods = _system(0.2), ("running_mean", "response", "multipliers", "meissner")
    by_mean = critical_speeds(system, (20.0, 40.0))
    expected = dict(zip(by_mean.labels, by_mean.speed, strict=True))
    assert set(expected) == {(1, 1), (2, 2), (2, 3)}
    for method in methods:
        other = critical_speeds(system, (20.0, 40.0), method=method, speeds=80)
        # Of the multipliers' real part damping moves the maximum, exp(-c pi/w) rising with w.
        speeds = dict(zip(other.labels, other.speed, strict=True))
        assert speeds == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("method", ["running_mean", "response", "multipliers", "meissner"])
def test_a_range_without_any(method):
    """Between 30 and 71/2 rad/s lies no fraction of a frequency."""
    found = critical_speeds(_system(0.2), (31.0, 34.0), method=method, speeds=40)
    assert found.labels == () and len(found.speed) == len(found.error) == 0 and found.passed


def test_a_varying_frequency_parts_the_methods():
    """Frequency of sqrt(900 + 400 cos): its mean is 29.23.. but the resonance is a Mathieu one."""
    system = _system(0.4, 0.0, 400.0)
    by_mean, by_step, by_multiplier = (
        critical_speeds(system, (25.0, 34.0), method=method, modes=1)
        for method in ("mean_frequency", "meissner", "multipliers")
    )
    even = 2 * np.pi * np.arange(400) / 400
    assert by_mean.speed == pytest.approx([np.mean(np.sqrt(900 + 400 * np.cos(even)))], rel=1e-12)
    # Second order of the modulation moves the multiplier's maximum, not the mean.
    assert len(by_step.speed) and abs(by_step.speed[0] - by_mean.speed[0]) > 0.05
    # Intervals leave out little; the damping, which Meissner's way leaves out, moves it more.
    assert by_step.speed == pytest.approx(by_multiplier.speed, rel=2e-3)


test_bad_input_is_refused = refused(
    lambda system, changes: critical_speeds(system, **{"speed_range": (10.0, 40.0), **changes}),
    [
        (_system(), {"method": "guess"}, "one of"),
        (_system(), {"modes": 3}, "from 1 to 2"),
        (_system(), {"speeds": 2}, "3 or more"),
        (_system(), {"method": "multipliers", "speed_range": (1e-4, 1.0)}, "at most 4000"),
        (_system(0.0), {"method": "response"}, "damped"),
        (_system(shape=False), {"method": "response"}, "deflections that are not known"),
        (_system(0.0, 0.5), {"method": "running_mean", "speed_range": (43.0, 60.0)}, "buckled"),
        (el.load_scene("aannaque_1996_portal_frame").linear_system(), {}, "no crank moves it"),
        *(
            (_system(), {"speed_range": ends}, "0 < low < high")
            for ends in ((0.0, 1.0), (2.0, 1.0), (1.0,), (np.nan, 2.0))
        ),
    ],
)
