"""Simulation by power series: against other methods and series of more digits, and its fallback."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from elastolink.runtime.benchmarking.work_precision import reference
from elastolink.runtime.benchmarking.work_precision.equation import Equation
from elastolink.runtime.core.errors import BadInput, LinearRangeWarning
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.floquet.first_order import canonical_form
from elastolink.runtime.simulation import simulate
from elastolink.runtime.simulation.generator_series import expansion, generator_series


def _waving(*terms, period=2 * np.pi, stiffness=(9.0, 47.0), force=1.0) -> LinearPeriodic:
    """Two coordinates with every kind of term."""
    rate = 2 * np.pi / period

    def full(theta, size):
        cos, sin = np.cos(rate * theta), np.sin(2 * rate * theta)
        rows = np.stack([1.0 + 0.3 * cos, 0.2 * sin, 0.2 * sin, 1.2 - 0.1 * cos], axis=-1)
        return size * rows.reshape(-1, 2, 2)

    def push(theta):
        return force * np.stack([np.cos(rate * theta), np.sin(rate * theta)], axis=-1)

    return LinearPeriodic(
        2,
        (
            Term("M", None, lambda theta: full(theta, 1.0)),
            Term("A", None, lambda theta: full(theta, 0.1) @ np.array([[0.0, 1.0], [-1.0, 0.3]])),
            Term("B", None, lambda theta: full(theta, 0.2)),
            Term("C", None, 0.05 * np.eye(2)),
            Term("K", None, np.diag(stiffness)),
            Term("Kg", None, lambda theta: full(theta, 0.5), power=2),
            Term("f", None, push),
            *terms,
        ),
        {},
        lambda values: {},
        period=period,
    )


def _jump(theta):
    return np.sign(np.sin(theta - 0.3))[:, None, None] * np.eye(2)


@pytest.mark.parametrize("samples", [1, 7, 60, 359, 1440])
@pytest.mark.parametrize("revolutions", [0.3, 2.6])
def test_any_number_of_angles(samples, revolutions):
    system = _waving()
    start = ([0.3, -0.2], [1.0, 0.4])
    run = simulate(system, 1.3, revolutions, initial=start, samples=samples)
    other = simulate(
        system, 1.3, revolutions, "gauss_legendre16", initial=start, samples=samples,
        steps=samples * max(1, 720 // samples),
    )  # fmt: skip
    assert run.method == "power_series"
    np.testing.assert_array_equal(run.theta, other.theta)
    np.testing.assert_allclose(run.q, other.q, atol=1e-13 * np.max(np.abs(other.q)))
    np.testing.assert_allclose(run.qd, other.qd, atol=2e-13 * np.max(np.abs(other.qd)))
    assert run.passed, run.checks


@pytest.mark.parametrize("speed", [0.05, 1.3])
def test_against_a_series_of_more_digits(speed):
    system = _waving()
    equation = Equation.of(system, speed, forced=True, cut=1e-15)
    q0, qd0 = np.array([0.3, -0.2]), np.array([1.0, 0.4])
    exact = reference.motion(equation, equation.start(q0, qd0 / speed), 3, 8).astype(float)
    q = equation.coordinates(exact)
    run = simulate(system, speed, 3, initial=(q0, qd0), samples=8)
    gap = np.max(np.abs(run.q - q), axis=0) / np.max(np.abs(q), axis=0)
    assert np.all(gap <= run.error)
    assert np.max(run.error) < 1e-11


@pytest.mark.parametrize("force", [1e-12, 1e9])
def test_a_small_force_keeps_its_digits(force):
    one, other = (simulate(_waving(force=f), 1.3, 2.0, samples=30) for f in (1.0, force))
    np.testing.assert_allclose(other.q / force, one.q, atol=1e-13 * np.max(np.abs(one.q)))
    assert np.max(other.error) < 1e-12


@pytest.mark.parametrize("period", [np.pi, 4 * np.pi, 2.3])
@pytest.mark.parametrize("start", [0.0, 5.1])
def test_any_period_and_start(period, start):
    system = _waving(period=period)
    run, other = (
        simulate(system, 1.3, 2.5, method, initial=(0.3, 0.0), start=start, samples=24)
        for method in ("auto", "gauss_legendre")
    )
    assert run.method == "power_series"
    np.testing.assert_allclose(run.q, other.q, atol=1e-12 * np.max(np.abs(other.q)))


def test_jumps_go_to_collocation():
    system = _waving(Term("Kg", None, _jump))
    run = simulate(system, 1.3, 1.0, samples=60)
    assert run.method == "gauss_legendre"
    assert "collocation of order 16" in run.error_norm
    with pytest.raises(BadInput, match="not smooth") as caught:
        simulate(system, 1.3, 1.0, "power_series")
    assert "\n" not in str(caught.value)


def test_it_takes_no_steps():
    with pytest.raises(BadInput, match="steps"):
        simulate(_waving(), 1.3, 1.0, "power_series", steps=90)


def test_a_tolerance_beyond_round_off_is_refused():
    with pytest.raises(BadInput, match="raise rtol"):
        simulate(_waving(), 0.02, 9.0, rtol=1e-14, samples=12)


def test_growth_beyond_a_revolution_stops_at_the_bound():
    system = _waving(stiffness=(-400.0, 47.0))
    run, other = (
        simulate(system, 1.3, 40.0, m, initial=(1.0, 0.0), samples=90, bound=1e90)
        for m in ("auto", "gauss_legendre")
    )
    assert run.status == other.status == 1
    assert run.message == other.message
    assert np.all(np.isfinite(run.q))
    assert np.max(np.abs(run.q)) > 1e90
    np.testing.assert_allclose(run.q, other.q, rtol=1e-9)


def test_the_series_of_a_generator_and_its_expansion():
    form = canonical_form(_waving(), 1.3, forcing=True)
    series = generator_series(form)
    theta = np.array([0.1, 2.0, 5.5, 1000.3])
    direct = form.generator(theta)[0]
    size = np.max(np.abs(direct))
    np.testing.assert_allclose(series(theta), direct, atol=1e-13 * size)
    half = 0.2
    powers = series.powers(half)
    parts = expansion(series, half, powers).about(theta).reshape(4, 5, powers, 5)
    for tau in (-1.0, 0.3, 1.0):
        found = np.einsum("kipj,p->kij", parts, tau ** np.arange(powers)) / half
        expected = form.generator(theta + tau * half)[0]
        np.testing.assert_allclose(found, expected, atol=1e-13 * size)
    assert series.powers(100.0) is None


def test_checks_are_made_for_a_pickle():
    run = simulate(_waving(), 1.3, 1.0, samples=60)
    again = pickle.loads(pickle.dumps(run))
    assert dict(again.checks) == dict(run.checks)
    assert again.q.tobytes() == run.q.tobytes()


def test_a_moving_shape_warns_beyond_the_linear_range():
    def shape(x, theta):
        return np.cos(theta)[:, None, None] * np.sin(np.pi * x)[:, None]

    def beam(amplitude):
        system = LinearPeriodic(
            1,
            (Term("M", None, np.eye(1)), Term("K", None, 4.0 * np.eye(1))),
            {},
            lambda values: {},
            moving_shape=shape,
        )
        return simulate(system, 1.0, 1.0, initial=(amplitude, 0.0))

    calm = beam(0.01)
    # The places nearest to the middle are 12/25 and 13/25 of the length.
    expected = 0.01 * np.sin(0.48 * np.pi)
    assert calm.checks["linear range"].value == pytest.approx(expected, rel=1e-12)
    with pytest.warns(LinearRangeWarning):
        assert not beam(0.06).passed
