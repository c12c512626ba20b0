"""Free-free modes to number 60, and the moving basis that the paper's conjecture makes of them."""

import free_free_truth as truth
import mpmath
import numpy as np
import pytest
from elastolink.runtime.systems.rod import FreeFreeBasis, MovingBasis
from elastolink.runtime.systems.rod.basis import MATRIX_ARRAYS, VECTOR_ARRAYS
from elastolink.runtime.systems.rod.free_free import FreeFreeModes

MANY = 60
PLACES = np.array([0.02, 0.3, 0.59997, 0.85, 1.0])


def nodes(count):
    x, weights = np.polynomial.legendre.leggauss(count)
    return (1 + x) / 2, weights / 2


def test_roots_to_the_last_digit():
    """Rounded correctly, or to the neighbour: an error of at most one unit in the last place."""
    roots = FreeFreeModes(MANY).roots
    exact = [truth.root(i) for i in range(1, MANY + 1)]
    errors = [abs(mpmath.mpf(float(b)) - e) for b, e in zip(roots, exact, strict=True)]
    assert all(e <= np.spacing(b) for e, b in zip(errors, roots, strict=True))
    assert roots[0] == pytest.approx(4.730040744862704, rel=1e-15)  # to 16 digits, mpmath


def test_modes_are_orthonormal():
    eta, weights = nodes(200)  # exact to degree 399; the modes turn 30 times
    modes = FreeFreeModes(MANY)
    value, slope, curvature, third = modes(eta)

    def gram(shapes):
        return shapes.T @ (weights[:, None] * shapes)

    unit = np.eye(MANY)
    assert np.max(np.abs(gram(value) - unit)) < 1e-12
    assert np.max(np.abs(weights @ value)) < 1e-12
    assert np.max(np.abs((weights * (eta - 0.5)) @ value)) < 1e-12
    scaled = curvature / modes.roots**2
    assert np.max(np.abs(gram(scaled) - unit)) < 1e-12
    # (39) by parts once more: int psi''' psi' = -b^4 for i = j
    mixed = (third / modes.roots**2).T @ (weights[:, None] * slope / modes.roots**2)
    assert np.max(np.abs(mixed + unit)) < 1e-12


@pytest.mark.parametrize("number", [1, 2, 13, 60, 200])
def test_values_of_single_modes(number):
    """Rounding moves the phase by b u and each derivative by its own size."""
    modes = FreeFreeModes(number)
    b = modes.roots[-1]
    for eta in (0.0, 1e-6, 0.25, 0.5, 0.9, 1.0):
        for order, found in enumerate(modes(eta)):
            with mpmath.workdps(250):
                exact = float(truth.mode(number, mpmath.mpf(eta) - 0.5, order))
            assert abs(found[-1] - exact) < 8e-16 * b * 2 * b**order


def test_integrals_of_slopes_against_quadrature():
    eta, weights = nodes(200)
    modes = FreeFreeModes(MANY)
    slope = modes(eta)[1]
    for power, name in enumerate(("plain", "first", "second")):
        found = modes.slope_integrals[name]
        exact = slope.T @ ((weights * (eta - 0.5) ** power)[:, None] * slope)
        assert np.max(np.abs(found - exact)) < 1e-12 * np.max(np.abs(exact))
    exact = slope.T @ ((weights * (1 - eta**2) / 2)[:, None] * slope)
    assert np.max(np.abs(modes.tension() - exact)) < 1e-12 * np.max(np.abs(exact))


def drifts(basis, eta, place, derivative):
    """Return the derivative of the shapes by the block's place, by differences of order 4."""
    step = 2.0**-9 * np.minimum(place, 1 / basis.size)

    def moved(k):
        at = place + k * step
        # Beyond the tip the shapes are continued by the same formula, as differences want it.
        modes = basis.modes
        lean = (modes(at)[0] - modes.left_values) / at[:, None]
        flat = {0: eta[:, None], 1: np.ones((len(eta), 1))}.get(derivative, 0.0 * eta[:, None])
        return -flat * lean[:, None, :]

    first = 8 * (moved(1) - moved(-1)) - (moved(2) - moved(-2))
    return first / (12 * step[:, None, None])


@pytest.mark.parametrize("size", [1, 2, 6])
def test_integrals_of_the_basis_against_quadrature(size):
    basis = FreeFreeBasis(size)
    assert isinstance(basis, MovingBasis)
    eta, weights = nodes(100)
    value, slope, curvature = (basis.shapes(eta, PLACES, k) for k in range(3))
    drift, bent = drifts(basis, eta, PLACES, 0), drifts(basis, eta, PLACES, 2)
    pull = weights * (1 - eta**2) / 2

    def gram(left, right, w=weights):
        return np.einsum("e,tei,tej->tij", w, left, right)

    exact = {
        "overlap": gram(value, value),
        "drift": gram(value, drift),
        "drift_drift": gram(drift, drift),
        "bending": gram(curvature, curvature),
        "bending_drift": gram(curvature, bent),
        "tension": gram(slope, slope, pull),
        "moment": np.einsum("e,tei->ti", weights * eta, value),
        "mean": np.einsum("e,tei->ti", weights, value),
    }
    assert set(exact) == {*MATRIX_ARRAYS, *VECTOR_ARRAYS}
    for name, wanted in exact.items():
        found = basis.array(name, PLACES)
        assert found.shape == wanted.shape
        # Differences of the fourth order leave 1e-9 of a shape's fifth derivative.
        accuracy = 1e-6 if "drift" in name else 1e-12
        size_ = np.max(np.abs(wanted), initial=1e-3)
        assert np.max(np.abs(found - wanted)) < accuracy * size_, name


def test_shapes_are_held_at_pin_and_block():
    basis = FreeFreeBasis(5)
    for place in PLACES:
        held = basis.shapes(np.array([0.0, place]), np.array([place]))
        assert np.max(np.abs(held)) < 1e-14
    assert basis.labels[:2] == ("free-free 1", "free-free 2")
