"""The canonical form against the equation of the family, entry by entry."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.floquet.first_order import canonical_form
from elastolink.runtime.floquet.spring_form import periodic_derivative, spring_generator

SPEED = 2.3
PARAMETERS = {"weight": 1.4, "load": 0.7}


def _wave(matrix, harmonic, phase):
    matrix = np.array(matrix)
    shape = (-1,) + (1,) * matrix.ndim
    return lambda theta: np.cos(harmonic * theta + phase).reshape(shape) * matrix


def _system() -> LinearPeriodic:
    terms = (
        Term("M", "weight", np.array([[2.0, 0.3], [0.3, 1.0]])),
        Term("M", None, _wave([[0.5, 0.1], [0.1, 0.2]], 1, 0.3)),
        Term("A", None, _wave([[0.2, 0.5], [-0.1, 0.3]], 2, 1.0)),
        Term("B", None, _wave([[1.0, 0.2], [0.2, -0.5]], 1, 0.0), power=1),
        Term("S", None, _wave([[9.0, 9.0], [9.0, 9.0]], 1, 0.0)),
        Term("C", "weight", np.array([[0.4, 0.1], [0.1, 0.3]]), power=1),
        Term("K", None, np.array([[20.0, 3.0], [3.0, 9.0]])),
        Term("Kg", "load", _wave([[2.0, 1.0], [1.0, 3.0]], 1, -0.4)),
        Term("f", "load", _wave([1.0, -2.0], 1, 0.0)),
        Term("h", None, _wave([0.3, 0.4], 2, 0.0)),
        Term("g", None, _wave([9.0, 9.0], 1, 0.0)),
        Term("p", None, np.array([0.5, 0.1])),
    )
    return LinearPeriodic(
        2,
        terms,
        PARAMETERS,
        lambda values: {name: np.asarray(values[name], dtype=float) for name in PARAMETERS},
    )


def _unscaled(form, theta):
    scale = form.scale[:, None, :]
    return form.generator(theta) * scale[..., :, None] / scale[..., None, :]


def test_generator_is_the_equation_of_the_family():
    system = _system()
    theta = np.array([0.0, 0.7, 2.9])
    form = canonical_form(system, SPEED, forcing=True)
    arrays = {name: system.array(name, theta, SPEED) for name in "MABCKfhp"}
    load = system.array("Kg", theta, SPEED)
    rng = np.random.default_rng(2)
    q, p = rng.standard_normal((2, 2))
    state = np.concatenate([q, p, [1.0]])
    slopes = _unscaled(form, theta)[0] @ state
    for k in range(len(theta)):
        at = {name: value[k] for name, value in arrays.items()}
        slope = np.linalg.solve(at["M"], p - at["A"] @ q)
        push = at["A"].T @ slope + at["B"] @ q - (at["K"] + load[k]) @ q / SPEED**2
        push += -at["C"] @ slope / SPEED + at["f"] + at["h"] / SPEED + at["p"] / SPEED**2
        np.testing.assert_allclose(slopes[k], [*slope, *push, 0.0], rtol=1e-13, atol=1e-13)
        momentum = form.momentum(theta[k], q, slope)
        np.testing.assert_allclose(momentum, p, rtol=1e-13)
    along = form.slope(theta, np.tile(q, (3, 1)), np.tile(p, (3, 1)))
    np.testing.assert_allclose(along, slopes[:, :2], rtol=1e-13)


def test_trace_is_the_generators():
    form = canonical_form(_system(), SPEED)
    theta = np.linspace(0.0, 6.0, 7)
    expected = np.trace(form.generator(theta), axis1=-2, axis2=-1)
    np.testing.assert_allclose(form.trace(theta), expected, rtol=1e-12)


def test_batch_is_the_members_together():
    system = _system()
    theta = np.array([0.2, 1.9])
    speed, load = np.array([[1.0], [2.0]]), np.array([0.1, 0.2, 0.3])
    form = canonical_form(system, speed, {"load": load})
    assert form.batch == (2, 3)
    together = _unscaled(form, theta).reshape(2, 3, 2, 4, 4)
    for i in range(2):
        for j in range(3):
            one = canonical_form(system, speed[i, 0], {"load": load[j]})
            np.testing.assert_allclose(together[i, j], _unscaled(one, theta)[0], rtol=1e-14)
    part = form.take(np.array([4, 1]))
    np.testing.assert_allclose(_unscaled(part, theta)[0], together[1, 1], rtol=1e-14)


def test_angle_functions_are_called_once_for_all_speeds():
    calls = []

    def spring(theta):
        calls.append(len(theta))
        return np.cos(theta)[:, None, None]

    terms = (Term("M", None, np.eye(1)), Term("K", None, np.eye(1)), Term("Kg", None, spring))
    system = LinearPeriodic(1, terms, {}, lambda values: {})
    form = canonical_form(system, np.linspace(1.0, 2.0, 50))
    _ = form.scale
    calls.clear()
    form.generator(np.linspace(0.0, 1.0, 8))
    assert calls == [8]


def test_absent_terms_cost_nothing():
    terms = (Term("M", None, np.eye(1)), Term("K", None, np.eye(1)))
    form = canonical_form(LinearPeriodic(1, terms, {}, lambda values: {}), 1.0)
    theta = np.linspace(0.0, 1.0, 5)
    assert form.assemble("A", theta) is None
    assert form.assemble("K", theta).shape == (1, 1, 1, 1)
    assert form.constant
    assert form.conservative


def test_second_order_form_with_a_symmetric_coupling():
    # G = A - A^T = 0; H = A' - B.
    symmetric = [[0.2, 0.5], [0.5, -0.3]]
    terms = (
        Term("M", None, np.array([[2.0, 0.3], [0.3, 1.0]])),
        Term("A", None, _wave(symmetric, 2, 1.0)),
        Term("B", None, _wave([[1.0, 0.2], [0.2, -0.5]], 1, 0.0)),
        Term("K", None, np.array([[20.0, 3.0], [3.0, 9.0]])),
        Term("f", None, _wave([1.0, -2.0], 1, 0.0)),
    )
    system = LinearPeriodic(2, terms, {}, lambda values: {})
    form = canonical_form(system, SPEED, forcing=True)
    theta = np.array([0.0, 0.7, 2.9])
    found = spring_generator(form)(theta)[0]
    for k, at in enumerate(theta):
        slope = -2 * np.sin(2 * at + 1.0) * np.array(symmetric)
        push = system.array("B", [at])[0] - slope - system.array("K", [at])[0] / SPEED**2
        mass = system.array("M", [at])[0]
        np.testing.assert_allclose(found[k, :2, :2], np.linalg.solve(mass, push), atol=1e-13)
        force = np.linalg.solve(mass, system.array("f", [at])[0])
        np.testing.assert_allclose(found[k, :2, 2], force, atol=1e-14)


def test_periodic_derivative_is_spectral_and_refuses_kinks():
    def smooth(theta):
        return (1 / (1.3 + np.cos(theta)))[None, :, None, None]

    theta = np.linspace(0.0, 20.0, 33)
    expected = np.sin(theta) / (1.3 + np.cos(theta)) ** 2
    found = periodic_derivative(smooth, 2 * np.pi)(theta)[0, :, 0, 0]
    np.testing.assert_allclose(found, expected, atol=1e-12)
    with pytest.raises(BadInput, match="4096 samples"):
        periodic_derivative(lambda at: np.abs(np.sin(at))[None, :, None, None], 2 * np.pi)
