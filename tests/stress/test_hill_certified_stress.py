"""Hard cases of exact boundaries, plain and certified: right answers or a clear refusal."""

from fractions import Fraction

import numpy as np
import pytest
from boundary_cases import rough
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.exact.derivatives import boundary_derivatives
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from elastolink.runtime.hill.exact.quasi import bloch_bands

COSINE = PeriodicFunction([0.0, 1.0])


def agree(f, mu, regions, damping=0.0):
    """Plain and certified boundaries, each within the other's figure; the certified ones."""
    plain = hill_boundaries(f, mu, regions, damping)
    proved = hill_boundaries(f, mu, regions, damping, certified=True)
    assert proved.passed
    np.testing.assert_array_equal(np.isnan(plain.upper), np.isnan(proved.upper))
    for end in ("lower", "upper"):
        ours, truth = getattr(plain, end), getattr(proved, end)
        there = np.isfinite(truth)
        slack = (plain.error + proved.error)[there]
        assert np.all(np.abs(ours[there] - truth[there]) <= slack)
    return proved


@pytest.mark.parametrize("mu", [1e-300, -1e-100, 1e-20, 1e-8])
def test_mu_tends_to_zero(mu):
    found = agree(COSINE, mu, (0, 1, 2, 3))
    # First order: region 1 is |mu| wide; second order: the others stand at n^2/4 to mu^2.
    low, high = found.enclosure("lower", 1), found.enclosure("upper", 1)
    assert low[0] <= Fraction(1, 4) - Fraction(abs(mu)) / 2 + Fraction(mu) ** 2
    assert high[1] >= Fraction(1, 4) + Fraction(abs(mu)) / 2 - Fraction(mu) ** 2
    if abs(mu) >= 1e-20:
        assert not found.pair[1]
        width = float(high[0] - low[1])
        assert width == pytest.approx(abs(mu), rel=1e-5)
    else:
        assert found.pair[1]


@pytest.mark.parametrize("mu", [100.0, -1e4, 1e5])
def test_mu_is_large(mu):
    """Deep wells: lam2 < 0, regions that cover all but a hair."""
    found = agree(COSINE, mu, (0, 1, 2, 3))
    assert np.all(found.upper < 0.0)
    assert found.error.max() < 1e-15 * abs(mu)
    # The stable band between two regions narrows like exp(-8 sqrt(|mu| / 2)) or so; the ends
    # belong to the two problems, so that each is enclosed by itself.
    if abs(mu) <= 1e4:
        gap = found.enclosure("lower", 1)[1] - found.enclosure("upper", 0)[0]
        assert gap >= 0


def test_beyond_what_can_be_settled_is_refused():
    for certified in (False, True):
        with pytest.raises(BadInput, match="2048 harmonics"):
            hill_boundaries(COSINE, 1e9, (1,), certified=certified)
        with pytest.raises(BadInput, match="at most 2048"):
            hill_boundaries(COSINE, 1.0, (4000,), certified=certified)


def test_large_sparse_problems_agree_with_the_dense_ones():
    """Band and dense reductions at the same size, in both problems."""
    f = PeriodicFunction([0.1, 1.0, -0.3], [0.0, 0.4, 0.2])
    band = hill_boundaries(f, 5e3, (1, 2, 7))
    proved = hill_boundaries(f, 5e3, (1, 2, 7), certified=True)
    assert np.all(np.abs(band.lower - proved.lower) <= band.error + proved.error)
    assert np.all(np.abs(band.upper - proved.upper) <= band.error + proved.error)
    assert band.error.max() < 1e-13 * 5e3


def test_regions_far_apart():
    found = hill_boundaries(COSINE, 1.0, (1, 1000))
    # Region 1000 stands at n^2/4 + mu^2 / (2 (n^2 - 1)), closed to every digit.
    assert abs(found.lower[1] - 250000.0 - 0.5 / 999999.0) <= found.error[1]
    alone = hill_boundaries(COSINE, 1.0, (1,))
    assert abs(found.lower[0] - alone.lower[0]) <= found.error[0] + alone.error[0]


def test_coefficients_that_vanish_exactly():
    """f = cos 3 theta: c_1 = c_2 = 0, and only regions 3, 6, ... open, to all orders."""
    f = PeriodicFunction([0.0, 0.0, 0.0, 1.0])
    found = agree(f, 2.0, (1, 2, 3, 4, 5, 6))
    np.testing.assert_array_equal(found.pair, [True, True, False, True, True, False])


@pytest.mark.parametrize("b", [0.125, -0.25, 0.5])
def test_coexistence_in_the_whittaker_hill_equation(b):
    """cos theta + b cos 2 theta closes all even regions at mu = 2 b, odd ones from 3 on at 8 b.

    There it is Ince's equation with polynomial solutions; b and mu are exact in doubles.
    """
    f, regions = PeriodicFunction([0.0, 1.0, b]), (1, 2, 3, 4, 5, 6)
    for mu, closed in ((2 * b, (2, 4, 6)), (8 * b, (3, 5))):
        found = agree(f, mu, regions)
        np.testing.assert_array_equal(found.pair, [n in closed for n in regions])
        for i in np.flatnonzero(found.pair):
            low, high = found.enclosure("lower", i), found.enclosure("upper", i)
            assert max(low[0], high[0]) <= min(low[1], high[1])
    for mu in (2 * b + 2.0**-40, 2 * b - 2.0**-40):
        # 1e-12 beside it region 2 is open, by less than doubles show, and that is proved.
        other = hill_boundaries(f, mu, (2,), certified=True)
        gap = float(other.enclosure("upper", 0)[0] - other.enclosure("lower", 0)[1])
        assert 1e-15 < gap < 1e-11 and not other.pair[0]


def test_coexistence_of_lames_equation():
    """2 m sn^2: one gap; all others are closed, for a function known to 1e-15 only.

    The certificate is for the rounded coefficients: gaps of the size of their errors may show.
    """
    from scipy.special import ellipj, ellipk

    m = 0.5
    scale = ellipk(m) / np.pi
    f = PeriodicFunction.from_callable(
        lambda theta: -2 * m * ellipj(theta * scale, m)[0] ** 2 * scale**2
    )
    found = agree(f, 1.0, (1, 2, 3, 4))
    assert found.upper[0] - found.lower[0] > 0.1
    assert np.all(found.width[1:] <= 2 * (found.function_error + found.error[1:]))


def test_three_equal_wells_make_clusters():
    """cos 3 theta, deep: three nearly equal levels in every group, told apart or held together."""
    f = PeriodicFunction([0.0, 0.0, 0.0, 1.0])
    found = agree(f, 400.0, (0, 1, 2, 3, 4, 5))
    for n in (1, 2, 4, 5):
        assert found.pair[n]
    # Levels r of the well in 3 theta: mu/9 in Mathieu's equation, whose own ends these are.
    same = agree(COSINE, 400.0 / 9, (0, 1, 2))
    np.testing.assert_allclose(found.upper[[0, 3]], 9 * same.upper[[0, 1]], rtol=1e-15)


@pytest.mark.parametrize("certified", [False, True])
def test_damping_at_and_beyond_critical(certified):
    k = np.array([0.0, 1e-12, 0.5, 1.0, 50.0])
    found = hill_boundaries(COSINE, 0.3, (0, 1, 2), k, certified=certified)
    assert np.isfinite(found.upper[0]).all()
    assert np.isnan(found.upper[1:, 2:]).all()
    assert np.isfinite(found.upper[1, :2]).all()
    if certified:
        assert found.passed and found.closed[1:, 2:].all()
    # Region 0 ends where lam2 = 0 is balanced: K^2 moves it up, the coupling down.
    assert np.all(found.upper[0] <= 0.0)


def test_damping_so_small_that_it_does_nothing():
    sharp = hill_boundaries(COSINE, 0.3, (1, 2), certified=True)
    found = hill_boundaries(COSINE, 0.3, (1, 2), 1e-200, certified=True)
    for end in ("lower", "upper"):
        for i in range(2):
            a, b = sharp.enclosure(end, i), found.enclosure(end, i)
            assert a[0] <= b[1] and b[0] <= a[1]


@pytest.mark.slow
def test_a_thousand_harmonics_certified():
    found = agree(rough(1000), 0.3, (1, 2))
    assert found.error.max() < 1e-13


def test_a_hundred_and_fifty_rough_harmonics_certified():
    f = rough(150)
    found = agree(f, 0.7, (0, 1, 2, 3))
    assert found.error.max() < 1e-14
    assert not found.pair.any()


@pytest.mark.parametrize("mu", [1e-300, 1e4, -300.0])
def test_bands_and_derivatives_at_the_extremes(mu):
    bands = bloch_bands(COSINE, mu, [0.0, 0.25, 0.5], (0, 1))
    assert np.all(np.diff(bands.lam2, axis=0) >= -bands.error[1:])
    found = boundary_derivatives(COSINE, mu, (1, 2), ("mu",))
    if abs(mu) > 1.0:
        # Levels of the oscillator: -|mu| + (r + 1/2) sqrt(2 |mu|) - ...
        r = np.array([0, 1])
        slope = np.sign(mu) * (-1 + (r + 0.5) / np.sqrt(2 * abs(mu)))
        np.testing.assert_allclose(found.lower[0], slope, rtol=0, atol=1e-4)
    else:
        np.testing.assert_allclose(found.upper[0], [0.5, 0.0], rtol=0, atol=1e-14)
