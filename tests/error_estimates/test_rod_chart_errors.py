"""Error estimates of charts of several modes: random rods, random axes, the worst of 21 points."""

import elastolink as el
import numpy as np
from elastolink.runtime.stability.invariants import weighed_characteristic
from elastolink.runtime.systems.rod import OverhangBasis, PolynomialBasis, rod_system
from honesty import over_scenes


def _random_rod(rng):
    basis = (PolynomialBasis, OverhangBasis)[int(rng.integers(2))](int(rng.integers(1, 4)))
    damping = float(rng.choice([0.0, rng.uniform(1.0, 40.0)], p=[2 / 3, 1 / 3]))
    return rod_system(
        basis,
        crank_ratio=0.1,
        frame=float(rng.uniform(0.5, 0.65)),
        length=1.0,
        bending_stiffness=float(rng.uniform(2e4, 6e4)),
        mass_per_length=7.15,
        damping=damping,
    )


@over_scenes(1992, few=None, many=10, floor=1e-17)
def test_errors_of_invariants_are_within_their_estimates(rng):
    """The reference is collocation of order 16 to 1e-13, point by point."""
    system = _random_rod(rng)
    low = float(rng.uniform(600.0, 1500.0))
    speeds = np.linspace(low, rng.uniform(2.0, 4.0) * low, 70)
    cranks = np.linspace(rng.uniform(0.01, 0.05), rng.uniform(0.1, 0.25), 40)
    chart = el.stability_chart(system, ("speed", speeds), ("crank_ratio", cranks))
    assert chart.passed
    actual = []
    for i in rng.choice(len(cranks), 3, replace=False):
        picked = rng.choice(len(speeds), 7, replace=False)
        bent = system.with_geometry(crank_ratio=cranks[i])
        direct = el.monodromy(bent, speeds[picked], rtol=1e-13)
        wanted, _ = weighed_characteristic(direct.scaled, chart.invariants.shape[-1])
        size = np.maximum(1.0, np.max(np.abs(wanted), axis=-1))
        actual.append(np.max(np.abs(chart.invariants[i, picked] - wanted), axis=-1) / size)
    return chart.error, np.max(actual)
