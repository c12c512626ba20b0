"""The integrators' coefficients, their single steps, and de Vogelaere's recurrence."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
import scipy.linalg
from elastolink.runtime.core.errors import BadInput, SelfCheckFailed
from elastolink.runtime.integrators import (
    METHODS,
    de_vogelaere,
    expm,
    gauss_tableau,
    kutta_merson,
    rk4,
    rooted_trees,
)
from elastolink.runtime.integrators.gauss_legendre import gauss_legendre
from elastolink.runtime.integrators.tableau import GaussTableau


def _wavy(theta):
    """A smooth 3 x 3 generator without any symmetry."""
    c, s = np.cos(theta), np.sin(2 * theta)
    out = np.zeros((len(theta), 3, 3))
    out[:, 0, 1] = 1.0 + 0.3 * c
    out[:, 1, 0] = -2.0 + s
    out[:, 1, 2] = c
    out[:, 2, 0] = 0.5 * s
    out[:, 2, 2] = -0.4 + 0.1 * c
    return out


def test_rooted_trees_are_counted_as_known():
    # Number of rooted trees with n vertices: OEIS A000081.
    assert [len(rooted_trees(n)) for n in range(1, 9)] == [1, 1, 2, 4, 9, 20, 48, 115]


def test_a_wrong_coefficient_is_caught():
    with pytest.raises(SelfCheckFailed, match="row 1"):
        replace(rk4.TABLEAU, c=(Fraction(0), Fraction(1, 3), Fraction(1, 2), Fraction(1)))
    swapped = (Fraction(1, 3), Fraction(1, 6), Fraction(1, 6), Fraction(1, 3))
    with pytest.raises(SelfCheckFailed, match="declared order 4"):
        replace(rk4.TABLEAU, b=swapped)
    with pytest.raises(SelfCheckFailed, match="declared order 5"):
        replace(rk4.TABLEAU, order=5)
    with pytest.raises(SelfCheckFailed, match="error weights"):
        replace(kutta_merson.TABLEAU, error=kutta_merson.TABLEAU.b)


@pytest.mark.parametrize("stages", [1, 2, 3, 6, 8, 16, 32])
def test_gauss_coefficients_prove_themselves(stages):
    tableau = gauss_tableau(stages)
    assert tableau.order == 2 * stages
    crooked = tableau.a + 1e-9
    with pytest.raises(SelfCheckFailed):
        GaussTableau(stages, tableau.c, tableau.b, crooked)


def test_two_stage_gauss_is_the_textbook_one():
    root = np.sqrt(3.0) / 6
    tableau = gauss_tableau(2)
    np.testing.assert_allclose(tableau.c, [0.5 - root, 0.5 + root], rtol=1e-15)
    np.testing.assert_allclose(tableau.a, [[0.25, 0.25 - root], [0.25 + root, 0.25]], rtol=1e-14)


def test_number_of_stages_is_checked():
    for stages in (0, 33, 2.5):
        with pytest.raises(BadInput, match="stages"):
            gauss_legendre(stages)


@pytest.mark.parametrize("size", [1e-3, 0.1, 1.0, 4.0, 300.0])
def test_exponential_agrees_with_scipy_and_keeps_symplectic_form(size):
    rng = np.random.default_rng(7)
    unit = np.kron([[0.0, 1.0], [-1.0, 0.0]], np.eye(3))
    symmetric = rng.standard_normal((5, 6, 6))
    # Positive definite, so that the flow oscillates and does not hide errors behind growth.
    generator = size / 30 * unit @ (symmetric @ np.swapaxes(symmetric, 1, 2) + np.eye(6))
    result = expm(generator)
    norm = np.max(np.abs(generator))
    for one, matrix in zip(result, generator, strict=True):
        expected = scipy.linalg.expm(matrix)
        scale = np.max(np.abs(expected))
        assert np.max(np.abs(one - expected)) < 1e-14 * scale * (1 + norm) * 50
        defect = one.T @ unit @ one - unit
        assert np.max(np.abs(defect)) < 1e-14 * scale**2 * (1 + norm)


def test_rk4_is_the_classical_method():
    theta, h = np.array([0.4]), 0.3
    y = np.array([0.3, -1.0, 0.7])

    def slope(at, state):
        return _wavy(np.array([at]))[0] @ state

    k1 = slope(0.4, y)
    k2 = slope(0.4 + h / 2, y + h / 2 * k1)
    k3 = slope(0.4 + h / 2, y + h / 2 * k2)
    k4 = slope(0.4 + h, y + h * k3)
    expected = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    np.testing.assert_allclose(rk4.maps(_wavy, theta, h)[0] @ y, expected, rtol=1e-14)


@pytest.mark.parametrize(
    "name", ["magnus4", "magnus6", "magnus8", "cf4", "cf6", "gauss_legendre", "gauss_legendre14"]
)
def test_exact_methods_on_constant_coefficients(name):
    matrix = _wavy(np.array([1.1]))[0]

    def constant(theta):
        return np.broadcast_to(matrix, (len(theta), 3, 3))

    found = METHODS[name].maps(constant, np.array([0.0]), 0.2)[0]
    np.testing.assert_allclose(found, scipy.linalg.expm(0.2 * matrix), rtol=0, atol=1e-15)


# Of a generator without any symmetry; the symplectic Nystroem methods have a test of their own.
@pytest.mark.parametrize("name", sorted(name for name in METHODS if "srkn" not in name))
def test_a_batch_gives_the_same_steps_as_its_members(name):
    def batch(theta):
        return np.stack([_wavy(theta), 2 * _wavy(theta)])

    theta = np.array([0.0, 0.5, 1.0])
    maps = METHODS[name].maps(batch, theta, 0.1)
    for index, factor in enumerate((1, 2)):
        alone = METHODS[name].maps(lambda at, f=factor: f * _wavy(at), theta, 0.1)
        np.testing.assert_allclose(maps[index], alone, rtol=1e-14, atol=1e-16)


def test_condensed_collocation_equals_the_full_one():
    rng = np.random.default_rng(3)
    blocks = rng.standard_normal((2, 2, 2))

    def split(theta):
        out = np.zeros((2, len(theta), 4, 4))
        out[..., :2, 2:] = np.eye(2) + 0.3 * np.cos(theta)[:, None, None] * blocks[0]
        out[..., 2:, :2] = -3 * np.eye(2) + np.sin(theta)[:, None, None] * blocks[1]
        out[1] *= 1.7
        return out

    def disturbed(theta):
        # A damping far below round-off sends the same numbers through the full system.
        return split(theta) + 1e-200 * np.eye(4)

    theta = np.array([0.0, 0.4, 0.8])
    for stages in (1, 3, 8):
        method = gauss_legendre(stages)
        np.testing.assert_allclose(
            method.maps(split, theta, 0.4), method.maps(disturbed, theta, 0.4), atol=1e-14
        )


def test_magnus_step_is_the_published_one():
    h, theta = 0.25, np.array([0.3])
    nodes = 0.3 + h * (0.5 + np.array([-1, 1]) * np.sqrt(3) / 6)
    first, second = _wavy(nodes)
    exponent = h / 2 * (first + second)
    exponent -= np.sqrt(3) / 12 * h**2 * (first @ second - second @ first)
    expected = scipy.linalg.expm(exponent)
    np.testing.assert_allclose(METHODS["magnus4"].maps(_wavy, theta, h)[0], expected, atol=1e-15)


# Kutta-Merson's error estimate ---------------------------------------------------------------


def _local(step, y):
    exact = gauss_legendre(8).maps(_wavy, np.array([0.2]), step)[0] @ y
    actual = kutta_merson.maps(_wavy, np.array([0.2]), step)[0] @ y - exact
    return actual, kutta_merson.error_maps(_wavy, np.array([0.2]), step)[0] @ y


def test_merson_estimate_is_exact_to_leading_order_for_constant_coefficients():
    matrix = _wavy(np.array([1.1]))[0]
    y = np.array([0.3, -1.0, 0.7])

    def constant(theta):
        return np.broadcast_to(matrix, (len(theta), 3, 3))

    ratios = []
    for step in (0.1, 0.05, 0.025, 0.0125):
        exact = scipy.linalg.expm(step * matrix) @ y
        actual = kutta_merson.maps(constant, np.array([0.0]), step)[0] @ y - exact
        estimate = kutta_merson.error_maps(constant, np.array([0.0]), step)[0] @ y
        ratios.append(np.linalg.norm(estimate) / np.linalg.norm(actual))
    gaps = np.abs(np.array(ratios) - 1)
    assert gaps[-1] < 0.01
    assert np.all(gaps[1:] < 0.6 * gaps[:-1])


def test_merson_estimate_exceeds_the_error_for_angle_dependent_coefficients():
    # The other solution of the pair is then of order three only, so the excess grows as 1/step.
    ratios = []
    y = np.array([0.3, -1.0, 0.7])
    for step in (0.2, 0.1, 0.05, 0.025):
        actual, estimate = _local(step, y)
        ratios.append(np.linalg.norm(estimate) / np.linalg.norm(actual))
    assert ratios[0] > 1
    assert np.all(np.diff(ratios) > 0)


def test_merson_pair_has_orders_four_and_three():
    weights = kutta_merson.TABLEAU
    other = tuple(b - 5 * e for b, e in zip(weights.b, weights.error, strict=True))
    assert weights.attained_order(weights.b) == 4
    assert weights.attained_order(other) == 3


def test_adaptive_merson_keeps_its_tolerance():
    theta = np.linspace(0.0, 6.0, 13)
    y = np.array([0.3, -1.0, 0.7])
    exact = [y]
    for left in theta[:-1]:
        fine = gauss_legendre(8).maps(_wavy, left + 0.05 * np.arange(10), 0.05)
        state = exact[-1]
        for matrix in fine:
            state = matrix @ state
        exact.append(state)
    counts = []
    for rtol in (1e-5, 1e-7, 1e-9):
        run = kutta_merson.adaptive(
            _wavy,
            theta,
            y,
            rtol,
            np.full(3, rtol),
            stop=lambda state: False,
            first=0.3,
        )
        assert np.max(np.abs(run.states - np.array(exact))) < 20 * rtol
        counts.append(run.accepted)
    # With these coefficients the estimate is of fourth order in the step: 100**(1/4) = 3.16.
    assert 2.8 < counts[2] / counts[1] < 3.4


def test_adaptive_merson_stops_when_told():
    run = kutta_merson.adaptive(
        lambda theta: np.broadcast_to(np.eye(1), (len(theta), 1, 1)),
        np.arange(10.0),
        np.ones(1),
        1e-6,
        np.full(1, 1e-6),
        stop=lambda state: bool(state[0] > 50),
        first=0.1,
    )
    assert len(run.states) == 5  # e^4 = 54.6 is the first beyond 50
    np.testing.assert_allclose(run.states[-1], np.exp(4.0), rtol=1e-5)


# De Vogelaere's recurrence -------------------------------------------------------------------


def _force(theta, y):
    """y'' of a forced Hill equation."""
    return -30.0 * (1 + 0.3 * np.cos(theta)) * y + 0.2 * np.sin(theta)


def _hill(theta):
    out = np.zeros((len(theta), 2, 2))
    out[:, 0, 0] = -30.0 * (1 + 0.3 * np.cos(theta))
    out[:, 0, 1] = 0.2 * np.sin(theta)
    return out


def _listing(x0, y0, z0, h, steps, *, as_printed=False):
    """Integrate as Smith's appendix 4 does, its two slips of the start mended unless asked not to.

    Printed are ``q := h*x0`` (the initial angle for the initial slope) and ``f(-h, t)`` (right
    only where the initial angle is zero).
    """
    x, p = x0, y0
    q = h * (x0 if as_printed else z0)
    r = h**2 * _force(x, p) / 3
    t = p - q + 3 * r / 2
    s = h**2 * _force(-h if as_printed else x0 - h, t) / 3
    out = [p]
    for _ in range(steps):
        q = q + r
        p = p + q
        s = p + r - s / 2
        x = x + h
        s = h**2 * _force(x, s) / 3
        q = q + 4 * s
        p = p + q
        x = x + h
        r = h**2 * _force(x, p) / 3
        q = q + r
        out.append(p)
    return np.array(out)


def _by_maps(x0, y0, z0, h, steps):
    state = de_vogelaere.start(_hill, x0, h, np.array([y0, 1.0]), np.array([z0, 0.0]))
    out = [state[0]]
    for matrix in de_vogelaere.maps(_hill, x0 + 2 * h * np.arange(steps), h):
        state = matrix @ state
        out.append(state[0])
    return np.array(out)


@pytest.mark.parametrize("start", [(0.0, 0.1, 0.0), (0.0, 0.0, 0.4), (0.7, 0.05, -0.2)])
def test_de_vogelaere_equals_the_recurrence_of_the_listing(start):
    h = np.radians(0.5)
    expected = _listing(*start, h, 720)
    np.testing.assert_allclose(
        _by_maps(*start, h, 720), expected, rtol=0, atol=1e-12 * np.max(np.abs(expected))
    )


def test_the_listing_as_printed_is_right_only_at_rest_in_zero_angle():
    h = np.radians(0.5)
    at_rest = (0.0, 0.1, 0.0)
    np.testing.assert_array_equal(
        _listing(*at_rest, h, 50, as_printed=True), _listing(*at_rest, h, 50)
    )
    for start in ((0.0, 0.1, 0.3), (0.7, 0.1, 0.0)):
        mended = _listing(*start, h, 360)
        printed = _listing(*start, h, 360, as_printed=True)
        assert np.max(np.abs(printed - mended)) > 0.05 * np.max(np.abs(mended))


def test_a_half_step_of_two_degrees_damps_and_one_of_half_a_degree_does_not():
    # Smith's figures 28 and 29: 20 degrees of wavelength, lambda = 18.
    def oscillator(theta):
        return np.full((len(theta), 1, 1), -(18.0**2))

    left = {}
    for degrees in (2.0, 0.5):
        h = np.radians(degrees)
        steps = round(np.pi / h)
        state = de_vogelaere.start(oscillator, 0.0, h, np.ones(1), np.zeros(1))
        path = []
        for matrix in de_vogelaere.maps(oscillator, 2 * h * np.arange(steps), h):
            state = matrix @ state
            path.append(abs(state[0]))
        left[degrees] = max(path[-20:])
    assert left[2.0] < 0.75
    assert left[0.5] > 0.99
