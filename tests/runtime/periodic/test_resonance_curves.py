"""Peaks over many speeds, and resonances."""

from dataclasses import replace

import numpy as np
import pytest
from elastolink import resonance_curve, steady_state
from elastolink.runtime.core.errors import BadInput
from periodic_systems import forced_mathieu


def test_peaks_of_many_speeds_are_those_of_the_motions():
    speeds = np.linspace(0.3, 4.0, 80)
    curve = resonance_curve(forced_mathieu(), speeds)
    assert curve.passed and curve.x == 1.0
    finer = steady_state(forced_mathieu(), speeds, samples=2**13).peak()
    assert np.all(np.abs(curve.peak - finer) <= curve.error * finer)
    assert np.all(curve.error < 1e-3)


def test_strong_damping_and_a_slow_crank_cost_nothing():
    peak = steady_state(forced_mathieu(mu=0.0), np.full(200, 0.01), c=1e4).peak()
    # Harmonic k of the load, 2 (1.5 - r)^k / r with r = sqrt(5/4), over 9.3 + 100 i k.
    theta, root = np.linspace(0, 2 * np.pi, 4000), np.sqrt(1.25)
    q = 1 / root / 9.3 + sum(
        2
        * (1.5 - root) ** k
        / root
        * np.real(np.exp(1j * k * theta) / (9.3 - 1e-4 * k**2 + 100j * k))
        for k in range(1, 40)
    )
    np.testing.assert_allclose(peak, 2e-4 * np.max(np.abs(q)), rtol=1e-5)


def test_resonances_are_found_and_labelled():
    # A constant spring: maxima at sqrt(9.3)/n, the damping's shift of second order.
    curve = resonance_curve(forced_mathieu(mu=0.0, c=0.02), np.linspace(0.9, 4.0, 60))
    assert list(curve.order) == [3, 2, 1] and list(curve.mode) == [1, 1, 1]
    np.testing.assert_allclose(curve.maxima, np.sqrt(9.3) / np.array([3, 2, 1]), rtol=3e-3)
    np.testing.assert_allclose(curve.ratio, 1.0, rtol=3e-3)
    # Harmonic n alone: amplitude 2 f_n/(c sqrt(k)), a little less than the whole peak.
    root = np.sqrt(1.25)
    alone = 2e-4 * 2 * (1.5 - root) ** curve.order / root / (0.02 * np.sqrt(9.3))
    assert np.all(curve.maxima_peak > 0.99 * alone) and np.all(curve.maxima_peak < 1.3 * alone)
    state = steady_state(forced_mathieu(mu=0.0, c=0.02), curve.maxima)
    np.testing.assert_allclose(state.peak(), curve.maxima_peak, rtol=1e-6)


def test_curves_are_drawn_and_bad_input_is_refused():
    curve = resonance_curve(forced_mathieu(), np.linspace(1.0, 4.0, 30))
    assert curve.plot().get_yscale() == "log"
    for arguments, word in ((("x",), "speed: found 'x'"), (([1.0, 0.5, 2.0],), "rising")):
        with pytest.raises(BadInput, match=word):
            resonance_curve(forced_mathieu(), *arguments)
    with pytest.raises(BadInput, match="one place"):
        resonance_curve(forced_mathieu(), [1.0, 1.5, 2.0], x=2.0)
    with pytest.raises(BadInput, match="mode shapes"):
        resonance_curve(replace(forced_mathieu(), shape=None), [1.0, 1.5, 2.0])
