from fractions import Fraction

import numpy as np
import pytest
from elastolink.runtime.benchmarking.records import functions
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from elastolink.runtime.hill.perturbation.boundaries import perturbation_boundaries
from smith_chapter_8.first_order import boundaries as first_order_boundaries

FUNCTIONS = functions()


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_formula(name):
    """Smith (7.46), (7.49), written out once more."""
    f, mu, k = FUNCTIONS[name], np.array([[-1.0, 0.3], [2.0, 0.05]]), 0.01
    found = perturbation_boundaries(f, mu, (1, 2, 3), damping=k, outside="value")
    for i, n in enumerate((1, 2, 3)):
        square = mu**2 * (f.a[n] ** 2 + f.b[n] ** 2) - 4 * k**2 * n**2
        closed = square < 0
        np.testing.assert_array_equal(np.isnan(found.lower[i]), closed)
        np.testing.assert_array_equal(np.isnan(found.error[i]), closed)
        np.testing.assert_array_equal(found.closed[i], closed & ~found.outside[i])
        assert np.all(np.isinf(found.error[i][found.outside[i] & ~closed]))
        half = 0.5 * np.sqrt(square[~closed])
        middle = (n**2 / 4 - f.a[0] * mu)[~closed]
        np.testing.assert_allclose(found.lower[i][~closed], middle - half, rtol=1e-14, atol=1e-15)
        np.testing.assert_allclose(found.upper[i][~closed], middle + half, rtol=1e-14, atol=1e-15)


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("form", ["uniform", "series"])
def test_first_order_is_the_emitted_formula(name, form):
    f, mu, k = FUNCTIONS[name], np.linspace(-0.4, 0.5, 8), 0.002
    found = perturbation_boundaries(f, mu, (1, 2, 3), damping=k, form=form, outside="value")
    for i, n in enumerate((1, 2, 3)):
        centre, square = first_order_boundaries()(
            float(n), mu, float(f.a[0]), float(f.a[n]), float(f.b[n]), k
        )
        open_ = square > 0
        half = np.sqrt(square[open_])
        near = {"rtol": 1e-14, "atol": 1e-15}
        np.testing.assert_allclose(found.lower[i][open_], centre[open_] - half, **near)
        np.testing.assert_allclose(found.upper[i][open_], centre[open_] + half, **near)


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("n", [1, 2, 3])
def test_the_error_falls_with_the_square_of_mu(name, n):
    f = FUNCTIONS[name]
    mu = np.array([4e-3, 2e-3, 1e-3])
    exact, first = hill_boundaries(f, mu, (n,)), perturbation_boundaries(f, mu, (n,))
    for end in ("lower", "upper"):
        gap = np.abs(getattr(exact, end) - getattr(first, end))[0]
        slopes = np.log2(gap[:-1] / gap[1:])
        np.testing.assert_allclose(slopes, 2.0, atol=0.1)


def test_the_error_falls_with_the_square_when_damping_is_of_the_order_of_mu():
    f = FUNCTIONS["f3 (5,1,5,2)"]
    mu = np.array([4e-3, 2e-3, 1e-3])
    k = 0.1 * mu
    exact = hill_boundaries(f, mu, (1,), k)
    first = perturbation_boundaries(f, mu, (1,), damping=k)
    for end in ("lower", "upper"):
        gap = np.abs(getattr(exact, end) - getattr(first, end))[0]
        np.testing.assert_allclose(np.log2(gap[:-1] / gap[1:]), 2.0, atol=0.1)


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("k", [0.0, 0.003, 0.03])
def test_the_error_figure_covers_the_truth_and_is_not_idle(name, k):
    f, mu = FUNCTIONS[name], np.linspace(-1, 1, 41)
    regions = (0, 1, 2, 3, 4)
    exact, first = hill_boundaries(f, mu, regions, k), perturbation_boundaries(f, mu, regions, 1, k)
    ratios = []
    for end in ("lower", "upper"):
        gap = np.abs(getattr(exact, end)[1:] - getattr(first, end)[1:])
        both = ~np.isnan(gap)
        figure = (first.error + exact.error)[1:][both]
        assert np.all(gap[both] <= figure)
        ratios += list(figure[gap[both] > 1e-12] / gap[both][gap[both] > 1e-12])
    inside = ~first.outside[0]
    gap = np.abs(exact.upper[0] - first.upper[0])[inside]
    assert np.all(gap <= (first.error[0] + exact.error[0])[inside])
    assert np.mean(first.outside) < 0.35
    assert np.median(ratios) < 50


def test_the_tip_of_a_damped_tongue():
    """Smith (7.50): the tongue opens at mu = 2 K n / sqrt(an^2 + bn^2)."""
    f, k = FUNCTIONS["f3 (5,1,5,2)"], 0.02
    tip = 2 * k * 2 / np.hypot(f.a[2], f.b[2])
    found = perturbation_boundaries(f, np.array([0.999, 1.001]) * tip, (2,), damping=k)
    assert np.isnan(found.lower[0, 0])
    assert found.width[0, 1] > 0


def test_regions_beyond_the_harmonics_have_no_width():
    found = perturbation_boundaries(PeriodicFunction([0.0, 1.0]), 0.3, (2, 7))
    assert np.all(found.width == 0)


def test_shapes():
    found = perturbation_boundaries(
        PeriodicFunction([0.0, 1.0]), np.zeros((2, 1)), (1, 2, 3), damping=np.zeros(4)
    )
    assert found.lower.shape == found.upper.shape == found.error.shape == (3, 2, 4)


@pytest.mark.parametrize("order", [0, 9, 1.5, True, "one"])
def test_other_orders_are_refused(order):
    with pytest.raises(BadInput, match="order"):
        perturbation_boundaries(PeriodicFunction([0.0, 1.0]), 0.1, (1,), order=order)


@pytest.mark.parametrize(
    "arguments",
    [{"mu": np.nan}, {"mu": 1.0, "damping": -1.0}, {"mu": 1.0, "regions": (0.5,)}],
)
def test_bad_input(arguments):
    with pytest.raises(BadInput):
        perturbation_boundaries(PeriodicFunction([0.0, 1.0]), **arguments)


def test_a_figure_beyond_half_the_width_fails_the_check():
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
