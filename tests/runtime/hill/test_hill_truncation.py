"""The proved parts by themselves: truncation, coarse isolation, integer products."""

from fractions import Fraction

import numpy as np
import pytest
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.exact.integer_products import (
    FUNCTION_BITS,
    VECTOR_BITS,
    HillOperator,
    Wave,
    _packed,
    _unpacked,
    inner,
    root_above,
    wave,
)
from elastolink.runtime.hill.exact.isolation import cluster, spectrum
from elastolink.runtime.hill.exact.layout import banded, layout, stacked, truncation
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from hypothesis import given, settings
from hypothesis import strategies as st

GENERAL = PeriodicFunction([0.3, 1.0, -0.4, 0.2], [0.0, 0.5, 0.7, -0.1])


def random_function(rng):
    count = int(rng.choice([1, 2, 4, 12, 30]))
    size = rng.uniform(0.3, 0.95) ** np.arange(count + 1)
    a, b = rng.normal(size=(2, count + 1)) * size
    a[0] = b[0] = 0.0
    return PeriodicFunction(a, b)


def test_the_bound_of_the_truncation_holds_and_is_of_use():
    """Matrices cut early, against certified ends: never below, never above by more than said."""
    rng = np.random.default_rng(31)
    shares = []
    for _ in range(40):
        f, mu = random_function(rng), float(10 ** rng.uniform(-1, 1.5))
        goal = float(10 ** rng.uniform(-9, -2))
        cut = truncation(f, mu, 4, goal=goal)
        assert cut.left_out <= goal * 1.0001
        truth = hill_boundaries(f, mu, (1, 2, 3, 4), certified=True)
        for odd, rows in ((1, (0, 2)), (0, (1, 3))):
            values = np.linalg.eigvalsh(stacked(f, odd, cut.harmonic + odd, np.array([mu]))[0])
            for row in rows:
                n = row + 1
                excess = values[n - 1 : n + 1] - [truth.lower[row], truth.upper[row]]
                noise = 4 * 2.2e-16 * cut.norm
                assert np.all(excess >= -noise)
                assert np.all(excess <= cut.left_out + noise)
                shares.append(excess.max() / cut.left_out)
    # A majorant of eigenvectors is not sharp, and covers the highest region; but it is not idle.
    assert np.max(shares) > 1e-6


def test_the_cut_grows_slowly_with_the_goal():
    sizes = [truncation(GENERAL, 1.0, 6, goal=10.0**-e).harmonic for e in (5, 10, 20, 30)]
    assert sizes == sorted(sizes) and sizes[-1] <= 2 * sizes[0] + 10


@pytest.mark.parametrize("odd", [0, 1])
def test_isolation_covers_the_eigenvalues(odd):
    rng = np.random.default_rng(32)
    for _ in range(15):
        f, mu = random_function(rng), float(10 ** rng.uniform(-2, 1.5))
        found = spectrum(f, mu, odd, 4 + odd)
        regions = (1, 3) if odd else (2, 4)
        truth = hill_boundaries(f, mu, regions, certified=True)
        for row, n in enumerate(regions):
            ends = [truth.lower[row], truth.upper[row]]
            assert np.all(np.abs(found.values[n - 1 : n + 1] - ends) <= found.reach)
        assert found.reach < 1e-5


def test_clusters_join_what_is_close():
    f = PeriodicFunction([0.0, 0.0, 1.0])
    found = spectrum(f, 1.0, 1, 5)
    assert cluster(found, (0, 0)) == cluster(found, (1, 1)) == (0, 1)
    assert cluster(found, (4, 4)) is None
    apart = spectrum(GENERAL, 1.0, 1, 5)
    assert cluster(apart, (0, 0)) == (0, 0)


@pytest.mark.parametrize("odd", [0, 1])
@pytest.mark.parametrize("k", [0.0, 0.0625])
def test_the_integer_operator_is_the_matrix(odd, k):
    """On random integer vectors, against sums of fractions over the float matrix's definition."""
    size = layout(odd, 6 + odd).squares.size
    x = np.random.default_rng(1).normal(size=size)
    x /= np.linalg.norm(x)
    # Dyadic coefficients, so that the float matrix is exact but for the root of 1/2.
    f = PeriodicFunction([0.25, 1.0, -0.5], [0.0, 0.5, 0.75])
    image = HillOperator(f, 0.5, k)(wave(odd, x))
    wide = stacked(f, odd, 8 + odd, np.array([0.5]))[0]
    number = np.sqrt(layout(odd, 8 + odd).squares)
    cos = np.arange(1 - odd, number.size, 2)
    wide[cos + 1, cos] += 2 * k * number[cos]
    wide[cos, cos + 1] -= 2 * k * number[cos]
    expected = wide[:, :size] @ x
    unit = 2.0 ** -(VECTOR_BITS + FUNCTION_BITS + 2)
    got = np.stack([np.array(image.alpha, float), np.array(image.beta, float)], axis=1) * unit
    got = got.ravel()
    if not odd:
        got = np.concatenate([[got[0] * np.sqrt(2)], got[2:]])
    np.testing.assert_allclose(got, expected, rtol=0, atol=1e-13)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(-(2**70), 2**70), min_size=1, max_size=9), st.integers(9, 12))
def test_packing_is_undone(values, size):
    assert _unpacked(_packed(values, size), size, len(values)) == values


@settings(max_examples=60, deadline=None)
@given(st.fractions(min_value=0, max_value=10**12))
def test_roots_are_bounded_from_above_and_tightly(value):
    root = root_above(value)
    assert root * root >= value
    assert root * root <= value * (1 + Fraction(1, 10**15)) + Fraction(1, 10**30)


def test_inner_products_count_the_constant_twice():
    one = Wave(0, [3, 0], [0, 0])
    assert inner(one, one) == 18
    assert inner(Wave(1, [3, 1], [2, 0]), Wave(1, [1, 1], [5, 7])) == 14


@pytest.mark.parametrize("odd", [0, 1])
@pytest.mark.parametrize("harmonic", [1, 2, 9])
def test_the_band_is_that_of_the_dense_matrix(odd, harmonic):
    band = banded(GENERAL, odd, harmonic + odd, 0.7)
    dense = stacked(GENERAL, odd, harmonic + odd, np.array([0.7]))[0]
    n = len(dense)
    for i in range(n):
        expected = np.diagonal(dense, -i)
        ours = band[i, : n - i] if i < len(band) else np.zeros(n - i)
        np.testing.assert_allclose(ours, expected, rtol=0, atol=1e-16)


@pytest.mark.parametrize(
    "f",
    [PeriodicFunction([0.5]), PeriodicFunction([0.0], [0.0, 1.0]), PeriodicFunction([0.0, 0.0])],
)
@pytest.mark.parametrize("k", [0.0, 0.1])
def test_poor_functions(f, k):
    plain = hill_boundaries(f, 1.5, (0, 1, 2), k)
    proved = hill_boundaries(f, 1.5, (0, 1, 2), k, certified=True)
    assert proved.passed
    np.testing.assert_array_equal(np.isnan(plain.upper), np.isnan(proved.upper))
    there = ~np.isnan(plain.upper)
    assert np.all(np.abs(plain.upper - proved.upper)[there] <= plain.error[there] + 1e-16)
