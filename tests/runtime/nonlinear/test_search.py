"""Periodic motions beside the known ones: planted ones are found, and what was tried is told."""

from __future__ import annotations

from dataclasses import replace

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.nonlinear import coexisting_motions
from elastolink.runtime.nonlinear.search import _solved
from planted import duffing, planted_system
from random_systems import random_rig

ANGLES = 2.0 * np.pi * np.arange(32) / 32


def found(seed: int, count: int) -> float:
    """Return the share of planted motions that were found."""
    rng, hits = np.random.default_rng(seed), 0
    for _ in range(count):
        system, speed, motion = planted_system(rng)
        others = coexisting_motions(system, "speed", speed)
        wanted = motion(ANGLES)[0]
        gaps = [np.max(np.abs(m.at(ANGLES)[0] - wanted)) for m in others.motions if m.turns == 1]
        hits += min(gaps, default=np.inf) < 1e-6
    return hits / count


def test_planted_motions_are_found():
    assert found(0, 1) == 1.0


@pytest.mark.slow
def test_nearly_all_planted_motions_are_found():
    assert found(1, 20) >= 0.95


def test_a_start_without_a_correction_stops_no_other():
    # Of three starts the second is at a motion with a multiplier of 1.
    matrices = np.stack([np.eye(2), np.zeros((2, 2)), 2.0 * np.eye(2)])
    found = _solved(matrices, np.ones((3, 2, 1)))[..., 0]
    assert found[[0, 2]].tolist() == [[1.0, 1.0], [0.5, 0.5]]
    assert np.all(np.isnan(found[1]))


def test_the_three_motions_of_a_hardened_resonance():
    # Between its folds, 1.1292 and 1.3315, Duffing's equation has three motions, the middle one
    # unstable; their multipliers multiply to exp(-2 pi damping / speed).
    motions = coexisting_motions(duffing(), "speed", 1.2, largest=5.0)
    assert motions.turns.tolist() == [1, 1, 1]
    assert motions.stable.tolist() == [True, False, True]
    assert np.all(np.diff(motions.highest) > 0.1)
    assert motions.error.max() < 1e-8
    assert set(motions.searched) >= {"rest", "mode 1", "marched", "random"}


def test_motions_are_starts_of_branches():
    # Above the folds nothing leads from the small motion to the large one within the range.
    system, bounds = duffing(), (1.15, 1.3)
    motions = coexisting_motions(system, "speed", 1.2, largest=5.0)
    starts = [(1.2, motion) for motion in motions.motions]
    alone, all_of_them = (
        el.response_curve(system, "speed", bounds, starts=given) for given in ((), starts)
    )
    assert len(alone.ended) < len(all_of_them.ended) == 3
    assert np.all(all_of_them.value >= 1.15 - 1e-12)
    assert np.all(all_of_them.value <= 1.3 + 1e-12)
    # Each is followed both ways, from one end of the range to the other.
    for number in range(3):
        values = all_of_them.value[all_of_them.branch == number]
        assert values[[0, -1]].tolist() == pytest.approx([1.15, 1.3])


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"value": np.nan}, "value"),
        ({"parameter": "mass"}, "parameter"),
        ({"turns": 0}, "turns"),
        ({"largest": -1.0}, "largest"),
        ({"parameter": "force"}, "speed"),
    ],
)
def test_refusals(changes, word):
    arguments = {"parameter": "speed", "value": 1.2, **changes}
    with pytest.raises(BadInput, match=word):
        coexisting_motions(duffing(), **arguments)


@pytest.mark.slow
def test_a_start_that_newton_misses_from_rest_is_marched_to():
    # At the upper end of this rig's range Newton's iteration fails from rest.
    system, bounds = random_rig(np.random.default_rng(402))
    curve = el.response_curve(system, "speed", bounds)
    assert curve.missed == () and len(curve.ended) == 2
    last = int(np.argmax(np.where(curve.branch == 1, curve.value, 0.0)))
    assert curve.value[last] == pytest.approx(bounds[1], rel=1e-12) and curve.stable[last]
    # A slow sweep from there begins with the same motion.
    far = el.sweep_response(system, (bounds[1], 1.001 * bounds[1]), 1e-3, "up", kicks=0.0)
    assert far.peak_to_peak[0] == pytest.approx(curve.peak_to_peak[last], rel=0.02)


def test_an_end_without_a_motion_is_said():
    system = duffing()

    def limited(q, qd, qdd, drive, parameters, derivatives=True):
        left = system.equations(q, qd, qdd, drive, parameters, derivatives)
        beyond = np.asarray(drive.speed)[..., None] > 0.7
        return left._replace(residual=np.where(beyond, np.nan, left.residual))

    curve = el.response_curve(replace(system, equations=limited), "speed", (0.5, 0.9))
    assert curve.missed == (0.9,)
    assert curve.ended == ("it cannot be followed",)
    assert curve.value.max() == pytest.approx(0.7, abs=1e-3)
