"""Critical damping and least parameter, and one against the other."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import critical_damping, discriminant
from hill_functions import ANOTHER as GENERAL
from hill_functions import COSINE

REGIONS = (1, 2, 3)


def least_parameter(f, damping, regions=(1, 2)):
    return critical_damping(f, None, regions, damping=damping)


@pytest.mark.parametrize("f", [COSINE, GENERAL], ids=["cosine", "general"])
def test_the_half_trace_touches_its_level_there(f):
    mu = np.array([0.1, 0.7])
    found = critical_damping(f, mu, REGIONS)
    assert found.passed and found.checks
    step = 1e-4 * np.array([-1.0, 0.0, 1.0])[:, None, None]
    half = discriminant(f, found.lam2 + step, mu, found.damping)
    excess = np.abs(half.value) - half.level
    assert np.abs(excess[1]).max() < 1e-12
    assert np.all(excess[[0, 2]] < 0)


def test_no_tongue():
    """f constant, and a region that nothing couples."""
    flat = PeriodicFunction([3.0])
    found = critical_damping(flat, [0.1, 1.0], (1, 2))
    assert np.all(found.damping <= 1e-7)
    assert np.all(found.damping <= found.error + 1e-300)
    least = least_parameter(flat, [0.0, 0.1], (1, 2))
    assert np.all(np.isinf(least.mu)) and least.absent.all()
    third = PeriodicFunction([0.0, 0.0, 0.0, 1.0])
    closed = critical_damping(third, 0.3, (1, 2, 4))
    assert np.all(closed.damping <= closed.error)
    assert least_parameter(third, 0.1, (1, 2)).absent.all()


def test_no_damping():
    np.testing.assert_array_equal(least_parameter(GENERAL, 0.0, REGIONS).mu, 0.0)
    assert least_parameter(COSINE, 0.0, (2,)).mu[0] == 0.0


def test_tiny_tongues_keep_their_digits():
    """Region 4 of a cosine at mu = 1e-3: K is 4e-16, far below the round-off of its ends."""
    found = critical_damping(COSINE, 1e-3, (4,))
    # |B| = mu^4 / 576 to the lowest order, and K = |B| / 4.
    assert found.damping[0] == pytest.approx(1e-12 / 2304, rel=1e-5)
    assert found.error[0] < 1e-10 * found.damping[0]


def test_shapes_and_pictures():
    found = critical_damping(COSINE, np.full((2, 3), 0.1), (1, 2))
    assert found.damping.shape == found.error.shape == (2, 2, 3)
    assert critical_damping(COSINE, [], (1,)).damping.shape == (1, 0)
    assert critical_damping(COSINE, 0.1, ()).damping.shape == (0,)
    least = least_parameter(COSINE, [0.01, 0.02], (1, 2))
    assert least.mu.shape == (2, 2) and least.searched.shape == (2,)
    assert least_parameter(COSINE, [], (1,)).mu.shape == (1, 0)
    assert critical_damping(COSINE, [0.1, 0.2], (1, 2)).plot().lines
    assert least.plot().lines
    with pytest.raises(BadInput, match="plot"):
        found.plot()


@pytest.mark.slow
def test_half_traces_beyond_the_range_of_doubles():
    """Deep wells, by WKB: the exponent is the mean of ``sqrt(-lam2 - mu cos)`` over the turn."""
    mu = np.array([1e3, 3e4])
    found = critical_damping(COSINE, mu, (1,))
    # At the middle of a low gap of a deep well nearly 2 sqrt(2 mu) / pi; less some levels.
    top = 2.0 * np.sqrt(2.0 * mu) / np.pi
    assert np.all(found.damping < top) and np.all(found.damping > top - 3.0)
    assert np.all(found.error < 1e-12 * top + 1e-11)
    assert found.passed
    # The same by the growth of the solution itself.
    k, lam2 = found.damping[0], found.lam2[0]
    half = discriminant(COSINE, lam2, mu, k)
    np.testing.assert_allclose(np.abs(half.value), half.level, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("k", [60.0, 130.0])
def test_least_parameter_of_strong_damping(k):
    found = least_parameter(COSINE, k, (1,))
    assert not found.absent[0] and found.passed
    again = critical_damping(COSINE, found.mu, (1,))
    assert again.damping[0, 0] == pytest.approx(k, abs=1e-9)
    assert 0.0 < found.error[0] < 1e-9 * found.mu[0]


def test_a_maximum_between_two_grid_values_is_seen():
    """Region 2 of cos + 0.05 cos 2 opens, closes near mu = 0.1, and opens again."""
    f = PeriodicFunction([0.0, 1.0, 0.05])
    mu = np.linspace(0.045, 0.055, 2001)
    top = critical_damping(f, mu, (2,)).damping[0].max()
    found = least_parameter(f, top * np.array([0.9999, 1.0001]), (2,))
    assert 0.045 < found.mu[0, 0] < 0.05
    assert found.mu[0, 1] > 0.1
    assert found.passed
