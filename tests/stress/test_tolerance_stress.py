"""Tolerances of random linkages of any size: finite numbers and held checks, or one clear line."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages.length_tolerances import tolerances
from elastolink.runtime.rigid import Machine, MassDistribution
from random_linkages import KINDS, random_linkage


def with_masses(linkage, size):
    body = MassDistribution.about_centre(0.7, 0.06 * size, 0.01 * size, 0.004 * size * size)
    return Machine(linkage, dict.fromkeys(linkage.links, body), gravity=(0.0, -9.81))


@pytest.mark.parametrize("scenes", [4, pytest.param(60, marks=pytest.mark.slow)])
@pytest.mark.parametrize("size", [1e-200, 1e-3, 1.0, 1e3, 1e150])
def test_random_linkages(size, scenes):
    random = np.random.default_rng(int(abs(np.log10(size))))
    shown = refused = 0
    while shown < scenes:
        linkage = random_linkage(random, random.choice(KINDS), size)
        low, high = linkage.crank_ranges()[-1]
        theta = random.uniform(low, high, 5) + 2.0 * np.pi * random.integers(-2, 3)
        widths = {
            name: float(abs(length) * 10.0 ** random.uniform(-8.0, -1.0))
            for name, length in linkage.lengths.items()
            if random.uniform() < 0.7
        }
        if random.uniform() < 0.3:
            widths["theta2"] = float(10.0 ** random.uniform(-6.0, -1.0))
        heavy = 1e-10 < size < 1e10 and random.uniform() < 0.5
        subject = with_masses(linkage, size) if heavy else linkage
        try:
            found = tolerances(subject, widths, theta, 20.0, random.choice([0.0, 3.0]))
        except BadInput as refusal:
            assert "\n" not in str(refusal)
            refused += 1
            continue
        shown += 1
        assert np.all(np.isfinite(found.error)) and np.all(np.isfinite(found.root_sum_square))
        assert np.all(found.root_sum_square <= found.worst_case * (1.0 + 1e-14))
        assert found.passed, dict(found.checks)
        trial = found.monte_carlo(100, seed=shown)
        assert trial.passed, dict(trial.checks)
    assert refused <= shown
