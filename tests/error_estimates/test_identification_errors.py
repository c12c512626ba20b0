"""The error of fitted numbers by the computation alone, against the numbers that were planted.

The points are ends of unstable regions of Smith's coupler with other stiffness and inertia, as
computed; so what is fitted is known exactly.
"""

import elastolink as el
import numpy as np
from elastolink.runtime.design import Point, identify
from honesty import over_scenes

NAMES = ("bending_stiffness", "follower_inertia")
# Ends are computed to some 1e-14; inertia takes a hundredth part in them.
FLOOR = 1e-12


@over_scenes(77, few=None, many=40)
def test_fitted_stiffness_and_inertia(rng):
    system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    start = np.array([system.parameters[name] for name in NAMES])
    planted = start * np.exp(rng.uniform(-0.03, 0.03, 2))
    edges = el.stability_edges(system, (60.0, 90.0), **dict(zip(NAMES, planted, strict=True)))
    both = (("unstable from", edges.lower), ("unstable to", edges.upper))
    points = [Point(kind, float(v)) for kind, ends in both for v in ends if np.isfinite(v)]
    found = identify(system, points, NAMES)
    return found.error, found.value / planted - 1.0
