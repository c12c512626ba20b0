import numpy as np
import pytest
from boundary_cases import closing_damping
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from elastolink.runtime.hill.half_trace import discriminant
from elastolink.runtime.hill.perturbation.thresholds import critical_damping
from hill_functions import functions

FUNCTIONS = functions()
COSINE = PeriodicFunction([0.0, 1.0])


def level_off(f, found, i, n, k):
    """How far the damped half trace is from its level, and what the figure allows, where open."""
    there = ~np.isnan(found.lower[i])
    mu, reach = found.mu[there], found.error[i][there]
    out = []
    for ends in (found.lower[i][there], found.upper[i][there]):
        h = 1e-5
        half, up, down = (discriminant(f, ends + s, mu, k) for s in (0.0, h, -h))
        slope = np.abs(up.value - down.value) / (2 * h)
        bend = np.abs(up.value + down.value - 2 * half.value) / h**2
        off = np.abs(half.value - (-1.0) ** n * half.level)
        out.append((off, half.error + 1e-15 + (slope + bend * reach) * reach))
    return out


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("k", [1e-6, 1e-3, 0.03, 0.2])
def test_the_half_trace_stands_at_its_damped_level(name, k):
    f = FUNCTIONS[name]
    mu = np.linspace(-2, 2, 17)
    found = hill_boundaries(f, mu, (1, 2, 3, 4), k)
    seen = 0
    for i, n in enumerate(found.regions):
        for off, allowed in level_off(f, found, i, n, k):
            seen += off.size
            assert np.all(off <= allowed)
    assert seen > 0


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_region_is_missing_only_where_no_point_of_it_is_unstable(name):
    f, k = FUNCTIONS[name], 0.05
    mu = np.linspace(-2, 2, 15)
    sharp, damped = (hill_boundaries(f, mu, (1, 2, 3, 4, 5), c) for c in (0.0, k))
    closed = np.isnan(damped.lower)
    assert closed.any()
    assert not closed.all()
    share = np.linspace(0, 1, 101)[:, None, None]
    lam2 = sharp.lower + share * sharp.width + k * k
    half = discriminant(f, lam2, mu, k)
    excess = (np.abs(half.value) - half.level - half.error).max(axis=0)
    assert np.all(excess[closed] <= 0)
    np.testing.assert_array_equal(np.isnan(damped.error), closed)


def test_a_damped_region_lies_within_the_undamped_one_moved_by_k_squared():
    f, mu = FUNCTIONS["f3 (5,1,5,2)"], np.linspace(0.05, 2, 30)
    sharp = hill_boundaries(f, mu, (1, 2, 3))
    for k in (0.01, 0.05, 0.1):
        found = hill_boundaries(f, mu, (1, 2, 3), k)
        there = ~np.isnan(found.lower)
        slack = found.error + sharp.error
        assert np.all((found.lower - sharp.lower - k * k + slack)[there] >= 0)
        assert np.all((sharp.upper + k * k - found.upper + slack)[there] >= 0)


def test_region_zero_never_closes():
    found = hill_boundaries(COSINE, np.array([0.0, 0.5, 3.0]), (0,), 0.3)
    half = discriminant(COSINE, found.upper[0], found.mu, 0.3)
    np.testing.assert_allclose(half.value, half.level, atol=1e-12)
    assert found.upper[0, 0] == pytest.approx(0.0, abs=1e-13)
    assert np.all(found.lower == -np.inf)


def test_no_damping_in_some_entries():
    mu, k = np.array([0.0, 0.0, 0.8, 0.8]), np.array([0.0, 0.1, 0.0, 0.1])
    found = hill_boundaries(COSINE, mu, (1, 2), k)
    assert found.lower[0, 0] == pytest.approx(0.25, abs=1e-14)
    assert np.isnan(found.lower[:, 1]).all()
    plain = hill_boundaries(COSINE, 0.8, (1, 2))
    np.testing.assert_allclose(found.lower[:, 2], plain.lower, atol=1e-13)
    assert 0 < found.width[0, 3] < found.width[0, 2]
    assert np.isnan(found.width[1, 3])


def test_vanishing_damping_tends_to_the_undamped_boundaries():
    f = FUNCTIONS["24 harmonics"]
    sharp = hill_boundaries(f, 1.1, (1, 2, 3))
    gaps = []
    for k in (1e-2, 5e-3, 2.5e-3):
        found = hill_boundaries(f, 1.1, (1, 2, 3), k)
        gaps.append(np.abs(found.lower - sharp.lower).max())
    # The ends move by K^2 times a constant.
    np.testing.assert_allclose(np.log2(np.array(gaps[:-1]) / gaps[1:]), 2.0, atol=0.1)


def test_near_the_tip_the_error_grows_and_still_covers():
    """Find K at which region 1 closes by bisection; just inside, the figure must cover."""
    mu = 0.6
    low, _ = closing_damping(COSINE, mu, 0.2, 0.4)
    # Independent: the largest |half trace| over the region equals the level at the tip.
    sharp = hill_boundaries(COSINE, mu, (1,))
    lam2 = np.linspace(sharp.lower[0], sharp.upper[0], 4001)
    top = np.abs(discriminant(COSINE, lam2, mu).value).max()
    assert np.arccosh(top) / (2 * np.pi) == pytest.approx(low, abs=1e-7)
    errors = []
    for inside in (1e-3, 1e-6, 1e-9, 1e-12):
        k = low * (1 - inside)
        found = hill_boundaries(COSINE, np.array([mu]), (1,), k)
        for off, allowed in level_off(COSINE, found, 0, 1, k):
            assert np.all(off <= allowed)
        errors.append(found.error[0, 0])
    assert np.all(np.diff(errors) > 0)
    assert errors[0] < 1e-11
    assert 1e-9 < errors[-1] < 1e-5


def test_a_rough_function_keeps_its_damped_tongues():
    """Meissner's square wave cut at 201 harmonics."""
    m = np.arange(202)
    a = np.where(m % 2 == 1, 4 / np.pi * np.sin(m * np.pi / 2) / np.maximum(m, 1), 0.0)
    f = PeriodicFunction(a)
    found = hill_boundaries(f, np.array([0.4, 0.9]), (1, 2, 3), 0.02)
    for i, n in enumerate(found.regions):
        for off, allowed in level_off(f, found, i, n, 0.02):
            assert np.all(off <= allowed)
    assert not np.isnan(found.lower[0]).any()


@pytest.mark.parametrize(
    ("mu", "n", "k"), [(150.0, 1, 5.137), (100.0, 3, 6.0), (30.0, 0, 2.0), (-2000.0, 2, 10.9)]
)
def test_strong_damping_in_deep_wells(mu, n, k):
    """The eigenvalues of the matrix are off by many times its round-off, or beyond their slack."""
    found, proved = (hill_boundaries(COSINE, mu, (n,), k, certified=c) for c in (False, True))
    assert not np.isnan(found.upper[0])
    gaps = [found.upper - proved.upper, (found.lower - proved.lower) if n else np.zeros(1)]
    assert np.all(np.abs(gaps) <= found.error)
    assert found.error[0] < 1e-13 * abs(mu) * 4
    assert found.passed


def test_a_region_proved_open_is_found_open():
    f, mu, k = PeriodicFunction([0.0, -0.36, 1.28], [0.0, 0.74, -0.41]), 300.0, 6.0
    found, proved = (hill_boundaries(f, mu, (1, 2, 3), k, certified=c) for c in (False, True))
    known = ~np.isnan(proved.upper)
    assert known.any()
    assert np.all(np.abs(found.upper - proved.upper)[known] <= found.error[known])
    assert np.all(np.abs(found.lower - proved.lower)[known] <= found.error[known])


@pytest.mark.parametrize("mu", [1.0, 40.0])
def test_what_doubles_cannot_decide_fails_a_check(mu):
    closing = float(critical_damping(COSINE, mu, (1,)).critical[0])
    for away, open_ in ((-1e-9, True), (1e-9, False)):
        found = hill_boundaries(COSINE, mu, (1,), closing * (1.0 + away))
        assert np.isfinite(found.upper[0]) == open_ and found.passed
    # At the tip itself: either ends whose figure covers their distance, or a failing check.
    for steps in range(-8, 9):
        k = closing * (1.0 + steps * 1e-15)
        found = hill_boundaries(COSINE, mu, (1,), k)
        if np.isnan(found.upper[0]):
            assert not found.passed
        else:
            assert found.error[0] >= 0.5 * found.width[0]


@pytest.mark.parametrize("k", [300.0, 1e4])
def test_region_zero_under_huge_damping(k):
    """``-mu^2 / (8 K^2)`` to leading order: z = y'/y is -mu cos / (2 K), and lam2 = -mean z^2."""
    found = hill_boundaries(COSINE, 0.1, (0, 1), k)
    assert np.isnan(found.upper[1])
    gap = abs(found.upper[0] + 0.01 / (8.0 * k * k))
    assert gap <= found.error[0] + 1e-3 * 0.01 / (8.0 * k * k)


def test_damping_beyond_all_bounds_is_refused():
    with pytest.raises(BadInput, match="damping"):
        hill_boundaries(COSINE, 0.1, damping=1e308)
