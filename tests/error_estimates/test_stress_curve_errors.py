"""Stress against speed: the error estimate of each maximum against its actual error.

The reference solves the whole equations speed by speed: no modal truncation, no tables.  Both
recover stresses from a motion the same way.
"""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.recovery.stress_over_speed import Fibres

STATIONS = 5
# Elements of each link, damping ratio, lowest and highest speed [rad/s].
CASES = ((1, 0.02, 5.0, 70.0), (1, 0.005, 20.0, 60.0), (1, 0.05, 12.0, 90.0))

pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")


def compared(elements, ratio, low, high, count, method):
    """Return actual relative errors and their estimates at random speeds."""
    overrides = {"mesh.elements": elements, "damping.ratio": ratio}
    system = el.load_scene("aannaque_1996_table_4_1", overrides=overrides).system()
    speeds = np.sort(np.random.default_rng(96).uniform(low, high, count))
    curve = el.stress_curve(system, speeds, stations=STATIONS, method=method)
    fibres = Fibres(system, STATIONS, method)
    motion = el.steady_state(system, speeds, rtol=1e-8, samples=512)
    truth = fibres.peaks(motion.theta, motion.q, speeds).size.T
    return np.abs(curve.maximum / truth - 1.0), curve.error


@pytest.mark.parametrize("count", [2, pytest.param(24, marks=pytest.mark.slow)])
def test_estimates_cover_the_actual_errors_and_are_not_idle(count):
    both = [
        compared(*case, count, method)
        for case, method in zip(CASES, ("shape", "equilibrium", "shape"), strict=True)
    ]
    actual, estimate = (np.concatenate(parts) for parts in zip(*both, strict=True))
    assert np.mean(actual <= estimate) >= 0.99
    # Round-off aside, the estimate is within a factor of a thousand.
    assert np.median(estimate / np.maximum(actual, 1e-12)) <= 1e3


@pytest.mark.slow
def test_three_elements_meet_what_is_wanted():
    """27 freedoms."""
    actual, estimate = compared(3, 0.02, 5.0, 70.0, 3, "shape")
    assert np.all(actual <= np.minimum(estimate, 1e-4))
