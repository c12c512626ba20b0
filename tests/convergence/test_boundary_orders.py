"""Perturbation boundaries of every order against Hill's matrix: the order by slope."""

import numpy as np
import pytest
from boundary_cases import drag, function, trigonometric
from boundary_truth import MP, boundary
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import perturbation_boundaries
from orders import slope

MIXED = function("mixed")
# The ends of region 1 part at order 2; the uniform form goes through without a loss of order.
LATE = PeriodicFunction(MIXED.a * [1, 0, 1, 1], MIXED.b * [1, 0, 1, 1])
TWO = (trigonometric(11, 2), trigonometric(12, 2))
THREE = (trigonometric(15, 1), trigonometric(16, 2), trigonometric(17, 2, sines=False))


def observed(parts, weights, n, order, friction, power):
    """Return the slopes of the ends' errors over t.

    The parameters are the weights times t, K is ``friction t^power``.
    """
    # Errors of some 1e-9, far above round-off; the next power bends their slopes by 0.16 at most.
    times = 2.0 ** -(26 // (order + 1) + np.arange(2.0))
    parameters, drags = np.multiply.outer(weights, times), friction * times**power
    found = perturbation_boundaries(parts, list(parameters), (n,), order, drags)
    slopes = []
    for side, ends in ((-1, found.lower[0]), (1, found.upper[0]))[n == 0 :]:
        points = zip(ends, parameters.T, drags, strict=True)
        errors = [MP.mpf(x) - boundary(parts, mu, k, n, side, digits=25) for x, mu, k in points]
        slopes.append(slope(times, np.array(errors, dtype=float)))
    return slopes


@pytest.mark.parametrize(
    ("parts", "n", "friction", "power"),
    [
        ([MIXED], 0, 0.0, 1),
        ([MIXED], 1, drag(MIXED, 1, 0.4), 1),
        ([MIXED], 2, 0.0, 1),
        ([function("odd")], 3, 0.0, 1),
        ([function("cosine")], 1, 0.0, 1),
        ([LATE], 1, 0.0, 1),
        # K = beta t^2 leaves such a region open.
        ([LATE], 1, 0.02, 2),
        (TWO, 2, 0.0, 1),
        (THREE, 2, 0.0, 1),
    ],
)
def test_the_first_order_left_out_is_the_error(parts, n, friction, power):
    for order in range(power, 7):
        slopes = observed(parts, [1.0, -0.625, 0.75][: len(parts)], n, order, friction, power)
        np.testing.assert_allclose(slopes, order + 1, atol=0.2)
