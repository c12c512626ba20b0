"""Newmark's steps on the four-bar with flexible links, against its steady state."""

import numpy as np
import pytest
from beam_motions import damped_four_bar
from elastolink.runtime.gallery.algorithms import newmark_maps
from elastolink.runtime.periodic import steady_state
from elastolink.runtime.periodic.ring import solve_ring

# Deflections leave the linear range at these speeds; the methods solve the linear equations.
pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
SPEED = 62.0


def newmark(system, speed, intervals):
    """Return q ``(intervals, n)`` of the periodic motion of Newmark's steps."""
    maps, loads = newmark_maps(system, speed, intervals)
    return solve_ring(maps[None], loads[None])[0][0, :, : system.size]


def test_newmarks_steps_come_near():
    """Second order: four times as many steps, a sixteenth of the gap."""
    system = damped_four_bar()
    gaps = []
    for intervals in (720, 2880):
        exact = steady_state(system, SPEED, samples=intervals).q
        gap = np.max(np.abs(newmark(system, SPEED, intervals) - exact), axis=0)
        gaps.append(float(np.max(gap / np.max(np.abs(exact), axis=0))))
    assert gaps[0] < 0.03
    assert gaps[1] < gaps[0] / 12
