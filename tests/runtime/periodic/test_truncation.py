"""Modal truncation: motions and multipliers of the lowest modes against those of the whole."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.periodic import floquet_multipliers, steady_state
from elastolink.runtime.periodic.truncation import modal_truncation
from elastolink.runtime.scenes import load_scene
from periodic_systems import system_of

pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
FREQUENCIES = np.array([1.0, 2.3, 45.0, 160.0])


def stiff_chain(drag=0.0, swing=0.4, modulation=0.3):
    """Return oscillators whose modes swing to and fro between slow and stiff coordinates."""

    def turn(theta):
        angle = swing * np.sin(theta)
        out = np.broadcast_to(np.eye(4), (len(theta), 4, 4)).copy()
        for a, b, share in ((0, 2, 1.0), (1, 3, 0.6), (0, 1, 0.5)):
            part = np.broadcast_to(np.eye(4), (len(theta), 4, 4)).copy()
            c, s = np.cos(share * angle), np.sin(share * angle)
            part[:, a, a], part[:, a, b], part[:, b, a], part[:, b, b] = c, -s, s, c
            out = out @ part
        return out

    def stiffness(theta):
        r = turn(theta)
        levels = np.broadcast_to(FREQUENCIES**2, (len(theta), 4)).copy()
        levels[:, 0] *= 1.0 + modulation * np.cos(theta)
        levels[:, 1] *= 1.0 + 0.5 * modulation * np.sin(theta)
        return np.swapaxes(r, -1, -2) @ (levels[:, :, None] * r)

    damping = {"C": lambda theta: drag * stiffness(theta)} if drag else {}
    return system_of(M=np.eye(4), K=stiffness, **damping)


def apart(few, whole):
    """Return the distance of each multiplier to the nearest of the whole system."""
    return np.min(np.abs(few[:, None] - whole), axis=-1)


@pytest.fixture(scope="module")
def four_bar():
    system = load_scene("aannaque_1996_table_4_1").linear_system()
    return system, modal_truncation(system, 6)


@pytest.mark.smoke
def test_the_lifted_motion_is_that_of_the_whole_system(four_bar):
    """Six of the modes at 62 rad/s: 1.3e-5 of the small coordinates, measured against the whole."""
    system, truncated = four_bar
    few = steady_state(truncated, 62.0, rtol=1e-9, samples=len(truncated.theta))
    q, change = truncated.lift(few.q[None], 62.0)
    whole = steady_state(system, 62.0, rtol=1e-9, samples=len(truncated.theta)).q
    gap = np.max(np.abs(q[0] - whole), axis=0) / np.max(np.abs(whole), axis=0)
    assert np.max(gap) < 1e-4
    assert 0.0 < change[0] < 1e-2


def test_the_multipliers_of_six_modes_are_those_of_the_whole_system(four_bar):
    """Measured: 5e-6 at the most at 62 rad/s."""
    system, truncated = four_bar
    few = floquet_multipliers(truncated, 62.0).multipliers
    whole = floquet_multipliers(system, 62.0).multipliers
    assert few.shape == (12,)
    assert np.max(apart(few, whole)) < 2e-5


@pytest.mark.parametrize("drag", [0.0, 2e-3])
@pytest.mark.parametrize("speed", [0.31, 0.97])
def test_slow_modes_of_a_swinging_chain(drag, speed):
    """What is left out is of the order (2.3/45)^2 of the angle that a mode turns in a period."""
    system = stiff_chain(drag)
    few = floquet_multipliers(modal_truncation(system, 2), speed).multipliers
    whole = floquet_multipliers(system, speed, rtol=1e-12).multipliers
    turns = FREQUENCIES[1] / speed
    assert np.max(apart(few, whole)) < 2 * np.pi * turns * (2.3 / 45.0) ** 2
    if not drag:
        assert np.max(np.abs(np.abs(few) - 1.0)) < 1e-9


def test_all_modes_are_the_whole_system():
    system = stiff_chain(2e-3)
    few = floquet_multipliers(modal_truncation(system, 4), 0.6, rtol=1e-10)
    whole = floquet_multipliers(system, 0.6, rtol=1e-10)
    assert np.max(apart(few.multipliers, whole.multipliers)) < 1e-7
