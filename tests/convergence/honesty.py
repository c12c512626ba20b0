"""What an error figure has to be over many cases."""

from __future__ import annotations

import numpy as np


def verdict(ratios, least):
    """Figure over actual error: at least 1 in 99 %, median no larger than 1000."""
    ratios = np.concatenate(ratios)
    assert ratios.size >= least
    assert np.mean(ratios >= 1.0) >= 0.99
    assert np.median(ratios) <= 1e3
