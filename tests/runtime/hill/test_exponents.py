"""Exponents at given lam2 and lam2 of given exponents: half trace, boundaries, mpmath."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import characteristic_exponents, hill_boundaries
from hill_functions import COSINE, functions

FUNCTIONS = functions()


def bands_of(f, mu, nu, bands=(0, 1, 2), k=0.0):
    return characteristic_exponents(f, None, mu, k, nu=nu, bands=bands)


@pytest.mark.smoke
@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("k", [0.0, 0.05])
def test_the_half_trace_is_the_cosine_of_the_phase(name, k):
    """At 24 points, within the errors themselves, which are small."""
    mu, nu = np.linspace(-1.5, 1.5, 7)[:, None], np.linspace(-0.9, 1.3, 11)
    found = bands_of(FUNCTIONS[name], mu, nu, (0, 1, 2, 5), k)
    (check,) = found.checks.values()
    assert check.value <= 1.0
    assert found.error.max() < 3e-12


@pytest.mark.parametrize("mu", [0.7, -2.0])
def test_the_ends_of_the_bands_are_the_boundaries(mu):
    f = FUNCTIONS["24 harmonics"]
    ends = hill_boundaries(f, mu, (0, 1, 2, 3, 4))
    found = bands_of(f, mu, [0.0, 0.5], (0, 1, 2, 3))
    for band in range(4):
        # Band j reaches from the upper end of region j to the lower one of region j + 1.
        bottom, top = sorted(found.lam2[band])
        slack = found.error[band].max() + ends.error.max()
        assert abs(bottom - ends.upper[band]) <= slack
        assert abs(top - ends.lower[band + 1]) <= slack
        assert np.argmin(found.lam2[band]) == band % 2


def test_exponents_of_a_constant_coefficient():
    lam2, k = np.array([0.3, 2.0, -1.0, 0.01]), 0.2
    found = characteristic_exponents(PeriodicFunction([0.0]), lam2, 0.0, k)
    root = np.sqrt((lam2 - k * k).astype(complex))
    turns = root.real - np.rint(root.real)
    assert np.all(np.abs(found.nu - np.abs(turns)) <= found.error + 1e-15)
    assert np.all(np.abs(found.growth - (np.abs(root.imag) - k)) <= found.error + 1e-15)
    np.testing.assert_array_equal(found.stable, [True, True, False, True])


def test_growth_beyond_doubles_is_said():
    found = characteristic_exponents(COSINE, [-1e5, -100.0], 1.0)
    assert not found.passed
    assert np.isinf(found.growth[0]) and np.isinf(found.error[0])
    assert found.growth[1] == pytest.approx(10.0, abs=0.01)


def test_plot_shapes_and_empty():
    found = bands_of(COSINE, 1.0, np.linspace(0, 0.5, 5))
    assert len(found.plot().lines) == 3
    assert bands_of(COSINE, np.zeros((0, 1)), [0.1, 0.2]).lam2.shape == (3, 0, 2)
    assert bands_of(COSINE, 1.0, 0.1, ()).lam2.shape == (0,)
    with pytest.raises(BadInput, match="slice"):
        bands_of(COSINE, 1.0, 0.1).plot()
