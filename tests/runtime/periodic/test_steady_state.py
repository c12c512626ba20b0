"""Steady states: harmonic balance, marching, closed forms, singular speeds, growth, bad input."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput, LinearRangeWarning
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.floquet.first_order import canonical_form
from elastolink.runtime.response import (
    frozen_frequencies,
    resonance_curve,
    steady_peaks,
    steady_state,
)
from elastolink.runtime.response.cyclic import solve_ring
from elastolink.runtime.simulation import simulate

EPS = float(np.finfo(float).eps)


def _system(**changes) -> LinearPeriodic:
    """q'' + c q' + (k + mu cos theta) q = 1/(1.5 - cos theta), theta = speed t."""
    numbers = {"k": 9.3, "mu": 1.4, "c": 0.2, **changes}
    terms = (
        Term("M", None, np.eye(1)),
        Term("K", "k", np.eye(1)),
        Term("Kg", "mu", lambda theta: np.cos(theta)[:, None, None]),
        Term("C", "c", np.eye(1)),
        Term("p", None, lambda theta: (1 / (1.5 - np.cos(theta)))[:, None]),
    )

    def scales(values):
        return {name: np.asarray(values[name], dtype=float) for name in numbers}

    return LinearPeriodic(
        1, terms, numbers, scales, reference_length=2.0, shape=lambda x: 1e-4 * x[:, None]
    )


def _harmonic_balance(speed, k=9.3, mu=1.4, c=0.2, reach=60):
    """Return harmonics and coefficients of the periodic motion, by the infinite matrix cut off."""
    number = np.arange(-reach, reach + 1)
    matrix = np.diag(k - (speed * number) ** 2 + 1j * speed * c * number)
    matrix = matrix + 0.5 * mu * (np.eye(len(number), k=1) + np.eye(len(number), k=-1))
    # 1/(a - cos theta) has the coefficients (a - r)^|n|/r, r = sqrt(a^2 - 1).
    root = np.sqrt(1.25)
    return number, np.linalg.solve(matrix, (1.5 - root) ** np.abs(number) / root)


def test_harmonic_balance_gives_the_same_motion_and_rate():
    speeds = np.array([0.3, 1.0, 2.0, 3.0])
    state = steady_state(_system(), speeds)
    assert state.passed and np.all(state.stable)
    assert state.q.shape == (4, len(state.theta), 1)
    for index, speed in enumerate(speeds):
        number, coefficients = _harmonic_balance(speed)
        waves = np.exp(1j * np.outer(state.theta, number))
        exact = (waves @ coefficients).real
        rate = (waves @ (1j * speed * number * coefficients)).real
        assert np.max(np.abs(state.q[index, :, 0] - exact)) <= 1e-13 * np.max(np.abs(exact))
        assert np.max(np.abs(state.qd[index, :, 0] - rate)) <= 1e-11 * np.max(np.abs(rate))
        found = state.coefficients[index, :30, 0]
        assert np.max(np.abs(found - coefficients[60:90])) <= 1e-14 * np.max(np.abs(exact))


def test_a_long_damped_march_ends_in_it():
    state = steady_state(_system(), 2.0)
    # exp(-0.2/2 2 pi 120/2) of the start is left after 120 turns.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = simulate(_system(), 2.0, 120, samples=len(state.theta))
    last = run.q[-len(state.theta) - 1 : -1, 0]
    assert np.max(np.abs(last - state.q[:, 0])) <= 1e-12 * np.max(np.abs(last))


def test_parameters_broadcast_with_the_speed():
    speeds, drag = np.array([1.0, 2.0]), np.array([[0.1], [0.2], [0.5]])
    state = steady_state(_system(), speeds, c=drag)
    assert state.q.shape[:2] == (3, 2) and state.error.shape == (3, 2, 1)
    alone = steady_state(_system(c=0.5), 2.0)
    step = len(state.theta) // len(alone.theta)
    np.testing.assert_allclose(state.q[2, 1, ::step], alone.q, rtol=0, atol=1e-10)


def test_deflection_and_peak_are_shapes_times_coordinates():
    state = steady_state(_system(), [1.0, 2.0])
    np.testing.assert_allclose(state.deflection(), 2e-4 * state.q[..., 0], rtol=1e-14)
    assert state.deflection([0.0, 0.5]).shape == (2, len(state.theta), 2)
    np.testing.assert_allclose(state.peak(), np.max(np.abs(state.deflection()), axis=-1))
    np.testing.assert_allclose(state.peak([0.5, 1.0])[:, 0], state.peak() / 2, rtol=1e-14)


def test_no_single_motion_at_a_multiplier_of_one_is_told():
    # q'' + k q at speed 3: k = 9 is the third harmonic's resonance.
    state = steady_state(_system(), 3.0, mu=0.0, c=0.0, k=[9.0, 9.5])
    assert np.all(np.isnan(state.q[0])) and np.isinf(state.error[0, 0])
    assert not state.passed and not state.checks["single"].passed
    number, coefficients = _harmonic_balance(3.0, k=9.5, mu=0.0, c=0.0)
    exact = (np.exp(1j * np.outer(state.theta, number)) @ coefficients).real
    assert np.max(np.abs(state.q[1, :, 0] - exact)) <= state.error[1, 0] * np.max(np.abs(exact))


def test_near_a_resonance_the_error_grows_like_the_inverse_distance():
    shifts = np.array([1e-2, 1e-5, 1e-8])
    with pytest.warns(LinearRangeWarning):
        state = steady_state(_system(), 3.0, mu=0.0, c=0.0, k=9.0 + shifts)
    for index, shift in enumerate(shifts):
        number, coefficients = _harmonic_balance(3.0, k=9.0 + shift, mu=0.0, c=0.0)
        exact = (np.exp(1j * np.outer(state.theta, number)) @ coefficients).real
        gap = np.max(np.abs(state.q[index, :, 0] - exact)) / np.max(np.abs(exact))
        assert gap <= state.error[index, 0] + 8 * EPS * 9.0 / shift
        # Not idle: the loss of digits is the distance's.
        assert state.error[index, 0] <= 1e-9 + 1e4 * EPS / shift


@pytest.mark.parametrize("k", [-4.0, -400.0, -1e5])
def test_growth_within_the_period_costs_no_digits(k):
    # exp(2 pi sqrt(1e5)) = 1e863 in a turn: no product of the flow could be formed.
    state = steady_state(_system(), 1.0, mu=0.0, c=0.0, k=k)
    number, coefficients = _harmonic_balance(1.0, k=k, mu=0.0, c=0.0)
    exact = (np.exp(1j * np.outer(state.theta, number)) @ coefficients).real
    assert np.max(np.abs(state.q[:, 0] - exact)) <= 1e-11 * np.max(np.abs(exact))
    assert not state.stable


@pytest.mark.parametrize("c", [30.0, 3e3])
def test_strong_damping_asks_for_no_more_segments(c):
    # An angle turns by 1/c a radian: what has died away within a segment needs no steps.
    form = canonical_form(_system(c=c), 1.0, {}, forcing=True)
    assert form.needed_rate[0] <= max(6.0, 1.001 * form.rate[0] / 40)
    state = steady_state(_system(c=c), [0.3, 1.0, 3.0])
    assert state.passed and np.all(state.stable)
    for index, speed in enumerate(state.speed):
        number, coefficients = _harmonic_balance(speed, c=c)
        exact = (np.exp(1j * np.outer(state.theta, number)) @ coefficients).real
        gap = np.max(np.abs(state.q[index, :, 0] - exact)) / np.max(np.abs(exact))
        assert gap <= state.error[index, 0] <= 1e-9


def test_negative_and_gyroscopic_damping_keeps_its_segments():
    for matrix in (-3e3 * np.eye(2), 3e3 * np.array([[0.0, 1.0], [-1.0, 0.0]])):
        terms = (Term("M", None, np.eye(2)), Term("K", None, np.eye(2)), Term("C", None, matrix))
        form = canonical_form(LinearPeriodic(2, terms, {}, lambda values: {}), 1.0)
        assert form.needed_rate[0] == form.rate[0] > 3e3


def test_peaks_of_many_speeds_are_those_of_the_motions():
    speeds = np.linspace(0.3, 4.0, 80)
    peaks = steady_peaks(_system(), speeds, x=[0.5, 1.0])
    assert peaks.passed and np.all(peaks.place == 1.0)
    state = steady_state(_system(), speeds)
    np.testing.assert_allclose(peaks.peak, state.peak(), rtol=1e-4)
    finer = steady_state(_system(), speeds, samples=2**13).peak()
    assert np.all(np.abs(peaks.peak - finer) <= peaks.error * finer)
    np.testing.assert_allclose(peaks.distance, state.distance, rtol=1e-8)
    np.testing.assert_array_equal(peaks.stable, state.stable)
    assert peaks.plot().get_yscale() == "log"
    assert steady_peaks(_system(), speeds[:2]).place[0] == 1.0
    with pytest.raises(BadInput, match="places"):
        steady_peaks(_system(), speeds, x=1.5)
    with pytest.raises(BadInput, match="fewer speeds"):
        steady_peaks(_system(), np.full(200, 0.01), c=1e4)
    with pytest.raises(BadInput, match="row of speeds"):
        steady_peaks(_system(), [])


def test_peaks_beyond_the_linear_range_are_told_once():
    with pytest.warns(LinearRangeWarning, match="leave out resonant speeds") as told:
        peaks = steady_peaks(_system(), np.full(70, 3.0), mu=0.0, c=0.0, k=9.001)
    assert not peaks.checks["linear range"].passed
    assert len(told) == 1


def test_progress_is_shown_where_it_is_wanted(capsys):
    pytest.importorskip("tqdm")
    steady_state(_system(), [1.0, 2.0], progress=True)
    assert "4/4" in capsys.readouterr().err
    steady_peaks(_system(), [1.0, 2.0, 3.0], progress=True)
    assert "3/3" in capsys.readouterr().err
    steady_state(_system(), 1.0)
    assert not capsys.readouterr().err


def test_a_ring_with_growth_and_decay_is_solved_to_round_off():
    rng = np.random.default_rng(3)
    turns = np.linalg.qr(rng.normal(size=(64, 3, 3)))[0]
    maps = turns @ np.diag([30.0, 1.0, 0.02]) @ np.swapaxes(np.roll(turns, 1, axis=0), -1, -2)
    exact = rng.normal(size=(64, 3))
    loads = np.roll(exact, -1, axis=0) - (maps @ exact[..., None])[..., 0]
    nodes, sensitivity = solve_ring(1.001 * maps[None], (loads - 0.001 * 0)[None])
    again = np.roll(nodes[0], -1, axis=0) - (1.001 * maps @ nodes[0][..., None])[..., 0]
    # The middle direction turns round by 1.001^64: the ring is well away from singular.
    assert np.max(np.abs(again - loads)) <= 1e-12 * np.max(np.abs(loads))
    assert 1.0 < sensitivity[0] < 1e5


def test_the_linear_range_is_watched():
    with pytest.warns(LinearRangeWarning, match="leave out resonant speeds"):
        state = steady_state(_system(), 3.0, mu=0.0, c=0.0, k=9.001)
    assert not state.checks["linear range"].passed


def test_frozen_frequencies_and_their_mean():
    found = frozen_frequencies(_system(), np.array([0.0, np.pi]))
    np.testing.assert_allclose(found.frequency[:, 0], np.sqrt([10.7, 7.9]), rtol=1e-14)
    even = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    np.testing.assert_allclose(found.mean, np.mean(np.sqrt(9.3 + 1.4 * np.cos(even))), rtol=1e-13)
    assert found.passed
    with pytest.raises(BadInput, match="theta"):
        frozen_frequencies(_system(), [])
    with pytest.raises(BadInput, match="no natural frequency"):
        frozen_frequencies(_system(k=1.0))


def test_resonances_are_found_and_labelled():
    # A constant spring: maxima at sqrt(9.3)/n, the damping's shift of second order.
    curve = resonance_curve(_system(mu=0.0, c=0.02), np.linspace(0.9, 4.0, 60))
    assert list(curve.order) == [3, 2, 1] and list(curve.mode) == [1, 1, 1]
    np.testing.assert_allclose(curve.maxima, np.sqrt(9.3) / np.array([3, 2, 1]), rtol=3e-3)
    np.testing.assert_allclose(curve.ratio, 1.0, rtol=3e-3)
    # Harmonic n alone: amplitude 2 f_n/(c sqrt(k)), a little less than the whole peak.
    root = np.sqrt(1.25)
    alone = 2e-4 * 2 * (1.5 - root) ** curve.order / root / (0.02 * np.sqrt(9.3))
    assert np.all(curve.maxima_peak > 0.99 * alone) and np.all(curve.maxima_peak < 1.3 * alone)
    state = steady_state(_system(mu=0.0, c=0.02), curve.maxima)
    np.testing.assert_allclose(state.peak(), curve.maxima_peak, rtol=1e-6)


def test_plots_are_drawn():
    assert steady_state(_system(), 2.0).plot().get_xlabel() == "crank angle [deg]"
    curve = resonance_curve(_system(), np.linspace(1.0, 4.0, 30))
    assert curve.plot().get_yscale() == "log"
    assert frozen_frequencies(_system()).plot().get_ylabel()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"method": "harmonics"}, "one of"),
        ({"method": "shoting"}, "one of"),
        ({"rtol": 0.0}, "rtol"),
        ({"samples": 0}, "samples"),
        ({"samples": "x"}, "samples"),
        ({"samples": np.nan}, "samples"),
        ({"rtol": "x"}, "rtol"),
        ({"speed": []}, "no speed at all"),
        ({"speed": "x"}, "speed"),
        ({"speed": np.ones(100), "samples": 2**20}, "steady_peaks"),
        ({"speed": np.full(200, 0.01), "c": 1e4}, "fewer speeds"),
        ({"speed": -1.0}, "positive"),
        ({"speed": 1e-7}, "raise the speed"),
        ({"stiffness": 2.0}, "parameters"),
    ],
)
def test_bad_input_is_refused_in_one_line(options, message):
    with pytest.raises(BadInput, match=message) as caught:
        steady_state(_system(), options.pop("speed", 1.0), **options)
    assert "\n" not in str(caught.value).strip()


def test_without_forcing_or_shapes_it_is_refused():
    still = [
        Term("p", None, lambda theta: np.zeros((len(theta), 1))) if term.array == "p" else term
        for term in _system().terms
    ]
    with pytest.raises(BadInput, match="forcing that is zero"):
        steady_state(LinearPeriodic(1, still, _system().parameters, _system().scales), 1.0)
    free = _system().without("p")
    with pytest.raises(BadInput, match="without forcing"):
        steady_state(free, 1.0)
    bare = LinearPeriodic(1, _system().terms, _system().parameters, _system().scales)
    with pytest.raises(BadInput, match="without mode shapes"):
        steady_state(bare, 1.0).deflection()
    with pytest.raises(BadInput, match="places"):
        steady_state(_system(), 1.0).deflection(1.5)
    with pytest.raises(BadInput, match="speed: found 'x'"):
        resonance_curve(_system(), "x")
    with pytest.raises(BadInput, match="one place"):
        resonance_curve(_system(), [1.0, 1.5, 2.0], x=2.0)
    with pytest.raises(BadInput, match="rising"):
        resonance_curve(_system(), [1.0, 0.5, 2.0])
