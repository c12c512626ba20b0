"""The energy balance of a motion: it holds for right motions, and sees wrong ones."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.periodic import simulate
from elastolink.runtime.periodic.equation import equation_of
from elastolink.runtime.periodic.motion import energy_balance
from manufactured import manufactured
from periodic_systems import system_of


def moved(seed, samples=256):
    """Return the equation of a random system with all its terms, and a motion of 1.3 turns."""
    rng = np.random.default_rng(seed)
    system, speed, _ = manufactured(seed)
    start = rng.standard_normal(system.size), speed * rng.standard_normal(system.size)
    return equation_of(system, speed, {}, forcing=True), simulate(
        system, speed, 1.3, initial=start, samples=samples
    )


@pytest.mark.parametrize("scenes", [20, pytest.param(200, marks=pytest.mark.slow)])
def test_random_motions_are_balanced_and_wrong_ones_are_not(scenes):
    seen = []
    for seed in range(4100, 4100 + scenes):
        equation, run = moved(seed)
        slope, error = run.qd / run.speed, float(np.max(run.error))
        right = energy_balance(equation, run.theta, run.q, slope, error)
        if right is None:
            # Too few angles for the fastest mode.
            continue
        assert right.passed and right.value < 1e-4
        drift = np.linspace(1.0, 1.01, len(run.q))[:, None]
        wrong = energy_balance(equation, run.theta, run.q * drift, slope, error)
        seen.append(not wrong.passed)
    assert len(seen) > 0.8 * scenes
    # Where nearly all of the energy is kinetic, coordinates off by 1 % matter little.
    assert np.mean(seen) >= 0.85


def test_energy_of_an_oscillator_by_hand():
    """q = cos 3 theta: E = 9/2 throughout, and no power goes in; rates too large by 1 % give more.

    The last of the 66 angles is left out, so that 64 intervals cover a quarter of a wave.
    """
    equation = equation_of(system_of(M=np.eye(1), K=9.0 * np.eye(1)), 1.0, {})
    theta = np.pi / 6 / 64 * np.arange(66.0)
    q, slope = np.cos(3 * theta)[:, None], -3 * np.sin(3 * theta)[:, None]
    right = energy_balance(equation, theta, q, slope, 1e-12)
    assert right.passed and right.value < 1e-13
    wrong = energy_balance(equation, theta, q, 1.01 * slope, 1e-12)
    growth = 4.5 * (1.01**2 - 1)
    assert wrong.value == pytest.approx(growth / (4.5 + growth), rel=1e-6)
    assert not wrong.passed


def test_damping_and_load_do_work():
    """q'' + 0.2 q' + 9 q = 2: without the damping, or without the load, nothing is balanced."""
    system = system_of(M=np.eye(1), C=0.2 * np.eye(1), K=9.0 * np.eye(1), p=np.array([2.0]))
    run = simulate(system, 1.0, 1.0, samples=128)
    assert run.checks["energy balance"].passed
    for left_out in ("C", "p"):
        equation = equation_of(system.without(left_out), 1.0, {}, forcing=left_out != "p")
        assert not energy_balance(equation, run.theta, run.q, run.qd, 1e-8).passed


def test_too_few_angles_are_no_check():
    equation, run = moved(4100, samples=6)
    assert energy_balance(equation, run.theta, run.q, run.qd / run.speed, 1e-8) is None
    assert "energy balance" not in run.checks
