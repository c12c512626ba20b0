"""Slow run-ups and coast-downs: jumps at folds, their delay, what disturbances do, basins."""

from __future__ import annotations

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import Drive
from elastolink.runtime.nonlinear import basins, coexisting_motions
from elastolink.runtime.nonlinear.march import Marcher, end
from elastolink.runtime.nonlinear.segments import Problem, Ramp
from elastolink.runtime.nonlinear.swept import _growth
from planted import duffing
from scipy.integrate import solve_ivp

# Folds of the softening equation below, by response_curve; see also test_response.
SOFT = {"damping": 0.05, "cubic": -0.05, "force": 0.12}


def test_a_revolution_with_a_rising_speed_against_dop853():
    system, rise = duffing(), 0.01

    def rates(t, y):
        angle = 1.1 * t + 0.5 * rise * t * t
        drive = Drive(np.array([angle]), np.array([1.1 + rise * t]), np.array([rise]))
        q, qd = y[None, :1], y[None, 1:]
        left = system.equations(q, qd, 0.0 * q, drive, system.parameters)
        return [y[1], -left.residual[0, 0] / left.mass[0, 0, 0]]

    # The angle is 2 pi at this time; rates by the angle are those by time over the speed.
    time = (np.sqrt(1.1**2 + 4.0 * np.pi * rise) - 1.1) / rise
    start = np.array([0.3, -0.2])
    marched = end(
        Marcher(Problem(system, "speed", 0.0), 1e-11).revolution(
            1.1, start[None] / [1.0, 1.1], ramp=Ramp(rise)
        )
    )[0]
    exact = solve_ivp(rates, (0.0, time), start, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    assert marched * [1.0, 1.1 + rise * time] == pytest.approx(exact, abs=1e-9)


@pytest.fixture(scope="module")
def folds():
    curve = el.response_curve(duffing(**SOFT), "speed", (0.6, 1.2))
    assert curve.special == ("fold", "fold")
    return np.sort(curve.special_value)


def delays(rates, folds):
    """Return how far past the folds the jumps come, up and down, ``(rates, 2)``."""
    rows = []
    for rate in rates:
        found = el.sweep_response(duffing(**SOFT), (0.7, 1.1), rate)
        assert found.jump_rising.tolist() == [True, False]
        assert found.jump_ratio[0] > 1.2 > 0.8 > found.jump_ratio[1]
        rows.append([found.jump_speed[0] - folds[1], folds[0] - found.jump_speed[1]])
    return np.array(rows)


def test_jumps_come_after_the_folds(folds):
    late = delays((1e-4,), folds)[0]
    assert np.all(late > 0.0)
    assert np.all(late < 0.03 * folds)


@pytest.mark.slow
def test_the_delay_of_jumps_goes_with_two_thirds_of_the_rate(folds):
    rates = np.array([8e-5, 2e-5, 1e-5])
    late = delays(rates, folds)
    assert np.all(late[-1] < 0.01 * folds)
    slopes = np.diff(np.log(late), axis=0) / np.diff(np.log(rates))[:, None]
    # The law of a fold that is passed slowly; what is left falls with the rate.
    assert np.all(np.abs(slopes[-1] - 2.0 / 3.0) < 0.1)


@pytest.mark.parametrize(("rate", "damping", "kicks"), [(4e-4, 0.05, 1e-6), (3e-3, 0.05, 1e-3)])
@pytest.mark.parametrize(("cubic", "force"), [(0.0, 0.12), (-0.05, 0.05)])
def test_resonances_without_folds_have_no_jumps(rate, damping, kicks, cubic, force):
    """However steep or disturbed they are."""
    system = duffing(damping=damping, cubic=cubic, force=force)
    assert el.response_curve(system, "speed", (0.7, 1.3)).special == ()
    found = el.sweep_response(system, (0.7, 1.3), rate, kicks=kicks)
    assert np.max(np.abs(np.diff(np.log(found.peak_to_peak)))) > 0.02
    assert found.jump_speed.size == 0


def test_a_resonance_that_nothing_damps_has_no_jumps():
    """All its multipliers stay on the unit circle, but for rounding."""
    system = duffing(damping=0.0, cubic=0.0, force=0.12)
    found = el.sweep_response(system, (0.7, 1.3), 4e-4, kicks=0.0)
    assert found.peak_to_peak.max() > 5.0 * found.peak_to_peak[0]
    assert found.jump_speed.size == 0


def test_growth_over_any_number_of_revolutions():
    """A turn by an angle and a growth by ten, a thousand times: the logarithm is a sum."""
    turn = 10.0 * np.array([[0.6, -0.8], [0.8, 0.6]])
    assert _growth(np.array([turn] * 1000)) == pytest.approx(1000.0 * np.log(10.0), rel=1e-13)
    both = _growth([np.stack([turn, np.eye(2)])] * 500)
    assert both == pytest.approx([500.0 * np.log(10.0), 0.0], rel=1e-13)


@pytest.mark.slow
def test_a_rig_jumps_to_both_larger_motions_and_back():
    """At its fold and at its doubling as the speed rises, at the folds of both as it falls."""
    changes = {"model.formulation": "inextensible", "coupler.damping_ratio": 0.0318}
    rig = el.load_scene("smith_1972_101104_thirtysecond_inch", changes).system()
    bounds = (340.0 * np.pi / 30.0, 500.0 * np.pi / 30.0)
    curve = el.response_curve(rig, "speed", bounds, turns=2)
    folds, doublings = (
        np.sort(curve.special_value[[kind == name for kind in curve.special]])
        for name in ("fold", "doubling")
    )
    found = el.sweep_response(rig, bounds, np.pi / 30.0, kicks=1e-3)
    up, down = found.jump_speed[found.jump_rising], found.jump_speed[~found.jump_rising]
    late = up[:2] - [folds[1], doublings[0]]
    assert np.all((late > 0.0) & (late < 0.02 * up[:2]))
    assert np.all(found.jump_ratio[found.jump_rising][:2] > 1.3)
    # Coming down the motion of two revolutions goes at its fold, that of one at the other fold.
    late = folds[[2, 0]] - down[-2:]
    assert np.all((late > 0.0) & (late < 0.02 * down[-2:]))
    assert np.all(found.jump_ratio[~found.jump_rising][-2:] < 0.6)


def test_only_a_disturbed_motion_leaves_rest():
    # Where the linear equation says unstable the motion at rest is one all the same.
    system = duffing(0.05, 0.2, 0.0, pumped=0.3)
    quiet, kicked = (
        el.sweep_response(system, (1.9, 2.1), 4e-4, "up", kicks=size) for size in (0.0, 1e-6)
    )
    assert quiet.peak_to_peak.max() == 0.0
    assert kicked.peak_to_peak.max() > 0.5
    again = el.sweep_response(system, (1.9, 2.1), 4e-4, "up", kicks=1e-6)
    assert np.array_equal(again.highest, kicked.highest)


@pytest.mark.slow
def test_basins_are_those_of_marched_states():
    system = duffing()
    motions = coexisting_motions(system, "speed", 1.2, largest=5.0)
    stable = [m for m, holds in zip(motions.motions, motions.stable, strict=True) if holds]
    places = np.linspace(-5.0, 5.0, 9)
    found = basins(system, 1.2, stable, places, places)
    assert found.error <= 2.0 / 16.0
    assert set(np.unique(found.motion)) == {0, 1}
    # Each motion is in its own basin.
    for number, motion in enumerate(stable):
        state = motion.states[0]
        one = basins(system, 1.2, stable, [state[0], 5.0], [state[1], 5.0])
        assert one.motion[0, 0] == number
    # A few states alone come to what they come to among others.
    for q in (places[4], places[6]):
        alone = basins(system, 1.2, stable, [q], [0.0])
        assert alone.error == 0.0
        assert alone.motion[0, 0] == found.motion[4, list(places).index(q)]


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"rate": 0.0}, "rate"),
        ({"rate": 1e-12}, "revolutions"),
        ({"rate": 1.0}, "revolutions"),
        ({"direction": "sideways"}, "direction"),
        ({"kicks": -1.0}, "kicks"),
        ({"bounds": (2.0, 1.0)}, "bounds"),
        ({"seed": -1}, "seed"),
    ],
)
def test_refusals(changes, word):
    arguments = {"bounds": (0.7, 1.1), "rate": 1e-3, **changes}
    with pytest.raises(BadInput, match=word):
        el.sweep_response(duffing(), **arguments)
