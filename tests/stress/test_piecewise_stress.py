"""Piecewise constant coefficients at their limits: many intervals, extreme levels and lengths."""

import numpy as np
import pytest
from elastolink.runtime.hill import (
    coexistence_points,
    meissner_boundaries,
    multiplier_surfaces,
    piecewise_monodromy,
    strutt_chart,
)

TURN = 2.0 * np.pi


def test_equal_intervals_are_one_however_many():
    for count in (1, 10, 1000, 6000):
        found = piecewise_monodromy(np.full(count, 5.3), np.full(count, TURN / count))
        # The lengths add up to the turn but for round-off, which the figure does not know.
        assert abs(found.half_trace - np.cos(TURN * np.sqrt(5.3))) <= found.error + 1e-14
        assert found.passed and found.error < 1e-9


def test_levels_over_thirty_decades():
    levels = np.array([1e-15, -1e15, 1e6, 0.0, -1e-300, 1.0])
    found = piecewise_monodromy(levels, np.full(6, 1e-6))
    assert np.all(np.isfinite(found.matrix)) and found.passed
    # sqrt(1e15) 1e-6 = 31.6: one interval alone makes it grow.
    assert not found.stable


def test_lengths_that_nearly_vanish():
    found = piecewise_monodromy([3.0, 1e10, 3.0], [1.0, 1e-300, TURN - 1.0])
    assert abs(found.half_trace - np.cos(TURN * np.sqrt(3.0))) <= found.error + 1e-14


@pytest.mark.parametrize("mu", [0.0, 1e-300, 1e-12, -1e-12])
def test_vanishing_modulation(mu):
    found = meissner_boundaries(mu, (0, 1, 2, 7))
    middles = np.array([0.0, 0.25, 1.0, 12.25])
    off = np.maximum(np.abs(found.upper - middles), np.abs(found.lower - middles)[[1, 1, 2, 3]])
    assert np.all(np.abs(found.upper - middles) <= found.error + abs(mu))
    assert found.passed and np.all(np.isfinite(off))


def test_large_modulation_keeps_its_order():
    mu = np.array([1e2, 1e3, 1e4])
    found = meissner_boundaries(mu, range(12))
    assert found.passed
    ends = np.concatenate([found.upper[:1], *zip(found.lower[1:], found.upper[1:], strict=True)])
    ends = ends.reshape(-1, mu.size)
    # Exponentially thin stable bands: the ends may agree to the last digits.
    slack = 2.0 * np.max(found.error, axis=0)
    assert np.all(np.diff(ends, axis=0) >= -slack)
    # The bottom of a deep well: -mu + v^2 with v of the well's first wave.
    assert np.all(np.abs(found.upper[0] + mu - 1.0) < 0.3)


def test_high_regions():
    n = 200
    lam2, mu = coexistence_points(n)
    pick = [10, 50, 90]
    for place, factor in zip(lam2[pick], mu[pick], strict=True):
        found = meissner_boundaries(factor, (n,))
        assert abs(found.lower[0] - place) <= found.error[0] + 1e-14 * place
        assert found.width[0] <= 2.0 * found.error[0]


def test_extreme_damping_stabilises_all_but_negative_stiffness():
    found = piecewise_monodromy([[4.0, 1.0], [-4.0, -1.0]], [np.pi, np.pi], 1e4)
    assert found.passed and list(found.stable) == [True, False]
    chart = strutt_chart(50.0, (-2.0, 6.0), (0.0, 2.0), points=(9, 3))
    assert chart.passed
    assert np.all(chart.stable[chart.d > 0.1]) and not np.any(chart.stable[chart.d < -0.1])


def test_a_chart_far_into_the_unstable_range():
    found = multiplier_surfaces(np.linspace(-300.0, 300.0, 41), np.linspace(-200.0, 200.0, 21))
    assert found.passed and np.all(np.isfinite(found.first)) and np.all(np.isfinite(found.second))
    chart = strutt_chart(0.0, (-100.0, 400.0), (0.0, 300.0), points=(101, 31))
    assert chart.passed and len(chart.regions) > 15
