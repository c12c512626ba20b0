"""Error figures of stresses over random beams: actual error against fine meshes of quintics."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest
from beam_motions import periodic_motion, turning_bar
from elastolink.runtime.beams import stress
from elastolink.runtime.beams.recovery import stations_of
from elastolink.runtime.beams.stress_errors import fibre_factors, largest_difference, stresses
from elastolink.runtime.errors import LinearRangeWarning

SCENES = 200
COUNT, PLACES = 24, 7
FIRST = {False: 3.516, True: 9.870}  # (lambda L)^2 of a clamped and of a pinned bar


def scene(rng):
    """Return what makes a random rocking bar and its speed, over its first frequency."""
    size, second = rng.uniform(0.05, 0.5), rng.uniform(-0.2, 0.2)

    def angle(theta):
        phi = size * np.sin(theta) + second * np.cos(2 * theta)
        rate = size * np.cos(theta) - 2 * second * np.sin(2 * theta)
        return phi, rate, -size * np.sin(theta) - 4 * second * np.cos(2 * theta)

    pinned = bool(rng.integers(2))
    # Of the bar of 1 m, 10 mm thick: sqrt(EI/m) = 14.93 m^2/s.
    return (
        {
            "angle": angle,
            "pinned": pinned,
            "drag": rng.uniform(0.01, 0.1) * FIRST[pinned] * 14.93,
        },
        rng.uniform(0.03, 0.6) * FIRST[pinned] * 14.93,
        int(rng.integers(1, 4)),
        "equilibrium" if rng.integers(2) else "shape",
    )


def figures(rng):
    bar, speed, elements, method = scene(rng)
    angle = bar.pop("angle")
    fine = turning_bar(angle, elements=2, kind="internal_node", **bar)
    coarse = turning_bar(angle, elements=elements, **bar)
    factors = fibre_factors(fine, stations_of(fine.structure, PLACES))
    exact = stresses(fine, periodic_motion(fine, speed, COUNT), PLACES, "equilibrium", factors)
    # As if steady_state had found it: the figure then counts the frequencies of the mesh too.
    motion = replace(periodic_motion(coarse, speed, COUNT), solved="collocation")
    found = stress(coarse, motion, stations=PLACES, method=method)
    return largest_difference((found.axial, found.bending), exact), float(found.error)


@pytest.mark.slow
def test_actual_errors_stay_within_their_figures():
    rng = np.random.default_rng(1996)
    with warnings.catch_warnings():
        # Stiffness and speed are drawn without regard to the linear range.
        warnings.simplefilter("ignore", LinearRangeWarning)
        pairs = np.array([figures(rng) for _ in range(SCENES)])
    within = pairs[:, 0] <= pairs[:, 1]
    assert np.mean(within) >= 0.99
    assert np.median(pairs[:, 1] / pairs[:, 0]) <= 1e3
