"""Error estimates of boundary speeds against exact answers.

Two springs seen in random wavy coordinates z = R(theta) q have periodic mass, Coriolis,
centrifugal and stiffness terms, and multipliers and boundaries that are known in closed form.
"""

from __future__ import annotations

import numpy as np
from elastolink.runtime.stability.boundary_speeds import speed_boundaries
from honesty import over_scenes
from wavy_springs import Wavy, tame


@over_scenes(3, few=60, many=None)
def test_boundary_estimate(rng):
    scene = Wavy(rng, rng.uniform(1.0, 9.0, 2))
    if not tame(scene):
        return None
    found = speed_boundaries(scene.system, speed_range=(0.9, 7.0))
    # w = 2 Omega/k, k odd for -1; every one double, as nothing couples.
    natural = np.sqrt(scene.squares)
    exact = np.sort((2 * natural[:, None] / np.arange(1, 9)).ravel())
    exact = np.repeat(exact[(exact > 0.9) & (exact < 7.0)], 2)
    assert len(found.speed) == len(exact)
    assert found.passed, found.checks
    return found.error, found.speed - exact
