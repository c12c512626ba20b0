"""Error estimate of the optimiser: a proved bound, and no idle one."""

import numpy as np
from balancing_machines import nine_equations, random_machine, with_crank_counterweight
from honesty import over_scenes

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


@over_scenes(0, few=4, many=80, floor=np.finfo(float).eps / 2.0)
def test_error_bounds_the_distance_from_the_optimum_and_is_not_idle(rng):
    """Both are of the order of 1: no difference below its round-off means anything."""
    machine = random_machine(rng)
    found = with_crank_counterweight(machine, SPEED)
    return found.error, found.value - exact(machine)
