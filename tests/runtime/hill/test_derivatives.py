"""Derivatives of boundaries: differences of certified ends, double edges, exact cases."""

import numpy as np
import pytest
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import boundary_derivatives, critical_damping, hill_boundaries
from hill_functions import COSINE, GENERAL

REGIONS = (1, 2, 3)


def test_at_mu_zero_the_slopes_are_those_of_the_first_order():
    """Smith (7.25): lam2 = n^2/4 - a0 mu -+ |mu| sqrt(an^2 + bn^2) / 2."""
    found = boundary_derivatives(GENERAL, 0.0, (0, 1, 2, 3, 4), ("mu", "K", "a0"))
    half = 0.5 * np.append(GENERAL.amplitudes[1:4], 0.0)
    assert found.double[1:].all() and not found.double[0]
    np.testing.assert_allclose(found.lower[0, 1:], -0.3 - half, rtol=0, atol=1e-13)
    np.testing.assert_allclose(found.upper[0, 1:], -0.3 + half, rtol=0, atol=1e-13)
    assert found.upper[0, 0] == pytest.approx(-0.3, abs=1e-13)
    assert np.isnan(found.lower[:, 0]).all()
    # Damping closes a double edge at once; a change of the mean times mu = 0 does nothing.
    assert np.isnan(found.upper[1, 1:]).all() and np.isnan(found.error[1, 1:]).all()
    np.testing.assert_allclose(found.upper[2], 0.0, atol=1e-15)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_closed_region_opens_with_one_sided_slopes(sign):
    """f = cos 2 theta leaves odd regions closed; cos theta opens them."""
    f, g = PeriodicFunction([0.0, 0.0, 1.0]), PeriodicFunction([0.1, 1.0])
    found = boundary_derivatives(f, 1.0, REGIONS, (g,))
    np.testing.assert_array_equal(found.double, [True, False, True])
    h = sign * 2.0**-20
    base, moved = (hill_boundaries(each, 1.0, REGIONS, certified=True) for each in (f, f + g * h))
    changes = [moved.lower - base.lower, moved.upper - base.upper]
    slopes = np.sort(np.array(changes) / h, axis=0)
    # First differences: the second derivatives, below 5, times the step.
    np.testing.assert_allclose(found.lower[0], slopes[0], rtol=0, atol=1e-5)
    np.testing.assert_allclose(found.upper[0], slopes[1], rtol=0, atol=1e-5)


def test_the_sum_rule_of_the_mean():
    """Adding to the mean moves every boundary by just that, times mu: d lam2 / d a0 = -mu."""
    mu = np.array([[0.5, -1.5]])
    found = boundary_derivatives(GENERAL, mu, (0, 1, 4), ("a0", "mu", "a1", "a2", "a3"), 0.0)
    assert found.lower.shape == (5, 3, 1, 2)
    expected = np.broadcast_to(-mu, (3, 1, 2))
    np.testing.assert_allclose(found.upper[0], expected, rtol=0, atol=1e-14)


def test_closed_regions_give_nan():
    found = boundary_derivatives(COSINE, 0.1, REGIONS, ("mu", "K"), 0.3)
    assert np.isnan(found.lower).all() and np.isnan(found.error).all()


def test_nothing_asked_nothing_given():
    assert boundary_derivatives(COSINE, 1.0, (), ("mu",)).lower.shape == (1, 0)
    assert boundary_derivatives(COSINE, 1.0, (1,), ()).lower.shape == (0, 1)
    assert boundary_derivatives(COSINE, np.zeros(0), (1,)).lower.shape == (1, 1, 0)


@pytest.mark.parametrize("short", [1e-3, 1e-6, 1e-9, 1e-11])
def test_estimates_next_to_the_tip(short):
    """The ends move as ``centre -+ c sqrt(K0 - K)``: both slopes times what is left are known."""
    top = float(critical_damping(COSINE, 1.0, (1,)).damping[0])
    k = top * (1.0 - short)
    found = boundary_derivatives(COSINE, 1.0, (1,), ("K",), k)
    # Slopes of the upper and lower end differ by -c / sqrt(K0 - K), with c from a step away.
    away = top * (1.0 - 1e-2)
    far = boundary_derivatives(COSINE, 1.0, (1,), ("K",), away)
    c = float((far.lower - far.upper)[0, 0]) * np.sqrt(top - away)
    expected = c / np.sqrt(top - k)
    slopes = float((found.lower - found.upper)[0, 0])
    # The next term of the expansion is 1 % of the first where c is taken.
    assert slopes == pytest.approx(expected, rel=0.02)
    # Round-off of K, 1e-16 of it, and of the matrix, a few 1e-15: over twice their distance.
    floor = 0.1 * 1e-16 / short * expected
    assert floor <= found.error[0, 0] < 1e-13 / short * expected + 1e-9


def test_no_derivatives_where_doubles_see_no_two_ends():
    top = float(critical_damping(COSINE, 1.0, (1,)).damping[0])
    for steps in range(-12, 13):
        found = boundary_derivatives(COSINE, 1.0, (1,), ("mu", "K"), top * (1.0 + steps * 2e-16))
        blank = np.isnan(found.error[:, 0])
        assert np.array_equal(np.isnan(found.lower[:, 0]), blank)
        slope = np.abs(found.upper[:, 0])
        assert np.all(blank | (found.error[:, 0] > 1e-7 * slope))
