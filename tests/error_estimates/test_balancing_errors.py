"""Error estimate of the optimiser: a proved bound, and no idle one."""

import numpy as np
import pytest
from balancing_machines import nine_equations, random_machine, with_crank_counterweight

SPEED = 10.0
THETA = np.linspace(0.0, 2.0 * np.pi, 4097)[:-1]


def exact(machine):
    """Least root mean square of the shaking force with a crank counterweight, by least squares."""
    force = nine_equations(machine, THETA, SPEED)["shaking_force"].astype(np.longdouble)
    turned = np.exp(1j * THETA)
    along = np.stack([turned.real, turned.imag], axis=-1).astype(np.longdouble)
    across = along[:, ::-1] * np.array([-1.0, 1.0])
    left = force
    for column in (along, across):  # at right angles to each other over a whole turn
        left = left - column * (np.sum(column * left) / np.sum(column * column))
    return float(np.sqrt(np.sum(left**2) / np.sum(force**2)))


@pytest.mark.parametrize("scenes", [4, pytest.param(80, marks=pytest.mark.slow)])
def test_error_bounds_the_distance_from_the_optimum_and_is_not_idle(scenes):
    ratios, kept = [], 0
    for seed in range(scenes):
        machine = random_machine(np.random.default_rng(seed))
        found = with_crank_counterweight(machine, SPEED)
        actual = abs(found.value - exact(machine))
        kept += actual <= found.error
        # Both are of the order of 1: no difference below its round-off means anything.
        ratios.append(found.error / max(actual, np.finfo(float).eps / 2.0))
    assert kept >= 0.99 * scenes
    assert np.median(ratios) <= 1e3
