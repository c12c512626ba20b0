"""Both methods of the steady state, and Newmark's steps, on the four-bar with flexible links."""

from functools import cache

import numpy as np
import pytest
from beam_motions import damped_four_bar
from elastolink.runtime.gallery.algorithms import newmark_maps
from elastolink.runtime.periodic import steady_state
from elastolink.runtime.periodic.ring import solve_ring
from periodic_systems import peak_gap

# Deflections leave the linear range at these speeds; the methods solve the linear equations.
pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
SPEED = 62.0


four_bar = cache(damped_four_bar)


def newmark(system, speed, intervals):
    """Return q ``(intervals, n)`` of the periodic motion of Newmark's steps."""
    maps, loads = newmark_maps(system, speed, intervals)
    return solve_ring(maps[None], loads[None])[0][0, :, : system.size]


@pytest.mark.parametrize(
    ("mesh", "speed"),
    [
        ({"kind": "internal_node"}, 62.0),
        pytest.param({"elements": 2}, 93.0, marks=pytest.mark.slow),
    ],
)
def test_both_methods_agree(mesh, speed):
    system = four_bar(**mesh)
    segments = steady_state(system, speed, rtol=1e-9)
    balance = steady_state(system, speed, method="harmonic_balance", rtol=1e-6)
    assert segments.passed or not segments.checks["linear range"].passed
    assert balance.checks["converged"].passed and balance.checks["residual"].passed
    # Peaks at the given angles are lower than between them by a per cent or so.
    assert np.all(peak_gap(balance, segments) <= 1.02 * balance.error + segments.error)
    assert np.max(segments.error) <= 1e-9 and np.max(balance.error) <= 1e-6


def test_newmarks_steps_come_near():
    """Second order: four times as many steps, a sixteenth of the gap."""
    system = four_bar()
    gaps = []
    for intervals in (720, 2880):
        exact = steady_state(system, SPEED, samples=intervals).q
        gap = np.max(np.abs(newmark(system, SPEED, intervals) - exact), axis=0)
        gaps.append(float(np.max(gap / np.max(np.abs(exact), axis=0))))
    assert gaps[0] < 0.03
    assert gaps[1] < gaps[0] / 12


def test_an_unstable_speed_is_answered_and_flagged():
    state = steady_state(four_bar(), 91.0)
    assert not state.stable and np.all(np.isfinite(state.q))
    assert np.max(state.error) <= 1e-6
