"""Error bounds of frame frequencies, over random frames, against determinants in 60 digits."""

from __future__ import annotations

import frame_truth
import frequency_truth
import numpy as np
import pytest
from elastolink.runtime.frequencies import dynamic_stiffness, wittrick_williams
from honesty import covers

SCENES = 100


@pytest.mark.slow
def test_bounds_hold_and_are_not_idle():
    rng = np.random.default_rng(2024)
    estimates, actual = [], []
    for _ in range(SCENES):
        structure = frame_truth.random_frame(rng)
        number = int(rng.integers(1, 5))
        found = wittrick_williams(dynamic_stiffness(structure), count=number)
        assert found.passed
        place = found.frequencies[-1]
        if np.max(np.abs(found.vectors()[-1])) * place < 1e-12:
            continue  # the nodes stand still: a pole of the determinant
        frequency_truth.stiffness.cache_clear()
        frequency_truth.amplitudes.cache_clear()
        truth = frame_truth.exact_frequency(structure, place)
        estimates.append(found.error[-1])
        actual.append(abs(float(truth - float(place))))
    assert len(actual) > 0.95 * SCENES
    assert np.all(np.array(actual) <= estimates)
    covers(estimates, actual)
