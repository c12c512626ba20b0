"""Simulation against hand solutions, heyoka and itself; its warnings, checks and refusals."""

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import LinearRangeWarning
from elastolink.runtime.core.families import LinearPeriodic
from elastolink.runtime.periodic import Trajectory, simulate
from elastolink.runtime.periodic.motion import SCIPY_METHODS
from periodic_systems import system_of, wave

ALL = ("auto", *SCIPY_METHODS)
NUMBERS = {"stiffness": 50.0, "damping": 0.0, "f": 0.4, "h": 3.0, "p": 7.0, "depth": 0.0}


def _driven(**changes) -> LinearPeriodic:
    """One mass with inertia forcing, a load along the speed, a constant load, a wavy spring."""
    return system_of(
        NUMBERS | changes,
        M=np.array([[2.0]]),
        K=("stiffness", np.eye(1)),
        Kg=("depth", wave(np.eye(1))),
        C=("damping", np.eye(1)),
        f=("f", wave([1.0])),
        h=("h", lambda theta: np.sin(2 * theta)[:, None]),
        p=("p", np.ones(1)),
    )


def _by_hand(theta, speed, q0, qd0):
    """Solution of 2 qdd + 50 q = 0.4 w^2 cos th + 3 w sin 2 th + 7; natural frequency 5."""
    f = 0.4 * speed**2 / (50 - 2 * speed**2)
    h = 3.0 * speed / (50 - 8 * speed**2)
    static = 7.0 / 50
    a = q0 - f - static
    b = (qd0 - 2 * speed * h) / 5.0
    t = theta / speed
    q = a * np.cos(5 * t) + b * np.sin(5 * t) + f * np.cos(theta) + h * np.sin(2 * theta) + static
    qd = -5 * a * np.sin(5 * t) + 5 * b * np.cos(5 * t)
    return q, qd + speed * (2 * h * np.cos(2 * theta) - f * np.sin(theta))


@pytest.mark.parametrize("method", ALL)
def test_every_method_meets_the_hand_solution_within_its_error(method):
    run = simulate(_driven(), 2.0, 2.0, method, initial=(0.1, -0.3), samples=60)
    q, qd = _by_hand(run.theta, 2.0, 0.1, -0.3)
    actual = np.max(np.abs(run.q[:, 0] - q)) / np.max(np.abs(q))
    assert run.success
    assert run.theta[-1] == pytest.approx(4 * np.pi, rel=1e-15)
    assert actual <= run.error[0]
    assert actual < 1e-4
    assert np.max(np.abs(run.qd[:, 0] - qd)) < 1e-3 * np.max(np.abs(qd))
    np.testing.assert_allclose(run.time, run.theta / 2.0, rtol=1e-15)
    assert run.passed, run.checks


@pytest.mark.smoke
def test_a_wanted_error_is_reached_down_to_round_off():
    for rtol in (1e-4, 1e-8, 1e-12):
        run = simulate(_driven(), 2.0, 30.0, initial=(0.1, -0.3), rtol=rtol)
        q, qd = _by_hand(run.theta, 2.0, 0.1, -0.3)
        actual = np.max(np.abs(run.q[:, 0] - q)) / np.max(np.abs(q))
        # The angles' rounding leaves 2e-13 of the hand solution.
        assert actual <= run.error[0] + 2e-13 and run.error[0] <= max(rtol, 2e-12)
    assert actual < 1e-12
    assert np.max(np.abs(run.qd[:, 0] - qd)) < 1e-12 * np.max(np.abs(qd))
    assert set(run.checks) == {"accuracy", "energy balance"} and run.passed


@pytest.mark.parametrize(
    ("revolutions", "samples"),
    [
        *((part, 64) for part in (0.3, 0.9999, 1.0, 1.9877, 2.0 - 1e-5, 3.0001)),
        (3.0, 7),
        (3.0, 360),
    ],
)
def test_the_last_interval_may_be_a_part_of_one(revolutions, samples):
    """In the last interval of a revolution too, where those before it repeat earlier ones."""
    run = simulate(_driven(), 2.0, revolutions, initial=(0.1, -0.3), samples=samples)
    q, qd = _by_hand(run.theta, 2.0, 0.1, -0.3)
    even = 2.0 * np.pi / samples * np.arange(np.ceil(samples * revolutions))
    np.testing.assert_allclose(run.theta, [*even, 2.0 * np.pi * revolutions], rtol=1e-14)
    np.testing.assert_allclose(run.q[:, 0], q, atol=run.error[0] * np.max(np.abs(q)) + 1e-13)
    np.testing.assert_allclose(run.qd[:, 0], qd, atol=1e-8 * np.max(np.abs(qd)))


def test_forcing_can_be_left_out():
    run = simulate(_driven(), 2.0, 1.0, initial=(0.1, 0.0), forcing=False, rtol=1e-13)
    np.testing.assert_allclose(run.q[:, 0], 0.1 * np.cos(2.5 * run.theta), atol=1e-14)


def test_against_heyoka():
    hy = pytest.importorskip("heyoka")
    q, v = hy.make_vars("q", "v")
    w = 1.3
    force = 0.4 * w**2 * hy.cos(hy.time) + 3.0 * w * hy.sin(2.0 * hy.time) + 7.0
    spring = 50.0 + 20.0 * hy.cos(hy.time)
    # Per radian: w^2 (2 v') + w 0.6 v + spring q = force.
    system = [(q, v), (v, (force - spring * q - 0.6 * w * v) / (2.0 * w**2))]
    ta = hy.taylor_adaptive(system, [0.1, -0.3 / w], tol=1e-18)
    run = simulate(_driven(damping=0.6, depth=20.0), w, 5.0, initial=(0.1, -0.3), rtol=1e-12)
    _, states = ta.propagate_grid(run.theta)[-2:]
    for found, exact in ((run.q, states[:, :1]), (run.qd / w, states[:, 1:])):
        assert np.max(np.abs(found - exact)) < 1e-11 * np.max(np.abs(exact))


@pytest.mark.parametrize("start", [0.0, 0.3, -2.0, 1000.3])
def test_going_on_from_the_end_equals_one_run(start):
    system = _driven(depth=10.0)
    whole = simulate(system, 2.0, 2.0, initial=(0.1, 0.0), start=start)
    first = simulate(system, 2.0, 0.75, initial=(0.1, 0.0), start=start)
    rest = simulate(system, 2.0, 1.25, initial=first.at_end, start=first.theta[-1])
    assert whole.theta[0] == start and len(first.q) + len(rest.q) == len(whole.q) + 1
    np.testing.assert_allclose(rest.q, whole.q[len(first.q) - 1 :], atol=1e-12)


@pytest.mark.parametrize("start", [1e6, -1e12, 1e18])
def test_a_large_start_keeps_its_digits(start):
    """The remainder comes from mpmath with 60 digits; SciPy marches from there."""
    with mpmath.workdps(60):
        remainder = float(mpmath.fmod(mpmath.mpf(start), 2 * mpmath.pi))
    system = _driven(depth=10.0)
    found = simulate(system, 2.0, 1.0, initial=(0.1, 0.0), start=start)
    other = simulate(system, 2.0, 1.0, "DOP853", initial=(0.1, 0.0), start=remainder, rtol=1e-12)
    assert found.passed and found.theta[0] == start
    np.testing.assert_allclose(found.q, other.q, atol=1e-10 * np.max(np.abs(other.q)))


@pytest.mark.parametrize("period", [np.pi, 4 * np.pi, 2.3])
def test_any_period_of_the_coefficients(period):
    springs = [9.0 * np.eye(1), wave(np.eye(1), 2 * np.pi / period)]
    system = system_of({}, period, M=np.eye(1), K=springs)
    found = simulate(system, 1.0, 3.0, initial=(1.0, 0.0))
    other = simulate(system, 1.0, 3.0, "DOP853", initial=(1.0, 0.0), rtol=1e-12)
    np.testing.assert_allclose(found.q, other.q, atol=1e-9)


def test_a_spring_that_jumps_is_met_within_its_error():
    """Stiffness 9 and 25 by turns of half a revolution, at speed 1: sines and cosines by parts."""

    def spring(theta):
        return np.where(np.sin(theta) > 0.0, 9.0, 25.0)[:, None, None]

    system = system_of(M=np.eye(1), K=spring)
    run = simulate(system, 1.0, 1.0, initial=(1.0, 0.0), samples=64, rtol=1e-6)
    first, later = run.theta[:33], run.theta[32:] - np.pi
    middle, rate = np.cos(3 * np.pi), -3 * np.sin(3 * np.pi)
    exact = np.cos(3 * first), middle * np.cos(5 * later) + rate / 5 * np.sin(5 * later)
    gap = np.abs(run.q[:, 0] - np.concatenate([exact[0], exact[1][1:]]))
    assert np.max(gap) <= run.error[0] and np.max(gap) < 1e-2


@pytest.mark.parametrize("size", [1e-200, 1e-9, 1e9])
def test_the_size_of_the_force_is_no_matter(size):
    one = simulate(_driven(), 2.0, 2.0, samples=60)
    other = simulate(_driven(f=0.4 * size, h=3.0 * size, p=7.0 * size), 2.0, 2.0, samples=60)
    np.testing.assert_allclose(other.q / size, one.q, rtol=1e-9, atol=1e-12)
    assert np.max(other.error) <= 1e-8


@pytest.mark.parametrize("method", ["auto", "LSODA"])
def test_growth_stops_at_the_bound_and_says_so(method):
    system = _driven(stiffness=-800.0)
    run = simulate(system, 2.0, 200.0, method, initial=(1.0, 0.0), samples=60, bound=1e60)
    assert run.status == 1
    assert not run.success
    assert "passed the bound 1e+60 after" in run.message
    assert np.all(np.isfinite(run.q))
    # cosh(20 t) reaches 1e60 at t = 6.94, 2.21 revolutions.
    assert 2.1 < run.theta[-1] / (2 * np.pi) < 2.3


def test_growth_beyond_every_number_does_not_overflow():
    run = simulate(_driven(stiffness=-8e5), 2.0, 50.0, initial=(1.0, 0.0), samples=60)
    assert run.status == 1
    assert np.all(np.isfinite(run.q))
    assert np.max(np.abs(run.q)) >= 1e150


def _beam(length: float) -> LinearPeriodic:
    return replace(
        system_of(M=np.eye(2), K=np.diag([9.0, 30.0])),
        reference_length=length,
        shape=lambda x: np.stack([np.sin(np.pi * x), np.sin(2 * np.pi * x)], axis=-1),
    )


def test_leaving_the_linear_range_is_told():
    run = simulate(_beam(0.4), 1.0, 1.0, initial=([0.03, 0.0], 0.0))
    assert run.checks["linear range"].value == pytest.approx(0.03, rel=1e-12)
    assert run.passed
    with pytest.warns(LinearRangeWarning, match=r"0\.06"):
        run = simulate(_beam(0.4), 1.0, 1.0, initial=([0.06, 0.0], 0.0))
    assert not run.checks["linear range"].passed
    assert not run.passed


def test_progress_is_shown_only_when_wanted(capsys):
    quiet = simulate(_driven(), 2.0, 3.0, initial=(0.1, 0.0), samples=36)
    assert capsys.readouterr() == ("", "")
    for method in ("auto", "DOP853"):
        shown = simulate(_driven(), 2.0, 3.0, method, initial=(0.1, 0.0), samples=36, progress=True)
        assert "108/108" in capsys.readouterr().err
        assert shown.q.shape == quiet.q.shape


def test_record_plots_and_saves(tmp_path):
    xarray = pytest.importorskip("xarray")
    run = simulate(_beam(0.4), 1.0, 1.0, initial=([0.01, 0.0], 0.0), samples=24)
    assert isinstance(run, Trajectory)
    data = run.to_xarray()
    assert isinstance(data, xarray.Dataset)
    assert data["q"].dims == ("sample", "coordinate")
    assert data["time"].dims == ("sample",)
    ax = run.plot()
    assert len(ax.lines) == 2
    saved = np.load(run.save(tmp_path / "run.npz"))
    np.testing.assert_array_equal(saved["q"], run.q)
