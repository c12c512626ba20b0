"""Collocation: coefficients that prove themselves, and single steps."""

import numpy as np
import pytest
import scipy.linalg
from elastolink.runtime.core.collocation import (
    CollocationTableau,
    gauss_maps,
    gauss_tableau,
    legendre_integrals,
    radau_tableau,
)
from elastolink.runtime.core.errors import SelfCheckFailed
from marching import wavy


@pytest.mark.smoke
@pytest.mark.parametrize(("family", "less"), [(gauss_tableau, 0), (radau_tableau, 1)])
@pytest.mark.parametrize("stages", [1, 2, 3, 6, 8, 16, 32])
def test_coefficients_prove_themselves(family, less, stages):
    tableau = family(stages)
    assert tableau.order == 2 * stages - less
    with pytest.raises(SelfCheckFailed):
        CollocationTableau(tableau.family, stages, tableau.c, tableau.b, tableau.a + 1e-9)


def test_two_stages_are_those_of_the_textbook():
    root = np.sqrt(3.0) / 6
    tableau = gauss_tableau(2)
    np.testing.assert_allclose(tableau.c, [0.5 - root, 0.5 + root], rtol=1e-15)
    np.testing.assert_allclose(tableau.a, [[0.25, 0.25 - root], [0.25 + root, 0.25]], rtol=1e-14)
    tableau = radau_tableau(2)
    np.testing.assert_allclose(tableau.c, [1 / 3, 1.0], rtol=1e-15)
    np.testing.assert_allclose(tableau.a, [[5 / 12, -1 / 12], [3 / 4, 1 / 4]], rtol=1e-14)


def test_integrals_of_legendre_polynomials():
    x = np.linspace(-1.0, 1.0, 7)
    polynomials = [np.polynomial.Legendre.basis(k).integ(lbnd=-1.0)(x) for k in range(5)]
    np.testing.assert_allclose(legendre_integrals(x, 5), np.transpose(polynomials), atol=1e-15)


@pytest.mark.parametrize("stages", [6, 7])
def test_steps_are_exponentials_where_coefficients_are_constant(stages):
    matrix = wavy(np.array([1.1]))[0]

    def constant(theta):
        return np.broadcast_to(matrix, (len(theta), 3, 3))

    step = gauss_maps(stages, constant, np.array([0.0]), 0.2)[0]
    np.testing.assert_allclose(step, scipy.linalg.expm(0.2 * matrix), rtol=0, atol=1e-15)


@pytest.mark.parametrize("stages", [2, 6, 8])
def test_steps_are_symplectic_and_undo_themselves(stages):
    # y' = J S(theta) y with symmetric S: two freedoms, undamped.
    rng = np.random.default_rng(3)
    first, second = (half + half.T for half in rng.standard_normal((2, 4, 4)))
    unit = np.kron([[0.0, 1.0], [-1.0, 0.0]], np.eye(2))

    def generator(theta):
        return unit @ (first + np.cos(theta)[:, None, None] * second)

    theta = np.array([0.0, 0.4, 0.8])
    steps = gauss_maps(stages, generator, theta, 0.4)
    back = gauss_maps(stages, generator, theta + 0.4, -0.4)
    size = np.max(np.abs(steps))
    defect = np.swapaxes(steps, -1, -2) @ unit @ steps - unit
    assert np.max(np.abs(defect)) < 1e-14 * size**2
    assert np.max(np.abs(back @ steps - np.eye(4))) < 1e-13 * size**2
