"""The sampled equation: its fields, harmonics and evaluations; masses that are refused."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import Term
from elastolink.runtime.periodic.equation import equation_of, fourier_series, sampled, waves
from periodic_systems import system_of, wave


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
