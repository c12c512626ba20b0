"""The energy balance of motions given at few angles: it holds, and it sees a corrupted motion."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.floquet.first_order import canonical_form
from elastolink.runtime.simulation.energy import energy_balance
from elastolink.runtime.periodic import simulate
from manufactured import manufactured

SCENES = 200
# Relative, of each coordinate and each slope at each angle, with a sign of its own.
CORRUPTION = 1e-6


def balances(seed, scenes, most=32):
    """Return the balances of random motions with few samples a revolution: as found, corrupted."""
    rng = np.random.default_rng(seed)
    found = []
    for number in range(scenes):
        system, speed, _ = manufactured(seed + number)
        n = system.size
        initial = rng.standard_normal(n), speed * rng.standard_normal(n)
        samples = int(rng.integers(2, most))
        # Some by a method with an error of its own that is still far below the corruption.
        method = str(rng.choice(["auto", "magnus8", "gauss_legendre"]))
        run = simulate(
            system, speed, rng.uniform(0.6, 1.4), method, initial=initial, samples=samples
        )
        signs = rng.choice([-1.0, 1.0], (2, *run.q.shape))
        q, slope = np.array([run.q, run.qd / speed]) * (1.0 + CORRUPTION * signs)
        worse = energy_balance(
            canonical_form(system, speed, forcing=True),
            run.theta,
            q,
            slope,
            float(np.max(run.error)),
        )
        found.append((run.checks["energy balance"], worse))
    return found


def test_some_motions_at_few_angles():
    for right, wrong in balances(4100, 4, 9):
        assert right.passed and not wrong.passed


@pytest.mark.slow
def test_the_balance_of_few_samples_holds_and_sees_a_millionth():
    found = balances(4200, SCENES)
    assert all(right.passed for right, _ in found)
    assert not any(wrong.passed for _, wrong in found)
    # The limits leave room for round-off and for the figure of the motion, not for a millionth.
    assert np.median([right.limit for right, _ in found]) < 1e-9


def test_waves_that_fall_on_the_given_angles_are_no_rest():
    """A wave of twelve turns, given at twelve angles: it looks constant, and is balanced."""
    spring = 12.0**2 - 0.25

    def stiffness(theta):
        return (spring + 40.0 * np.cos(12.0 * theta))[:, None, None]

    terms = (Term("M", None, np.eye(1)), Term("K", None, stiffness))
    system = LinearPeriodic(1, terms, {}, lambda values: {})
    run = simulate(system, 1.0, 3.0, initial=([1.0], [0.0]), samples=12)
    check = run.checks["energy balance"]
    assert check.passed and check.limit < 1e-10
    wrong = energy_balance(
        canonical_form(system, 1.0),
        run.theta,
        run.q * np.linspace(1.0, 1.0 + CORRUPTION, len(run.q))[:, None],
        run.qd,
        float(np.max(run.error)),
    )
    assert not wrong.passed


def test_a_long_motion_is_looked_at_from_its_beginning_and_as_a_whole():
    """What goes wrong late is seen by the spline, what goes wrong early by the stages."""
    system, speed, motion = manufactured(4304)
    zero = np.zeros(1)
    start = motion(zero)[0], speed * motion.derivative(zero)[0]
    run = simulate(system, speed, 12.0, initial=start, samples=180)
    error = float(np.max(run.error))
    form = canonical_form(system, speed, forcing=True)
    whole = energy_balance(form, run.theta, run.q, run.qd / speed, error)
    assert whole.passed
    for part in (slice(5, 400), slice(1500, None)):
        q = run.q.copy()
        q[part] *= 1.001
        assert not energy_balance(form, run.theta, q, run.qd / speed, error).passed
