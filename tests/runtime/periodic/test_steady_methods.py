"""All methods of the steady state: that they agree, and what each says where it cannot answer."""

import warnings

import numpy as np
import pytest
from elastolink import load_scene
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.response import (
    cycles_to_settle,
    resonance_curve,
    steady_peaks,
    steady_state,
)
from elastolink.runtime.response.cyclic import solve_ring
from elastolink.runtime.response.request import resampled
from elastolink.runtime.simulation import simulate
from periodic_systems import peak_gap

STEPPED = ("transition_matrix", "time_marching")


def stiff(damping=0.02, fast=1600.0):
    """Return three freedoms on axes that turn: a soft one, and two a thousand times as stiff.

    In fixed axes the stiffness turns with the crank, as that of the links of a mechanism does.
    """
    frequencies = np.array([4.3, 0.6 * fast, fast])

    def turned(values):
        def function(theta):
            angle = 0.7 * np.sin(theta) + 0.3 * np.cos(2 * theta)
            c, s, one = np.cos(angle), np.sin(angle), np.ones_like(angle)
            zero = np.zeros_like(angle)
            axes = np.array([[c, -s, zero], [s, c, zero], [zero, zero, one]]).transpose(2, 0, 1)
            return axes @ np.diag(values) @ axes.transpose(0, 2, 1)

        return function

    def push(theta):
        wave = np.exp(np.cos(theta))
        return np.stack([wave, np.sin(theta) * wave, np.cos(3 * theta)], axis=1)

    terms = (
        Term("M", None, np.diag([1.0, 1.2, 0.5])),
        Term("K", None, turned(frequencies**2)),
        Term("C", "damping_ratio", turned(2 * frequencies)),
        Term("f", None, push),
    )
    return LinearPeriodic(
        3,
        terms,
        {"damping_ratio": damping},
        lambda values: {"damping_ratio": np.asarray(values["damping_ratio"], dtype=float)},
        limits={"damping_ratio": "non-negative"},
    )


@pytest.fixture(scope="module")
def truth():
    """Return the motion of the stiff system by shooting, which resolves every mode."""
    return steady_state(stiff(fast=160.0), 1.1)


@pytest.mark.parametrize("method", ["harmonic_balance", "cyclic"])
def test_spectral_methods_agree_with_shooting(truth, method):
    state = steady_state(stiff(fast=160.0), 1.1, method=method)
    assert state.passed, state.checks
    assert np.all(peak_gap(state, truth) <= state.error + truth.error)
    assert np.max(state.error) <= 1e-9
    np.testing.assert_allclose(state.multipliers, truth.multipliers)
    rate = np.max(np.abs(resampled(state.qd, len(truth.theta)) - truth.qd), axis=0)
    assert np.all(rate <= 1e-7 * np.max(np.abs(truth.qd), axis=0))


@pytest.mark.parametrize(
    ("method", "options"),
    [
        ("closed_form", {}),
        *((method, {}) for method in STEPPED),
        *((method, {"scheme": "generalized_alpha"}) for method in STEPPED),
        ("cyclic", {"scheme": "newmark"}),
        ("cyclic", {"scheme": "generalized_alpha", "rho_inf": 0.5}),
        ("cyclic", {"scheme": "gauss_legendre"}),
    ],
)
def test_stepped_methods_agree_to_their_stated_errors(truth, method, options):
    state = steady_state(
        stiff(fast=160.0),
        1.1,
        method=method,
        rtol=1e-2,
        options=options,
        stability=False,
    )
    assert np.all(peak_gap(state, truth) <= state.error + truth.error)
    assert np.max(state.error) <= 1e-2
    assert state.checks["converged"].passed


def test_what_is_stiff_costs_the_spectral_methods_nothing():
    # A hundred times as stiff: the motion hardly changes, and shooting would need 30000 segments.
    states = [
        steady_state(stiff(), 1.1, method=method, stability=False)
        for method in ("harmonic_balance", "cyclic")
    ]
    assert np.all(peak_gap(*states) <= states[0].error + states[1].error)
    # The stiff coordinates' peaks are small beside the soft one's round-off.
    assert np.max(states[0].error) <= 1e-6
    assert states[0].multipliers is None and states[0].stable is None
    assert states[0].checks["stability not computed"].passed
    left_open = steady_state(stiff(fast=4e4), 1.1, method="harmonic_balance", rtol=1e-6)
    assert left_open.stable is None
    assert not left_open.checks["stability not computed"].passed


def test_many_speeds_share_one_call_and_parameters_broadcast():
    speeds = np.array([0.7, 1.1, 2.3])
    for method in ("harmonic_balance", "cyclic"):
        state = steady_state(
            stiff(fast=160.0),
            speeds,
            method=method,
            damping_ratio=np.array([[0.02], [0.05]]),
            stability=False,
        )
        assert state.q.shape[:2] == (2, 3) and state.error.shape == (2, 3, 3)
        alone = steady_state(stiff(0.05, 160.0), 2.3, method=method, stability=False)
        count = len(state.theta)
        difference = np.max(np.abs(state.q[1, 2] - resampled(alone.q, count)), axis=0)
        allowed = state.error[1, 2] + alone.error
        assert np.all(difference <= allowed * np.max(np.abs(alone.q), axis=0))


def test_the_printed_algorithm_loses_its_digits_with_the_intervals_and_says_so():
    found = {
        count: steady_state(
            stiff(0.1, 160.0),
            1.1,
            method="closed_form",
            options={"intervals": count},
            stability=False,
        )
        for count in (90, 720, 5760)
    }
    rounding = {count: state.checks["round-off"].value for count, state in found.items()}
    assert rounding[90] < 1e-6 and rounding[90] < rounding[720] < rounding[5760]
    assert not found[5760].checks["round-off"].passed
    assert np.all(np.isnan(found[5760].q)) and np.all(np.isinf(found[5760].error))
    # The same system of equations, closed by orthogonal elimination, loses nothing.
    options = {"intervals": 5760, "scheme": "newmark"}
    stable = steady_state(stiff(0.1, 160.0), 1.1, method="cyclic", options=options, stability=False)
    assert stable.checks["round-off"].value < 1e-9 and np.max(stable.error) < 1e-2


def test_the_modal_method_states_its_difference():
    whole = steady_state(stiff(fast=160.0), 1.1, method="cyclic", stability=False)
    for options in ({}, {"intervals": 90}, {"modes": 1}):
        state = steady_state(
            stiff(fast=160.0), 1.1, method="modal", options=options, stability=False
        )
        count = len(state.theta)
        exact = resampled(whole.q, 16 * count)[::16]
        actual = np.max(np.abs(state.q - exact), axis=0) / np.max(np.abs(exact), axis=0)
        assert np.all(actual <= state.error + whole.error)
        assert np.all(state.error <= 1.05 * actual + 1e-4)


def test_the_modal_method_is_exact_where_nothing_turns():
    # One freedom of constant coefficients: the intervals hold the force alone.
    terms = (
        Term("M", None, np.eye(1)),
        Term("K", None, 9.3 * np.eye(1)),
        Term("C", None, 0.2 * np.eye(1)),
        Term("p", None, lambda theta: np.cos(theta)[:, None]),
    )
    system = LinearPeriodic(1, terms, {}, lambda values: {})
    errors = [
        float(steady_state(system, 1.0, method="modal", options={"intervals": n}).error[0])
        for n in (64, 256)
    ]
    # The force is held at its middle: second order.
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.1)


def test_marching_counts_its_cycles():
    state = steady_state(
        stiff(fast=160.0), 1.1, method="time_marching", options={"intervals": 2048}
    )
    slowest = state.multipliers[np.argmax(np.abs(state.multipliers))]
    # The fast modes and the shape of the start make it one or two more or less.
    assert abs(int(state.cycles) - int(cycles_to_settle(slowest, 1e-4))) <= 3
    tighter = steady_state(
        stiff(fast=160.0),
        1.1,
        method="time_marching",
        options={"intervals": 2048, "tolerance": 1e-8},
        stability=False,
    )
    gained = np.log(1e-4) / np.log(np.abs(slowest))
    assert int(tighter.cycles) - int(state.cycles) == pytest.approx(gained, abs=2.0)
    start = (state.q[0], state.qd[0])
    again = steady_state(
        stiff(fast=160.0),
        1.1,
        method="time_marching",
        options={"intervals": 2048, "initial": start},
        stability=False,
    )
    assert int(again.cycles) == 2


def test_cycles_to_settle_by_hand():
    # 0.5^k: 1e-3 takes ten periods after the first.
    assert cycles_to_settle(0.5, 1e-3, norm="remaining") == 11
    assert cycles_to_settle([0.5, 1.0, 2.0, 0.0], 1e-3).tolist() == [11, -1, -1, 2]
    state = 0.0
    history = []
    for _ in range(40):
        state = -0.8 * state + 1.8
        history.append(state)
    changes = np.abs(np.diff([0.0, *history]))
    # The first period starts from 0, the k-th from history[k - 2].
    assert cycles_to_settle(-0.8, 1e-3) == 2 + int(np.argmax(changes <= 1e-3))
    with pytest.raises(BadInput, match="tolerance"):
        cycles_to_settle(0.5, 2.0)
    with pytest.raises(BadInput, match="norm"):
        cycles_to_settle(0.5, 1e-3, norm="energy")


def unstable():
    """Return Mathieu's equation within its first unstable region, forced."""
    terms = (
        Term("M", None, np.eye(1)),
        Term("K", None, 0.25 * np.eye(1)),
        Term("Kg", None, lambda theta: 0.1 * np.cos(theta)[:, None, None]),
        Term("p", None, lambda theta: (1.0 + np.cos(theta))[:, None]),
    )
    return LinearPeriodic(1, terms, {}, lambda values: {})


@pytest.mark.parametrize("method", ["shooting", "harmonic_balance", "cyclic", "transition_matrix"])
def test_an_unstable_motion_is_given_and_flagged(method):
    state = steady_state(unstable(), 1.0, method=method)
    assert not state.stable and np.max(np.abs(state.multipliers)) > 1.3
    # At omega = w/2 the growth exponent is eps/4 of eps cos, per w: exp(2 pi 0.1/ (4 * 0.5)).
    assert np.max(np.abs(state.multipliers)) == pytest.approx(np.exp(0.1 * np.pi), rel=0.02)
    # Started on it, a march leaves it by the multiplier.
    run = simulate(unstable(), 1.0, 12, initial=(state.q[0], state.qd[0] + 1e-9), samples=64)
    left = np.abs(run.q[::64, 0] - state.q[0, 0])
    assert left[-1] > 1e-9 and left[-1] / left[-5] == pytest.approx(
        np.max(np.abs(state.multipliers)) ** 4, rel=0.2
    )


def test_marching_an_unstable_system_ends_with_its_growth():
    state = steady_state(unstable(), 1.0, method="time_marching", rtol=1e-2)
    assert int(state.cycles) == -1 and np.all(np.isnan(state.q))
    assert not state.checks["growth"].passed
    assert state.checks["growth"].value == pytest.approx(
        np.max(np.abs(state.multipliers)), rel=0.01
    )


def resonant():
    """Return q'' + 4 q = cos t at speed 1: two multipliers are 1."""
    terms = (
        Term("M", None, np.eye(1)),
        Term("K", None, 4.0 * np.eye(1)),
        Term("p", None, lambda theta: np.cos(theta)[:, None]),
    )
    return LinearPeriodic(1, terms, {}, lambda values: {})


@pytest.mark.parametrize("method", ["shooting", "harmonic_balance", "cyclic", "modal"])
def test_a_multiplier_of_one_is_no_single_motion(method):
    state = steady_state(resonant(), 1.0, method=method)
    assert np.all(np.isnan(state.q)) and np.all(np.isinf(state.error))
    assert not state.checks["single"].passed


def test_a_ring_of_any_length_is_solved():
    random = np.random.default_rng(4)
    for count in (1, 2, 3, 5, 7, 12, 90):
        maps, loads = random.normal(size=(2, count, 3, 3)), random.normal(size=(2, count, 3))
        nodes, _ = solve_ring(maps, loads)
        ahead = np.roll(nodes, -1, axis=1)
        rest = ahead - np.einsum("bkij,bkj->bki", maps, nodes) - loads
        assert np.max(np.abs(rest)) <= 1e-11 * np.max(np.abs(nodes))


@pytest.mark.parametrize(
    ("method", "options", "message"),
    [
        ("cyclic", {"scheme": "euler"}, "scheme"),
        ("cyclic", {"intervals": 1}, "intervals"),
        ("cyclic", {"intervals": 12.5}, "whole number"),
        ("transition_matrix", {"gamma": 3.0}, "gamma"),
        ("transition_matrix", {"rho_inf": 0.5}, "none with newmark"),
        ("transition_matrix", {"scheme": "generalized_alpha", "rho_inf": -1.0}, "rho_inf"),
        ("time_marching", {"tolerance": 0.0}, "tolerance"),
        ("time_marching", {"most_cycles": 0}, "most_cycles"),
        ("time_marching", {"initial": 1.0}, "a pair"),
        ("time_marching", {"initial": (np.zeros(2), np.zeros(3))}, "3 finite numbers"),
        ("modal", {"modes": 4}, "modes"),
        ("harmonic_balance", {"harmonics": 0}, "harmonics"),
        ("harmonic_balance", {"intervals": 90}, "options of harmonic_balance"),
        ("shooting", {"intervals": 90}, "none"),
    ],
)
def test_bad_options_are_refused_in_one_line(method, options, message):
    with pytest.raises(BadInput, match=message) as caught:
        steady_state(stiff(), 1.1, method=method, options=options)
    assert "\n" not in str(caught.value).strip()


def test_negative_damping_is_refused_where_it_is_a_parameter():
    with pytest.raises(BadInput, match="damping_ratio"):
        steady_state(stiff(), 1.1, method="harmonic_balance", damping_ratio=-0.1)


def test_a_fixed_number_of_harmonics_tells_what_it_leaves_out(truth):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        state = steady_state(
            stiff(fast=160.0),
            1.1,
            method="harmonic_balance",
            options={"harmonics": 6},
            stability=False,
        )
    assert not state.checks["converged"].passed
    assert np.all(peak_gap(state, truth) <= state.error + truth.error)


def beams():
    """Return the four-bar of Aannaque's Table 4.1, one element a link."""
    return load_scene("aannaque_1996_table_4_1", overrides={"mesh.elements": 1}).system()


@pytest.mark.slow
@pytest.mark.parametrize("speed", [9.5, 11.0])
def test_harmonic_balance_is_honest_below_resonances_of_harmonics_ahead(speed):
    # Between 36 and 56 harmonics lie those that meet the second and third mode.
    exact = steady_state(beams(), speed, rtol=1e-10, stability=False)
    assert exact.method.startswith("cyclic") and np.max(exact.error) < 1e-9
    for harmonics in (8, 23, 36):
        options = {"harmonics": harmonics}
        found = steady_state(
            beams(), speed, method="harmonic_balance", options=options, stability=False
        )
        assert np.all(peak_gap(found, exact) <= found.error + exact.error)


def test_beams_have_no_deflection_over_one_link_and_say_so_at_once():
    for curve in (steady_peaks, resonance_curve):
        with pytest.raises(BadInput, match="without mode shapes"):
            curve(beams(), [61.0, 62.0, 63.0])
