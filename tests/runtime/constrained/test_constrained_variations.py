"""Columns of a constrained motion: the derivative of its end by its start."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from constrained_truth import Circle
from elastolink.runtime.constrained import motion_with_variations, tangent_basis
from elastolink.runtime.constrained.steppers import StoppedEarly, jacobian_rate
from elastolink.runtime.core.errors import BadInput
from scipy.integrate import solve_ivp

CIRCLE = Circle(
    start=5.0, oblique=np.array([[1.0, 0.3], [0.0, 0.2]]), pivot=np.array([0.4, -0.2]), row=5.0
)
SPAN = (0.0, 1.2)


def free(state, span):
    """The end by the equations of motion with the constraints at acceleration level only."""

    def rate(t, y):
        return np.concatenate([y[2:], CIRCLE.system.accelerations(y[:2], y[2:], t)[0]])

    run = solve_ivp(rate, span, state, "DOP853", rtol=1e-13, atol=1e-13)
    return run.y[:, -1]


def test_all_columns_are_those_of_the_reduced_equations():
    """Also the ones that leave the constraints, against differences of another integrator."""
    found = motion_with_variations(CIRCLE.system, *CIRCLE.state, SPAN, steps=60)
    start = np.concatenate(CIRCLE.state)
    change = 1e-4
    for column, unit in enumerate(np.eye(4)):
        near = [
            free(start + k * change * unit, SPAN) - free(start - k * change * unit, SPAN)
            for k in (1, 2)
        ]
        slope = (8 * near[0] - near[1]) / (12 * change)
        np.testing.assert_allclose(found.columns[:, column], slope, atol=2e-6)
    end = CIRCLE.exact([SPAN[1]])
    np.testing.assert_allclose(found.q[-1], end[0][0], atol=1e-9)
    np.testing.assert_allclose(found.qd[-1], end[1][0], atol=1e-8)
    assert found.t[-1] == SPAN[1]


def test_columns_on_the_constraints_stay_there():
    q, qd = CIRCLE.state
    basis = tangent_basis(CIRCLE.system, q, qd)
    assert basis.shape == (4, 2)
    found = motion_with_variations(CIRCLE.system, q, qd, SPAN, basis, steps=40)
    jacobian = CIRCLE.system.violation(found.q[-1], SPAN[1])["jacobian"]
    rate = jacobian_rate(CIRCLE.system, found.q[-1], found.qd[-1], SPAN[1])
    # d(Phi_q)/dt by hand: (R zd - pivot)^T R, times the row's factor
    moving = CIRCLE.oblique @ found.qd[-1] - CIRCLE.pivot
    np.testing.assert_allclose(rate[0], CIRCLE.row * moving @ CIRCLE.oblique, rtol=1e-12)
    size = np.max(np.abs(found.columns))
    np.testing.assert_allclose(jacobian @ found.columns[:2], 0.0, atol=1e-12 * size)
    defect = jacobian @ found.columns[2:] + rate @ found.columns[:2]
    np.testing.assert_allclose(defect, 0.0, atol=1e-10 * size)
    # Two states of the freedom: the map keeps areas, as the pivot's frame is inertial.
    after = tangent_basis(CIRCLE.system, found.q[-1], found.qd[-1], SPAN[1])
    area = [area_of(CIRCLE, q, columns) for q, columns in ((q, basis), (found.q[-1], after))]
    inside = np.linalg.lstsq(after, found.columns, rcond=None)[0]
    np.testing.assert_allclose(np.linalg.det(inside) * area[1], area[0], rtol=1e-9)


def area_of(circle, q, columns):
    """The form dq^T M dqd - dqd^T M dq on two columns."""
    mass = circle.mass * circle.oblique.T @ circle.oblique
    (a, b), (c, d) = columns[:2].T, columns[2:].T
    return a @ mass @ d - b @ mass @ c


def test_a_motion_without_velocity_has_a_basis():
    circle = replace(CIRCLE, pivot=np.zeros(2))
    q, _ = circle.state
    basis = tangent_basis(circle.system, q, np.zeros(2))
    jacobian = circle.system.violation(q, 0.0)["jacobian"]
    np.testing.assert_allclose(jacobian @ basis[:2], 0.0, atol=1e-14)
    np.testing.assert_allclose(jacobian @ basis[2:], 0.0, atol=1e-13)


@pytest.mark.parametrize(
    ("named", "message"),
    [
        ({"steps": 0}, "steps"),
        ({"steps": 5, "stages": 1}, "stages"),
        ({"steps": 5, "columns": np.eye(3)}, "columns: found shape"),
        ({"steps": 5, "q": [np.nan, 1.0]}, "finite"),
    ],
)
def test_bad_input_is_refused(named, message):
    q, qd = CIRCLE.state
    given = {"q": q, "qd": qd, "span": SPAN} | named
    with pytest.raises(BadInput, match=message):
        motion_with_variations(CIRCLE.system, **given)
    with pytest.raises(BadInput, match="no variations"):
        motion_with_variations(replace(CIRCLE.system, variations=None), q, qd, SPAN, steps=3)


def test_steps_that_are_too_long_are_named():
    with pytest.raises(StoppedEarly, match="take more steps"):
        motion_with_variations(CIRCLE.system, *CIRCLE.state, (0.0, 40.0), steps=2)
