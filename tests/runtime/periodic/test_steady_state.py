"""Steady states: harmonic balance, marching, closed forms, singular speeds, growth, bad input."""

from dataclasses import replace

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput, LinearRangeWarning
from elastolink.runtime.periodic import simulate, steady_state
from elastolink.runtime.periodic.equation import equation_of
from elastolink.runtime.periodic.ring import solve_ring
from elastolink.runtime.periodic.transition import levels_for, method
from elastolink.runtime.scenes import load_scene
from periodic_systems import forced_mathieu, peak_gap, system_of

METHODS = ("auto", "harmonic_balance")


def gap_and_size(state, index=..., speed=1.0, **changes):
    """Return how far a motion is from harmonic balance by the infinite matrix cut off; its peak."""
    number, coefficients = _harmonic_balance(speed, **changes)
    exact = (np.exp(1j * np.outer(state.theta, number)) @ coefficients).real
    return np.max(np.abs(state.q[index][:, 0] - exact)), np.max(np.abs(exact))


def _harmonic_balance(speed, k=9.3, mu=1.4, c=0.2, reach=60):
    """Return harmonics and coefficients of the periodic motion."""
    number = np.arange(-reach, reach + 1)
    matrix = np.diag(k - (speed * number) ** 2 + 1j * speed * c * number)
    matrix = matrix + 0.5 * mu * (np.eye(len(number), k=1) + np.eye(len(number), k=-1))
    # 1/(a - cos theta) has the coefficients (a - r)^|n|/r, r = sqrt(a^2 - 1).
    root = np.sqrt(1.25)
    return number, np.linalg.solve(matrix, (1.5 - root) ** np.abs(number) / root)


def test_harmonic_balance_gives_the_same_motion_and_coefficients():
    speeds = np.array([0.3, 1.0, 2.0, 3.0])
    state = steady_state(forced_mathieu(), speeds, rtol=1e-12)
    assert state.passed and np.all(state.stable)
    assert state.q.shape == (4, len(state.theta), 1)
    for index, speed in enumerate(speeds):
        gap, size = gap_and_size(state, index, speed)
        assert gap <= 1e-12 * size
        coefficients = _harmonic_balance(speed)[1][60:90]
        off = np.abs(state.coefficients[index, :30, 0] - coefficients)
        assert np.max(off) <= np.max(state.error[index]) * size


@pytest.mark.parametrize("method", METHODS)
def test_parameters_broadcast_with_the_speed(method):
    speeds, drag = np.array([1.0, 2.0]), np.array([[0.1], [0.2], [0.5]])
    state = steady_state(forced_mathieu(), speeds, method=method, c=drag)
    assert state.q.shape[:2] == (3, 2) and state.error.shape == (3, 2, 1)
    alone = steady_state(forced_mathieu(c=0.5), 2.0, method=method)
    step = len(state.theta) // len(alone.theta)
    np.testing.assert_allclose(state.q[2, 1, ::step], alone.q, rtol=0, atol=1e-10)


def test_deflection_and_peak_are_shapes_times_coordinates():
    state = steady_state(forced_mathieu(), [1.0, 2.0])
    np.testing.assert_allclose(state.deflection(), 2e-4 * state.q[..., 0], rtol=1e-14)
    assert state.deflection([0.0, 0.5]).shape == (2, len(state.theta), 2)
    finer = steady_state(forced_mathieu(), [1.0, 2.0], samples=2**14)
    highest = np.max(np.abs(finer.deflection()), axis=-1)
    np.testing.assert_allclose(state.peak(), highest, rtol=1e-6)
    assert np.all(state.peak() >= np.max(np.abs(state.deflection()), axis=-1))
    np.testing.assert_allclose(state.peak([0.5, 1.0])[:, 0], state.peak() / 2, rtol=1e-14)


@pytest.mark.parametrize("method", METHODS)
def test_no_single_motion_at_a_multiplier_of_one_is_told(method):
    # q'' + k q at speed 3: k = 9 is the third harmonic's resonance.
    state = steady_state(forced_mathieu(), 3.0, method=method, mu=0.0, c=0.0, k=[9.0, 9.5])
    assert np.all(np.isnan(state.q[0])) and np.isinf(state.error[0, 0])
    assert not state.passed and not state.checks["single"].passed
    gap, size = gap_and_size(state, 1, 3.0, k=9.5, mu=0.0, c=0.0)
    assert gap <= state.error[1, 0] * size


@pytest.mark.parametrize("k", [-4.0, -400.0, -1e5])
def test_growth_within_the_period_costs_no_digits(k):
    # exp(2 pi sqrt(1e5)) = 1e863 in a turn: no product of the flow could be formed.
    state = steady_state(forced_mathieu(), 1.0, mu=0.0, c=0.0, k=k, rtol=1e-12)
    gap, size = gap_and_size(state, k=k, mu=0.0, c=0.0)
    assert gap <= 1e-11 * size
    assert not state.stable


@pytest.mark.parametrize("c", [30.0, 3e3])
def test_strong_damping_asks_for_no_more_segments(c):
    # What dies away within a segment follows its load: no more of them than without damping.
    equation = equation_of(forced_mathieu(c=c), 0.3, forcing=True).with_slow_modes(12.0)
    assert levels_for(equation, method("radau", 7), 1e-6)[0][0] <= 6
    state = steady_state(forced_mathieu(c=c), [0.3, 1.0, 3.0])
    assert state.passed and np.all(state.stable)
    for index, speed in enumerate(state.speed):
        gap, size = gap_and_size(state, index, speed, c=c)
        assert gap / size <= state.error[index, 0] <= 1e-6


def test_progress_is_shown_where_it_is_wanted(capsys):
    pytest.importorskip("tqdm")
    steady_state(forced_mathieu(), [1.0, 2.0], progress=True)
    assert "2/2" in capsys.readouterr().err
    steady_state(forced_mathieu(), 1.0)
    assert not capsys.readouterr().err


def test_the_linear_range_is_watched():
    with pytest.warns(LinearRangeWarning, match="leave out resonant speeds"):
        state = steady_state(forced_mathieu(), 3.0, mu=0.0, c=0.0, k=9.001)
    assert not state.checks["linear range"].passed


def test_beyond_the_linear_range_the_nonlinear_equation_is_named_where_there_is_one():
    changes = {"coupler.damping_ratio": 0.03}
    rig = load_scene("smith_1972_101104_thirtysecond_inch", overrides=changes)
    with pytest.warns(LinearRangeWarning, match=r"'inextensible' .* docs/nonlinear\.md"):
        steady_state(rig.system(), 385.0 * np.pi / 30.0)
    with pytest.warns(LinearRangeWarning) as caught:
        steady_state(forced_mathieu(), 3.0, mu=0.0, c=0.0, k=9.001)
    assert "nonlinear" not in str(caught[0].message)


def test_plots_are_drawn():
    assert steady_state(forced_mathieu(), 2.0).plot().get_xlabel() == "crank angle [deg]"
    assert steady_state(forced_mathieu(), [1.0, 2.0]).plot().get_yscale() == "log"


def test_deflections_without_shapes_or_off_the_beam_are_refused():
    with pytest.raises(BadInput, match="without mode shapes"):
        steady_state(replace(forced_mathieu(), shape=None), 1.0).deflection()
    with pytest.raises(BadInput, match="places"):
        steady_state(forced_mathieu(), 1.0).deflection(1.5)


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

    return system_of(
        M=np.diag([1.0, 1.2, 0.5]),
        K=turned(frequencies**2),
        C=turned(2 * damping * frequencies),
        f=push,
    )


@pytest.mark.parametrize("fast", [160.0, 1600.0])
def test_both_methods_agree_however_stiff(fast):
    """Collocation over segments and the Fourier series of the motion share the equation alone."""
    states = [steady_state(stiff(fast=fast), 1.1, method=m, rtol=1e-9) for m in METHODS]
    assert np.all(peak_gap(*states) <= states[0].error + states[1].error)
    # The stiff coordinates' peaks are small beside the soft one's round-off.
    assert max(np.max(state.error) for state in states) <= (1e-9 if fast < 200 else 1e-6)
    rates = [np.max(np.abs(state.qd), axis=0) for state in states]
    np.testing.assert_allclose(*rates, rtol=1e-5)
    assert all(state.stable for state in states)


@pytest.mark.parametrize("method", METHODS)
def test_an_unstable_motion_is_given_and_flagged(method):
    # Mathieu's equation within its first unstable region.
    unstable = forced_mathieu(k=0.25, mu=0.1, c=0.0)
    state = steady_state(unstable, 1.0, method=method)
    assert not state.stable and np.max(np.abs(state.multipliers)) > 1.3
    # At omega = w/2 the growth exponent is eps/4 of eps cos, per w: exp(2 pi 0.1/ (4 * 0.5)).
    assert np.max(np.abs(state.multipliers)) == pytest.approx(np.exp(0.1 * np.pi), rel=0.02)
    # Started on it, a march leaves it by the multiplier.
    run = simulate(unstable, 1.0, 12, initial=(state.q[0], state.qd[0] + 1e-9), samples=64)
    left = np.abs(run.q[::64, 0] - state.q[0, 0])
    assert left[-1] > 1e-9 and left[-1] / left[-5] == pytest.approx(
        np.max(np.abs(state.multipliers)) ** 4, rel=0.2
    )


def test_a_ring_of_any_length_is_solved():
    random = np.random.default_rng(4)
    for count in (1, 2, 3, 5, 7, 12, 90):
        maps, loads = random.normal(size=(2, count, 3, 3)), random.normal(size=(2, count, 3))
        nodes, _ = solve_ring(maps, loads)
        ahead = np.roll(nodes, -1, axis=1)
        rest = ahead - np.einsum("bkij,bkj->bki", maps, nodes) - loads
        assert np.max(np.abs(rest)) <= 1e-11 * np.max(np.abs(nodes))


def test_deflections_are_those_of_the_middle_where_the_end_is_held():
    pinned = steady_state(load_scene("smith_1972_5152_sixteenth_inch").system(), 30.0)
    assert pinned.place == 0.5
    assert pinned.peak() == pinned.peak(0.5) > 1e-4
    assert np.all(pinned.deflection() == pinned.deflection(0.5))
    free = steady_state(forced_mathieu(), 1.3)
    assert free.place == 1.0 and free.peak() == free.peak(1.0)
