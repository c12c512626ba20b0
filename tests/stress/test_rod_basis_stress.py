"""Polynomial bases of the rod far out: many shapes, the block near pin and tip."""

import numpy as np
import pytest
from elastolink.runtime.systems.rod import OverhangBasis, PolynomialBasis, TwoSegmentBasis
from elastolink.runtime.systems.rod.polynomials import INTEGRALS
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh

places = st.floats(1e-3, 1.0 - 1e-3)


@settings(max_examples=12, deadline=None, derandomize=True)
@given(place=places, size=st.integers(1, 24), name=st.sampled_from(sorted(INTEGRALS)))
def test_arrays_are_finite_and_symmetric(place, size, name):
    for basis in (PolynomialBasis(size), TwoSegmentBasis(size)):
        found = basis.array(name, np.array([place, place]))
        assert np.all(np.isfinite(found)) and np.array_equal(found[0], found[1])
        if name in ("overlap", "bending", "drift_drift", "tension"):
            part = found[0]
            assert np.abs(part - part.T).max() <= 1e-13 * np.abs(part).max()
            # Gram matrices: none of them is indefinite beyond rounding.
            assert np.linalg.eigvalsh(part)[0] >= -1e-12 * size * np.abs(part).max()


@settings(max_examples=12, deadline=None, derandomize=True)
@given(place=places, size=st.integers(1, 16))
def test_frequencies_bound_the_exact_ones_from_above(place, size):
    """Rayleigh and Ritz, to round-off of the highest frequency kept."""
    at = np.array([place])
    exact = OverhangBasis(size).roots(at)[0] ** 4
    for basis in (PolynomialBasis(size), TwoSegmentBasis(size)):
        found = eigh(
            basis.array("bending", at)[0], basis.array("overlap", at)[0], eigvals_only=True
        )
        # The condition of the mass matrix is 5e3 at most over these places.
        assert np.all(found >= exact * (1 - 1e-9) - 1e-9 * found[-1])


@pytest.mark.parametrize("place", [1e-9, 1e-3, 0.5, 1.0 - 1e-9])
def test_as_many_shapes_as_there_are(place):
    """No overflow, and a mass matrix that is diagonal to rounding."""
    overlap = TwoSegmentBasis(40).array("overlap", np.array([place]))[0]
    scale = np.sqrt(np.diag(overlap))
    assert np.all(np.isfinite(overlap)) and scale.min() > 0
    assert np.abs(overlap / scale / scale[:, None] - np.eye(40)).max() < 1e-12
