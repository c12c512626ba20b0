"""The observed order of every integrator: slope of log error over log step, down to round-off."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.integrators import METHODS
from elastolink.runtime.integrators.gauss_legendre import gauss_legendre
from elastolink.runtime.periodic.first_order import canonical_form
from elastolink.runtime.simulation.marching import make_grid, march

SPEED = 3.0
START = (np.array([0.3, -0.2]), np.array([0.1, 0.4]))


def _matrices(*entries):
    """Return a function of the angle from 2 x 2 entries given as functions."""

    def function(theta):
        values = [np.broadcast_to(entry(theta), theta.shape) for entry in entries]
        return np.stack(values, axis=-1).reshape(len(theta), 2, 2)

    return function


def _system(second_order: bool) -> LinearPeriodic:
    """Two forced degrees of freedom: with periodic mass, Coriolis and damping terms, or without."""
    cos, sin = np.cos, np.sin
    terms = [
        Term("K", None, np.array([[20.0, 2.0], [2.0, 35.0]])),
        Term("Kg", None, _matrices(lambda t: 5 * cos(t), sin, sin, lambda t: 4 * cos(2 * t))),
        Term("f", None, lambda t: np.stack([0.3 * cos(t), 0.1 * sin(t)], axis=-1)),
        Term("p", None, np.array([0.5, -1.0])),
    ]
    if second_order:
        symmetric = _matrices(lambda t: 0.2 * sin(t), cos, cos, lambda t: 0.1 + 0 * t)
        terms += [Term("M", None, np.array([[2.0, 0.3], [0.3, 1.0]])), Term("A", None, symmetric)]
    else:
        mass = _matrices(
            lambda t: 2 + 0.4 * cos(t),
            lambda t: 0.2 * sin(t),
            lambda t: 0.2 * sin(t),
            lambda t: 1 + 0 * t,
        )
        gyro = _matrices(lambda t: 0.1 * sin(t), lambda t: -0.5 + 0 * t, cos, lambda t: 0 * t)
        inertia = _matrices(cos, lambda t: 0.1 + 0 * t, lambda t: 0.1 + 0 * t, sin)
        terms += [
            Term("M", None, mass),
            Term("A", None, gyro),
            Term("B", None, inertia),
            Term("C", None, np.array([[0.3, 0.1], [0.1, 0.2]])),
            Term("h", None, lambda t: np.stack([sin(t), cos(2 * t)], axis=-1)),
        ]
    return LinearPeriodic(2, tuple(terms), {}, lambda values: {})


def _slope(method, system, counts):
    form = canonical_form(system, SPEED, forcing=True)
    # Two revolutions; the end carries the accumulated error.
    exact = march(gauss_legendre(10), form, make_grid(0.3, 2.0, 8, 512), *START, 1e9).q[-1]
    errors = []
    for count in counts:
        end = march(method, form, make_grid(0.3, 2.0, 8, count), *START, 1e9).q[-1]
        errors.append(np.linalg.norm(end - exact) / np.linalg.norm(exact))
    errors = np.array(errors)
    kept = (errors < 1e-2) & (errors > 1e-13)
    assert np.sum(kept) >= 3
    # The finest three that round-off leaves alone.
    x, y = np.log(np.array(counts))[kept][-3:], np.log(errors[kept][-3:])
    return -np.polyfit(x, y, 1)[0]


@pytest.mark.parametrize("name", ["rk4", "kutta_merson", "magnus4", "cf4"])
def test_fourth_order_methods(name):
    counts = [128, 256, 512, 1024, 2048]
    assert abs(_slope(METHODS[name], _system(False), counts) - 4.0) < 0.1
    assert METHODS[name].order == 4


def test_de_vogelaere_is_of_fourth_order():
    counts = [128, 256, 512, 1024, 2048]
    assert abs(_slope(METHODS["de_vogelaere"], _system(True), counts) - 4.0) < 0.1


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
    assert abs(_slope(gauss_legendre(stages), _system(False), counts) - 2 * stages) < 0.1


@pytest.mark.parametrize("name", ["magnus6", "cf6"])
def test_sixth_order_methods(name):
    counts = [64, 96, 128, 192, 256]
    assert abs(_slope(METHODS[name], _system(False), counts) - 6.0) < 0.1
    assert METHODS[name].order == 6


def test_magnus8_is_of_eighth_order():
    counts = [64, 80, 96, 128, 160]
    assert abs(_slope(METHODS["magnus8"], _system(False), counts) - 8.0) < 0.15


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
