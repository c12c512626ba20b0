"""What a response curve calls stable stays, and what it calls unstable goes, over 300 turns.

A motion is disturbed by a millionth of its size and marched: oscillators by DOP853, which shares
nothing with the curve; rigs by the marcher of slow sweeps, which shares the collocation steps with
it but neither the closing of the period nor the multipliers.
"""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.nonlinear.march import Marcher, end
from oscillators import marched
from random_systems import curve_of, random_oscillators, random_rig

TURNS, BLOCK = 300, 2  # a block is a whole number of periods of motions of one turn and of two
DISTURBED = 1e-6
MARGINAL = 0.03  # growth of a turn, as a logarithm, that 300 turns tell
GROWN, SHRUNK = 100.0, 0.01


def chosen(rng, curve, most: int):
    """Return numbers of some motions, of either stability, that are not marginal."""
    growth = np.log(np.max(np.abs(curve.multipliers), axis=1)) / curve.turns
    found = []
    for kind in (curve.stable, ~curve.stable):
        (at,) = np.nonzero(kind & (np.abs(growth) > MARGINAL))
        found += rng.choice(at, min(most, len(at)), replace=False).tolist()
    return found


def disturbed(rng, curve, numbers):
    """Return states of motions, sizes by coordinates and rates, and states beside the former."""
    motions = [curve.orbits[i].motion for i in numbers]
    states = np.array([motion.states[0] for motion in motions])
    sizes = np.array([curve.source.scale(motion) for motion in motions])
    return states, sizes, states + DISTURBED * sizes * rng.uniform(-1.0, 1.0, states.shape)


def judged(step, curve, numbers, states, sizes, moved) -> int:
    """March disturbed motions, compare with their labels, and return how many there are.

    ``step``: from numbers and states to the states a block later.
    """
    numbers = np.array(numbers)
    begun = np.max(np.abs(moved - states) / sizes, axis=1)
    at = np.arange(len(numbers))
    for _ in range(TURNS // BLOCK):
        moved[at] = step(numbers[at], moved[at])
        ratios = np.max(np.abs(moved - states) / sizes, axis=1) / begun
        # What has grown may go anywhere, what has died away is no more than rounding.
        at = np.flatnonzero((ratios > SHRUNK) & (ratios < GROWN))
        if not at.size:
            break
    assert np.all(ratios[curve.stable[numbers]] < 10.0 * SHRUNK)
    assert np.all(ratios[~curve.stable[numbers]] >= GROWN)
    return len(numbers)


def judge_oscillators(rng, systems: int) -> tuple[int, int]:
    """Judge motions of so many random oscillators; return how many were stable, and not."""
    counts = np.zeros(2, dtype=int)
    drawn = 0
    while drawn < systems:
        system, bounds = random_oscillators(rng)
        curve = curve_of(rng, (system, bounds), turns=2)
        if curve is None:
            continue
        drawn += 1
        numbers = chosen(rng, curve, 3)

        def step(which, states, system=system, curve=curve):
            speeds = curve.value[which][:, None]
            return marched(system, speeds, states, BLOCK, rtol=1e-10)[-1]

        judged(step, curve, numbers, *disturbed(rng, curve, numbers))
        counts += [np.sum(curve.stable[numbers]), np.sum(~curve.stable[numbers])]
    return tuple(counts.tolist())


def test_labels_of_oscillators():
    stable, unstable = judge_oscillators(np.random.default_rng(301), 2)
    assert stable > 0 and unstable > 0


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(310, 315))
def test_labels_of_many_oscillators(seed):
    stable, unstable = judge_oscillators(np.random.default_rng(seed), 4)
    assert stable > 0 and unstable > 0


@pytest.mark.slow
@pytest.mark.parametrize("seed", [400, 402, 403, 413, 418])
def test_labels_of_rigs(seed):
    rng = np.random.default_rng(seed)
    curve, numbers = None, []
    while not numbers:
        drawn = random_rig(rng)
        curve = drawn and curve_of(rng, drawn, turns=2)
        numbers = chosen(rng, curve, 2) if curve else []
    marcher = Marcher(curve.source.problem, rtol=1e-10)

    def step(which, states):
        found = []
        for number, state in zip(which, states, strict=True):
            motion, state = None, state[None]
            for _ in range(BLOCK):
                motion = marcher.revolution(curve.value[number], state, motion)
                state = end(motion)
            found.append(state[0])
        return np.array(found)

    assert judged(step, curve, numbers, *disturbed(rng, curve, numbers)) > 0
