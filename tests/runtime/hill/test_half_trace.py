"""Half traces: other integrators, closed forms, extremes, shapes."""

import numpy as np
import pytest
from boundary_cases import rough
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import discriminant, hill_boundaries
from half_trace_truth import half_traces
from hill_functions import COSINE, general
from honesty import extended
from hypothesis import given, settings
from hypothesis import strategies as st

SHAPES = [(), (1,), (4,), (3, 1), (1, 4), (3, 4), (2, 1, 1), (1, 3, 1), (2, 3, 4)]


@given(lam2=st.floats(-100, 1e6), mean=st.floats(-2, 2), mu=st.floats(-5, 5), k=st.floats(0, 1))
def test_a_constant_coefficient_has_its_closed_form(lam2, mean, mu, k):
    f = PeriodicFunction([mean])
    found = discriminant(f, lam2, mu, k)
    root = np.sqrt(complex(lam2 + mu * mean - k * k))
    exact = (np.exp(-2 * np.pi * k) * np.cos(2 * np.pi * root)).real
    # The closed form loses digits itself: the argument's round-off times its size.
    slack = 1e-15 * (1 + 2 * np.pi * abs(root)) * np.exp(2 * np.pi * (abs(root.imag) - k))
    assert abs(found.value - exact) <= found.error + 4 * slack


@settings(max_examples=25, deadline=None)
@given(shapes=st.tuples(*[st.sampled_from(SHAPES)] * 3), seed=st.integers(0, 99))
def test_arguments_broadcast(shapes, seed):
    f = PeriodicFunction([0.1, 1.0, 0.2], [0, -0.3, 0.1])
    shape = np.broadcast_shapes(*shapes)
    rng = np.random.default_rng(seed)
    lam2, mu, k = (rng.uniform(0, most, s) for most, s in zip((5, 2, 0.2), shapes, strict=True))
    found = discriminant(f, lam2, mu, k)
    assert found.value.shape == found.error.shape == shape
    assert np.broadcast_shapes(found.level.shape, shape) == shape
    for index in list(np.ndindex(shape))[:5]:
        one = [np.broadcast_to(item, shape)[index] for item in (lam2, mu, k)]
        alone = discriminant(f, *one)
        assert abs(alone.value - found.value[index]) <= alone.error + found.error[index]


def test_the_level_is_where_a_multiplier_reaches_the_unit_circle():
    """rho^2 - 2 X rho + exp(-4 pi K) = 0, Smith (7.9) with the damped Wronskian."""
    f = PeriodicFunction([0.0, 1.0])
    found = discriminant(f, np.linspace(-0.5, 3, 400), 0.6, 0.05)
    w = np.exp(-4 * np.pi * 0.05)
    root = np.sqrt(found.value.astype(complex) ** 2 - w)
    largest = np.maximum(np.abs(found.value + root), np.abs(found.value - root))
    assert 0 < found.stable.sum() < 400
    np.testing.assert_array_equal(found.stable, largest < 1.0)


def test_the_error_of_the_function_enters():
    f = PeriodicFunction([0.0, 1.0], error=1e-6)
    found = discriminant(f, 2.0, 1.0)
    moved = discriminant(PeriodicFunction([1e-6, 1.0]), 2.0, 1.0)
    assert abs(found.value - moved.value) < found.error < 1e-4


def test_plots():
    f = PeriodicFunction([0.0, 1.0])
    grid = discriminant(f, np.linspace(0, 3, 20)[:, None], np.linspace(0, 1, 10))
    line = discriminant(f, np.linspace(0, 3, 20), 0.3)
    assert grid.plot().get_ylabel() == r"$\mu$"
    assert line.plot().get_ylabel() == "half trace"
    with pytest.raises(BadInput, match="a line or a grid"):
        discriminant(f, 1.0, 1.0).plot()


@extended
@pytest.mark.parametrize(
    ("low", "high", "reach", "shape"),
    [
        (-30.0, 30.0, 60.0, (70, 70)),
        pytest.param(3990.0, 4000.0, 2.0, (60, 60), marks=pytest.mark.slow),
        (1.0, 1.0 + 1e-9, 1e-9, (60, 60)),
        (-1.0, 20.0, 1e-14, (60, 60)),
        (-1.0, 20.0, 0.0, (5000, 1)),
    ],
)
def test_any_box_is_within_its_error(low, high, reach, shape):
    f = general(12, 0.7)
    lam2, mu = np.linspace(low, high, shape[0]), np.linspace(-reach, reach, shape[1])
    found = discriminant(f, lam2[:, None], mu)
    rng = np.random.default_rng(1)
    i, j = rng.integers(0, shape[0], 8), rng.integers(0, shape[1], 8)
    i[:4], j[:4] = [0, 0, -1, -1], [0, -1, 0, -1]
    truth = half_traces(f, lam2[i], mu[j])
    gap = np.abs(found.value[i, j] - truth).astype(float)
    assert np.all(gap <= found.error[i, j])
    assert found.passed
    # Growth leaves relative accuracy: digits are lost in proportion to the exponent only.
    relative = found.error / np.maximum(1.0, np.abs(found.value))
    assert relative.max() < 1e-9
    assert np.all(gap <= 1e-11 * np.maximum(1.0, np.abs(truth.astype(float))))


@pytest.mark.slow
def test_a_thousand_harmonics():
    """Half traces against the Hill matrix: two routes with nothing in common."""
    f = rough(1000)
    ends = hill_boundaries(f, 0.3, (1, 2))
    for points in (ends.lower, ends.upper):
        half = discriminant(f, points, 0.3)
        assert half.error.max() < 1e-11
        assert np.all(np.abs(half.value - [-1.0, 1.0]) <= half.error + 10 * ends.error)
    assert ends.error.max() < 1e-8


@pytest.mark.parametrize("lam2", [-1e4, -3e5, -1e7])
def test_growth_beyond_the_range_of_doubles(lam2):
    found = discriminant(COSINE, [lam2, lam2], [1.0, -1.0])
    exponent = 2 * np.pi * np.sqrt(-lam2) / np.log(10)
    if exponent < 300:
        np.testing.assert_allclose(np.log10(found.value), exponent, rtol=1e-2)
        assert np.all(found.error < 1e-9 * found.value)
    else:
        assert np.all(np.isposinf(found.value))
        assert np.all(np.isposinf(found.error))
    assert not found.stable.any()
    beyond = found.checks["entries beyond the range of doubles"]
    assert beyond.value == np.count_nonzero(np.isinf(found.value))
    assert found.passed == (exponent < 300)


def test_strong_damping_brings_the_growth_back_into_range():
    """lam2 = -2e4 grows as exp(2 pi sqrt(2e4 + K^2)); exp(-2 pi K) takes most of it away."""
    k = 400.0
    found = discriminant(PeriodicFunction([0.0]), -2e4, 0.0, k)
    exact = 0.5 * np.exp(2 * np.pi * (np.sqrt(2e4 + k * k) - k))
    assert found.value == pytest.approx(exact, rel=1e-9)
    assert found.error < 1e-9 * exact
    assert found.level == pytest.approx(0.5)
