"""Exact boundaries without and with damping: tables, mpmath, half traces, extremes."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import critical_damping, hill_boundaries
from elastolink.runtime.hill.boundaries import half_trace_check
from hill_functions import COSINE
from hypothesis import given, settings
from hypothesis import strategies as st

CHECK = "half trace at the ends over what the errors explain"


@settings(max_examples=15, deadline=None)
@given(
    shape=st.sampled_from([(), (1,), (5,), (2, 3), (0,), (2, 1, 2)]),
    regions=st.lists(st.integers(0, 8), max_size=4),
    seed=st.integers(0, 99),
)
def test_shapes_and_independence_of_the_batch(shape, regions, seed):
    f = PeriodicFunction([0.1, 1.0, 0.3], [0, 0.2, -0.5])
    mu = np.random.default_rng(seed).uniform(-2, 2, shape)
    found = hill_boundaries(f, mu, regions)
    assert found.lower.shape == found.upper.shape == found.error.shape == (len(regions), *shape)
    assert found.regions == tuple(regions)
    for index in list(np.ndindex(mu.shape))[:2]:
        for i, n in enumerate(regions):
            alone = hill_boundaries(f, mu[index], (n,))
            slack = alone.error[0] + found.error[(i, *index)]
            assert abs(alone.upper[0] - found.upper[(i, *index)]) <= slack
            assert np.all(found.lower[i] <= found.upper[i] + found.error[i])


def test_plot_and_export():
    found = hill_boundaries(COSINE, np.linspace(0, 1, 5), (1, 2))
    assert len(found.plot().lines) == 4
    assert found.to_dict()["regions"] == [1, 2] and found.to_dict()["checks"][CHECK]["passed"]
    assert len(hill_boundaries(COSINE, 0.0, (1,), damping=0.1).checks) == 0
    with pytest.raises(BadInput, match="slice"):
        hill_boundaries(COSINE, 1.0).plot()


@pytest.mark.parametrize(
    "given",
    [
        {"mu": np.linspace(0.0, 50.0, 6), "regions": (0, 1, 2, 5, 8)},
        {"mu": np.linspace(0.0, 1.0, 300), "regions": (1, 2, 3)},
        {"mu": np.linspace(0.0, 3.0, 50), "regions": (1, 2), "damping": 0.1},
        {"mu": 1e4, "regions": (1, 2)},
        {"mu": np.array([0.4, -0.9]), "regions": (40, 99, 100)},
        # Solutions grow beyond the range of doubles there.
        pytest.param({"mu": 1e6, "regions": (1, 2)}, marks=pytest.mark.slow),
        pytest.param({"mu": -1e5, "regions": (0, 3), "damping": 200.0}, marks=pytest.mark.slow),
    ],
)
def test_the_half_trace_confirms_the_ends(given):
    found = hill_boundaries(PeriodicFunction([0.3, 1.0, 0.5], [0.0, 0.2]), **given)
    assert list(found.checks) == [CHECK] and found.passed
    assert {"elastolink", "numpy"} <= set(found.provenance)


@pytest.mark.parametrize("damping", [0.0, 0.1])
def test_a_wrong_end_fails_the_check(damping):
    f, mu, k = PeriodicFunction([0.0, 1.0, 0.5]), np.array([0.7]), np.array([damping])
    right = hill_boundaries(f, mu, (1, 2), damping=damping)
    level = -0.5 * (1.0 + np.exp(-4.0 * np.pi * k))
    good, wrong = (
        half_trace_check(f, right.upper[0] + off, right.error[0], mu, k, level)
        for off in (0.0, 1e-9)
    )
    assert good.passed and not wrong.passed


def test_no_damping_in_some_entries():
    mu, k = np.array([0.0, 0.0, 0.8, 0.8]), np.array([0.0, 0.1, 0.0, 0.1])
    found = hill_boundaries(COSINE, mu, (1, 2), k)
    assert found.lower[0, 0] == pytest.approx(0.25, abs=1e-14)
    assert np.isnan(found.lower[:, 1]).all()
    plain = hill_boundaries(COSINE, 0.8, (1, 2))
    np.testing.assert_allclose(found.lower[:, 2], plain.lower, atol=1e-13)
    assert 0 < found.width[0, 3] < found.width[0, 2]
    assert np.isnan(found.width[1, 3])


def test_near_the_tip_the_error_grows_and_still_covers():
    """Just inside, the half trace shows that the estimate covers."""
    mu, errors = 0.6, []
    tip = float(critical_damping(COSINE, mu, (1,)).damping[0])
    for inside in (1e-3, 1e-6, 1e-9, 1e-12):
        found = hill_boundaries(COSINE, mu, (1,), tip * (1 - inside))
        assert np.isfinite(found.upper[0]) and found.checks[CHECK].value <= 1.0
        errors.append(found.error[0])
    assert np.all(np.diff(errors) > 0)
    assert errors[0] < 1e-11
    assert 1e-9 < errors[-1] < 1e-5


@pytest.mark.parametrize("mu", [1.0, 40.0])
def test_what_doubles_cannot_decide_fails_a_check(mu):
    closing = float(critical_damping(COSINE, mu, (1,)).damping[0])
    for away, open_ in ((-1e-9, True), (1e-9, False)):
        found = hill_boundaries(COSINE, mu, (1,), closing * (1.0 + away))
        assert np.isfinite(found.upper[0]) == open_ and found.passed
    # At the tip itself: either ends whose estimate covers their distance, or a failing check.
    for steps in range(-8, 9):
        k = closing * (1.0 + steps * 1e-15)
        found = hill_boundaries(COSINE, mu, (1,), k)
        if np.isnan(found.upper[0]):
            assert not found.passed
        else:
            assert found.error[0] >= 0.5 * found.width[0]


@pytest.mark.parametrize("k", [300.0, pytest.param(1e4, marks=pytest.mark.slow)])
def test_region_zero_under_huge_damping(k):
    """``-mu^2 / (8 K^2)`` to leading order: z = y'/y is -mu cos / (2 K), and lam2 = -mean z^2."""
    found = hill_boundaries(COSINE, 0.1, (0, 1), k)
    assert np.isnan(found.upper[1])
    gap = abs(found.upper[0] + 0.01 / (8.0 * k * k))
    assert gap <= found.error[0] + 1e-3 * 0.01 / (8.0 * k * k)
