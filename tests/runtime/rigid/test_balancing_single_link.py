import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.rigid import (
    balanced_link_inertia,
    density_number,
    offset_function,
    optimal_offset,
)
from elastolink.runtime.rigid.barrier import Cones, PeakProblem
from elastolink.runtime.rigid.descent import local_minimum
from elastolink.runtime.rigid.designs import BalancedLinkDesign
from hypothesis import given
from hypothesis import strategies as st

# M = L = 1, h = 0.1 and these densities are the arbitrary values of Smith's Figs. 23 (b), (c).
DENSITIES = (5.0, 10.0, 20.0, 40.0, 80.0)


def by_quadrature(delta, k, n=4000):
    """Inertia of rod, extension and cylinder by the midpoint rule along the bars."""
    x = (np.arange(n) + 0.5) / n * (1.0 + delta) - delta
    bars = np.mean(x**2) * (1.0 + delta)
    moment = np.mean(x) * (1.0 + delta)
    m = moment / delta  # balances about the pivot
    radius_squared = 2.0 * k * m  # from m = pi r^2 h rho and K = M/(2 pi L^2 h rho)
    return bars + m * (delta**2 + radius_squared / 2.0)


@pytest.mark.parametrize("k", [0.0, 0.02, 0.3, 0.5, 2.0])
def test_inertia_is_that_of_rod_extension_and_cylinder(k):
    for delta in (0.05, 0.3, 0.7, 1.0):
        found = balanced_link_inertia(delta, k)
        # The midpoint rule errs by (1 + delta)^3/(12 n^2), below 5e-8.
        assert found.inertia == pytest.approx(by_quadrature(delta, k), rel=1e-6)


def test_printed_factors_of_the_inertia_are_wrong_and_its_derivative_is_right():
    # Smith prints (1 + delta^2)/2 for the bars; but his derivative has the slope of this function.
    delta, k, step = 0.4, 0.1, 1e-5
    found = balanced_link_inertia(np.array([delta - step, delta, delta + step]), k)
    slope = (found.inertia[2] - found.inertia[0]) / (2.0 * step)
    printed_slope = 0.5 * (1.0 - delta**2) + k / 2.0 * (delta - delta**-3)
    assert found.slope[1] == pytest.approx(printed_slope, rel=1e-12)
    assert slope == pytest.approx(printed_slope, rel=1e-7)

    def printed(d):
        return 0.5 * (1 + d**2) + k / 4.0 * (1 / d - d) ** 2 + 0.5 * (d - d**3)

    assert abs(printed(delta) - found.inertia[1]) > 0.1
    printed_difference = (printed(delta + step) - printed(delta - step)) / (2.0 * step)
    assert abs(printed_difference - printed_slope) > 0.1


def test_slope_by_complex_step():
    rng = np.random.default_rng(1)
    for delta, k in rng.uniform([0.05, 0.0], [1.0, 2.0], (50, 2)):
        z = complex(delta, 1e-30)
        value = 1 / 3 + z / 2 - z**3 / 6 + k / 4 * (1 / z - z) ** 2
        assert balanced_link_inertia(delta, k).slope == pytest.approx(
            value.imag / 1e-30, rel=1e-12, abs=1e-13
        )


@pytest.mark.parametrize("exponent", [-300, -61, -59, -20, -6, -1])
def test_optimal_offset_has_every_digit(exponent):
    with mpmath.workdps(400):
        for mantissa in (1.0, 2.7, 4.9):
            k = mpmath.mpf(float(mantissa * 10.0**exponent))
            found = mpmath.mpf(optimal_offset(float(k)))
            # One Newton step from a double doubles its digits: the root to 30 of them.
            residual = found**3 - k * (1 + found**2)
            exact = found - residual / (3 * found**2 - 2 * k * found)
            assert abs(found / exact - 1) < 4 * np.finfo(float).eps


@given(st.floats(0.0, 0.4999))
def test_optimal_offset_inverts_the_function_of_figure_23_a(k):
    assert offset_function(optimal_offset(k)) == pytest.approx(k, rel=1e-14, abs=0.0)


@pytest.mark.parametrize("k", [1e-4, 0.0199, 0.1, 0.3183, 0.45, 0.7])
def test_root_is_the_least_inertia_of_all_offsets(k):
    delta = np.linspace(0.01, 1.0, 20001)
    inertia = balanced_link_inertia(delta, k).inertia
    best = balanced_link_inertia(optimal_offset(k), k)
    assert best.inertia <= inertia.min() * (1 + 1e-15)
    assert abs(delta[np.argmin(inertia)] - optimal_offset(k)) < 1e-4
    assert abs(best.slope) < 1e-13 * (1.0 + 0.5 * k / optimal_offset(k) ** 3)


def test_full_length_is_a_maximum_below_one_half_and_the_minimum_from_there():
    for k, sign in ((0.3, -1.0), (0.49, -1.0), (0.5, 1.0), (0.6, 1.0), (3.0, 1.0)):
        near, at = balanced_link_inertia(np.array([0.999, 1.0]), k).inertia
        assert (near - at) * sign > 0
        assert (optimal_offset(k) == 1.0) == (k >= 0.5)


def test_smith_densities_all_have_their_minimum_inside():
    numbers = [density_number(1.0, 1.0, 0.1, density) for density in DENSITIES]
    assert max(numbers) < 0.5
    offsets = optimal_offset(np.array(numbers))
    assert np.all(np.diff(offsets) < 0)
    assert np.all((offsets > 0.2) & (offsets < 0.9))


@pytest.mark.parametrize("k", [1e-3, 0.0199, 0.1, 0.3183, 0.45, 0.49, 0.51, 2.0])
def test_optimiser_finds_the_closed_form_optimum_to_1e_10(k):
    basis = np.zeros((1, 1, 4))
    basis[0, 0, 3] = 1.0
    inertia = Cones(0, np.zeros((1, 1)), basis)
    problem = PeakProblem([], [inertia], np.ones(1), np.full(1, np.inf))
    found = local_minimum(problem, BalancedLinkDesign(k), np.array([0.5, 0.75]))
    assert abs(found.x[0] - optimal_offset(k)) < 1e-10
    assert found.value == pytest.approx(
        float(balanced_link_inertia(optimal_offset(k), k).inertia), abs=1e-12
    )


@pytest.mark.parametrize(
    "call",
    [
        lambda: balanced_link_inertia(0.0, 0.1),
        lambda: balanced_link_inertia(1.1, 0.1),
        lambda: balanced_link_inertia(0.5, -0.1),
        lambda: balanced_link_inertia([0.5, 0.6], [0.1, 0.2, 0.3]),
        lambda: balanced_link_inertia("half", 0.1),
        lambda: balanced_link_inertia(np.nan, 0.1),
        lambda: balanced_link_inertia(1e-200, 0.1),
        lambda: optimal_offset(-1.0),
        lambda: optimal_offset([]),
        lambda: offset_function(-0.1),
        lambda: density_number(1.0, 0.0, 1.0, 1.0),
    ],
)
def test_bad_input_is_one_line(call):
    with pytest.raises(BadInput) as caught:
        call()
    assert "\n" not in str(caught.value)


def test_picture_marks_the_minima():
    delta = np.linspace(0.1, 1.0, 50)
    numbers = np.array([[density_number(1.0, 1.0, 0.1, density)] for density in DENSITIES])
    ax = balanced_link_inertia(delta, numbers).plot()
    assert len(ax.lines) == 2 * len(DENSITIES)
