"""Helpers of the tests of unstable regions along the speed: find one; where multipliers meet."""

import numpy as np


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
