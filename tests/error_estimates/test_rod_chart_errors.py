"""Error estimates of charts of several modes: random rods, random axes, every sampled point."""

from __future__ import annotations

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.stability.invariants import weighed_characteristic
from elastolink.runtime.systems.rod import OverhangBasis, PolynomialBasis, rod_system
from honesty import verdict

_CHARTS, _POINTS = 10, 21


def _random_rod(rng, number):
    basis = (PolynomialBasis, OverhangBasis)[number % 2](int(rng.integers(1, 4)))
    damping = 0.0 if number % 3 else float(rng.uniform(1.0, 40.0))
    return rod_system(
        basis,
        crank_ratio=0.1,
        frame=float(rng.uniform(0.5, 0.65)),
        length=1.0,
        bending_stiffness=float(rng.uniform(2e4, 6e4)),
        mass_per_length=7.15,
        damping=damping,
    )


@pytest.mark.slow
def test_errors_of_invariants_are_within_their_estimates():
    """The reference is collocation of order 16 to 1e-13, point by point."""
    rng = np.random.default_rng(1992)
    ratios = []
    for number in range(_CHARTS):
        system = _random_rod(rng, number)
        low = float(rng.uniform(600.0, 1500.0))
        speeds = np.linspace(low, rng.uniform(2.0, 4.0) * low, 70)
        cranks = np.linspace(rng.uniform(0.01, 0.05), rng.uniform(0.1, 0.25), 40)
        chart = el.stability_chart(system, ("speed", speeds), ("crank_ratio", cranks))
        assert chart.passed
        for i in rng.choice(len(cranks), 3, replace=False):
            picked = rng.choice(len(speeds), _POINTS // 3, replace=False)
            direct = el.monodromy(
                system.with_geometry(crank_ratio=cranks[i]), speeds[picked], rtol=1e-13
            )
            wanted, _ = weighed_characteristic(direct.scaled, chart.invariants.shape[-1])
            size = np.maximum(1.0, np.max(np.abs(wanted), axis=-1))
            actual = np.max(np.abs(chart.invariants[i, picked] - wanted), axis=-1) / size
            ratios += (chart.error / np.maximum(actual, 1e-17)).tolist()
    verdict(ratios, 200)
