"""What an error estimate has to be over many cases: nearly always enough, and not idle."""

from __future__ import annotations

import numpy as np
import pytest

# How many random scenes: a few in the first stage of the tests, many in the second.
SCENES = pytest.mark.parametrize("scenes", [20, pytest.param(200, marks=pytest.mark.slow)])
# The same where a scene takes a good part of a second.
FEWER_SCENES = pytest.mark.parametrize("scenes", [10, pytest.param(100, marks=pytest.mark.slow)])


def verdict(ratios, least=1):
    """Estimate over actual error: at least 1 in 99 %, median no larger than 1000."""
    ratios = np.hstack(ratios).astype(float)
    assert ratios.size >= least
    assert np.mean(ratios >= 1.0) >= 0.99
    assert np.median(ratios) <= 1e3


def covers(estimates, actual, least=1, floor=1e-300):
    """The same of estimates and actual errors; below ``floor`` the reference is not known."""
    verdict(np.hstack(estimates) / np.maximum(np.hstack(actual).astype(float), floor), least)
