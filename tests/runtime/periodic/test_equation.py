"""The sampled equation against the definition of the family, entry by entry."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.periodic.equation import equation_of, fourier_series, sampled, waves
from periodic_systems import system_of, wave

SPEED = 2.3
PARAMETERS = {"weight": 1.4, "load": 0.7}


def _system() -> LinearPeriodic:
    return system_of(
        PARAMETERS,
        M=[("weight", np.array([[2.0, 0.3], [0.3, 1.0]])), wave([[0.5, 0.1], [0.1, 0.2]], 1, 0.3)],
        A=wave([[0.2, 0.5], [-0.1, 0.3]], 2, 1.0),
        B=(None, wave([[1.0, 0.2], [0.2, -0.5]]), 1),
        S=wave([[9.0, 9.0], [9.0, 9.0]]),
        C=("weight", np.array([[0.4, 0.1], [0.1, 0.3]]), 1),
        D=wave([[0.2, 0.1], [-0.3, 0.1]], 3, 0.2),
        K=np.array([[20.0, 3.0], [3.0, 9.0]]),
        Kg=("load", wave([[2.0, 1.0], [1.0, 3.0]], 1, -0.4)),
        f=("load", wave([1.0, -2.0])),
        h=wave([0.3, 0.4], 2),
        g=wave([9.0, 9.0]),
        p=np.array([0.5, 0.1]),
    )


def _unscaled(equation, theta):
    unit = np.concatenate([equation.scale, 1.0 / equation.scale], axis=1)
    if equation.forced:
        unit = np.concatenate([unit, np.ones((len(unit), 1))], axis=1)
    return equation.generator(theta) * unit[:, None, :, None] / unit[:, None, None, :]


@pytest.mark.smoke
def test_generator_is_the_equation_of_the_family():
    system = _system()
    theta = np.array([0.0, 0.7, 2.9])
    equation = equation_of(system, SPEED, forcing=True)
    arrays = {name: system.array(name, theta, SPEED) for name in ("M", "A", "B", "C", "D", "K")}
    arrays |= {name: system.array(name, theta, SPEED) for name in ("Kg", "f", "h", "p")}
    q, p = np.random.default_rng(2).standard_normal((2, 2))
    slopes = _unscaled(equation, theta)[0] @ np.concatenate([q, p, [1.0]])
    for k in range(len(theta)):
        at = {name: value[k] for name, value in arrays.items()}
        slope = np.linalg.solve(at["M"], p - at["A"] @ q)
        push = at["A"].T @ slope + at["B"] @ q - (at["K"] + at["Kg"]) @ q / SPEED**2
        push += -(at["C"] @ slope + at["D"] @ q) / SPEED
        push += at["f"] + at["h"] / SPEED + at["p"] / SPEED**2
        np.testing.assert_allclose(slopes[k], [*slope, *push, 0.0], rtol=1e-13, atol=1e-13)
        state = equation.state(theta[k], q, slope)
        unit = equation.scale[0]
        np.testing.assert_allclose(state * np.concatenate([unit, 1 / unit]), [*q, *p], rtol=1e-13)


def test_a_sampled_system_is_not_evaluated_again():
    calls = []

    def spring(theta):
        calls.append(len(theta))
        return np.cos(theta)[:, None, None]

    known = sampled(system_of(M=np.eye(1), K=np.eye(1), Kg=spring))
    calls.clear()
    equation_of(known, np.linspace(1.0, 2.0, 50)).generator(np.linspace(0.0, 1.0, 8))
    assert calls == []


def test_absent_and_vanishing_terms_leave_no_field():
    none = {"C": np.zeros((1, 1)), "D": lambda theta: 0.0 * theta[:, None, None]}
    equation = equation_of(system_of(M=np.eye(1), K=np.eye(1), **none), 1.0)
    assert set(equation.fields) == {"mass", "stiffness"}
    assert not equation.damped


@pytest.mark.parametrize("harmonics", [1, 30, 200, 900])
def test_series_have_the_harmonics_that_the_term_has(harmonics):
    rng = np.random.default_rng(harmonics)
    a, b = rng.standard_normal((2, harmonics + 1))
    order = np.arange(harmonics + 1)

    def function(theta):
        turns = np.outer(theta, order)
        return (np.cos(turns) @ a + np.sin(turns) @ b)[:, None, None]

    system = system_of(M=np.eye(1))
    (series,), count, reach = fourier_series(system, [Term("Kg", None, function)])
    assert count == reach == harmonics
    theta = np.linspace(0.1, 9.0, 17)
    exact = function(theta)[:, 0, 0]
    np.testing.assert_allclose(waves(count, theta) @ series[:, 0, 0], exact, atol=2e-12 * harmonics)


def test_a_kink_is_not_smooth_and_is_evaluated_where_it_is_wanted():
    kinked = system_of(M=np.eye(1), Kg=lambda theta: np.abs(np.sin(theta))[:, None, None])
    equation = equation_of(kinked, 1.0)
    assert equation.harmonics == -1
    theta = np.array([0.3, 4.0])
    values = -np.abs(np.sin(theta)) * equation.scale[0, 0] ** 2
    np.testing.assert_allclose(equation.at("stiffness", theta)[0, :, 0, 0], values, rtol=1e-15)


@pytest.mark.parametrize(
    ("mass", "words"),
    [
        ([0.5 * np.eye(2), wave(np.eye(2))], "found smallest eigenvalue"),
        (np.array([[1.0, 0.5], [0.0, 1.0]]), "found asymmetry"),
    ],
)
def test_a_mass_that_is_not_definite_is_named(mass, words):
    with pytest.raises(BadInput, match=f"mass matrix M: {words}"):
        equation_of(system_of(M=mass), 1.0)
