"""Stress against speed: the error estimate of each maximum against its actual error.

The reference solves the whole equations speed by speed: no modal truncation, no tables.  Both
recover stresses from a motion the same way.
"""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.recovery.stress_over_speed import Fibres
from honesty import covers

STATIONS = 5
# Elements of each link, damping ratio, lowest and highest speed [rad/s], way to the stresses.
CASES = (
    (1, 0.02, 5.0, 70.0, "shape"),
    (1, 0.005, 20.0, 60.0, "equilibrium"),
    (1, 0.05, 12.0, 90.0, "shape"),
)

pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")


def compared(elements, ratio, low, high, method, count):
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
    actual, estimate = zip(*(compared(*case, count) for case in CASES), strict=True)
    covers(estimate, actual, floor=1e-12)


@pytest.mark.slow
def test_three_elements_meet_what_is_wanted():
    """27 freedoms."""
    actual, estimate = compared(3, 0.02, 5.0, 70.0, "shape", 3)
    assert np.all(actual <= np.minimum(estimate, 1e-4))
