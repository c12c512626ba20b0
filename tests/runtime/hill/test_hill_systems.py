"""Hill's method for coupled modes, beside the monodromy matrix and the single equation."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.exact import systems
from elastolink.runtime.hill.exact.quasi import characteristic_exponents
from elastolink.runtime.hill.exact.systems import hill_exponents
from elastolink.runtime.periodic import floquet_multipliers
from scipy.optimize import linear_sum_assignment


def cosine(matrix, phase=0.0, number=1):
    return lambda theta: np.cos(number * theta + phase)[:, None, None] * np.asarray(matrix)


def hill(lam2, mu, k):
    terms = (
        Term("M", None, np.eye(1)),
        Term("K", None, lam2 * np.eye(1), power=2),
        Term("Kg", None, cosine([[mu]]), power=2),
        Term("C", None, 2 * k * np.eye(1), power=1),
    )
    return LinearPeriodic(1, terms, {}, lambda values: {})


def general(damping, coupling=0.3):
    """Two modes with every kind of term, all of them periodic."""
    terms = (
        Term("M", None, np.array([[2.0, 0.3], [0.3, 1.0]])),
        Term("M", None, cosine([[0.2, 0.1], [0.1, -0.1]], 0.3)),
        Term("A", None, cosine([[0.0, -0.4], [0.3, 0.1]], 1.0)),
        Term("B", None, cosine([[0.3, 0.1], [0.1, 0.2]], 0.0, 2)),
        Term("C", None, damping * np.array([[1.0, 0.2], [0.2, 2.0]])),
        Term("C", None, cosine(damping * np.array([[0.3, 0.0], [0.0, 0.1]]), 0.5)),
        Term("K", None, np.diag([1.0, 5.0])),
        Term("Kg", None, cosine(coupling * np.array([[1.0, 0.5], [0.5, -1.0]]), 0.2)),
    )
    return LinearPeriodic(2, terms, {}, lambda values: {})


def largest_gap(one, two):
    apart = np.abs(one[:, None] - two)
    rows, columns = linear_sum_assignment(apart)
    return apart[rows, columns].max()


@pytest.mark.parametrize(
    ("lam2", "mu", "k"), [(1.3, 0.4, 0.0), (0.25, 0.4, 0.0), (1.0, 0.9, 0.05), (-0.2, 1.5, 0.1)]
)
def test_one_mode_is_hills_equation(lam2, mu, k):
    found = hill_exponents(hill(lam2, mu, k), 3.0)
    single = characteristic_exponents(PeriodicFunction([0.0, 1.0]), lam2, mu, k)
    slack = found.error.max() + single.error
    turns = np.abs(found.exponents.imag - np.rint(found.exponents.imag))
    assert np.all(np.abs(turns - single.nu) <= slack)
    assert abs(found.exponents.real.max() - single.growth) <= slack
    assert abs(found.exponents.real.sum() + 2 * k) <= 2 * slack
    assert found.passed and found.error.max() < 1e-10


@pytest.mark.parametrize("damping", [0.0, 0.05])
@pytest.mark.parametrize("speed", [0.6, 1.0, 2.2])
def test_two_routes_to_the_multipliers(damping, speed):
    system = general(damping)
    ours, theirs = hill_exponents(system, speed), floquet_multipliers(system, speed)
    scale = np.abs(theirs.multipliers).max()
    slack = 2 * np.pi * scale * ours.error.max() + theirs.error.max()
    assert largest_gap(ours.multipliers, theirs.multipliers) <= slack
    assert ours.error.max() < 1e-9


def test_another_period():
    terms = (
        Term("M", None, np.eye(1)),
        Term("K", None, 2.0 * np.eye(1)),
        Term("Kg", None, cosine([[0.5]], 0.0, 2)),
    )
    long = LinearPeriodic(1, terms, {}, lambda values: {})
    short = LinearPeriodic(1, terms, {}, lambda values: {}, period=np.pi)
    half, whole = hill_exponents(short, 1.1), hill_exponents(long, 1.1)
    assert largest_gap(half.multipliers**2, whole.multipliers) <= 1e-9


def test_constant_coefficients_are_their_own_exponents():
    terms = (Term("M", None, np.eye(2)), Term("K", None, np.diag([1.0, 7.0])))
    found = hill_exponents(LinearPeriodic(2, terms, {}, lambda values: {}), 1.0)
    exact = np.exp(2j * np.pi * np.array([1.0, -1.0, np.sqrt(7), -np.sqrt(7)]))
    assert largest_gap(found.multipliers, exact) <= 2 * np.pi * found.error.max() + 1e-14


@pytest.mark.parametrize("speed", [0.0, -1.0, np.nan, np.array([1.0, 2.0])])
def test_bad_speeds(speed):
    with pytest.raises(BadInput, match="speed"):
        hill_exponents(general(0.0), speed)


def test_what_does_not_settle_is_refused(monkeypatch):
    monkeypatch.setattr(systems, "_LARGEST", 200)
    with pytest.raises(BadInput, match="floquet_multipliers"):
        hill_exponents(general(0.0), 1e-3)
