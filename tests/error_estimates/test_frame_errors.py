"""Error bounds of frame frequencies, over random frames, against determinants in 60 digits."""

from __future__ import annotations

import frame_truth
import frequency_truth
import numpy as np
from elastolink.runtime.frequencies import dynamic_stiffness, wittrick_williams
from honesty import over_scenes


@over_scenes(2024, few=None, many=100)
def test_bounds_hold_and_are_not_idle(rng):
    structure = frame_truth.random_frame(rng)
    number = int(rng.integers(1, 5))
    found = wittrick_williams(dynamic_stiffness(structure), count=number)
    assert found.passed
    place = found.frequencies[-1]
    if np.max(np.abs(found.vectors()[-1])) * place < 1e-12:
        return None  # the nodes stand still: a pole of the determinant
    frequency_truth.stiffness.cache_clear()
    frequency_truth.amplitudes.cache_clear()
    gap = abs(float(frame_truth.exact_frequency(structure, place) - float(place)))
    assert gap <= found.error[-1]
    return found.error[-1], gap
