"""Smith chapter 5: the link that a cylinder on its extension balances on its pivot."""

import mpmath
import numpy as np
import pytest
from elastolink.runtime.gallery.balanced_link import (
    BalancedLink,
    density_number,
    offset_function,
    optimal_offset,
)

MP = mpmath.mp.clone()
MP.dps = 400


@pytest.mark.parametrize("k", [0.0, 0.02, 0.3, 0.5, 2.0])
def test_inertia_and_slope_are_those_of_rod_extension_and_cylinder(k):
    """In 400 digits: bars from -delta to 1, a disc of radius^2 = 2 K m at -delta."""

    def exact(delta):
        disc = (1 - delta**2) / (2 * delta)
        return (1 + delta**3) / 3 + disc * delta**2 + disc * (2 * MP.mpf(k) * disc) / 2

    for delta in np.linspace(0.05, 1.0, 40):
        link = BalancedLink(delta, k)
        assert abs(link.inertia / exact(MP.mpf(float(delta))) - 1) < 8 * np.finfo(float).eps
        slope = MP.diff(exact, MP.mpf(float(delta)), h=MP.mpf(10) ** -100)
        assert float(link.slope) == pytest.approx(float(slope), rel=1e-12, abs=1e-13)


def test_printed_factors_of_the_inertia_are_wrong_and_its_derivative_is_right():
    # Smith prints (1 + delta^2)/2 for the bars; but his derivative has the slope of this function.
    delta, k = 0.4, 0.1
    link = BalancedLink(delta, k)
    printed = 0.5 * (1 + delta**2) + k / 4 * (1 / delta - delta) ** 2 + 0.5 * (delta - delta**3)
    assert abs(printed - link.inertia) > 0.1
    assert link.slope == pytest.approx(0.5 * (1 - delta**2) + k / 2 * (delta - delta**-3))


@pytest.mark.parametrize("exponent", [-300, -61, -59, -20, -6, -1])
def test_optimal_offset_has_every_digit(exponent):
    for mantissa in (1.0, 2.7, 4.9):
        k = MP.mpf(float(mantissa * 10.0**exponent))
        offset = MP.mpf(float(optimal_offset(float(k))))
        # One Newton step from a double doubles its digits: the root to 30 of them.
        residual = offset**3 - k * (1 + offset**2)
        exact = offset - residual / (3 * offset**2 - 2 * k * offset)
        assert abs(offset / exact - 1) < 4 * np.finfo(float).eps


@pytest.mark.parametrize("k", [1e-4, 0.0199, 0.1, 0.3183, 0.45, 0.7, 3.0])
def test_root_is_the_least_inertia_of_all_offsets(k):
    delta, best = np.linspace(0.01, 1.0, 20001), optimal_offset(k)
    inertia = BalancedLink(delta, k).inertia
    assert BalancedLink(best, k).inertia <= inertia.min() * (1 + 1e-15)
    assert abs(delta[np.argmin(inertia)] - best) < 1e-4
    # From K = 1/2 on no counterweight at all is best.
    assert (best == 1.0) == (k >= 0.5)
    assert k >= 0.5 or offset_function(best) == pytest.approx(k, rel=1e-14)


def test_smith_densities_all_have_their_minimum_inside():
    # M = L = 1, h = 0.1 and these densities are the values of Smith's Figs. 23 (b), (c).
    numbers = np.array(
        [density_number(1.0, 1.0, 0.1, rho) for rho in (5.0, 10.0, 20.0, 40.0, 80.0)]
    )
    offsets = optimal_offset(numbers)
    assert np.all(np.diff(offsets) < 0) and np.all((offsets > 0.2) & (offsets < 0.9))
