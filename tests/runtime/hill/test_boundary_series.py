"""Power series of the boundaries: published coefficients, exact boundaries, refusals."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.hill.perturbation.coefficients import boundary_series

MIXED = el.PeriodicFunction(a=[0.1, 1.0, 0.4, 0.15], b=[0.0, 0.3, -0.2, 0.1])
MATHIEU = el.PeriodicFunction(a=[0.0, 1.0])


@pytest.mark.parametrize(
    ("n", "upper", "published"),
    [
        # NIST DLMF 28.6(i): a_m and b_m in powers of q, exact rationals; a = 4 lam2, q = 2 mu up
        # to the origin of theta, which turns odd powers about.
        (0, True, {2: -1 / 2, 4: 7 / 128, 6: -29 / 2304, 8: 68687 / 18874368}),
        (1, True, {1: 1, 2: -1 / 8, 3: -1 / 64, 4: -1 / 1536, 5: 11 / 36864, 6: 49 / 589824}),
        (2, False, {2: -1 / 12, 4: 5 / 13824, 6: -289 / 79626240}),
        (2, True, {2: 5 / 12, 4: -763 / 13824, 6: 1002401 / 79626240}),
        (3, True, {2: 1 / 16, 3: 1 / 64, 4: 13 / 20480, 5: -5 / 16384, 6: -1961 / 23592960}),
    ],
)
def test_mathieu(n, upper, published):
    found = boundary_series(MATHIEU, n, 8)
    alpha = found.upper if upper else found.lower
    for power, value in published.items():
        assert 4 * alpha[power - 1] / 2**power == pytest.approx(value, rel=1e-12)
    assert found.passed
    for power in (3, 5, 7) if n % 2 == 0 else ():
        assert abs(alpha[power - 1]) <= found.error[:, power - 1].max() + 1e-17


@pytest.mark.parametrize("n", [0, 1, 2, 3, 5])
@pytest.mark.parametrize("ratio", [0.0, 0.005])
def test_remainder_falls_with_the_next_power(n, ratio):
    order = 3
    if n == 5 and ratio:
        return
    found = boundary_series(MIXED, n, order, ratio)
    gaps = []
    for mu in (0.02, 0.01):
        exact = el.hill_boundaries(MIXED, mu, (n,), damping=ratio * mu)
        powers = mu ** np.arange(1, order + 1)
        ends = 0.25 * n * n + np.array([found.lower @ powers, found.upper @ powers])
        true = (exact.lower[0], exact.upper[0])
        gaps.append(abs(ends[1] - true[1]) if n == 0 else np.abs(ends - true).max())
    assert np.log2(gaps[0] / gaps[1]) == pytest.approx(order + 1, abs=0.25)


def test_no_width_to_first_order():
    gapless = el.PeriodicFunction(a=[0.0, 1.0, 0.0, 0.3], b=[0.0, 0.2, 0.0, 0.0])
    found = boundary_series(gapless, 2, 4)
    assert found.splitting == 2 and found.lower[0] == found.upper[0] == 0.0
    assert found.lower[1] < found.upper[1]
    # A function of period pi leaves the odd regions closed for ever.
    closed = boundary_series(el.PeriodicFunction(a=[0.0, 0.0, 1.0]), 1, 6)
    assert closed.splitting == 0 and np.array_equal(closed.lower, closed.upper)


def test_error_covers_the_exact_coefficients():
    # alpha_2 of region 1 of a cos theta + b sin theta is -(a^2 + b^2)/8 by turning the origin.
    for a, b in ((0.3, 1.7), (1e-3, 2.0), (5.0, 1e-9)):
        f = el.PeriodicFunction(a=[0.0, a], b=[0.0, b])
        found = boundary_series(f, 1, 4)
        size = np.hypot(a, b)
        exact = np.array([0.5, -1 / 8, -1 / 32, -1 / 384]) * size ** np.arange(1, 5)
        assert np.all(np.abs(found.upper - exact) <= found.error[1] + 4e-16 * np.abs(exact))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"region": -1}, "whole numbers >= 0"),
        ({"region": 1, "order": 11}, "from 1 to 10"),
        ({"region": 1, "damping_ratio": -0.1}, "a finite number >= 0"),
        ({"region": 3, "damping_ratio": 0.05}, "closes region 3"),
    ],
)
def test_refusals(arguments, words):
    with pytest.raises(el.BadInput, match=words):
        boundary_series(MIXED, **arguments)


def test_plot():
    ax = boundary_series(MIXED, 2, 2).plot()
    assert {line.get_label() for line in ax.get_lines()} >= {"exact", "order 1", "order 2"}


def test_small_differences_are_not_taken_for_zero():
    # cos theta + 1e-14 cos 2 theta: c_2 itself opens region 2.
    found = boundary_series(el.PeriodicFunction([0.0, 1.0, 1e-14]), 2, 2)
    assert found.splitting == 1
    assert found.upper[0] - found.lower[0] == pytest.approx(1e-14, rel=1e-13, abs=0)
    assert abs(found.upper[1] - found.lower[1]) == pytest.approx(0.5, rel=1e-13)
    # DLMF 28.6.14 for a = 4 lam2, q = 2 mu: a_n - b_n begins with 2 q^n / (4^(n-1) (n-1)!^2).
    for size in (1.0, 1e-3):
        found = boundary_series(el.PeriodicFunction([0.0, size]), 10, 10)
        width = 0.5 * (2 * size) ** 10 / (4.0**9 * 362880.0**2)
        assert found.splitting == 10
        assert found.upper[9] - found.lower[9] == pytest.approx(width, rel=1e-12, abs=0)
    # The same with a fiftieth harmonic, which takes no part.
    a = np.zeros(51)
    a[[1, 50]] = 0.01, 1.0
    found = boundary_series(el.PeriodicFunction(a), 3, 3)
    assert found.splitting == 3 and found.passed
    assert found.upper[2] - found.lower[2] == pytest.approx(0.02**3 / 128, rel=1e-12, abs=0)


def test_a_cancelled_difference_is_zero_within_its_error():
    """Region 4: ``B_2 = c_2^2 / 4 + 2 c_1 c_3 / 3`` vanishes with ``a_3 = -3 a_2^2 / (8 a_1)``."""
    a1, a2 = 0.7, 0.3
    f = el.PeriodicFunction([0.0, a1, a2, -3 * a2 * a2 / (8 * a1)])
    found = boundary_series(f, 4, 4)
    assert found.splitting == 3 and found.passed
    assert found.upper[1] == found.lower[1]
    # Terms of 0.02, some units of round-off.
    assert 1e-17 < found.error[0, 1] < 1e-14
    near = boundary_series(el.PeriodicFunction(f.a * [1, 1, 1, 1 + 1e-9]), 4, 4)
    assert near.splitting == 2


def test_the_error_of_the_function_is_no_difference():
    f = el.PeriodicFunction([0.0, 1.0, 1e-17], error=1e-15)
    found = boundary_series(f, 2, 3)
    assert found.splitting == 2
    assert found.error[0, 0] >= 1e-17
