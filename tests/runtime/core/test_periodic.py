import numpy as np
import pytest
from elastolink.runtime.core.periodic_function import PeriodicFunction, segment_values
from hill_functions import end_load
from hypothesis import given, settings
from hypothesis import strategies as st
from refusals import refused

coefficients = st.lists(st.floats(-10, 10), min_size=1, max_size=12)


@given(a=coefficients, b=coefficients, theta=st.lists(st.floats(-20, 20), max_size=5))
def test_it_is_the_sum_that_the_docstring_states(a, b, theta):
    b[0] = 0.0
    f = PeriodicFunction(a, b)
    theta = np.array(theta)
    expected = sum(c * np.cos(m * theta) for m, c in enumerate(a)) + sum(
        c * np.sin(m * theta) for m, c in enumerate(b)
    )
    assert f(theta).shape == theta.shape
    np.testing.assert_allclose(f(theta), expected, rtol=0, atol=1e-11)


@given(a=coefficients, b=coefficients, spare=st.integers(1, 9))
def test_samples_give_the_coefficients_back(a, b, spare):
    b[0] = 0.0
    f = PeriodicFunction(a, b)
    n = 2 * f.harmonics + spare
    again = PeriodicFunction.from_samples(f(2 * np.pi * np.arange(n) / n))
    size = len(f.a)
    np.testing.assert_allclose(again.a[:size], f.a, rtol=0, atol=1e-12)
    np.testing.assert_allclose(again.b[:size], f.b, rtol=0, atol=1e-12)


def test_even_sample_counts_put_the_highest_harmonic_into_the_cosine():
    f = PeriodicFunction.from_samples([1.0, -1.0, 1.0, -1.0])
    np.testing.assert_allclose(f.a, [0.0, 0.0, 1.0], atol=1e-16)
    assert not f.b.any()


@pytest.mark.parametrize("eccentricity", [0.1, 0.5, 0.9])
def test_a_known_series(eccentricity):
    """1/(1 - r cos) has the coefficients 2 q^m / sqrt(1 - r^2), q = (1 - sqrt(1 - r^2)) / r."""
    r = eccentricity
    f = PeriodicFunction.from_callable(lambda theta: 1 / (1 - r * np.cos(theta)))
    root = np.sqrt(1 - r * r)
    exact = 2 * ((1 - root) / r) ** np.arange(f.harmonics + 1) / root
    exact[0] /= 2
    np.testing.assert_allclose(f.a, exact, rtol=0, atol=1e-14)
    np.testing.assert_allclose(f.b, 0, rtol=0, atol=1e-14)


def peak(width, place):
    return lambda theta: np.cos(theta) + 0.5 * np.exp(-(((theta - place) / width) ** 2))


@pytest.mark.parametrize(
    ("meant", "tol", "most"),
    [
        *((end_load(*lengths), None, 1e-12) for lengths in ((5, 1, 5, 2), (10, 1, 10, 4))),
        *((peak(*given), None, 1e-12) for given in ((0.01, 1.05), (0.02, 1.0), (0.004, 4.2))),
        (lambda t: np.cos(t) + 1e-13 * np.sin(1e9 * t), None, 1e-10),
        (lambda t: np.cos(t) + 1e-12 * np.sign(np.sin(t - 0.3)), None, 1e-11),
        *((lambda t: np.sign(np.sin(t)), tol, None) for tol in (0.1, 0.01)),
        *((lambda t: np.abs(np.sin(t)), tol, None) for tol in (1e-2, 1e-4)),
        *((lambda t: 1 / (1.0001 - np.cos(t)), tol, None) for tol in (1e-2, 1e-4, 1e-8, None)),
    ],
)
def test_the_error_covers_the_function(meant, tol, most):
    f = PeriodicFunction.from_callable(meant, tol=tol)
    theta = np.concatenate([np.linspace(-0.1, 0.1, 2001), np.linspace(0.0, 2 * np.pi, 20_001)])
    gap = np.abs(f(theta) - meant(theta)).max()
    assert gap <= f.error < (most or 10 * gap)


@pytest.mark.parametrize("order", [7, 31, 32, 40, 64, 500])
def test_high_harmonics_are_not_mistaken_for_low_ones(order):
    f = PeriodicFunction.from_callable(lambda theta: np.cos(order * theta))
    assert f.harmonics == order
    assert f.a[order] == pytest.approx(1.0, abs=1e-13)


def saw(theta):
    return np.asarray(theta) % (2 * np.pi)


test_unusable_functions_are_refused_by_name = refused(
    PeriodicFunction.from_callable,
    [
        (saw, "saw"),
        (lambda theta: np.where(theta > 3, np.nan, 1.0), "not finite"),
        (lambda theta: theta[:3], "one value per angle"),
    ],
)
test_unusable_numbers_are_refused = refused(
    lambda given, theta=0.0: PeriodicFunction(**given)(theta),
    [
        ({"a": [np.nan]}, "finite"),
        ({"a": [1.0, np.inf]}, "finite"),
        ({"a": [[1.0]]}, "a: found"),
        ({"a": []}, "a: found"),
        ({"a": [0.0], "b": [1.0]}, "b"),
        ({"a": ["one"]}, "a: found"),
        ({"a": [1.0], "error": -1.0}, "error"),
        ({"a": [1.0]}, np.inf, "theta"),
    ],
)


@settings(max_examples=25)
@given(a=coefficients, b=coefficients, c=st.floats(-5, 5))
def test_arithmetic(a, b, c):
    b[0] = 0.0
    f, g = PeriodicFunction(a, error=1e-3), PeriodicFunction(a=[0.0, 1.0], b=b, error=2e-3)
    theta = np.linspace(0, 7, 11)
    np.testing.assert_allclose((f + g)(theta), f(theta) + g(theta), atol=1e-12)
    np.testing.assert_allclose((c * f)(theta), c * f(theta), atol=1e-12)
    np.testing.assert_allclose((f - g)(theta), f(theta) - g(theta), atol=1e-12)
    np.testing.assert_allclose((f + c)(theta), f(theta) + c, atol=1e-12)
    assert (f + g).error == pytest.approx(3e-3)
    assert (f * c).error == pytest.approx(abs(c) * 1e-3)
    h = 1e-5
    slope = (f(theta + h) - f(theta - h)) / (2 * h)
    np.testing.assert_allclose(f.derivative()(theta), slope, atol=1e-5)


def test_truncation_never_changes_the_function_by_more_than_it_says():
    m = np.arange(40)
    f = PeriodicFunction(0.7**m, np.where(m > 0, (-0.6) ** m, 0.0))
    short = f.truncated(1e-3)
    theta = np.linspace(0, 7, 500)
    gap = np.abs(short(theta) - f(theta)).max()
    assert short.harmonics < f.harmonics
    assert 0 < gap <= short.error <= 1e-3
    assert f.truncated() is f
    assert PeriodicFunction([1.0, 0.0, 0.0]).truncated().harmonics == 0


def test_it_is_immutable():
    f = PeriodicFunction([1.0, 2.0])
    with pytest.raises(ValueError, match="read-only"):
        f.a[0] = 5.0
    with pytest.raises(AttributeError):
        f.error = 1.0


@pytest.mark.parametrize("harmonics", [0, 3, 4, 11, 60])
def test_values_on_segments(harmonics):
    rng = np.random.default_rng(0)
    b = rng.uniform(-1, 1, harmonics + 1)
    b[0] = 0.0
    f = PeriodicFunction(rng.uniform(-1, 1, harmonics + 1), b)
    nodes = (-0.5, 0.0, 1.0)
    theta = 2 * np.pi * (np.arange(4)[:, None] + 0.5 * (1 + np.array(nodes))) / 4
    np.testing.assert_allclose(segment_values(f, 4, nodes), f(theta), rtol=0, atol=1e-12)


def test_huge_values_do_not_overflow():
    f = PeriodicFunction.from_callable(lambda theta: 1e300 * np.cos(theta))
    assert f.harmonics == 1 and f.error < 1e287
