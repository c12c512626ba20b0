"""Both methods of the steady state, and Newmark's steps, on the four-bar with flexible links."""

import numpy as np
import pytest
from elastolink.runtime.gallery.aannaque_algorithms import newmark_maps
from elastolink.runtime.periodic import steady_state
from elastolink.runtime.periodic.ring import solve_ring
from four_bar_beams import four_bar
from periodic_systems import peak_gap

# Deflections leave the linear range at these speeds; the methods solve the linear equations.
pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
SPEED = 62.0


def newmark(system, speed, intervals):
    """Return q ``(intervals, n)`` of the periodic motion of Newmark's steps."""
    maps, loads = newmark_maps(system, speed, intervals)
    return solve_ring(maps[None], loads[None])[0][0, :, : system.size]


@pytest.mark.parametrize(
    ("mesh", "speed"),
    [
        ({}, 62.0),
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


@pytest.mark.parametrize("elements", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_newmarks_steps_come_near(elements):
    """Second order: four times as many steps, a sixteenth of the gap."""
    system = four_bar(elements)
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
    speeds = np.sort(np.random.default_rng(62).uniform(15.0, 100.0, 30))
    ring = steady_state(four_bar(), speeds, rtol=1e-5)
    balance = steady_state(four_bar(), speeds, method="harmonic_balance", rtol=1e-4)
    gap = np.max(np.abs(ring.q - balance.q), axis=1) / np.max(np.abs(balance.q), axis=1)
    # 270 coordinates: an estimate holds in 99 % of cases.
    assert np.mean(gap <= ring.error + balance.error) >= 0.99
    assert np.max(ring.error) <= 1e-5 and np.max(balance.error) <= 1e-4


@pytest.mark.slow
def test_newmarks_steps_at_a_dozen_speeds():
    for speed in np.sort(np.random.default_rng(7).uniform(20.0, 70.0, 12)):
        coarse, fine = (newmark(four_bar(), speed, count) for count in (1024, 2048))
        exact = steady_state(four_bar(), speed, samples=1024).q
        gap, step = (
            np.max(np.abs(one - coarse), axis=0) / np.max(np.abs(exact), axis=0)
            for one in (exact, fine[::2])
        )
        # Richardson: the gap is four thirds of what half the step changes.
        assert np.all(gap <= 1.1 * 4.0 / 3.0 * step + 1e-6)
