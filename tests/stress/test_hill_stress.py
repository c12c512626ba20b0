import numpy as np
import pytest
from boundary_cases import rough
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from elastolink.runtime.hill.half_trace import discriminant, discriminant_grid
from elastolink.runtime.hill.perturbation.boundaries import perturbation_boundaries
from half_trace_truth import half_traces
from hypothesis import given, settings
from hypothesis import strategies as st

COSINE = PeriodicFunction([0.0, 1.0])
extended = pytest.mark.skipif(
    np.finfo(np.longdouble).eps > 1e-18, reason="the reference needs a long double of 80 bits"
)


def general(harmonics, fall, seed=0):
    rng = np.random.default_rng(seed)
    size = fall ** np.arange(harmonics + 1)
    b = rng.uniform(-1, 1, harmonics + 1) * size
    b[0] = 0.0
    return PeriodicFunction(rng.uniform(-1, 1, harmonics + 1) * size, b)


@extended
@pytest.mark.parametrize(
    ("low", "high", "reach", "shape"),
    [
        (-300.0, 30.0, 3.0, (60, 40)),
        (-30.0, 30.0, 60.0, (70, 70)),
        (0.0, 4000.0, 2.0, (90, 40)),
        (3990.0, 4000.0, 2.0, (60, 60)),
        (1.0, 1.0 + 1e-9, 1e-9, (60, 60)),
        (-1.0, 20.0, 1e-14, (60, 60)),
        (-1.0, 20.0, 0.0, (5000, 1)),
    ],
)
def test_any_box_is_within_its_figure(low, high, reach, shape):
    f = general(12, 0.7)
    lam2, mu = np.linspace(low, high, shape[0]), np.linspace(-reach, reach, shape[1])
    found = discriminant_grid(f, lam2, mu)
    rng = np.random.default_rng(1)
    i, j = rng.integers(0, shape[0], 40), rng.integers(0, shape[1], 40)
    i[:4], j[:4] = [0, 0, -1, -1], [0, -1, 0, -1]
    truth = half_traces(f, lam2[i], mu[j])
    gap = np.abs(found.value[i, j] - truth).astype(float)
    assert np.all(gap <= found.error[i, j])
    assert found.passed
    # Growth leaves relative accuracy: digits are lost in proportion to the exponent only.
    relative = found.error / np.maximum(1.0, np.abs(found.value))
    assert relative.max() < 1e-9
    assert np.all(gap <= 1e-11 * np.maximum(1.0, np.abs(truth.astype(float))))


@extended
def test_a_rough_function_of_many_harmonics():
    f = rough(150)
    lam2, mu = np.array([0.2, 7.0, 20.0]), np.array([-2.0, 0.7, 2.0])
    found = discriminant(f, lam2, mu)
    assert np.all(np.abs(found.value - half_traces(f, lam2, mu)) <= found.error)
    assert np.all(found.error < 1e-12 * np.maximum(1.0, np.abs(found.value)))


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
    assert found.passed == (exponent < 300)


def test_strong_damping_brings_the_growth_back_into_range():
    """lam2 = -2e4 grows as exp(2 pi sqrt(2e4 + K^2)); exp(-2 pi K) takes most of it away."""
    k = 400.0
    found = discriminant(PeriodicFunction([0.0]), -2e4, 0.0, k)
    exact = 0.5 * np.exp(2 * np.pi * (np.sqrt(2e4 + k * k) - k))
    assert found.value == pytest.approx(exact, rel=1e-9)
    assert found.error < 1e-9 * exact
    assert found.level == pytest.approx(0.5)


def test_thousands_of_oscillations_per_turn():
    lam2 = np.array([1e4, 1e6, 1e8])
    found = discriminant(PeriodicFunction([0.0]), lam2 + 0.3, 0.0)
    exact = np.cos(2 * np.pi * np.sqrt(lam2 + 0.3))
    slack = 2 * np.pi * np.sqrt(lam2) * 4e-16
    assert np.all(np.abs(found.value - exact) <= found.error + slack)
    assert found.error.max() < 1e-7


@pytest.mark.parametrize("mu", [1e-300, 1e-20, 1e-8])
def test_mu_tends_to_zero(mu):
    regions = (0, 1, 2, 3, 6)
    found = hill_boundaries(COSINE, mu, regions)
    first = perturbation_boundaries(COSINE, mu, regions)
    slack = found.error + first.error
    assert np.all(np.abs(found.upper - first.upper) <= slack)
    assert np.all(np.abs(found.lower[1:] - first.lower[1:]) <= slack[1:])


@pytest.mark.parametrize("mu", [100.0, -1e4])
def test_deep_wells_have_the_levels_of_the_oscillator(mu):
    """Levels r of a deep cosine well, Abramowitz & Stegun 20.2.30 with q = 2 mu, a = 4 lam2."""
    found = hill_boundaries(COSINE, mu, (1, 2, 3))
    expected = []
    for n in (1, 2, 3):
        for level in (n - 1, n):
            shift = (2 * level**2 + 2 * level + 1) / 16
            expected.append(-abs(mu) + (level + 0.5) * np.sqrt(2 * abs(mu)) - shift)
    ours = np.stack([found.lower, found.upper], axis=1).ravel()
    np.testing.assert_allclose(ours, expected, rtol=0, atol=2.0 / np.sqrt(abs(mu)))
    assert found.error.max() < 1e-11 * abs(mu)


def test_high_regions():
    found = hill_boundaries(general(8, 0.6), np.array([0.4, -0.9]), (40, 99, 100))
    f = general(8, 0.6)
    for i in range(3):
        for ends in (found.lower[i], found.upper[i]):
            half = discriminant(f, ends, found.mu)
            assert np.all(np.abs(np.abs(half.value) - 1) <= half.error + found.error[i])
    squares = np.array([40, 99, 100])[:, None] ** 2 / 4
    assert np.all(np.abs(found.lower - squares + f.a[0] * found.mu) < 0.05)


def test_sparse_harmonics():
    """Only the tenth harmonic: Mathieu's equation at a tenth of the angle."""
    f = PeriodicFunction(np.eye(11)[10])
    same = hill_boundaries(COSINE, 0.02, (1, 2))
    found = hill_boundaries(f, 2.0, (10, 20))
    np.testing.assert_allclose(found.lower, 100 * same.lower, rtol=0, atol=1e-11)
    np.testing.assert_allclose(found.upper, 100 * same.upper, rtol=0, atol=1e-11)
    others = hill_boundaries(f, 2.0, (1, 2, 3, 11, 19))
    assert np.all(np.abs(others.width) <= 2 * others.error)


@settings(max_examples=60, deadline=None)
@given(
    bad=st.sampled_from([np.nan, np.inf, -np.inf]),
    where=st.integers(0, 2),
    what=st.sampled_from([discriminant, hill_boundaries, perturbation_boundaries]),
)
def test_nothing_but_finite_numbers_is_accepted(bad, where, what):
    if what is discriminant:
        arguments = [1.0, 1.0, 0.1]
        arguments[where] = [1.0, bad]
        with pytest.raises(BadInput, match="not finite"):
            discriminant(COSINE, *arguments)
        return
    keywords = {"mu": 1.0, "damping": 0.1}
    keywords[("mu", "damping")[where % 2]] = [0.5, bad]
    with pytest.raises(BadInput, match="not finite"):
        what(COSINE, regions=(1,), **keywords)


def test_points_that_hardly_differ():
    """A box of one unit in the last place still ends."""
    one = np.nextafter(1.0, 2.0)
    lam2 = np.tile([1.0, one], 5000)
    mu = np.repeat([0.5, np.nextafter(0.5, 1.0)], 5000)
    found = discriminant(COSINE, lam2, mu)
    np.testing.assert_allclose(found.value, found.value[0], atol=1e-14)


def test_many_regions_of_a_wild_scatter():
    rng = np.random.default_rng(8)
    lam2 = rng.uniform(-50, 1500, 20000)
    mu = rng.uniform(-40, 40, 20000)
    found = discriminant(COSINE, lam2, mu)
    some = rng.integers(0, 20000, 50)
    alone = discriminant(COSINE, lam2[some], mu[some])
    assert np.all(np.abs(found.value[some] - alone.value) <= found.error[some] + alone.error)
