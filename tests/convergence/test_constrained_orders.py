"""Observed order of the integrators of constrained systems, by slope against elliptic functions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from constrained_truth import Circle
from elastolink.runtime.constrained.equations import Equations
from elastolink.runtime.constrained.steppers import (
    METHODS,
    collocation,
    coordinate_partitioning,
    lobatto,
    motion_with_variations,
    projection,
)
from elastolink.runtime.constrained.steppers.lobatto_tableau import lobatto_pair
from elastolink.runtime.constrained.steppers.protocol import Control, natural_scales
from elastolink.runtime.core.errors import SelfCheckFailed

SPAN = 1.5
CIRCLE = Circle(
    start=5.0, oblique=np.array([[1.0, 0.3], [0.0, 0.2]]), pivot=np.array([0.4, -0.2]), row=5.0
)


# A swing so small that one choice of independent coordinates serves throughout: where the choice
# changes within a step more or less, the slope is not smooth.
SMALL = replace(CIRCLE, start=1.5, oblique=np.diag([1.0, 0.2]))


def error(method, steps: int, stages: int = 5, circle: Circle = CIRCLE) -> float:
    """Largest error at the end, of coordinates over 1 and velocities over 5."""
    equations = Equations(circle.system, *circle.state, 0.0)
    start = equations.at(0.0, *circle.state)
    scales = natural_scales(start, equations.columns)
    control = Control(1e-9, *scales, step=SPAN / steps, stages=stages)
    for taken in method(equations, start, np.array([0.0, SPAN]), control):
        last = taken.after
    q, qd = circle.exact([SPAN])
    assert last.t == SPAN
    return float(max(np.max(np.abs(last.q - q[0])), np.max(np.abs(last.qd - qd[0])) / 5))


def slopes(method, counts, stages: int = 5, circle: Circle = CIRCLE):
    errors = np.array([error(method, count, stages, circle) for count in counts])
    assert errors[-1] > 3e-13, "round-off hides the order"
    return -np.diff(np.log(errors)) / np.diff(np.log(counts)), errors


@pytest.mark.parametrize(
    ("method", "counts", "circle"),
    [(projection, (20, 30, 45), CIRCLE), (coordinate_partitioning, (10, 14, 20), SMALL)],
)
def test_explicit_steps_are_of_order_eight(method, counts, circle):
    found, _ = slopes(method, counts, circle=circle)
    assert np.all(found > 7.0)
    assert np.all(found < 9.5)


@pytest.mark.parametrize(
    ("stages", "counts"),
    [(2, (200, 400, 800)), (3, (40, 80, 160)), (4, (20, 30, 45)), (5, (12, 16, 22))],
)
def test_lobatto_steps_are_of_order_twice_the_stages_less_two(stages, counts):
    found, _ = slopes(lobatto, counts, stages)
    np.testing.assert_allclose(found, 2 * stages - 2, atol=0.35)
    assert METHODS["lobatto"].order(stages) == 2 * stages - 2


@pytest.mark.parametrize("stages", [6, 7])
def test_windows_of_collocation_are_of_order_twice_their_nodes(stages):
    found, _ = slopes(collocation, (6, 8, 10), stages)
    np.testing.assert_allclose(found, 2 * stages, atol=0.7)
    assert METHODS["collocation"].order(stages) == 2 * stages


def test_lobatto_with_two_stages_is_rattle():
    """On the pendulum in Cartesian coordinates: the textbook's steps, solved by hand."""
    circle, h = Circle(gravity=10.0, start=5.0, mass=1.0), 0.01
    x, v = circle.state
    pull = np.array([0.0, -10.0])
    for _ in range(5):
        # v_half = v + h/2 (pull + lam x); x_next = x + h v_half on the circle; then v_next.
        free = x + h * (v + h / 2 * pull)
        a, b, c = h**4 / 4 * (x @ x), h**2 * (free @ x), free @ free - 1.0
        lam = -2 * c / (b + np.sqrt(b * b - 4 * a * c))
        half = v + h / 2 * (pull + lam * x)
        x = x + h * half
        v = half + h / 2 * pull
        v = v - (v @ x) * x
    equations = Equations(circle.system, *circle.state, 0.0)
    start = equations.at(0.0, *circle.state)
    control = Control(1e-9, *natural_scales(start, equations.columns), step=h, stages=2)
    for taken in lobatto(equations, start, np.array([0.0, 5 * h]), control):
        last = taken.after
    np.testing.assert_allclose(last.q, x, atol=1e-14)
    np.testing.assert_allclose(last.qd, v, atol=1e-13)


@pytest.mark.parametrize("stages", [3, 4])
def test_columns_converge_with_the_order_of_the_steps(stages):
    """The derivative by the starting speed, against the exact motion of neighbouring starts."""
    q, qd = CIRCLE.state
    change = 1e-4
    ends = [
        np.concatenate(part)
        for sign in (1, -1)
        for part in zip(*replace(CIRCLE, start=5.0 + sign * change).exact([SPAN]), strict=True)
    ]
    exact = (ends[0] - ends[1]) / (2 * change)
    column = np.concatenate([np.zeros(2), np.linalg.solve(CIRCLE.oblique, [1.0, 0.0])])
    counts = (15, 30)
    gaps = []
    for count in counts:
        found = motion_with_variations(
            CIRCLE.system, q, qd, (0.0, SPAN), column[:, None], steps=count, stages=stages
        )
        gaps.append(np.max(np.abs(found.columns[:, 0] - exact)))
    slope = np.log(gaps[0] / gaps[1]) / np.log(2.0)
    assert abs(slope - (2 * stages - 2)) < 0.7


@pytest.mark.parametrize("stages", range(2, 13))
def test_coefficients_prove_themselves(stages):
    pair = lobatto_pair(stages)
    assert pair.order == 2 * stages - 2
    assert pair.c[0] == 0.0
    assert pair.c[-1] == 1.0
    assert np.all(pair.first[0] == 0.0)
    assert np.all(pair.second[:, -1] == 0.0)


def test_wrong_coefficients_are_refused():
    pair = lobatto_pair(3)
    wrong = pair.second.copy()
    wrong[1, 0] += 1e-9
    with pytest.raises(SelfCheckFailed, match="symplectic"):
        type(pair)(pair.c, pair.b, pair.first, wrong)
    with pytest.raises(ValueError, match="1 stages"):
        lobatto_pair(1)
