"""Strutt charts: exact boundaries, damping, multipliers, and that the checks see mistakes."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.core.plotting import new_figure
from elastolink.runtime.hill import multiplier_surfaces, strutt_chart
from elastolink.runtime.hill.cases import strutt
from elastolink.runtime.hill.cases.surfaces import boundary_fitted_grid
from elastolink.runtime.hill.half_trace import discriminant
from elastolink.runtime.hill.perturbation.thresholds import least_parameter
from scipy.integrate import solve_ivp
from scipy.special import mathieu_a, mathieu_b

OTHER = PeriodicFunction([0.2, 0.5, 0.3], [0.0, -0.4, 0.6])


def matrix(d, eps, damping, function):
    """Return the monodromy matrix over pi by marching."""
    columns = [
        solve_ivp(
            lambda t, y: [y[1], -2.0 * damping * y[1] - (d + eps * function(2.0 * t)) * y[0]],
            (0.0, np.pi),
            start,
            method="DOP853",
            rtol=1e-12,
            atol=1e-13,
        ).y[:, -1]
        for start in ([1.0, 0.0], [0.0, 1.0])
    ]
    return np.stack(columns, axis=1)


def test_boundaries_are_mathieus_characteristic_values():
    chart = strutt_chart(points=(41, 21))
    assert chart.passed and chart.regions == (0, 1, 2, 3, 4)
    # y'' + (a - 2 q cos 2t) y = 0: q = -eps / 2; the sign of eps shifts t alone.
    q = 0.5 * chart.boundary_eps
    for i, n in enumerate(chart.regions):
        ends = [mathieu_a(n, q)] if n == 0 else [mathieu_b(n, q), mathieu_a(n, q)]
        pair = np.sort(np.array(ends), axis=0)
        assert np.allclose(chart.upper[i], pair[-1], rtol=0.0, atol=1e-9)
        if n:
            assert np.allclose(chart.lower[i], pair[0], rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("damping", [0.0, 0.05, 0.3])
def test_the_map_agrees_with_marching(damping):
    chart = strutt_chart(damping, (-1.0, 12.0), (0.0, 12.0), points=(14, 9))
    for i in range(0, 14, 3):
        for j in range(0, 9, 2):
            m = matrix(chart.d[i], chart.eps[j], damping, np.cos)
            assert 0.5 * np.trace(m) == pytest.approx(chart.half_trace[i, j], abs=1e-8, rel=1e-9)
            largest = np.max(np.abs(np.linalg.eigvals(m)))
            if abs(largest - 1.0) > 1e-5:
                assert (largest < 1.0) == chart.stable[i, j]


def test_blunted_tips_are_where_damping_lets_regions_open():
    damping = 0.1
    chart = strutt_chart(damping, eps_range=(0.0, 20.0))
    least = 4.0 * least_parameter(PeriodicFunction([0.0, 1.0]), 0.5 * damping, (1, 2, 3, 4)).least
    for n, expected in zip((1, 2, 3, 4), least, strict=True):
        row = chart.upper[chart.regions.index(n)]
        first = chart.boundary_eps[np.isfinite(row)][0]
        # The last bracket is 0.1 / 32^6 wide; the ends meet at the tip as a square root.
        assert first == pytest.approx(expected, abs=1e-8)
        width = (chart.upper - chart.lower)[chart.regions.index(n)]
        assert width[np.isfinite(row)][0] < 1e-3
    # The damping has more effect at larger d.
    assert np.all(np.diff(least) > 0.0)
    assert chart.passed


def test_regions_that_close_again_have_both_tips():
    # Mirror of the chart: eps below zero is the same equation half a period later.
    chart = strutt_chart(0.2, (0.0, 6.0), (-4.0, 4.0), points=(61, 81))
    assert chart.passed
    row = np.isfinite(chart.upper[chart.regions.index(1)])
    eps = chart.boundary_eps
    assert eps[row & (eps > 0)].min() == pytest.approx(-eps[row & (eps < 0)].max(), abs=1e-7)


def test_the_check_sees_a_boundary_in_the_wrong_place():
    chart = strutt_chart(points=(201, 11))
    half = strutt.discriminant_grid(strutt.COSINE, 0.25 * chart.d, 0.25 * chart.eps)
    place = chart.lower, chart.upper, chart.boundary_error
    assert strutt._contradictions(half, chart.d, *place, 1.0) == 0.0
    shifted = chart.lower + 0.2, chart.upper + 0.2, chart.boundary_error
    assert strutt._contradictions(half, chart.d, *shifted, 1.0) > 0.0


def test_any_function_will_do():
    chart = strutt_chart(0.02, (-1.0, 8.0), (0.0, 4.0), points=(10, 5), function=OTHER)
    assert chart.passed
    for i, j in ((2, 1), (5, 3), (8, 4)):
        m = matrix(chart.d[i], chart.eps[j], 0.02, OTHER)
        assert 0.5 * np.trace(m) == pytest.approx(chart.half_trace[i, j], abs=1e-8)


@pytest.mark.parametrize("damping", [0.0, 0.15])
def test_multipliers_are_the_eigenvalues(damping):
    d, eps = np.array([-0.5, 0.9, 2.0, 4.1, 6.5]), np.array([0.0, 0.7, 3.0])
    found = multiplier_surfaces(d, eps, damping)
    assert found.passed and found.first.shape == (5, 3)
    for i in range(5):
        for j in range(3):
            values = np.linalg.eigvals(matrix(d[i], eps[j], damping, np.cos)).astype(complex)
            order = np.lexsort((-values.imag, -np.round(np.abs(values), 6)))
            first, second = values[order]
            assert found.first[i, j] == pytest.approx(first, abs=1e-8 * (1 + abs(first)))
            assert found.second[i, j] == pytest.approx(second, abs=1e-7)


def test_figures_of_multipliers_hold_where_the_values_are_known():
    # Without modulation they are exp(+-i pi sqrt(d)); at d = i^2 they meet.
    d = np.concatenate([np.linspace(0.0, 30.0, 301), np.arange(1, 6) ** 2 * (1.0 + 1e-13)])
    found = multiplier_surfaces(d, [0.0])
    angle = np.pi * np.sqrt(d)
    exact = np.cos(angle) + 1j * np.abs(np.sin(angle))
    off = np.abs(found.first[:, 0] - exact)
    assert np.mean(off <= found.error[:, 0]) >= 0.99
    off = np.abs(found.second[:, 0] - exact.conj())
    assert np.mean(off <= found.second_error[:, 0]) >= 0.99


def test_the_fitted_grid_follows_the_boundaries():
    d, eps = boundary_fitted_grid((0.0, 18.0), np.linspace(0.0, 12.0, 13), per_band=6)
    assert d.shape == eps.shape and np.all(np.diff(d, axis=0) >= 0.0)
    half = discriminant(strutt.COSINE, 0.25 * d, 0.25 * eps).value
    chart = strutt_chart(d_range=(0.0, 18.0), eps_range=(0.0, 12.0), points=(3, 13))
    ends = np.concatenate([chart.lower[1:], chart.upper])
    for j in range(13):
        for end in ends[:, j]:
            if 0.0 < end < 18.0:
                nearest = np.argmin(np.abs(d[:, j] - end))
                assert d[nearest, j] == pytest.approx(end, abs=1e-11)
                assert abs(half[nearest, j]) == pytest.approx(1.0, abs=1e-10)
    damped, _ = boundary_fitted_grid((0.0, 18.0), [4.0], damping=0.5)
    plain, _ = boundary_fitted_grid((0.0, 18.0), [4.0])
    inner = plain[(plain > 0.3) & (plain < 17.0)]
    assert damped.shape == plain.shape and inner.size > 20


def test_pictures():
    chart = strutt_chart(0.1, points=(21, 21))
    ax = chart.plot()
    assert ax.get_xlim() == (-2.0, 20.0) and len(ax.lines) == len(chart.regions)
    found = multiplier_surfaces(*boundary_fitted_grid((0.0, 10.0), [0.0, 1.0, 2.0], per_band=4))
    for which in ("first", "second"):
        space = found.plot(which=which)
        assert space.get_zlim() == (-1.0, 1.0)
    with pytest.raises(BadInput, match="which"):
        found.plot(which="third")
    with pytest.raises(BadInput, match="three dimensions"):
        found.plot(new_figure().add_subplot())


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"d_range": (2.0, 1.0)}, "d_range"),
        ({"eps_range": (0.0, np.inf)}, "eps_range"),
        ({"points": (1, 5)}, "points"),
        ({"points": (5, 2.5)}, "points"),
        ({"damping": -0.1}, "damping"),
        ({"damping": [0.1, 0.2]}, "damping"),
        ({"function": np.cos}, "PeriodicFunction"),
    ],
)
def test_a_bad_chart_is_refused(change, word):
    with pytest.raises(BadInput, match=word):
        strutt_chart(**{"points": (5, 5), **change})


def test_bad_surfaces_are_refused():
    with pytest.raises(BadInput, match="shapes"):
        multiplier_surfaces(np.zeros((2, 3)), np.zeros(3))
    with pytest.raises(BadInput, match="eps"):
        multiplier_surfaces([1.0], [np.nan])
    with pytest.raises(BadInput, match="eps"):
        boundary_fitted_grid((0.0, 1.0), [[0.0]])
    with pytest.raises(BadInput, match="per_band"):
        boundary_fitted_grid((0.0, 1.0), [0.0], per_band=1)
