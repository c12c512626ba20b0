"""Error figures of every method of the steady state, over systems whose motion is known."""

from __future__ import annotations

import warnings
from functools import cache

import numpy as np
import pytest
from elastolink.runtime.core.errors import LinearRangeWarning
from elastolink.runtime.response import steady_state
from manufactured import manufactured

SYSTEMS = 200
# Of each variant of a method that is tried on all.
FEWER = 80
EPS = float(np.finfo(float).eps)


@cache
def known(seed):
    """Return a system whose motion is known; its samples serve every method."""
    return manufactured(seed)


def outcomes(method, count, **more):
    """Return figures and actual errors of every coordinate, and the states."""
    figures, errors, states = [], [], []
    for seed in range(count):
        system, speed, motion = known(seed)
        with warnings.catch_warnings():
            warnings.simplefilter("error", LinearRangeWarning)
            state = steady_state(system, speed, method=method, stability=False, **more)
        states.append(state)
        if not np.all(np.isfinite(state.q)):
            assert not state.passed
            continue
        exact = motion(state.theta)
        figures.append(state.error)
        errors.append(np.max(np.abs(state.q - exact), axis=0) / np.max(np.abs(exact), axis=0))
    return np.concatenate(figures), np.concatenate(errors), states


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "rtol"),
    [
        ("harmonic_balance", 1e-9),
        ("harmonic_balance", 1e-3),
        ("cyclic", 1e-9),
        ("cyclic", 1e-4),
        ("transition_matrix", 1e-2),
        ("closed_form", 1e-2),
    ],
)
def test_the_figures_hold_and_are_not_idle(method, rtol):
    figure, actual, states = outcomes(method, SYSTEMS, rtol=rtol)
    assert np.mean(actual <= figure) >= 0.99
    # Below a few units in the last place the reference's own rounding shows.
    assert np.median(figure / np.maximum(actual, 4 * EPS)) <= 1e3
    assert len(figure) > 0.9 * sum(len(state.labels) for state in states)
    for state in states:
        assert state.passed or np.max(state.error) > rtol, state.checks


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "options"),
    [
        ("cyclic", {"scheme": "newmark", "intervals": 360}),
        ("cyclic", {"scheme": "generalized_alpha", "intervals": 180}),
        ("time_marching", {"intervals": 360}),
        ("modal", {"intervals": 128}),
        ("harmonic_balance", {"harmonics": 5}),
        ("cyclic", {"intervals": 4}),
    ],
)
def test_the_figures_hold_where_the_caller_chose_the_resolution(method, options):
    figure, actual, _ = outcomes(method, FEWER, options=options)
    assert np.mean(actual <= figure) >= 0.99
    assert np.median(figure / np.maximum(actual, 4 * EPS)) <= 1e3
