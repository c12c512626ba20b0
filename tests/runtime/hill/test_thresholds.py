"""Critical damping and least parameter: exact, by orders, and against each other."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import critical_damping, discriminant, hill_boundaries

COSINE = PeriodicFunction([0.0, 1.0])
GENERAL = PeriodicFunction([0.3, 1.0, -0.4, 0.25], [0.0, -0.5, 0.3, 0.1])
REGIONS = (1, 2, 3)


def least_parameter(f, damping, regions=(1, 2), order=None):
    return critical_damping(f, None, regions, order, damping=damping)


@pytest.mark.parametrize("f", [COSINE, GENERAL], ids=["cosine", "general"])
def test_boundaries_close_just_there(f):
    mu = np.array([0.05, 1.5, -0.4])
    found = critical_damping(f, mu, REGIONS)
    assert found.passed and found.checks
    for i, n in enumerate(REGIONS):
        k = found.damping[i]
        below = hill_boundaries(f, mu, (n,), 0.999 * k)
        above = hill_boundaries(f, mu, (n,), 1.001 * k)
        assert np.all(np.isfinite(below.upper)) and np.all(np.isnan(above.upper))
        # The last open point lies between the ends just below.
        near = hill_boundaries(f, mu, (n,), k * (1 - 1e-6))
        slack = 1e-2 * (below.upper - below.lower)[0] + 1e-9
        assert np.all(np.abs(found.lam2[i] - 0.5 * (near.lower + near.upper)[0]) < slack)


def test_the_half_trace_touches_its_level_there():
    mu = np.array([0.1, 0.7])
    found = critical_damping(GENERAL, mu, REGIONS)
    step = 1e-4 * np.array([-1.0, 0.0, 1.0])[:, None, None]
    half = discriminant(GENERAL, found.lam2 + step, mu, found.damping)
    excess = np.abs(half.value) - half.level
    assert np.abs(excess[1]).max() < 1e-12
    assert np.all(excess[[0, 2]] < 0)


@pytest.mark.slow
def test_errors_cover_the_exact_values():
    rng, cases = np.random.default_rng(5), 100
    covered, ratios = [], []
    for _ in range(cases):
        harmonics = int(rng.choice([1, 2, 3, 8]))
        a, b = rng.normal(size=(2, harmonics + 1)) * 0.7 ** np.arange(harmonics + 1)
        b[0] = 0.0
        f, n, order = PeriodicFunction(a, b), int(rng.integers(1, 6)), int(rng.integers(1, 9))
        mu = 10.0 ** rng.uniform(-4, 0, 3) / f.bound()
        k = 10.0 ** rng.uniform(-5, -1, 3)
        pairs = [
            (critical_damping(f, mu, (n,)), critical_damping(f, mu, (n,), order), "damping"),
            (least_parameter(f, k, (n,)), least_parameter(f, k, (n,), order), "mu"),
        ]
        for exact, found, name in pairs:
            there = np.isfinite(getattr(found, name)) & np.isfinite(getattr(exact, name))
            gap = np.abs(getattr(found, name) - getattr(exact, name))[there]
            covered.append(gap <= (found.error + exact.error)[there])
            clear = gap > 10 * exact.error[there]
            ratios.append(found.error[there][clear] / gap[clear])
    assert np.mean(np.concatenate(covered)) >= 0.99
    assert np.concatenate(covered).size > 3 * cases
    assert np.median(np.concatenate(ratios)) < 30


@pytest.mark.smoke
def test_first_order_is_the_printed_condition():
    """Smith (7.50), (7.51)."""
    mu, k = np.array([0.01, 0.02]), np.array([1e-4, 1e-3])
    for n in REGIONS:
        strength = np.hypot(GENERAL.a[n], GENERAL.b[n])
        found = critical_damping(GENERAL, mu, (n,), 1)
        np.testing.assert_allclose(found.damping[0], mu * strength / (2 * n), rtol=1e-14)
        least = least_parameter(GENERAL, k, (n,), 1)
        np.testing.assert_allclose(least.mu[0], 2 * k * n / strength, rtol=1e-13)


@pytest.mark.parametrize("order", [None, 1, 4, 8])
@pytest.mark.parametrize("f", [COSINE, GENERAL], ids=["cosine", "general"])
def test_one_is_the_inverse_of_the_other(f, order):
    k = np.array([1e-5, 1e-3, 2e-2])
    least = least_parameter(f, k, REGIONS, order)
    assert least.passed
    there = np.isfinite(least.mu)
    assert there.sum() >= 3
    for i, n in enumerate(REGIONS):
        here = there[i]
        if not here.any():
            continue
        back = critical_damping(f, least.mu[i, here], (n,), order)
        gap = np.abs(back.damping[0] - k[here])
        assert np.all(gap <= 4 * back.error[0] + 1e-12 * k[here])


def test_the_first_order_condition_may_be_far_off():
    """Strong damping: (7.51) against the truth, a factor of more than 1.2."""
    first = least_parameter(COSINE, 0.5, (1,), 1)
    exact = least_parameter(COSINE, 0.5, (1,))
    assert first.outside.all()
    assert abs(exact.mu[0] / (2 * 0.5) - 1) > 0.1


def test_no_tongue():
    """f constant, and a region that nothing couples."""
    flat = PeriodicFunction([3.0])
    for order in (None, 4):
        found = critical_damping(flat, [0.1, 1.0], (1, 2), order)
        assert np.all(found.damping <= 1e-7)
        assert np.all(found.damping <= found.error + 1e-300)
        least = least_parameter(flat, [0.0, 0.1], (1, 2), order)
        assert np.all(np.isinf(least.mu)) and least.absent.all() and not least.outside.any()
    third = PeriodicFunction([0.0, 0.0, 0.0, 1.0])
    for order in (None, 8):
        closed = critical_damping(third, 0.3, (1, 2, 4), order)
        assert np.all(closed.damping <= closed.error)
    assert least_parameter(third, 0.1, (1, 2), 8).absent.all()
    assert least_parameter(third, 0.1, (1, 2)).absent.all()


def test_no_damping():
    for order in (None, 1, 4):
        found = least_parameter(GENERAL, 0.0, REGIONS, order)
        np.testing.assert_array_equal(found.mu, 0.0)
    # To first order nothing couples the second region of a cosine.
    assert np.isinf(least_parameter(COSINE, 0.0, (2,), 1).mu[0])
    assert least_parameter(COSINE, 0.0, (2,)).mu[0] == 0.0


def test_tiny_tongues_keep_their_digits():
    """Region 4 of a cosine at mu = 1e-3: K is 4e-16, far below the round-off of its ends."""
    found = critical_damping(COSINE, 1e-3, (4,))
    # |B| = mu^4 / 576 to the lowest order, and K = |B| / 4.
    assert found.damping[0] == pytest.approx(1e-12 / 2304, rel=1e-5)
    assert found.error[0] < 1e-10 * found.damping[0]


def test_shapes_and_pictures():
    found = critical_damping(COSINE, np.full((2, 3), 0.1), (1, 2))
    assert found.damping.shape == found.error.shape == found.outside.shape == (2, 2, 3)
    assert critical_damping(COSINE, [], (1,)).damping.shape == (1, 0)
    assert critical_damping(COSINE, 0.1, ()).damping.shape == (0,)
    least = least_parameter(COSINE, [0.01, 0.02], (1, 2))
    assert least.mu.shape == (2, 2) and least.searched.shape == (2,)
    assert least_parameter(COSINE, [], (1,)).mu.shape == (1, 0)
    assert critical_damping(COSINE, [0.1, 0.2], (1, 2)).plot().lines
    assert least.plot().lines
    with pytest.raises(BadInput, match="plot"):
        found.plot()


@pytest.mark.parametrize(
    ("call", "arguments"),
    [
        (critical_damping, {"mu": np.nan}),
        (critical_damping, {"mu": 0.1, "regions": (0, 1)}),
        (critical_damping, {"mu": 0.1, "order": 0}),
        (critical_damping, {"mu": 0.1, "order": True}),
        (least_parameter, {"damping": -0.1}),
        (least_parameter, {"damping": 0.1, "regions": (1.5,)}),
        (least_parameter, {"damping": 0.1, "order": 9}),
        (critical_damping, {}),
        (critical_damping, {"mu": 0.1, "damping": 0.1}),
    ],
)
def test_bad_input(call, arguments):
    with pytest.raises(BadInput):
        call(COSINE, **arguments)


@pytest.mark.slow
def test_half_traces_beyond_the_range_of_doubles():
    """Deep wells, by WKB: the exponent is the mean of ``sqrt(-lam2 - mu cos)`` over the turn."""
    mu = np.array([1e3, 3e4])
    found = critical_damping(COSINE, mu, (1,))
    # At the middle of a low gap of a deep well nearly 2 sqrt(2 mu) / pi; less some levels.
    top = 2.0 * np.sqrt(2.0 * mu) / np.pi
    assert np.all(found.damping < top) and np.all(found.damping > top - 3.0)
    assert np.all(found.error < 1e-12 * top + 1e-11)
    assert found.passed
    # The same by the growth of the solution itself.
    k, lam2 = found.damping[0], found.lam2[0]
    half = discriminant(COSINE, lam2, mu, k)
    np.testing.assert_allclose(np.abs(half.value), half.level, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("k", [60.0, 130.0])
def test_least_parameter_of_strong_damping(k):
    found = least_parameter(COSINE, k, (1,))
    assert not found.absent[0] and found.passed
    again = critical_damping(COSINE, found.mu, (1,))
    assert again.damping[0, 0] == pytest.approx(k, abs=1e-9)
    assert 0.0 < found.error[0] < 1e-9 * found.mu[0]


@pytest.mark.parametrize("order", [None, 8])
def test_a_maximum_between_two_grid_values_is_seen(order):
    """Region 2 of cos + 0.05 cos 2 opens, closes near mu = 0.1, and opens again."""
    f = PeriodicFunction([0.0, 1.0, 0.05])
    mu = np.linspace(0.045, 0.055, 2001)
    top = critical_damping(f, mu, (2,)).damping[0].max()
    found = least_parameter(f, top * np.array([0.9999, 1.0001]), (2,), order=order)
    assert 0.045 < found.mu[0, 0] < 0.05
    assert found.mu[0, 1] > 0.1
    assert found.passed
