"""Observed order of collocation, and errors of constrained motions that fall with the tolerance."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.constrained.equations import Equations
from elastolink.runtime.constrained.orbits import Ring, Shooting
from elastolink.runtime.core.families import Constrained
from orders import slopes


def swing() -> Constrained:
    """A pendulum driven so that its angle is 2 cos t."""

    def dynamics(q, qd, t):
        t, batch = np.asarray(t), np.shape(q)[:-1]
        push = np.sin(2.0 * np.cos(t)) - 2.0 * np.cos(t)
        return {
            "mass": np.ones((*batch, 1, 1)),
            "rest": np.sin(q)[..., None],
            "forces": push[..., None, None],
            "jacobian": np.zeros((*batch, 0, 1)),
            "velocity_rhs": np.zeros((*batch, 0, 1)),
            "gamma": np.zeros((*batch, 0, 1)),
        }

    def variations(q, qd, qdd, lam, t):
        none = np.zeros((*np.shape(q)[:-1], 0, 1))
        stiffness = np.cos(q)[..., None]
        return {
            "damping": 0.0 * stiffness,
            "stiffness": stiffness,
            "jacobian_rate": none,
            "jacobian_acceleration": none,
        }

    def violation(q, t):
        none = np.zeros((*np.shape(q)[:-1], 0, 1))
        return {"constraints": none, "jacobian": none}

    return Constrained(1, 0, dynamics, violation, variations)


@pytest.mark.parametrize(
    ("stages", "counts"), [(2, (20, 30, 40)), (3, (10, 15, 20)), (4, (10, 14, 18))]
)
def test_steps_of_an_orbit_are_of_order_twice_their_nodes(stages, counts):
    errors = []
    for count in counts:
        start = np.arange(count) * (2 * np.pi / count)
        x, v = 2.0 * np.cos(start)[:, None], -2.0 * np.sin(start)[:, None]
        equations = Equations(swing(), x, v, start)
        ring = Ring(2 * np.pi, np.zeros(1), x, v, np.zeros((count, stages, 1)))
        shot = Shooting(equations, 1.0).solve(ring)
        assert not shot.reason
        errors.append(max(np.max(np.abs(shot.ring.x - x)), np.max(np.abs(shot.ring.v - v))))
    assert errors[-1] > 1e-13, "round-off hides the order"
    np.testing.assert_allclose(-slopes(counts, errors), 2 * stages, atol=0.5)
