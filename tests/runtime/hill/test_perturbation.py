"""Perturbation boundaries: exact coefficients, flags, extremes."""

import tracemalloc
from fractions import Fraction

import numpy as np
import pytest
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import (
    PerturbationBoundaries,
    critical_damping,
    hill_boundaries,
    perturbation_boundaries,
)
from hill_functions import ANOTHER as GENERAL
from hill_functions import COSINE, general
from hypothesis import given, settings
from hypothesis import strategies as st


def test_an_error_beyond_half_the_width_fails_the_check():
    f = PeriodicFunction([0.0, 1.0, 0.2])
    assert perturbation_boundaries(f, [0.0, 0.05], (1, 2)).passed
    assert not perturbation_boundaries(f, [0.0, 3.0], (1, 2)).passed
    assert "error over half the width" not in perturbation_boundaries(f, 0.1, (3,)).checks


def test_parameters_that_cancel_at_one_point():
    """1e15 cos - 3e15 (cos / 3): the sum is exact in fractions, and known to 0.1 in doubles."""
    third = 1.0 / 3.0
    functions = (PeriodicFunction([0.0, 1.0]), PeriodicFunction([0.0, third]))
    for scale in (1e10, 1e12, 1e15):
        mu = [scale + 0.1, -3.0 * scale]
        left = float(Fraction(mu[0]) + Fraction(mu[1]) * Fraction(third))
        found = perturbation_boundaries(functions, mu, (1,), order=2)
        exact = hill_boundaries(functions[0], left, (1,))
        told = found.error[0] + exact.error[0]
        assert not abs(found.lower[0] - exact.lower[0]) > told
        assert not abs(found.upper[0] - exact.upper[0]) > told


EPS = 2.0**-52
MIXED = general(6)
SECOND = PeriodicFunction([-0.1, 0.2, 0.5], [0.0, 0.7, -0.2])

# Radii of convergence in q, DLMF table 28.6.1: the series of a_0 and a_2; of b_2; of a_1 and b_1.
RADII = {0: 1.4687686138, 1: 3.7699574940, 2: 1.4687686138}


@pytest.mark.parametrize("n", RADII)
def test_nothing_is_given_beyond_the_radius_of_convergence(n):
    q = RADII[n] * np.array([0.3, 0.45, 1.3, 2.0, 10.0])
    for order in range(2, 9):
        found = perturbation_boundaries(COSINE, 0.5 * q, (n,), order)
        np.testing.assert_array_equal(found.outside[0], [False, False, True, True, True])


@pytest.mark.parametrize(("order", "k"), [(2, 0.0), (3, 0.001), (8, 0.0), (8, 0.001)])
@pytest.mark.parametrize("parts", [(GENERAL, SECOND), (GENERAL, SECOND, COSINE)])
def test_several_parameters_are_one_function(parts, order, k):
    eps = np.random.default_rng(8).uniform(-0.15, 0.15, (len(parts), 3))
    found = perturbation_boundaries(parts, list(eps), range(4), order, k)
    assert isinstance(found, PerturbationBoundaries)
    assert found.parameters.shape == eps.shape and found.outside.shape == (4, 3)
    np.testing.assert_array_equal(found.mu, eps[0])
    for j, point in enumerate(eps.T):
        whole = sum((f * float(x) for f, x in zip(parts, point, strict=True)), PeriodicFunction())
        one = perturbation_boundaries(whole, 1.0, range(4), order, k)
        np.testing.assert_allclose(found.lower[:, j], one.lower, rtol=2e-15, atol=1e-17)
        np.testing.assert_allclose(found.upper[:, j], one.upper, rtol=2e-15, atol=1e-17)
        # A single point of several parameters takes another way: one function.
        single = perturbation_boundaries(parts, list(point), range(4), order, k)
        np.testing.assert_allclose(single.upper, one.upper, rtol=2e-15, atol=1e-17)
        np.testing.assert_allclose(single.error, one.error, rtol=1e-3, atol=EPS)


def test_the_uniform_form_holds_where_c_n_vanishes():
    """The second harmonic of f and the second order of the first cancel: a kink, not a root."""
    mu = 0.1
    f = PeriodicFunction([0.0, 1.0, -0.5 * mu])
    exact = hill_boundaries(f, mu, (2,))
    for order in (3, 5):
        found = perturbation_boundaries(f, mu, (2,), order)
        assert not found.outside.any()
        gap = max(abs(found.upper - exact.upper)[0], abs(found.lower - exact.lower)[0])
        assert gap <= found.error[0] + exact.error[0]
        assert gap < 10 * mu ** (order + 1)


def test_open_closed_flagged_and_undecided_are_told_apart():
    f, n = GENERAL, 1
    tip = 0.5 * f.amplitudes[n] * 0.05
    k = tip * np.array([0.5, 1.5])
    found = perturbation_boundaries(f, [0.05, 0.05], (n,), 6, k)
    np.testing.assert_array_equal(found.closed[0], [False, True])
    np.testing.assert_array_equal(np.isnan(found.upper[0]), [False, True])
    assert not found.outside.any() and not found.undecided.any()
    far = perturbation_boundaries(f, [5.0, 5.0], (n,), 6, k)
    assert far.outside.all() and not far.closed.any() and np.isnan(far.lower).all()
    assert not far.passed and found.passed


@pytest.mark.parametrize(
    "cases", [pytest.param(20, id="some"), pytest.param(200, id="all", marks=pytest.mark.slow)]
)
def test_nothing_certain_is_false_about_the_tip(cases):
    """Damping within 1e-7 to a third of the critical one, which the half trace gives."""
    rng = np.random.default_rng(23)
    seen = 0
    for _ in range(cases):
        whole = general(int(rng.choice([1, 2, 3, 5, 8, 24])), rng.uniform(0.3, 0.95), rng)
        n, order = int(rng.integers(1, 7)), int(rng.integers(1, 9))
        mu = 10.0 ** rng.uniform(-3, 0.6, 4) / whole.bound()
        truth = critical_damping(whole, mu, (n,))
        k = truth.damping[0] * (1 + rng.normal(size=4) * 10.0 ** rng.uniform(-7, -0.5, 4))
        k = np.maximum(k, 0.0)
        apart = np.abs(k - truth.damping[0]) > 4 * truth.error[0]
        found = perturbation_boundaries(whole, mu, (n,), order, k)
        sure = apart & ~found.outside[0] & ~found.undecided[0]
        np.testing.assert_array_equal(found.closed[0][sure], (k > truth.damping[0])[sure])
        seen += np.count_nonzero(sure)
    assert seen > cases


@pytest.mark.parametrize("order", [1, 4, 8])
@pytest.mark.parametrize("mu", [0.0, 5e-324, -1e-200, 1e-20])
def test_mu_hardly_there(mu, order):
    found = perturbation_boundaries(MIXED, mu, range(8), order)
    levels = np.arange(8) ** 2 / 4
    np.testing.assert_allclose(found.upper, levels, atol=3 * abs(mu), rtol=EPS if mu else 0)
    np.testing.assert_allclose(found.lower[1:], levels[1:], atol=3 * abs(mu), rtol=EPS if mu else 0)
    assert found.lower[0] == -np.inf
    assert np.all(found.error <= 16 * EPS * (levels + 1))
    assert not found.outside.any() and not found.closed.any()


@pytest.mark.parametrize("damping", [0.0, 1.0])
@pytest.mark.parametrize("mu", [1e3, 1e150, -1.7e308])
def test_mu_beyond_all_bounds_is_flagged(damping, mu):
    found = perturbation_boundaries(MIXED, [mu, 0.0], (0, 1, 2), 8, damping)
    assert found.outside[:, 0].all()
    assert np.isnan(found.upper[:, 0]).all()
    assert np.isnan(found.error[:, 0]).all()
    assert found.checks["entries outside the estimated range"].value == 3
    assert not found.passed
    told = perturbation_boundaries(MIXED, [mu, 0.0], (0, 1), 8, damping, outside="value")
    # The number where there is one, with no claim about it.
    gone = np.isnan(told.upper[:, 0])
    assert np.all(np.isposinf(told.error[:, 0]) | gone)
    assert not gone.any() or abs(mu) > 1e30


@pytest.mark.parametrize("f", [PeriodicFunction(), PeriodicFunction([0.7])], ids=["zero", "one"])
def test_a_constant_has_no_width(f):
    found = perturbation_boundaries(f, [0.3, -40.0], range(5), 8)
    levels = np.arange(5)[:, None] ** 2 / 4 - f.mean * np.array([0.3, -40.0])
    np.testing.assert_allclose(found.upper, levels, rtol=2 * EPS, atol=2 * EPS)
    np.testing.assert_array_equal(found.lower[1:], found.upper[1:])
    assert not found.outside.any()
    drag = perturbation_boundaries(f, 0.3, (1, 2), 8, 0.01)
    assert drag.closed.all()


@pytest.mark.parametrize("damping", [0.0, 1e-3])
def test_memory_of_order_eight(damping):
    """The columns hold 24 x 8 harmonics on either side, times the monomials of two parameters."""
    f = general(24)
    tracemalloc.start()
    try:
        perturbation_boundaries(f, np.linspace(-0.1, 0.1, 100_000), (1,), 8, damping)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    # Five results of 1e5 doubles and what blocks of 4096 points take.
    assert peak < 1e8


@pytest.mark.parametrize(
    ("harmonics", "fall", "n"), [(8, 0.7, 50), (8, 0.7, 100), (8, 0.7, 400), (60, 0.99, 50)]
)
def test_very_high_regions(harmonics, fall, n):
    f, mu = general(harmonics, fall), np.array([1e-3, 0.01, 0.1, 0.4, -0.9])
    found, exact = perturbation_boundaries(f, mu, (n,), 8), hill_boundaries(f, mu, (n,))
    for end in ("lower", "upper"):
        gap = np.abs(getattr(found, end) - getattr(exact, end))
        assert not np.any(gap > found.error + exact.error)
    if harmonics < n:
        # Far from resonance with any harmonic the gap is narrower than round-off.
        assert np.all(found.width <= 2 * found.error) and not found.outside.any()
    else:
        assert np.any(found.width > 1e-4)


@settings(max_examples=25, deadline=None)
@given(
    n=st.integers(0, 12),
    order=st.integers(1, 8),
    mu=st.floats(-1e3, 1e3),
    k=st.one_of(st.just(0.0), st.floats(0.0, 2.0)),
    a=st.lists(st.floats(-2, 2), min_size=1, max_size=5),
    b=st.lists(st.floats(-2, 2), min_size=0, max_size=4),
)
def test_anything_finite_is_answered_or_flagged(n, order, mu, k, a, b):
    f = PeriodicFunction(a, [0.0, *b])
    found = perturbation_boundaries(f, mu, (n,), order, k)
    upper, error = found.upper[0], found.error[0]
    assert np.isnan(upper) == bool(found.outside[0] or found.closed[0])
    assert np.isnan(upper) or (np.isfinite(error) and error >= 0.0)
    if n and not np.isnan(upper):
        assert found.lower[0] <= upper
    again = perturbation_boundaries(f, mu, (n,), order, k)
    np.testing.assert_array_equal(again.upper, found.upper)
    np.testing.assert_array_equal(again.error, found.error)


def test_no_points_and_no_regions():
    assert perturbation_boundaries(COSINE, np.zeros((0, 3)), (1, 2)).lower.shape == (2, 0, 3)
    assert perturbation_boundaries(COSINE, 0.1, ()).lower.shape == (0,)
