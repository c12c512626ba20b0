"""The error of a proved bound, against the largest multiplier at many speeds of the interval."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.design import certify

pytest.importorskip("flint")


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in range(1, 5))]
)
def test_bounds_are_above_and_not_further_than_told(seed):
    rng = np.random.default_rng(seed)
    damping, low = rng.uniform(0.05, 0.3), rng.uniform(30.0, 60.0)
    system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    system = system.with_parameters(damping=damping)
    found = certify(system, (low, 1.05 * low), resolution=1e-3 * low)
    assert found.error_kind == "bound" and len(found.proved)
    for ends, bound, error in zip(found.proved, found.bound, found.error, strict=True):
        speeds = np.linspace(*ends, 200)
        largest = np.max(np.abs(el.floquet_multipliers(system, speeds).multipliers))
        # The largest of 200 speeds is not quite the largest of all.
        assert -1e-9 <= bound - largest <= error + 1e-4
        assert error < 0.1
