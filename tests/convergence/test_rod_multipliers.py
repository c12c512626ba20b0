"""Multipliers of the rod in an unstable region: every formulation tends to the same ones.

The error of a multiplier is that of the system with so many shapes.  What the shapes leave out is
told by a few shapes more: twice the change is the estimate tested here.
"""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.scenes import load_scene

# Formulation, number of shapes, a number that is larger by half or so.
COUNTS = (("overhang", 4, 6), ("two_segment", 8, 10), ("free_free_linear", 8, 12))
# In the principal region of the first mode, with centrifugal tension and as printed.
POINTS = (
    (0.05, 1680.0, ()),
    pytest.param(0.1, 1560.0, ("as_printed",), marks=pytest.mark.slow),
)


def largest(formulation: str, modes: int, eps: float, speed: float, drop=()) -> float:
    scene = load_scene(
        "beale_1992_flexible_rod",
        {
            "model.formulation": formulation,
            "model.modes": modes,
            "model.drop": list(drop),
            "links.crank_ratio": eps,
        },
    )
    found = floquet_multipliers(scene.linear_system(), speed)
    assert np.max(found.error) < 1e-7
    return float(np.max(np.abs(found.multipliers)))


@pytest.mark.parametrize(("eps", "speed", "drop"), POINTS)
def test_the_formulations_agree_to_their_stated_errors(eps, speed, drop):
    found = {}
    for formulation, few, more in COUNTS:
        one, other = (largest(formulation, n, eps, speed, drop) for n in (few, more))
        found[formulation] = (one, 2.0 * abs(one - other))
    # Sixteen exact modes: two shapes less move it by less than 1e-6 (twelve by 3e-6).
    truth = largest("overhang", 16, eps, speed, drop)
    assert truth > 1.05
    for formulation, (value, estimate) in found.items():
        assert abs(value - truth) <= estimate, formulation
        assert estimate < 0.02, formulation
    values = list(found.values())
    for i, (one, first) in enumerate(values):
        for other, second in values[:i]:
            assert abs(one - other) <= first + second
