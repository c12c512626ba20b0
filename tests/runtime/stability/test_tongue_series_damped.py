"""Damped tongues beside others: damping must not be said to close what the multipliers open."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.stability import resonances, tongue
from periodic_systems import is_growing


def _system(squares, wave, damping):
    """Return y'' + C y' + (diag(squares) + eps wave cos theta) y = 0."""
    terms = (
        Term("M", None, np.eye(2)),
        Term("K", None, np.diag(squares)),
        Term("K", "eps", lambda theta: np.cos(theta)[:, None, None] * np.array(wave)),
        Term("C", "c", np.diag(damping)),
    )
    return LinearPeriodic(
        2,
        terms,
        {"eps": 0.0, "c": 1.0},
        lambda values: {name: np.asarray(values[name], dtype=float) for name in ("eps", "c")},
    )


def _near(second, damping):
    return _system((3.11**2, second**2), ((0.5, 0.4), (0.4, 0.5)), damping)


def _resonance(system, label):
    return next(item for item in resonances(system, (0.3, 12.0)) if item.label == label)


@pytest.mark.parametrize("damping", [(0.003, 0.013), (0.013, 0.003), (0.001, 0.03)])
def test_unequal_damping_does_not_hide_a_tongue_beside_others(damping):
    # 2 w1, w1 + w2 and 2 w2 lie side by side; the motion is nearly all of the lightly damped mode.
    system = _near(3.551, damping)
    given = {"parameter": ("eps", 0.12), "order": 3}
    resonance = _resonance(system, "w1 + w2 = w")
    found = tongue(system, resonance, **given)
    alone = tongue(system, resonance, merge=0.0, **given)
    assert (found.dimension, alone.dimension) == (4, 2)
    assert found.open
    assert alone.open
    assert abs(found.lower - alone.lower) <= found.error + alone.error
    assert abs(found.upper - alone.upper) <= found.error + alone.error
    assert found.passed, dict(found.checks)
    ends = np.array([found.lower, found.upper]) + 3 * found.error * np.array([[-1.0], [1.0]])
    assert is_growing(system, ends, 0.0, eps=0.12).tolist() == [[False, True], [True, False]]


def test_damping_of_one_mode_alone_leaves_no_end_beside_others_either():
    system = _near(3.551, (0.01, 0.0))
    resonance = _resonance(system, "w1 + w2 = w")
    found = tongue(system, resonance, parameter=("eps", 0.12), order=3)
    assert found.dimension == 4
    assert (found.open, found.lower, found.upper) == (True, 0.0, np.inf)
    assert not found.passed


def test_a_range_wrongly_said_to_be_closed_fails_the_checks():
    for system, merge in ((_near(3.551, (0.003, 0.013)), 0.04), (_near(4.4, (0.003, 0.006)), 0.0)):
        resonance = _resonance(system, "w1 + w2 = w")
        values, factors = np.array([0.02, 0.12]), np.array([3.0, 1.0])
        given = {"parameter": ("eps", values), "damping_factor": factors}
        found = tongue(system, resonance, order=3, merge=merge, **given)
        assert found.open.tolist() == [False, True]
        assert found.checks["told apart"].value == 0.0
        nothing = np.full(2, np.nan)
        closed = replace(
            found, lower=nothing, upper=nothing, error=nothing, open=np.zeros(2, dtype=bool)
        )
        assert replace(found.checks._make, tongue=closed)()["told apart"].value == 1.0


def test_a_series_out_of_its_depth_does_not_pass_a_closed_range():
    # The ends are beyond the detunings that a series of order 2 can tell of.
    system = _system((1.0, 5.3), ((0.0, 1.0), (1.0, 0.0)), (0.01, 0.03))
    resonance = _resonance(system, "w1 + w2 = w")
    found = tongue(system, resonance, parameter=("eps", 5.0), order=2)
    assert np.isnan(found.lower)
    assert is_growing(system, 1 + np.sqrt(5.3), 1e-3, eps=5.0)
    assert not found.passed
