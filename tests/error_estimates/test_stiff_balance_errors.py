"""Error figures of the balance that slow modes steer, over stiff systems of known motion."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.response import harmonic_balance, steady_state
from elastolink.runtime.response.slow_balance import balanced_slowly
from manufactured import Series

EPS = float(np.finfo(float).eps)


def stiff(seed):
    """Return a system of some slow and some fast modes in turned axes, a speed, its motion."""
    rng = np.random.default_rng(seed)
    n, speed = int(rng.integers(6, 11)), float(rng.uniform(0.5, 4.0))
    slow = int(rng.integers(1, 4))
    squares = np.concatenate(
        [rng.uniform(4.0, 200.0, slow), 10.0 ** rng.uniform(5.0, 9.0, n - slow)]
    )
    axes = np.linalg.qr(rng.normal(size=(n, n)))[0]
    mass = Series.random(rng, (n, n), 0.1, 3, symmetric=True)
    mass.cosine[0] += 2.0 * np.eye(n)
    gyro = Series.random(rng, (n, n), 0.2, 2)
    inertia = Series.random(rng, (n, n), 0.2, 2, symmetric=True)
    drag = Series.random(rng, (n, n), 0.02, 2)
    drag.cosine[0] += rng.choice([0.05, 0.2, 3.0]) * np.eye(n)
    wobble = Series.random(rng, (n,), 0.2, 2)

    def spring(theta):
        # The axes turn twice in a period, stiff and soft ones exchanging their directions.
        turned = np.tile(axes, (len(theta), 1, 1))
        c, s = np.cos(2 * theta)[:, None], np.sin(2 * theta)[:, None]
        one, two = axes[:, 0], axes[:, -1]
        turned[:, :, 0], turned[:, :, -1] = c * one + s * two, c * two - s * one
        values = squares * (1.0 + wobble(theta))
        return (turned * values[:, None, :]) @ np.swapaxes(turned, 1, 2)

    harmonics = int(rng.integers(3, 40))
    decay = float(rng.uniform(1.2, 2.0)) ** -np.arange(harmonics + 1.0)[:, None]
    motion = Series(*(decay * rng.uniform(-1, 1, (harmonics + 1, n)) for _ in range(2)))

    def times(matrix, vector, theta):
        return np.einsum("tij,tj->ti", matrix(theta), vector(theta))

    def forcing(theta):
        q, slope = motion, motion.derivative
        total = times(mass.derivative, slope, theta) + times(mass, slope.derivative, theta)
        total += times(gyro.derivative, q, theta) + times(gyro, slope, theta)
        total -= np.einsum("tji,tj->ti", gyro(theta), slope(theta)) + times(inertia, q, theta)
        return total + times(spring, q, theta) / speed**2 + times(drag, slope, theta) / speed

    terms = (
        Term("M", None, mass),
        Term("A", None, gyro),
        Term("B", None, inertia),
        Term("K", None, spring),
        Term("C", None, drag),
        Term("f", None, forcing),
    )
    return LinearPeriodic(n, terms, {}, lambda values: {}), speed, motion


@pytest.mark.slow
@pytest.mark.parametrize(("rtol", "systems"), [(1e-3, 40), (1e-6, 220), (1e-9, 40)])
def test_the_figures_hold_and_are_not_idle(monkeypatch, rtol, systems):
    steered = []

    def counted(*given):
        found = balanced_slowly(*given)
        steered.append(found is not None)
        return found

    monkeypatch.setattr(harmonic_balance, "balanced_slowly", counted)
    figures, errors = [], []
    for seed in range(systems):
        system, speed, motion = stiff(seed)
        state = steady_state(system, speed, method="harmonic_balance", rtol=rtol, stability=False)
        exact = motion(state.theta)
        figures.append(state.error)
        errors.append(np.max(np.abs(state.q - exact), axis=0) / np.max(np.abs(exact), axis=0))
        assert state.passed, state.checks
    figure, actual = np.concatenate(figures), np.concatenate(errors)
    assert np.mean(actual <= figure) >= 0.99
    assert np.median(figure / np.maximum(actual, 4 * EPS)) <= 1e3
    # All of them have slow modes apart, at the speed and the harmonics drawn.
    assert np.mean(steered) >= 0.95
