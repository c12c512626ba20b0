"""Initial values that meet the constraints."""

import numpy as np
import pytest
from constrained_truth import Circle
from elastolink.runtime.constrained import consistent_state
from elastolink.runtime.core.errors import RedundantConstraints
from elastolink.runtime.core.families import Constrained

CIRCLE = Circle(oblique=np.array([[1.0, 0.3], [0.0, 0.02]]), pivot=np.array([0.4, -0.2]), row=50.0)


def test_a_state_on_the_constraints_stays():
    q, qd = CIRCLE.exact([0.0, 0.3, 1.7])
    found = consistent_state(CIRCLE.system, q, qd, [0.0, 0.3, 1.7])
    np.testing.assert_allclose(found.q, q, rtol=1e-14)
    np.testing.assert_allclose(found.qd, qd, rtol=1e-13)
    angle, turning = np.array([CIRCLE.angle(t) for t in (0.0, 0.3, 1.7)]).T
    by_hand = CIRCLE.multiplier(angle, turning)
    np.testing.assert_allclose(found.multipliers[:, 0], by_hand, rtol=1e-12)
    assert found.passed
    assert found.error < 1e-14


def test_the_change_is_the_least_one():
    circle = Circle()
    found = consistent_state(circle.system, [0.6, -1.2], [0.5, 0.7])
    # In Cartesian coordinates of one mass the nearest point lies along the ray.
    ray = np.array([0.6, -1.2]) / np.hypot(0.6, 1.2)
    np.testing.assert_allclose(found.q, ray, atol=1e-15)
    along = np.array([-ray[1], ray[0]])
    np.testing.assert_allclose(found.qd, along * (along @ [0.5, 0.7]), atol=1e-15)
    np.testing.assert_allclose(found.moved, ray - [0.6, -1.2], atol=1e-15)
    assert found.position_norm < 1e-15
    assert found.velocity_norm < 1e-15
    assert found.acceleration_norm < 1e-15


def test_held_coordinates_stay():
    found = consistent_state(Circle().system, [0.6, -1.2], [0.5, 0.7], hold=("a",))
    np.testing.assert_allclose(found.q, [0.6, -0.8], atol=1e-15)
    np.testing.assert_allclose(found.qd, [0.5, 0.375], atol=1e-15)
    by_place = consistent_state(Circle().system, [0.6, -1.2], [0.5, 0.7], hold=(0,))
    np.testing.assert_array_equal(found.q, by_place.q)


def test_a_batch_is_as_each_alone():
    rng = np.random.default_rng(3)
    q, qd = rng.normal(size=(2, 4, 3, 2))
    t = rng.uniform(0, 0.2, (4, 3))
    together = consistent_state(CIRCLE.system, q, qd, t)
    assert together.q.shape == (4, 3, 2)
    assert together.multipliers.shape == (4, 3, 1)
    assert together.velocity_norm.shape == (4, 3)
    for i in np.ndindex(4, 3):
        alone = consistent_state(CIRCLE.system, q[i], qd[i], t[i])
        np.testing.assert_allclose(together.q[i], alone.q, rtol=1e-10, atol=1e-12)
        np.testing.assert_allclose(together.qd[i], alone.qd, rtol=1e-9, atol=1e-10)


def twice(other: float = 1.0, offset: float = 0.0) -> Constrained:
    """The circle with its constraint a second time."""
    system = Circle().system

    def doubled(arrays, moved):
        found = dict(arrays)
        for name in moved:
            copy = other * found[name] + (offset if name == "constraints" else 0.0)
            found[name] = np.concatenate([found[name], copy], axis=-2)
        return found

    return Constrained(
        2,
        2,
        lambda q, qd, t: doubled(system.dynamics(q, qd, t), ("jacobian", "velocity_rhs", "gamma")),
        lambda q, t: doubled(system.violation(q, t), ("constraints", "jacobian")),
        labels=("a", "b"),
    )


@pytest.mark.parametrize("offset", [0.0, 0.3])
def test_redundant_and_contradictory_constraints_are_refused(offset):
    with pytest.raises(RedundantConstraints, match="constraints: found a Jacobian") as refusal:
        consistent_state(twice(2.0, offset), [0.6, -0.8], [0.0, 0.0])
    assert "\n" not in str(refusal.value)
    with pytest.raises(RedundantConstraints):
        twice().accelerations(np.array([0.6, -0.8]), np.zeros(2))
