"""Coefficients that prove themselves: order conditions in exact arithmetic; the exponential."""

from __future__ import annotations

import sys
from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput, SelfCheckFailed
from elastolink.runtime.integrators import METHODS, expm
from elastolink.runtime.integrators.commutator_free import CF4, CF6
from elastolink.runtime.integrators.commutators import combination, moments_of
from elastolink.runtime.integrators.lie_series import legendre, legendre_flow, letters
from elastolink.runtime.integrators.magnus import MAGNUS4, MAGNUS6, MAGNUS8
from elastolink.runtime.integrators.nystroem import SRKN4, SRKN6

SCHEMES = (MAGNUS4, MAGNUS6, MAGNUS8, CF4, CF6, SRKN4, SRKN6)


@pytest.mark.parametrize("scheme", SCHEMES, ids=lambda scheme: scheme.name)
def test_every_scheme_proves_its_order(scheme):
    scheme.verify()
    assert METHODS[scheme.name].order == scheme.order


@pytest.mark.parametrize("scheme", SCHEMES, ids=lambda scheme: scheme.name)
def test_a_digit_in_the_thirtieth_place_is_caught(scheme):
    slip = Fraction(1, 10**30)
    if scheme in (SRKN4, SRKN6):
        first, *rest = scheme.first_kicks
        wrong = replace(scheme, first_kicks=(first + slip, *rest))
    elif scheme in (CF4, CF6):
        (number, value), *rest = scheme.factors[0]
        wrong = replace(scheme, factors=(((number, value + slip), *rest), *scheme.factors[1:]))
    else:
        *rest, (number, value) = scheme.exponent
        wrong = replace(scheme, exponent=(*rest, (number, value + slip)))
    with pytest.raises(SelfCheckFailed, match="a condition of"):
        wrong.verify()


def test_a_method_that_is_better_than_declared_is_caught():
    modest = replace(SRKN4, order=3)
    with pytest.raises(SelfCheckFailed, match="all of the next"):
        modest.verify()


# The series that the proofs rest on -----------------------------------------------------------


def test_legendre_polynomials_of_the_unit_interval_are_orthogonal():
    rows = legendre(5)
    for i, first in enumerate(rows):
        for j, second in enumerate(rows):
            value = sum(
                a * b / (k + m + 1) for k, a in enumerate(first) for m, b in enumerate(second)
            )
            assert value == (Fraction(1, 2 * i + 1) if i == j else 0)


def test_exact_flow_agrees_with_the_solution_of_a_nilpotent_system():
    # y' = (P_0 E + P_1 F + P_2 G) y with strictly triangular E, F, G ends after three integrals.
    rng = np.random.default_rng(5)
    basis = [np.triu(rng.integers(-3, 4, (4, 4)), 1).astype(float) for _ in range(3)]
    total = np.zeros((4, 4))
    for word, value in legendre_flow(3, 9).terms.items():
        product = np.eye(4)
        for letter in word:
            product = product @ basis[letter]
        total += float(value) * product
    rows = legendre(3)

    def generator(theta):
        shapes = np.array([np.polynomial.polynomial.polyval(theta, [*map(float, r)]) for r in rows])
        return np.einsum("kt,kij->tij", shapes, np.array(basis))

    fine = METHODS["gauss_legendre16"].maps(generator, np.zeros(1), 1.0)[0]
    np.testing.assert_allclose(total, fine, rtol=0, atol=1e-13)


def test_logarithm_and_exponential_of_series_are_inverse():
    a, b = letters((1, 2), 6)
    series = a + b.times(Fraction(1, 3)) + a.commutator(b)
    assert (series.exp().log() - series).terms == {}


def test_moments_of_a_polynomial_generator_are_its_legendre_coefficients():
    coefficients = np.random.default_rng(2).standard_normal((3, 2, 2))

    def generator(theta):
        shapes = np.polynomial.legendre.legvander(2 * (theta - 0.7) / 0.4 - 1, 2)
        return np.einsum("tk,kij->tij", shapes, coefficients)

    found = moments_of(generator, np.array([0.7]), 0.4, 3)[0]
    np.testing.assert_allclose(found, 0.4 * coefficients, rtol=0, atol=1e-15)


def test_commutators_vanish_for_coefficients_that_commute():
    moments = np.stack([np.diag([1.0, 2.0]), np.diag([0.3, -1.0])])
    np.testing.assert_array_equal(MAGNUS4.matrices(moments), moments[0])
    assert combination((0, "1/3"))[0][1] == Fraction(1, 3)


# The exponential -------------------------------------------------------------------------------


def _module():
    return sys.modules["elastolink.runtime.integrators.expm"]


def test_polynomials_in_few_products_are_taylors():
    module, x = _module(), Fraction(1, 7)
    (x1, x2, x3), y = ([Fraction(v) for v in row] for row in module.eighth_degree())
    fourth = x**2 * (x1 * x + x2 * x**2)
    eighth = (x3 * x**2 + fourth) * (y[0] + y[1] * x + y[2] * x**2 + y[3] * fourth)
    eighth += y[4] * x**2 + x + 1
    rows = module.twelfth_degree()
    s, t, p, r = (sum(Fraction(c) * x**k for k, c in enumerate(row)) for row in rows)
    twelfth = (s**2 + t) * (s**2 + t + p) + r
    for degree, found in ((8, eighth), (12, twelfth)):
        exact, power = Fraction(0), Fraction(1)
        for k in range(degree + 1):
            exact += power
            power *= x / (k + 1)
        # The coefficients are rounded to doubles; the next term of the series would be 1e-14.
        assert abs(float(found - exact)) < 4e-16


@pytest.mark.parametrize("degree", [4, 8, 12])
def test_reach_of_a_polynomial_is_where_its_backward_error_is_round_off(degree):
    terms = 100
    with mpmath.workdps(50):
        taylor = [1 / mpmath.factorial(k) if k <= degree else 0 for k in range(terms)]
        back = [(-1) ** k / mpmath.factorial(k) for k in range(terms)]
        g = [sum(taylor[i] * back[k - i] for i in range(k + 1)) for k in range(terms)]
        log = [mpmath.mpf(0)] * terms
        for k in range(1, terms):
            log[k] = g[k] - sum(j * log[j] * g[k - j] for j in range(1, k)) / k
        reach = mpmath.mpf(_module()._REACH[degree])
        backward = sum(abs(c) * reach ** (k - 1) for k, c in enumerate(log) if k)
        assert mpmath.mpf(2) ** -53 * 0.98 < backward < mpmath.mpf(2) ** -53 * 1.02


def _exact(matrix):
    with mpmath.workdps(60):
        value = mpmath.expm(mpmath.matrix(matrix.tolist()))
        return np.array(value.tolist(), dtype=object)


@pytest.mark.parametrize("size", [1e-6, 1e-3, 0.03, 0.2, 1.0, 7.0, 60.0])
@pytest.mark.parametrize("count", [2, 3, 5])
def test_exponential_against_sixty_digits(count, size):
    rng = np.random.default_rng(11)
    matrices = rng.standard_normal((3, count, count))
    matrices *= size / np.max(np.sum(np.abs(matrices), axis=-2))
    for matrix, found in zip(matrices, expm(matrices), strict=True):
        exact = _exact(matrix)
        error = max(abs(float(a - b)) for a, b in zip(found.ravel(), exact.ravel(), strict=True))
        # Backward error of a few units in the last place of a matrix of this norm.
        norm = np.max(np.abs(exact.astype(float)))
        assert error < 4e-16 * (4 + 4 * size) * max(norm, 1.0)


@pytest.mark.parametrize(
    "matrix",
    [
        [[0.0, 1.0], [-4e6, 0.0]],  # two thousand radians
        [[-1e4, 1.0], [-1.0, -1e4]],  # decays to nothing
        [[0.0, 1.0], [0.0, 0.0]],  # nilpotent
        [[0.0, 0.0], [0.0, 0.0]],
        [[1e-9, 1.0], [-1e-18, -1e-9]],  # s^2 cancels to nothing
        [[-700.0, 1.0], [1.0, 700.0]],
    ],
)
def test_two_by_two_exponential_at_nasty_places(matrix):
    matrix = np.array(matrix)
    found = expm(matrix)
    exact = _exact(matrix).astype(float)
    assert np.all(np.isfinite(found))
    scale = np.maximum(np.abs(exact), np.max(np.abs(exact)) * 1e-3)
    # The condition of the exponential: the angle or growth exponent times round-off.
    allowed = 1e-15 * (4 + np.max(np.abs(np.linalg.eigvals(matrix))))
    assert np.max(np.abs(found - exact) / np.maximum(scale, 1e-300)) < allowed


def test_an_exponent_that_is_no_number_is_refused():
    for value in (np.inf, np.nan, 1e16):
        with pytest.raises(BadInput, match="norm of a matrix exponent"):
            expm(np.full((2, 3, 3), value))
