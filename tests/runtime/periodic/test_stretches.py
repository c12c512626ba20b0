"""The kernel of all stretches: against exact solutions in more digits, and its own rules."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core import chebyshev
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.stretches import (
    Equation,
    Tabulated,
    coefficients,
    mixed,
    nodes,
    running_products,
    solved,
    solving,
    stretch_maps,
    tabulated,
)
from hypothesis import given, settings
from hypothesis import strategies as st

EPS = float(np.finfo(float).eps)
ENDS = np.array([1.0])


def side_by_side(*parts):
    return np.concatenate(parts, axis=-1)


def ulps(found, exact):
    """Return the largest error in units of the last place of the largest entry."""
    exact = np.array(exact.tolist(), dtype=float).reshape(found.shape)
    return np.max(np.abs(found - exact)) / (EPS * np.max(np.abs(exact)))


def exponential(matrix):
    """Return exp of a matrix of floats, taken as they are, in 40 digits."""
    with mpmath.workdps(40):
        return mpmath.expm(mpmath.matrix(matrix.tolist()))


@pytest.mark.parametrize("size", [1, 2, 3, 5, 8])
def test_constant_coefficients_give_exponentials(size):
    """exp((tau + 1) L) of rates as those of the stretches in use, against mpmath in 40 digits.

    The middle solution is inverted: the error is some ulp times its condition, below 1e2 here.
    """
    rng = np.random.default_rng(size)
    matrix = rng.normal(size=(size, size))
    matrix *= 1.5 / np.linalg.norm(matrix, 2)
    places = np.array([-0.4, 0.3, 1.0])
    found = stretch_maps(matrix, places)
    assert found.shape == (3, size, size)
    for place, own in zip(places, found, strict=True):
        with mpmath.workdps(40):
            exact = mpmath.expm((mpmath.mpf(place) + 1) * mpmath.matrix(matrix.tolist()))
        assert ulps(own, exact) <= 40


def test_a_rotation_is_exact_to_a_few_ulp():
    """The fastest mode of a stretch turns by 4 rad, the most that is in use."""
    turn = 2.0 * np.array([[0.0, 1.0], [-1.0, 0.0]])
    found = stretch_maps(turn, ENDS)[0]
    assert ulps(found, exponential(2.0 * turn)) <= 8
    assert abs(np.linalg.det(found) - 1.0) <= 8 * EPS


def test_coefficients_that_commute():
    """L = (0.5 + 2 tau - 3 tau^2 + tau^5) A: from -1 to tau it is exp of the integral."""
    a = np.array([[0.3, -1.1, 0.2], [0.9, -0.2, 0.4], [-0.1, 0.6, 0.1]])
    by_power = {0: 0.5, 1: 2.0, 2: -3.0, 5: 1.0}
    parts = [by_power.get(k, 0.0) * a for k in range(6)]
    places = np.array([-0.7, 0.0, 1.0])
    for place, own in zip(places, stretch_maps(side_by_side(*parts), places), strict=True):
        with mpmath.workdps(40):
            tau = mpmath.mpf(place)
            whole = sum(
                c * (tau ** (k + 1) - (-1) ** (k + 1)) / (k + 1) for k, c in by_power.items()
            )
            exact = mpmath.expm(whole * mpmath.matrix(a.tolist()))
        assert ulps(own, exact) <= 40


def test_a_nilpotent_generator_is_integrated():
    """[[0, 1 + tau + tau^2], [0, 0]] gives the polynomial tau + tau^2/2 + tau^3/3 + 5/6."""
    one = np.array([[0.0, 1.0], [0.0, 0.0]])
    places = np.array([-1.0, -0.25, 0.5, 1.0])
    found = stretch_maps(side_by_side(one, one, one), places)
    expected = places + places**2 / 2 + places**3 / 3 + 5 / 6
    np.testing.assert_allclose(found[:, 0, 1], expected, rtol=0, atol=4 * EPS)
    np.testing.assert_array_equal(found[:, 1], np.tile([0.0, 1.0], (4, 1)))


@pytest.mark.parametrize("size", [1.0, 4.0, -9.0])
def test_airys_equation(size):
    """y'' = c tau y, whose coefficients do not commute: Ai and Bi of c^(1/3) tau in 40 digits."""
    first, second = np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0, 0.0], [size, 0.0]])
    places = np.array([-0.1, 0.62, 1.0])
    found = stretch_maps(side_by_side(first, second), places)
    with mpmath.workdps(40):
        root = mpmath.sign(size) * mpmath.cbrt(abs(size))

        def fundamental(tau):
            at = root * mpmath.mpf(tau)
            rows = [
                [f(at, derivative=d) * root**d for f in (mpmath.airyai, mpmath.airybi)]
                for d in (0, 1)
            ]
            return mpmath.matrix(rows)

        begin = fundamental(-1.0) ** -1
        for place, own in zip(places, found, strict=True):
            assert ulps(own, fundamental(place) * begin) <= 40


def test_many_stretches_with_places_of_their_own():
    rng = np.random.default_rng(1)
    series = 0.4 * rng.normal(size=(2, 3, 2, 8))
    places = np.array([[0.1, 1.0], [-0.5, 1.0], [0.9, 1.0]])
    found = stretch_maps(series, places)
    assert found.shape == (2, 3, 2, 2, 2)
    for i in range(2):
        for j in range(3):
            alone = stretch_maps(series[i, j], places[j])
            np.testing.assert_allclose(found[i, j], alone, rtol=0, atol=8 * EPS * np.max(alone))


def test_stretches_that_are_too_long_are_told():
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    assert stretch_maps(100.0 * turn, ENDS) is None  # 80 terms do not end it
    assert stretch_maps(np.diag([7.0, -7.0]), ENDS) is None  # growth of e^14 beside e^-14
    assert stretch_maps(np.diag([3.0, -3.0]), ENDS) is not None
    assert stretch_maps(np.full((1, 1), 1e300), ENDS) is None


@given(st.integers(1, 12), st.integers(1, 5))
def test_running_products_start_anew_with_each_group(count, together):
    rng = np.random.default_rng(count)
    maps = rng.normal(size=(2, count, 3, 3))
    found = running_products(maps.copy(), together)
    for k in range(count):
        flow = np.eye(3)
        for j in range(k - k % together, k + 1):
            flow = maps[:, j] @ flow
        np.testing.assert_allclose(found[:, k], flow, rtol=1e-12, atol=1e-12)


def test_tables_give_what_they_were_made_of(monkeypatch):
    """A polynomial of degree four by five nodes: at nodes and between, in blocks or not."""
    rng = np.random.default_rng(5)
    own = rng.normal(size=(5, 4, 2, 2))

    def at(x):
        return np.einsum("nk,kabc->nabc", np.vander(x, 5, increasing=True), own)

    low, high = 0.5, 1.25
    table = Tabulated(low, high, coefficients(at(nodes(low, high, 5))))
    values = np.array([low, 0.777, 1.0, high])
    exact = at(values)
    np.testing.assert_allclose(mixed(table.weights(values), table.stretches), exact, atol=1e-13)
    wanted = exact[:, 3] @ exact[:, 2] @ exact[:, 1] @ exact[:, 0]
    whole, power = table.products(values)
    assert not power.any()
    np.testing.assert_allclose(whole, wanted, atol=1e-12 * np.max(np.abs(wanted)))
    monkeypatch.setattr(tabulated, "_BLOCK_FLOATS", 1)
    np.testing.assert_allclose(table.products(values)[0], whole, rtol=1e-12, atol=1e-13)
    # Beyond the ends as at them: speeds are rounded.
    np.testing.assert_array_equal(table.weights(np.array([2.0])), table.weights(np.array([high])))


def test_weights_are_chebyshevs_polynomials():
    table = Tabulated(-1.0, 1.0, np.zeros((30, 1, 1, 1)))
    x = np.linspace(-1.0, 1.0, 201)
    exact = np.stack([np.polynomial.chebyshev.Chebyshev.basis(k)(x) for k in range(30)], axis=1)
    # k times the error of the angle.
    np.testing.assert_allclose(table.weights(x), exact, rtol=0, atol=60 * EPS)


def test_growth_beyond_all_numbers_leaves_by_powers_of_two():
    table = Tabulated(1.0, 1.0, np.full((1, 7, 1, 1), 1e100))
    matrices, power = table.products(np.array([1.0]))
    logarithm = np.log10(matrices[0, 0, 0]) + power[0] * np.log10(2.0)
    assert logarithm == pytest.approx(700.0, rel=1e-13)


def oscillator(low, high, span=2.0, **options):
    """x is the frequency, and the state (q, q'/x)."""

    def generators(x):
        turn = x[:, None, None, None] * np.array([[0.0, 1.0], [-1.0, 0.0]])
        return lambda theta: np.broadcast_to(turn, (len(x), len(theta), 2, 2))

    return Equation(generators, 2, low, high, span, **options)


def rotation(angle):
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([cos, sin, -sin, cos], axis=-1).reshape(*np.shape(angle), 2, 2)


@settings(max_examples=25, deadline=None)
@given(
    st.integers(3, 13),
    st.integers(1, 4),
    st.lists(st.floats(0.0, 2.0), max_size=9),
    st.sampled_from([None, 1]),
)
def test_an_oscillator_at_any_angles(count, together, angles, degree):
    """Stretches, merged or not, with no, some or many wanted angles in each."""
    theta = np.sort(np.array(angles))
    equation = oscillator(1.0, 3.0, angles=theta, together=together, degree=degree)
    found = solved(equation, count)
    assert found.stretches.shape[1] == -(-count // together)
    x = np.array([1.0, 1.618, 3.0])
    table = Tabulated(1.0, 3.0, found.stretches)
    np.testing.assert_allclose(table.products(x)[0], rotation(2.0 * x), rtol=0, atol=2e-13)
    weights = table.weights(x)
    single, inner = mixed(weights, found.stretches), mixed(weights, found.inner)
    for k, place in enumerate(found.within):
        flow = np.eye(2)
        for j in range(place):
            flow = single[:, j] @ flow
        np.testing.assert_allclose(inner[:, k] @ flow, rotation(theta[k] * x), rtol=0, atol=2e-13)
    assert 0.0 < found.missed < 1e-11


def test_one_value_takes_one_node():
    found = solved(oscillator(2.5, 2.5), 4)
    assert found.stretches.shape == (1, 4, 2, 2)
    table = Tabulated(2.5, 2.5, found.stretches)
    np.testing.assert_allclose(table.products(np.array([2.5]))[0][0], rotation(5.0), atol=1e-15)


def test_nodes_and_stretches_are_added_until_nothing_is_missed():
    """Sixteen nodes do not do for a stretch of 20 to 40 rad; nor one stretch for that."""
    found = solved(oscillator(10.0, 20.0, together=8), 8)
    assert found.stretches.shape[0] > 16
    x = np.linspace(10.0, 20.0, 7)
    whole = Tabulated(10.0, 20.0, found.stretches).products(x)[0]
    np.testing.assert_allclose(whole, rotation(2.0 * x), rtol=0, atol=1e-12)
    assert solved(oscillator(100.0, 100.0), 1).stretches.shape[1] > 1


def jumping(where, **options):
    def generators(x):
        turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
        return lambda theta: np.where(theta < where, 1.0, 2.0)[None, :, None, None] * turn

    return Equation(generators, 2, 1.0, 1.0, 1.0, fix="use simulate", **options)


def wavy(harmonic):
    def generators(x):
        wave = np.array([[0.0, 1.0], [0.0, 0.0]])
        return lambda theta: np.cos(harmonic * theta)[None, :, None, None] * wave

    return Equation(generators, 2, 1.0, 1.0, 6.0)


def test_harmonics_of_coefficients_shorten_the_stretches():
    """cos(90 theta) asks for more than two stretches of 3 rad; another fineness for others."""
    first, other = (solved(wavy(90.0), 2, fineness=f) for f in (1.0, 1.37))
    assert first.stretches.shape[1] > 30
    assert other.stretches.shape[1] > 1.2 * first.stretches.shape[1]
    for found in (first, other):
        whole = Tabulated(1.0, 1.0, found.stretches).products(np.ones(1))[0][0]
        assert whole[0, 1] == pytest.approx(np.sin(540.0) / 90.0, abs=1e-13)


def test_a_jump_is_missed_and_told():
    """Inside one of 65536 stretches: that is all that its polynomial misses."""
    found = solved(jumping(0.3), 4)
    whole = Tabulated(1.0, 1.0, found.stretches).products(np.ones(1))[0][0]
    gap = np.max(np.abs(whole - rotation(0.3 + 2.0 * 0.7)))
    assert gap <= found.missed < 0.1


def test_what_no_number_of_stretches_resolves_is_refused():
    for equation in (
        jumping(0.3, most_stretches=256),
        oscillator(1e5, 1e5, most_stretches=256),
    ):
        with pytest.raises(BadInput, match="terms too large for 256 stretches") as caught:
            solved(equation, 4)
        assert "\n" not in str(caught.value)


def test_tables_without_room_are_refused():
    with pytest.raises(BadInput, match="MB a range"):
        solved(oscillator(1.0, 2.0, most_floats=100.0), 4)


def test_coefficients_by_powers():
    """cos(k acos x) by powers of x, exactly."""
    table = solving._by_powers(9)
    x = chebyshev.nodes(23)
    np.testing.assert_allclose(
        x[:, None] ** np.arange(9) @ table, chebyshev.basis(x, 9).T, atol=1e-13
    )
