"""The observed order of collocation: slope of log error over log step, down to round-off."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from marching import marched

SPEED = 3.0
START = (np.array([0.3, -0.2]), np.array([0.1, 0.4]))


def _matrices(*entries):
    """Return a function of the angle from 2 x 2 entries given as functions."""

    def function(theta):
        values = [np.broadcast_to(entry(theta), theta.shape) for entry in entries]
        return np.stack(values, axis=-1).reshape(len(theta), 2, 2)

    return function


def _system() -> LinearPeriodic:
    """Two forced degrees of freedom with periodic mass, Coriolis and damping terms."""
    cos, sin = np.cos, np.sin
    mass = _matrices(
        lambda t: 2 + 0.4 * cos(t),
        lambda t: 0.2 * sin(t),
        lambda t: 0.2 * sin(t),
        lambda t: 1 + 0 * t,
    )
    gyro = _matrices(lambda t: 0.1 * sin(t), lambda t: -0.5 + 0 * t, cos, lambda t: 0 * t)
    inertia = _matrices(cos, lambda t: 0.1 + 0 * t, lambda t: 0.1 + 0 * t, sin)
    terms = (
        Term("K", None, np.array([[20.0, 2.0], [2.0, 35.0]])),
        Term("Kg", None, _matrices(lambda t: 5 * cos(t), sin, sin, lambda t: 4 * cos(2 * t))),
        Term("f", None, lambda t: np.stack([0.3 * cos(t), 0.1 * sin(t)], axis=-1)),
        Term("p", None, np.array([0.5, -1.0])),
        Term("M", None, mass),
        Term("A", None, gyro),
        Term("B", None, inertia),
        Term("C", None, np.array([[0.3, 0.1], [0.1, 0.2]])),
        Term("h", None, lambda t: np.stack([sin(t), cos(2 * t)], axis=-1)),
    )
    return LinearPeriodic(2, terms, {}, lambda values: {})


def _slope(stages, system, counts):
    def end(stages, count):
        q, slope = START
        return marched(stages, system, SPEED, count, 2, start=0.3, q=q, slope=slope)[-1]

    # Two revolutions; the end carries the accumulated error.
    exact = end(10, 512)
    errors = [np.linalg.norm(end(stages, n) - exact) / np.linalg.norm(exact) for n in counts]
    errors = np.array(errors)
    # The reference rounds to 4e-15, which has to be below some percent of an error.
    kept = (errors < 1e-2) & (errors > 2e-13)
    assert np.sum(kept) >= 3
    # The finest three that round-off leaves alone.
    x, y = np.log(np.array(counts))[kept][-3:], np.log(errors[kept][-3:])
    return -np.polyfit(x, y, 1)[0]


@pytest.mark.parametrize("stages", [1, 2, 3, 4, 5, 6])
def test_gauss_legendre_is_of_order_twice_its_stages(stages):
    counts = {
        1: [256, 512, 1024, 2048],
        2: [128, 256, 512, 1024],
        3: [48, 64, 96, 128, 192],
        4: [32, 40, 48, 64, 80],
        5: [16, 18, 20, 22],
        6: [12, 14, 16, 18],
    }[stages]
    assert abs(_slope(stages, _system(), counts) - 2 * stages) < 0.1
