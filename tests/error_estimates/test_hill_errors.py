import numpy as np
import pytest
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from elastolink.runtime.hill.half_trace import discriminant, discriminant_grid
from half_trace_truth import half_traces
from honesty import verdict

pytestmark = pytest.mark.skipif(
    np.finfo(np.longdouble).eps > 1e-18, reason="the reference needs a long double of 80 bits"
)


def scene(rng):
    """A random function with 1-24 harmonics of decaying size, and ranges of the parameters."""
    harmonics, fall = int(rng.choice([1, 2, 5, 12, 24])), rng.uniform(0.3, 0.9)
    size = fall ** np.arange(harmonics + 1)
    a, b = rng.normal(size=(2, harmonics + 1)) * size
    b[0] = 0.0
    low = -(10.0 ** rng.uniform(-1, 1.5)) if rng.random() < 0.3 else 0.0
    return PeriodicFunction(a, b), low, 10.0 ** rng.uniform(-1, 2.5), 10.0 ** rng.uniform(-2, 1)


def half_trace_ratios(rng, grid):
    f, low, high, reach = scene(rng)
    lam2, mu = rng.uniform(low, high, 4), rng.uniform(-reach, reach, 4)
    truth = half_traces(f, lam2, mu)
    if grid:
        x = np.sort(np.concatenate([lam2, np.linspace(low, high, 70)]))
        y = np.sort(np.concatenate([mu, np.linspace(-reach, reach, 40)]))
        whole = discriminant_grid(f, x, y)
        i, j = np.searchsorted(x, lam2), np.searchsorted(y, mu)
        value, error = whole.value[i, j], whole.error[i, j]
    else:
        found = discriminant(f, lam2, mu)
        value, error = found.value, found.error
    # Errors below the reference's own are not told apart from zero.
    gap = np.abs(value - truth).astype(float)
    return error / np.maximum(gap, 1e-18 * np.maximum(1.0, np.abs(value)))


def boundary_ratios(rng, k):
    """Newton steps on the extended half trace, wherever the boundary is a simple root."""
    f, _, _, _ = scene(rng)
    mu = rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-2, 0.7)
    found = hill_boundaries(f, mu, (1, 2, 3, 4), k)
    level = np.array([-1.0, 1.0, -1.0, 1.0]) * 0.5 * (1.0 + np.exp(-4 * np.pi * k))
    ratios = []
    for ends in (found.lower, found.upper):
        there = ~np.isnan(ends)
        if not there.any():
            continue
        h = 1e-6
        left, at, right = half_traces(f, ends[there] + np.array([[-h], [0.0], [h]]), mu, k)
        slope = ((right - left) / (2 * h)).astype(float)
        gap = np.abs((at - level[there]).astype(float) / np.where(slope == 0, np.inf, slope))
        simple = np.abs(slope) > 1e-3
        ratios.append((found.error[there] / np.maximum(gap, 1e-17))[simple])
    return np.concatenate(ratios) if ratios else np.zeros(0)


@pytest.mark.parametrize(
    "scenes", [pytest.param(30, id="some"), pytest.param(200, marks=pytest.mark.slow, id="all")]
)
@pytest.mark.parametrize("grid", [False, True])
def test_half_traces(scenes, grid):
    rng = np.random.default_rng(11)
    verdict([half_trace_ratios(rng, grid) for _ in range(scenes)], 4 * scenes)


@pytest.mark.parametrize(
    "scenes", [pytest.param(20, id="some"), pytest.param(200, marks=pytest.mark.slow, id="all")]
)
@pytest.mark.parametrize("k", [0.0, 0.01])
def test_boundaries(scenes, k):
    rng = np.random.default_rng(12)
    verdict([boundary_ratios(rng, k) for _ in range(scenes)], scenes)
