"""Taylor models: what they leave out is bounded, of third order, and round-off is in it."""

import itertools

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.taylor_models import TaylorModel, UndecidedError, features

MIDDLE = np.array([1.3, 0.7, 2.1])
ANGLES = np.array([0.0, 0.4, 1.9, np.pi, 4.0])
EXPRESSIONS = {
    "product": lambda a, b, c, f: a * b * c - b * b + 2.0,
    "quotient": lambda a, b, c, f: (a - 3.0) / (b + c**2) + 1.0 / a + a**-3 + a / 4.0,
    "root": lambda a, b, c, f: f.sqrt(a * a + b * c) - c**0.5,
    "sines": lambda a, b, c, f: f.sin(a * b) * f.cos(c - 5.0 * b),
    "tangent": lambda a, b, c, f: f.tan(a - b) + f.tan(2.0 * b),
    "angle": lambda a, b, c, f: f.atan2(b - a, c - 0.5) + f.atan2(c, a - 4.0),
    "size": lambda a, b, c, f: abs(b - a) + (b < a) * c,
}


def drawn(count):
    """Return points of the box, the corners first."""
    corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    return np.concatenate([corners, np.random.default_rng(5).uniform(-1.0, 1.0, (count, 3))])


@pytest.mark.parametrize("name", EXPRESSIONS)
def test_remainder_is_bounded_and_of_third_order(name):
    expression, points = EXPRESSIONS[name], drawn(2000)
    rests = []
    for width in (0.02, 0.01):
        model = expression(*TaylorModel.numbers(MIDDLE, width * MIDDLE), np)
        values = expression(*(MIDDLE * (1.0 + width * points)).T, np)
        gap = np.abs(values - features(points) @ model.coefficients)
        assert np.max(gap) <= model.rest + 1e-14
        low, high = model.bounds()
        assert low <= np.min(values) and np.max(values) <= high
        assert np.max(values) - np.min(values) > 0.9 * (high - low)
        rests.append(float(model.rest))
    if name != "size":
        assert np.max(gap) > 0.02 * rests[1]
        assert 2.7 < np.log2(rests[0] / rests[1]) < 3.6
    else:
        assert rests[0] < 1e-13


@pytest.mark.parametrize("name", EXPRESSIONS)
def test_round_off_is_within_the_bound(name):
    expression = EXPRESSIONS[name]
    model = expression(*TaylorModel.numbers(MIDDLE, np.zeros(3)), np)
    with mpmath.workdps(50):
        exact = expression(*map(mpmath.mpf, MIDDLE.tolist()), mpmath)
        off = float(abs(exact - float(model.middle)))
    assert off <= model.rest < 1e-12


def test_arrays_of_angles_beside_numbers():
    a, b, _ = TaylorModel.numbers(MIDDLE, 0.01 * MIDDLE)
    model = np.sin(ANGLES) * a + ANGLES / 2.0 * b - np.float64(2.0) / a
    points = drawn(100)
    x, y, _ = (MIDDLE * (1.0 + 0.01 * points)).T[..., None]
    values = np.sin(ANGLES) * x + ANGLES / 2.0 * y - 2.0 / x
    assert model.rest.shape == ANGLES.shape
    gap = np.abs(values - features(points) @ model.coefficients.T)
    assert np.all(np.max(gap, axis=0) <= model.rest + 1e-14)
    assert np.all(model[1:3].middle == model.middle[1:3])


def test_halves_of_angles_are_exact_so_that_a_straight_angle_has_a_tangent():
    lifted = TaylorModel.numbers(MIDDLE, 0.01 * MIDDLE)[0].lifted
    half = (ANGLES + lifted(0.0)) / 2.0
    assert np.all(half.rest == 0.0)
    tangent = np.tan(half)
    assert tangent.middle[3] == np.tan(np.pi / 2.0) and tangent.rest[3] < 1e-13 * tangent.middle[3]
    square = 1.0 / (1.0 + tangent**2)
    assert square.middle == pytest.approx(np.cos(ANGLES / 2.0) ** 2, abs=1e-15)
    assert np.all(square.rest < 1e-13 * np.abs(square.middle))


def test_what_has_no_bound_is_no_number():
    a, b, _ = TaylorModel.numbers(np.array([0.01, -1.0, 1.0]), np.array([0.02, 0.1, 0.1]))
    with np.errstate(invalid="ignore"):
        wrong = np.sqrt(a), 1.0 / a, np.arctan2(a, b), np.tan(a + 1.56), np.sqrt(b)
    assert all(np.isnan(one.rest) for one in wrong)
    assert np.isfinite(np.arctan2(b, a).rest) and np.isfinite((1.0 / b).rest)


def test_comparisons_that_are_not_the_same_for_all_numbers_are_refused():
    a, b, _ = TaylorModel.numbers(np.array([1.0, 1.1, 2.0]), np.array([0.2, 0.05, 0.1]))
    with pytest.raises(UndecidedError):
        _ = a > b
    with pytest.raises(UndecidedError):
        abs(a - b)
    assert a + 1.0 > b and not (a < b - 0.5) and np.greater(np.real(b), 0.5)
    with pytest.raises(TypeError):
        np.exp(a)
    with pytest.raises(TypeError):
        _ = a**1.5
