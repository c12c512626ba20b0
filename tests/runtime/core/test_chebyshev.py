import numpy as np
import pytest
from elastolink.runtime.core import chebyshev


@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (9, 1), (9, 4), (4, 9)])
def test_points_and_tensor_agree(shape):
    rng = np.random.default_rng(0)
    c, x, y = rng.uniform(-1, 1, shape), rng.uniform(-1, 1, 13), rng.uniform(-1, 1, 11)
    grid = chebyshev.tensor_values(c, x, y)
    expected = np.polynomial.chebyshev.chebgrid2d(x, y, c)
    np.testing.assert_allclose(grid, expected, atol=1e-13)
    points = chebyshev.point_values(c, np.repeat(x, 11), np.tile(y, 13))
    np.testing.assert_allclose(points.reshape(13, 11), expected, atol=1e-13)


def test_length_and_unit():
    assert chebyshev.length(np.array([1.0, 0.1, 0.0, 1e-3, 1e-9]), 1e-6) == 4
    assert chebyshev.length(np.zeros(4), 1e-6) == 1
    values = np.array([2.0, 3.0, 4.0])
    np.testing.assert_array_equal(chebyshev.unit(values, 2.0, 4.0), [-1.0, 0.0, 1.0])
    np.testing.assert_array_equal(chebyshev.unit(values, 2.0, 2.0), 0.0)
