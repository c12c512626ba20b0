"""The observed order of collocation: slope of log error over log step, down to round-off."""

import numpy as np
import pytest
from manufactured import manufactured
from marching import marched
from orders import slope


def _slope(stages, counts):
    """Return the order of marching two turns along a periodic motion that is known exactly."""
    system, speed, motion = manufactured(5)  # three coordinates, eight harmonics
    start = np.array([0.3])
    q, rate = motion(start)[0], motion.derivative(start)[0]
    ends = [marched(stages, system, speed, n, 2, start=0.3, q=q, slope=rate)[-1] for n in counts]
    errors = np.linalg.norm(np.array(ends) - q, axis=1) / np.linalg.norm(q)
    # Rounding is some 1e-15 of it.
    assert errors[0] < 1e-2 and errors[-1] > 2e-13
    return -slope(counts, errors)


@pytest.mark.parametrize(
    ("stages", "counts"),
    [
        (1, (512, 1024, 2048)),
        (2, (256, 512, 1024)),
        (3, (128, 192, 256)),
        (4, (64, 80, 96)),
        (5, (26, 30, 36)),
        (6, (18, 20, 24)),
    ],
)
def test_gauss_legendre_is_of_order_twice_its_stages(stages, counts):
    assert abs(_slope(stages, counts) - 2 * stages) < 0.1
