"""Both methods of the steady state, and Newmark's steps, on the four-bar with flexible links."""

from functools import cache

import numpy as np
import pytest
from beam_motions import FOUR_BAR, JOINT_MASSES, SECTIONS
from elastolink.runtime.beams import linkage_system
from elastolink.runtime.gallery.algorithms import newmark_maps
from elastolink.runtime.periodic import steady_state
from elastolink.runtime.periodic.ring import solve_ring
from elastolink.runtime.systems import with_modal_damping
from periodic_systems import peak_gap

# Deflections leave the linear range at these speeds; the methods solve the linear equations.
pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
SPEED = 62.0


@cache
def four_bar(elements=1, kind="cubic"):
    """Return the linkage of Aannaque's Table 4.1, all links beams, damped alike in all modes."""
    system = linkage_system(
        FOUR_BAR, SECTIONS, elements=elements, kind=kind, joint_masses=JOINT_MASSES
    )
    return with_modal_damping(system, 0.02)


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


@pytest.mark.slow
def test_both_methods_agree_at_random_speeds():
    speeds = np.sort(np.random.default_rng(62).uniform(15.0, 100.0, 20))
    ring = steady_state(four_bar(), speeds, rtol=1e-5)
    balance = steady_state(four_bar(), speeds, method="harmonic_balance", rtol=1e-4)
    gap = np.max(np.abs(ring.q - balance.q), axis=1) / np.max(np.abs(balance.q), axis=1)
    # 180 coordinates: an estimate holds in 99 % of cases.
    assert np.mean(gap <= ring.error + balance.error) >= 0.99
    assert np.max(ring.error) <= 1e-5 and np.max(balance.error) <= 1e-4
