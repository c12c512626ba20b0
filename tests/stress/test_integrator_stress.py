"""Integrators with steps long beside the fastest mode: stiffness, and what must not pass."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.integrators import METHODS
from elastolink.runtime.periodic import simulate

pytestmark = pytest.mark.filterwarnings("error")


def _stiff(frequency):
    """A fast and a slow mode, weakly coupled by a term that varies with the angle."""

    def generator(theta):
        out = np.zeros((len(theta), 4, 4))
        out[:, 0, 2] = out[:, 1, 3] = 1.0
        out[:, 2, 0], out[:, 3, 1] = -(frequency**2), -4.0 - np.cos(theta)
        out[:, 2, 1] = out[:, 3, 0] = 0.5 * np.sin(theta)
        return out

    return generator


@pytest.mark.parametrize("name", ["cf4", "cf6", "gauss_legendre16", "gauss_legendre"])
@pytest.mark.parametrize("phase", [3.0, 30.0, 3000.0])
def test_slow_modes_survive_steps_long_beside_the_fast_one(name, phase):
    # Danger: a mode of many radians per step; the slow one must keep its accuracy.
    steps = 40
    step = 2 * np.pi / steps
    frequency = phase / step
    maps = METHODS[name].maps(_stiff(frequency), step * np.arange(steps), step)
    scale = np.array([1 / frequency, 1.0, 1.0, 1.0])
    state = np.array([0.0, 1.0, 0.0, 0.0])
    for matrix in maps:
        state = matrix @ state
        # The fast mode is not driven beyond the static deflection by the coupling.
        assert np.all(np.isfinite(state))
        assert np.max(np.abs(state / scale)) < 50.0

    def slow(theta):
        return _stiff(frequency)(theta)[:, 1::2, 1::2]

    alone = np.array([1.0, 0.0])
    for matrix in METHODS["gauss_legendre16"].maps(slow, step * np.arange(steps), step):
        alone = matrix @ alone
    # The coupling bends the slow mode by its square over the fast stiffness.
    assert np.max(np.abs(state[1::2] - alone)) < 20.0 * 0.25 / frequency**2 + 2e-4


@pytest.mark.parametrize("name", ["magnus4", "magnus6", "magnus8", "cf4", "cf6"])
@pytest.mark.parametrize("phase", [1.0, 100.0, 1e4, 1e6])
def test_constant_coefficients_are_exact_at_any_step(name, phase):
    # Danger: scaling and squaring; the figure is the angle times round-off.
    generator = np.array([[0.0, phase, 0.0], [-phase, 0.0, phase], [0.0, 0.0, 0.0]])
    found = METHODS[name].maps(
        lambda theta: np.broadcast_to(generator, (len(theta), 3, 3)), np.zeros(1), 1.0
    )[0]
    c, s = np.cos(phase), np.sin(phase)
    exact = np.array([[c, s, 1 - c], [-s, c, s], [0.0, 0.0, 1.0]])
    assert np.max(np.abs(found - exact)) < 4e-16 * (8 + 4 * phase)


def test_thousands_of_revolutions_keep_the_energy():
    # Danger: drift over long runs; an undamped constant system keeps its amplitude.
    system = LinearPeriodic(
        1, (Term("M", None, np.eye(1)), Term("K", None, 6.25 * np.eye(1))), {}, lambda values: {}
    )
    run = simulate(system, 1.0, 3000.0, initial=(0.1, 0.0), samples=20)
    amplitude = np.hypot(run.q[:, 0], run.qd[:, 0] / 2.5)
    # The transition matrices of a revolution are reused, and so is their rounding: it adds up.
    limit = 4 * 2.2e-16 * 3000 * 20
    assert np.max(np.abs(amplitude[-400:] / 0.1 - 1.0)) < limit
