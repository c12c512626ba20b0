"""Helpers of the tests of unstable regions: systems, find a region, where multipliers meet."""

import elastolink as el
import numpy as np
from elastolink.runtime.systems.rod import rod_system

RIG = "smith_1972_5152_sixteenth_inch"


def rig(**overrides):
    """Return Smith's 1/16 in rig."""
    return el.load_scene(RIG, overrides=overrides).system()


def flexible_rod(basis, crank_ratio=0.1, **changes):
    """Return Beale & Scott's very flexible rod."""
    return rod_system(
        basis,
        crank_ratio=crank_ratio,
        frame=0.59997,
        length=1.0,
        bending_stiffness=0.7e11 * 0.5208e-6,
        mass_per_length=7.15,
        **changes,
    )


def region_of(found, kind, harmonic):
    """Return the place of the first region of a kind and harmonic."""
    for i, label in enumerate(found.kind):
        if label == kind and found.harmonic[i] == harmonic:
            return i
    raise AssertionError((kind, harmonic, found.labels))


def discriminant(matrix):
    """Of the reduced polynomial z^2 - a z + b - 2: a^2 - 4 (b - 2), zero at a double z."""
    a = np.trace(matrix)
    b = 0.5 * (a**2 - np.trace(matrix @ matrix))
    return a**2 - 4 * (b - 2)
