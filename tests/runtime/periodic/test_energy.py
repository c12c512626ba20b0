"""The energy balance of a motion: it holds for right motions, and sees wrong ones."""

import numpy as np
import pytest
from elastolink.runtime.periodic import simulate
from elastolink.runtime.periodic.equation import equation_of
from elastolink.runtime.periodic.motion import energy_balance
from manufactured import manufactured


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


def test_too_few_angles_are_no_check():
    equation, run = moved(4100, samples=6)
    assert energy_balance(equation, run.theta, run.q, run.qd / run.speed, 1e-8) is None
    assert "energy balance" not in run.checks
