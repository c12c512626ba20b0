"""The observed order of every integrator: slope of log error over log step, down to round-off."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.integrators import METHODS, de_vogelaere
from elastolink.runtime.integrators.gauss_legendre import gauss_legendre
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


def _slope(method, system, counts):
    def end(integrator, count):
        q, slope = START
        return marched(integrator, system, SPEED, count, 2, start=0.3, q=q, slope=slope)[-1]

    # Two revolutions; the end carries the accumulated error.
    exact = end(gauss_legendre(10), 512)
    errors = [np.linalg.norm(end(method, n) - exact) / np.linalg.norm(exact) for n in counts]
    errors = np.array(errors)
    kept = (errors < 1e-2) & (errors > 1e-13)
    assert np.sum(kept) >= 3
    # The finest three that round-off leaves alone.
    x, y = np.log(np.array(counts))[kept][-3:], np.log(errors[kept][-3:])
    return -np.polyfit(x, y, 1)[0]


@pytest.mark.parametrize("name", ["rk4", "kutta_merson", "magnus4", "cf4"])
def test_fourth_order_methods(name):
    counts = [128, 256, 512, 1024, 2048]
    assert abs(_slope(METHODS[name], _system(), counts) - 4.0) < 0.1
    assert METHODS[name].order == 4


def test_de_vogelaere_is_of_fourth_order():
    def spring(theta):
        out = np.zeros((len(theta), 2, 2))
        out[:, 0, 0], out[:, 0, 1] = -20.0 - 5.0 * np.cos(theta), 3.0 * np.sin(theta)
        return out

    ends = []
    for count in (1024, 2048, 4096, 32768):
        h = np.pi / count
        state = de_vogelaere.start(spring, 0.3, h, np.array([0.3, 1.0]), np.array([0.1, 0.0]))
        for matrix in de_vogelaere.maps(spring, 0.3 + 2 * h * np.arange(count), h):
            state = matrix @ state
        ends.append(state[0])
    errors = np.abs(np.array(ends[:3]) - ends[3])
    np.testing.assert_allclose(np.log2(errors[:2] / errors[1:]), 4.0, atol=0.1)


@pytest.mark.parametrize("stages", [1, 2, 3, 4, 5, 6])
def test_gauss_legendre_is_of_order_twice_its_stages(stages):
    counts = {
        1: [256, 512, 1024, 2048],
        2: [128, 256, 512, 1024],
        3: [48, 64, 96, 128, 192],
        4: [32, 40, 48, 64, 80],
        5: [16, 18, 20, 22],
        6: [14, 16, 18, 20],
    }[stages]
    assert abs(_slope(gauss_legendre(stages), _system(), counts) - 2 * stages) < 0.1


@pytest.mark.parametrize("name", ["magnus6", "cf6"])
def test_sixth_order_methods(name):
    counts = [64, 96, 128, 192, 256]
    assert abs(_slope(METHODS[name], _system(), counts) - 6.0) < 0.1
    assert METHODS[name].order == 6


def test_magnus8_is_of_eighth_order():
    counts = [64, 80, 96, 128, 160]
    assert abs(_slope(METHODS["magnus8"], _system(), counts) - 8.0) < 0.15


def _split_system(varying_mass: bool) -> LinearPeriodic:
    """Two forced degrees of freedom without first derivatives in the canonical equations."""
    cos, sin = np.cos, np.sin
    mass = np.array([[2.0, 0.3], [0.3, 1.0]])
    if varying_mass:
        mass = _matrices(
            lambda t: 2 + 0.4 * cos(t),
            lambda t: 0.2 * sin(t),
            lambda t: 0.2 * sin(t),
            lambda t: 1 + 0 * t,
        )
    return LinearPeriodic(
        2,
        (
            Term("M", None, mass),
            Term("K", None, np.array([[20.0, 2.0], [2.0, 35.0]])),
            Term("Kg", None, _matrices(lambda t: 5 * cos(t), sin, sin, lambda t: 4 * cos(2 * t))),
            Term("f", None, lambda t: np.stack([0.3 * cos(t), 0.1 * sin(t)], axis=-1)),
            Term("p", None, np.array([0.5, -1.0])),
        ),
        {},
        lambda values: {},
    )


@pytest.mark.parametrize("varying_mass", [False, True])
@pytest.mark.parametrize(("name", "order"), [("srkn4", 4), ("srkn6", 6)])
def test_symplectic_nystroem_methods(name, order, varying_mass):
    counts = {4: [64, 128, 256, 512], 6: [16, 24, 32, 48, 64]}[order]
    system = _split_system(varying_mass)
    assert abs(_slope(METHODS[name], system, counts) - order) < 0.15
    assert METHODS[name].order == order
