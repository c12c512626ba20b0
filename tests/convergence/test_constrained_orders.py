"""Observed order of collocation, and errors of constrained motions that fall with the tolerance."""

import numpy as np
import pytest
from constrained_truth import unconstrained
from elastolink.runtime.constrained.equations import Equations
from elastolink.runtime.constrained.orbits import Ring, Shooting
from orders import slopes

# A pendulum driven so that its angle is 2 cos t.
SWING = unconstrained(
    lambda q, qd, t: np.sin(2.0 * np.cos(t)) - 2.0 * np.cos(t) - np.sin(q), slope=np.cos
)


@pytest.mark.parametrize(
    ("stages", "counts"), [(2, (20, 30, 40)), (3, (10, 15, 20)), (4, (10, 14, 18))]
)
def test_steps_of_an_orbit_are_of_order_twice_their_nodes(stages, counts):
    errors = []
    for count in counts:
        start = np.arange(count) * (2 * np.pi / count)
        x, v = 2.0 * np.cos(start)[:, None], -2.0 * np.sin(start)[:, None]
        equations = Equations(SWING, x, v, start)
        ring = Ring(2 * np.pi, np.zeros(1), x, v, np.zeros((count, stages, 1)))
        shot = Shooting(equations, 1.0).solve(ring)
        assert not shot.reason
        errors.append(max(np.max(np.abs(shot.ring.x - x)), np.max(np.abs(shot.ring.v - v))))
    assert errors[-1] > 1e-13, "round-off hides the order"
    np.testing.assert_allclose(-slopes(counts, errors), 2 * stages, atol=0.5)
