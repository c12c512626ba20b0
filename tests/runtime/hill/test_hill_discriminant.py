import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.half_trace import discriminant, discriminant_grid
from half_trace_truth import half_traces
from hill_functions import functions
from hypothesis import given, settings
from hypothesis import strategies as st

FUNCTIONS = functions()
extended = pytest.mark.skipif(
    np.finfo(np.longdouble).eps > 1e-18, reason="the reference needs a long double of 80 bits"
)


@pytest.mark.parametrize("name", FUNCTIONS)
@extended
def test_half_traces_against_a_taylor_series_in_extended_precision(name):
    f = FUNCTIONS[name]
    rng = np.random.default_rng(1)
    lam2, mu = rng.uniform(0, 30, 60), rng.uniform(-2, 2, 60)
    lam2[:3], mu[:3] = [0.0, 0.0, 30.0], [2.0, -2.0, 0.0]
    found = discriminant(f, lam2, mu)
    error = np.abs(found.value - half_traces(f, lam2, mu)).astype(float)
    assert error.max() < 1e-11
    assert np.all(error <= found.error)
    assert found.passed


@pytest.mark.parametrize("name", FUNCTIONS)
def test_half_traces_against_heyoka(name):
    from hill_functions import batched_heyoka

    pytest.importorskip("heyoka")
    f = FUNCTIONS[name]
    lam2, mu = np.linspace(0.3, 29.0, 24), np.linspace(-2.0, 2.0, 24)
    # heyoka's own error at tolerance 1e-12 reaches a few units of 1e-12 where the motion grows.
    scale = np.maximum(1.0, np.abs(half_traces(f, lam2, mu)).astype(float))
    gap = np.abs(discriminant(f, lam2, mu).value - batched_heyoka(f)(lam2, mu))
    assert np.all(gap < 1e-11 * scale)


def taylor_half_trace(f, lam2, mu, steps=64, order=36):
    """Integrate by Taylor series with mpmath's numbers, at its current precision."""
    from mpmath import mp, mpf

    h = 2 * mp.pi / steps
    a, b = [mpf(x) for x in f.a], [mpf(x) for x in f.b]
    columns = [[mpf(1), mpf(0)], [mpf(0), mpf(1)]]
    for step in range(steps):
        series = [mpf(0)] * order
        for m in range(f.harmonics + 1):
            cos, sin = mp.cos_sin(m * h * step)
            value, slope, factor = a[m] * cos + b[m] * sin, b[m] * cos - a[m] * sin, mpf(1)
            for k in range(order):
                series[k] += factor * (value, slope, -value, -slope)[k % 4]
                factor *= m * h / (k + 1)
        potential = [mpf(mu) * s for s in series]
        potential[0] += mpf(lam2)
        for column in columns:
            terms = [column[0], column[1] * h]
            for k in range(order - 2):
                total = mp.fdot(potential[: k + 1], terms[k::-1])
                terms.append(-h * h * total / ((k + 1) * (k + 2)))
            column[:] = mp.fsum(terms), mp.fsum(k * t for k, t in enumerate(terms)) / h
    return (columns[0][0] + columns[1][1]) / 2


@pytest.mark.parametrize(
    ("name", "lam2", "mu"),
    [("f3 (5,1,5,2)", 2.25, 1.5), ("f3 (10,1,10,4)", 9.1, -2.0), ("24 harmonics", 0.3, 0.9)],
)
def test_half_traces_against_mpmath(name, lam2, mu):
    from mpmath import mp

    f = FUNCTIONS[name]
    with mp.workdps(30):
        truth = taylor_half_trace(f, lam2, mu)
        found = discriminant(f, lam2, mu)
        assert abs(truth - float(found.value)) < 1e-13
        assert abs(truth - float(found.value)) <= found.error


@given(
    lam2=st.floats(-100, 1000),
    mean=st.floats(-2, 2),
    mu=st.floats(-5, 5),
    k=st.floats(0, 1),
)
def test_a_constant_coefficient_has_its_closed_form(lam2, mean, mu, k):
    f = PeriodicFunction([mean])
    found = discriminant(f, lam2, mu, k)
    root = np.sqrt(complex(lam2 + mu * mean - k * k))
    exact = (np.exp(-2 * np.pi * k) * np.cos(2 * np.pi * root)).real
    # The closed form loses digits itself: the argument's round-off times its size.
    slack = 1e-15 * (1 + 2 * np.pi * abs(root)) * np.exp(2 * np.pi * (abs(root.imag) - k))
    assert abs(found.value - exact) <= found.error + 4 * slack


def test_meissner_equation_through_its_fourier_series():
    """A square wave: the product of two constant segments is exact; the series tends to it."""
    lam2, mu = 1.3, 0.7
    p, q = np.sqrt(lam2 + mu), np.sqrt(lam2 - mu)
    cp, sp, cq, sq = np.cos(np.pi * p), np.sin(np.pi * p), np.cos(np.pi * q), np.sin(np.pi * q)
    exact = cp * cq - 0.5 * (p / q + q / p) * sp * sq
    gaps = []
    tops = (159, 319, 639)
    for top in tops:
        m = np.arange(top + 1)
        a = np.where(m % 2 == 1, 4 / np.pi * np.sin(m * np.pi / 2) / np.maximum(m, 1), 0.0)
        gaps.append(abs(discriminant(PeriodicFunction(a), lam2, mu).value - exact))
    slopes = np.log2(np.array(gaps[:-1]) / gaps[1:])
    # The tail of the series enters squared over its frequency squared: third order.
    np.testing.assert_allclose(slopes, 3.0, atol=0.1)


@pytest.mark.parametrize("name", FUNCTIONS)
@extended
def test_a_chart_is_within_its_figure_everywhere(name):
    f = FUNCTIONS[name]
    lam2, mu = np.linspace(0, 30, 300), np.linspace(0, 2, 200)
    found = discriminant_grid(f, lam2, mu)
    assert found.value.shape == found.error.shape == (300, 200)
    assert "Chebyshev" in found.method
    rng = np.random.default_rng(2)
    i, j = rng.integers(0, 300, 300), rng.integers(0, 200, 300)
    i[:4], j[:4] = [0, 0, 299, 299], [0, 199, 0, 199]
    gap = np.abs(found.value[i, j] - half_traces(f, lam2[i], mu[j])).astype(float)
    assert np.all(gap <= found.error[i, j])
    assert found.error.max() < 1e-10
    assert found.passed


def test_grid_scattered_and_single_points_agree():
    f = FUNCTIONS["24 harmonics"]
    rng = np.random.default_rng(3)
    lam2, mu = rng.uniform(-1, 40, 120), rng.uniform(-3, 3, 90)
    grid = discriminant_grid(f, lam2, mu)
    mesh = discriminant(f, *np.meshgrid(lam2, mu))
    np.testing.assert_array_equal(grid.value, mesh.value.T)
    x, y = np.repeat(lam2, 90), np.tile(mu, 120)
    order = rng.permutation(x.size)
    scattered = discriminant(f, x[order], y[order])
    gap = np.abs(scattered.value - grid.value.ravel()[order])
    assert np.all(gap <= scattered.error + grid.error.ravel()[order])
    for i, j in ((0, 0), (7, 3), (119, 89)):
        point = discriminant(f, lam2[i], mu[j])
        assert point.value.shape == ()
        assert abs(point.value - grid.value[i, j]) <= point.error + grid.error[i, j]


SHAPES = [(), (1,), (3,), (3, 1), (1, 4), (3, 4), (2, 1, 1), (1, 3, 1), (2, 3, 4), (0,), (2, 0)]


@settings(max_examples=60, deadline=None)
@given(shapes=st.tuples(*[st.sampled_from(SHAPES)] * 3), seed=st.integers(0, 99))
def test_arguments_broadcast(shapes, seed):
    f = PeriodicFunction([0.1, 1.0, 0.2], [0, -0.3, 0.1])
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        with pytest.raises(BadInput, match="broadcast"):
            discriminant(f, *[np.ones(s) for s in shapes])
        return
    rng = np.random.default_rng(seed)
    lam2, mu, k = rng.uniform(0, 5, shapes[0]), rng.uniform(0, 2, shapes[1]), None
    k = rng.uniform(0, 0.2, shapes[2])
    found = discriminant(f, lam2, mu, k)
    assert found.value.shape == found.error.shape == shape
    assert np.broadcast_shapes(found.level.shape, shape) == shape
    for index in list(np.ndindex(shape))[:5]:
        one = [np.broadcast_to(item, shape)[index] for item in (lam2, mu, k)]
        alone = discriminant(f, *one)
        assert abs(alone.value - found.value[index]) <= alone.error + found.error[index]


@extended
def test_damping_scales_and_shifts():
    f = FUNCTIONS["f3 (5,1,5,2)"]
    lam2, mu, k = np.linspace(0.1, 9, 7)[:, None], np.linspace(0.2, 2, 5), 0.07
    found = discriminant(f, lam2, mu, k)
    truth = half_traces(f, lam2, mu, k)
    assert np.all(np.abs(found.value - truth) <= found.error)
    bare = discriminant(f, lam2 - k * k, mu)
    np.testing.assert_allclose(found.value, np.exp(-2 * np.pi * k) * bare.value, atol=1e-13)
    assert found.level == pytest.approx(np.exp(-2 * np.pi * k) * np.cosh(2 * np.pi * k), rel=1e-15)


def test_the_level_is_where_a_multiplier_reaches_the_unit_circle():
    """rho^2 - 2 X rho + exp(-4 pi K) = 0, Smith (7.9) with the damped Wronskian."""
    f = PeriodicFunction([0.0, 1.0])
    found = discriminant(f, np.linspace(-0.5, 3, 400), 0.6, 0.05)
    w = np.exp(-4 * np.pi * 0.05)
    root = np.sqrt(found.value.astype(complex) ** 2 - w)
    largest = np.maximum(np.abs(found.value + root), np.abs(found.value - root))
    assert 0 < found.stable.sum() < 400
    np.testing.assert_array_equal(found.stable, largest < 1.0)


def test_even_and_odd_mu_of_a_half_shifted_function():
    """F(theta + pi) = -F(theta) for odd harmonics alone: the half trace is even in mu."""
    f = PeriodicFunction([0, 1, 0, 0.3], [0, 0.2, 0, -0.4])
    lam2 = np.linspace(0, 10, 50)
    up, down = discriminant(f, lam2, 1.7), discriminant(f, lam2, -1.7)
    assert np.all(np.abs(up.value - down.value) <= up.error + down.error)


def test_the_error_of_the_function_enters():
    f = PeriodicFunction([0.0, 1.0], error=1e-6)
    found = discriminant(f, 2.0, 1.0)
    moved = discriminant(PeriodicFunction([1e-6, 1.0]), 2.0, 1.0)
    assert abs(found.value - moved.value) < found.error < 1e-4


def test_the_same_input_gives_the_same_bytes():
    f = FUNCTIONS["f3 (2,1,2,2)"]
    lam2, mu = np.linspace(0, 30, 200), np.linspace(0, 2, 200)
    first, second = (discriminant_grid(f, lam2, mu) for _ in range(2))
    assert first.value.tobytes() == second.value.tobytes()
    assert first.error.tobytes() == second.error.tobytes()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([np.nan], 1.0), "lam2"),
        ((1.0, np.inf), "mu"),
        ((1.0, 1.0, np.nan), "damping"),
        ((1.0, 1.0, -0.1), "K >= 0"),
        ((np.ones(3), np.ones(4)), "broadcast"),
        (("one", 1.0), "lam2"),
        ((1e13, 1.0), "scale the equation"),
    ],
)
def test_bad_input(arguments, message):
    with pytest.raises(BadInput, match=message):
        discriminant(PeriodicFunction([0.0, 1.0]), *arguments)


def test_anything_but_a_periodic_function_is_refused():
    with pytest.raises(BadInput, match="PeriodicFunction"):
        discriminant(np.cos, 1.0, 1.0)


def test_plots():
    import matplotlib.pyplot as plt

    f = PeriodicFunction([0.0, 1.0])
    grid = discriminant_grid(f, np.linspace(0, 3, 20), np.linspace(0, 1, 10))
    line = discriminant(f, np.linspace(0, 3, 20), 0.3)
    assert grid.plot().get_ylabel() == r"$\mu$"
    assert line.plot().get_ylabel() == "half trace"
    with pytest.raises(BadInput, match="a line or a grid"):
        discriminant(f, 1.0, 1.0).plot()
    plt.close("all")


def test_an_overflow_fails_a_check():
    found = discriminant(PeriodicFunction([0.0, 1.0]), [-1e5, 1.0], 1.0)
    assert np.isinf(found.value[0]) and not found.passed
    assert found.checks["entries beyond the range of doubles"].value == 1
    assert discriminant(PeriodicFunction([0.0, 1.0]), [-1e3, 1.0], 1.0).passed


def test_a_grid_leaves_as_long_form_with_its_verdict(tmp_path):
    lam2, mu = np.linspace(0.0, 2.0, 4), np.linspace(0.0, 1.0, 3)
    found = discriminant_grid(PeriodicFunction([0.0, 1.0]), lam2, mu)
    header, *lines = found.save(tmp_path / "d.csv").read_text().splitlines()
    rows = [dict(zip(header.split(","), line.split(","), strict=True)) for line in lines]
    assert len(rows) == 12
    for row, (i, j) in zip(rows, np.ndindex(4, 3), strict=True):
        assert float(row["lam2"]) == lam2[i] and float(row["mu"]) == mu[j]
        assert float(row["value"]) == found.value[i, j]
        assert row["stable"] == str(found.stable[i, j])
    assert found.to_dict()["stable"] == found.stable.tolist()
    assert {"elastolink", "numpy"} <= set(found.provenance)
