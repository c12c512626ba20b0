"""Periodic solutions on the boundaries: to an order, exactly, and by an integrator."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import boundary_solution, hill_boundaries
from hill_functions import ANOTHER as GENERAL
from hill_functions import COSINE

THETA = np.linspace(0.0, 4 * np.pi, 97)


@pytest.mark.parametrize("n", [0, 1, 4])
@pytest.mark.parametrize("damping", [0.0, 1e-5])
@pytest.mark.parametrize("order", [None, 2, 6])
def test_it_solves_the_equation(n, damping, order):
    """The residual is taken anew, from the values alone, by differences of Fourier series."""
    mu = 0.1
    found = boundary_solution(GENERAL, mu, n, "upper", order, damping)
    assert found.passed
    k = found.wave_numbers
    waves, amplitudes = np.exp(1j * np.outer(THETA, k)), found.a - 1j * found.b
    y, slope, bend = ((waves @ ((1j * k) ** p * amplitudes)).real for p in range(3))
    np.testing.assert_allclose(found(THETA), y, atol=1e-13)
    residual = bend + 2 * damping * slope + (found.lam2 + mu * GENERAL(THETA)) * y
    # The largest value over theta of what is small in the root mean square.
    assert np.abs(residual).max() <= 10 * found.residual + 1e-12
    assert found.residual < {None: 1e-12, 2: 1e-2, 6: 1e-5}[order]


def test_normalisation_and_sign():
    for n in (0, 1, 2, 3):
        found = boundary_solution(GENERAL, 0.2, n, "upper")
        theta = np.linspace(0.0, found.period, 4096, endpoint=False)
        assert np.mean(found(theta) ** 2) == pytest.approx(1.0, abs=1e-12)
        at = list(found.wave_numbers).index(0.5 * n)
        assert max(found.a[at], found.b[at], key=abs) > 0
        assert found.period == (4 * np.pi if n % 2 else 2 * np.pi)
        sign = -1.0 if n % 2 else 1.0
        np.testing.assert_allclose(found(theta + 2 * np.pi), sign * found(theta), atol=1e-11)


def test_where_the_ends_coincide_every_solution_will_do():
    """Only cos 3 theta: region 1 is closed, and both ends have solutions."""
    f = PeriodicFunction([0.0, 0.0, 0.0, 1.0])
    for order in (None, 4):
        pair = [boundary_solution(f, 0.1, 1, end, order) for end in ("lower", "upper")]
        for found in pair:
            assert found.degenerate and found.passed
        # They are two, not one.
        product = np.mean(pair[0](THETA[:-1]) * pair[1](THETA[:-1]))
        assert abs(product) < 1e-3


def test_a_deep_well_needs_many_harmonics():
    found = boundary_solution(COSINE, -2000.0, 1, "lower")
    assert found.passed
    bounds = hill_boundaries(COSINE, -2000.0, (1,))
    assert found.lam2 == pytest.approx(bounds.lower[0], rel=1e-14)
    # The solution is confined to the bottom of the well.
    theta = np.linspace(0.0, 4 * np.pi, 2001)
    assert np.abs(found(theta)).max() > 2.0


def test_bad_angles_and_picture():
    found = boundary_solution(COSINE, 0.1, 1)
    with pytest.raises(BadInput, match="theta"):
        found([0.0, np.nan])
    assert found.plot().lines
