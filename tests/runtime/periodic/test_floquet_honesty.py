"""Monodromy matrices that are hard to see: what is refused, what fails its check, what is told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.integrate
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.periodic import floquet_multipliers, monodromy
from periodic_systems import mathieu


def _single(mass=None, spring=None) -> LinearPeriodic:
    """Return a spring of 2, with a mass and a further spring that may depend on the angle."""

    def wrapped(function):
        return lambda theta: function(theta)[:, None, None]

    terms = [
        Term("M", None, np.eye(1) if mass is None else wrapped(mass)),
        Term("K", None, 2.0 * np.eye(1)),
    ]
    if spring is not None:
        terms.append(Term("Kg", None, wrapped(spring)))
    return LinearPeriodic(1, tuple(terms), {}, lambda values: {})


def _spike(width):
    return lambda theta: np.exp(-((((theta % (2 * np.pi)) - 1.0345) / width) ** 2)) / width


@pytest.mark.parametrize("wave", [np.cos, np.sin])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_mass_negative_between_even_angles_is_refused(wave, sign):
    system = _single(mass=lambda theta: 1.0 + sign * 1.2 * wave(8 * theta))
    with pytest.raises(BadInput, match="mass matrix M"):
        floquet_multipliers(system, 1.0)


def test_two_by_two_mass_that_turns_indefinite_at_a_collocation_angle_is_refused():
    # Negative over a sixtieth of the turn only, where no angle of the first test lies.
    def mass(theta):
        dip = np.exp(-((np.mod(theta - 2.0, 2 * np.pi) / 0.03) ** 2))
        return np.eye(2) - 1.5 * dip[:, None, None] * np.diag([0.0, 1.0])

    terms = (Term("M", None, mass), Term("K", None, np.eye(2)))
    with pytest.raises(BadInput, match="mass matrix M"):
        monodromy(LinearPeriodic(2, terms, {}, lambda values: {}), 1.0)


@pytest.mark.parametrize("width", [0.03, 0.01, 0.005])
def test_a_narrow_spike_is_seen(width):
    found = floquet_multipliers(_single(spring=_spike(width)), 1.0)
    # Independent: Runge-Kutta of order 8 with steps that cannot pass over the spike.
    spike = _spike(width)

    def slope(theta, y):
        spring = 2.0 + spike(np.array([theta]))[0]
        return [y[1], -spring * y[0], y[3], -spring * y[2]]

    exact = scipy.integrate.solve_ivp(
        slope,
        (0.0, 2 * np.pi),
        [1.0, 0.0, 0.0, 1.0],
        method="DOP853",
        rtol=1e-11,
        atol=1e-12,
        max_step=width,
    ).y[:, -1]
    trace = np.sum(found.multipliers).real
    assert abs(trace - (exact[0] + exact[3])) < np.max(found.error) + 1e-9
    assert found.passed, found.checks


def test_what_does_not_converge_fails_its_check():
    # A jump at no angle that halving meets.
    system = _single(spring=lambda theta: np.sign(np.sin(theta - 0.3) + 0.4))
    found = floquet_multipliers(system, 1.0)
    assert not found.checks["converged"].passed
    assert not found.passed
    assert floquet_multipliers(system, 1.0, rtol=1e-2).passed


def test_an_error_that_says_nothing_is_not_called_stable():
    found = floquet_multipliers(_single(), 1.0)
    assert found.stable
    for error in (0.5, 800.0, np.inf):
        assert not replace(found, error=np.full(2, error)).stable
    # Far inside the circle it may.
    inside = replace(found, multipliers=np.array([0.1, 0.1 + 0j]), error=np.full(2, 0.5))
    assert inside.stable


def test_a_term_that_is_not_a_number_is_named():
    def spring(theta):
        return np.where(theta > 3.0, np.nan, 1.0)

    with pytest.raises(BadInput, match=r"term Kg \(None\): found a value that is not finite at"):
        monodromy(_single(spring=spring), 1.0)


def test_provenance_tells_changes_and_versions():
    system = mathieu().with_parameters(mu=0.5)
    found = monodromy(system, 1.0, K2=np.array([0.0, 0.1]))
    assert found.provenance["changed"] == "mu=0.5, K2=2 values from 0.0 to 0.1"
    assert found.provenance["numpy"] == np.__version__
    assert "elastolink" in found.provenance
    assert "changed" not in monodromy(mathieu(), 1.0).provenance


def test_damping_counts_only_where_it_is_not_zero():
    system = mathieu()
    assert not system.is_damped()
    assert system.is_damped(K2=0.1)
    assert system.is_damped(K2=np.array([0.0, 0.1]))
    zero = _single().with_terms(Term("C", None, np.zeros((1, 1))))
    assert not zero.is_damped()
    assert "symplectic" in monodromy(zero, 1.0).checks
    wave = _single().with_terms(Term("C", None, lambda theta: np.sin(theta)[:, None, None]))
    assert wave.is_damped()
    with pytest.raises(BadInput, match="mass"):
        system.is_damped(mass=1.0)
