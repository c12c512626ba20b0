"""Simulation against hand solutions, heyoka and itself; its warnings, checks and refusals."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput, LinearRangeWarning
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.periodic import Trajectory, simulate
from elastolink.runtime.periodic.motion import SCIPY_METHODS
from elastolink.runtime.scenes import load_scene

ALL = ("auto", *SCIPY_METHODS)
NUMBERS = {"stiffness": 50.0, "damping": 0.0, "f": 0.4, "h": 3.0, "p": 7.0, "depth": 0.0}


def _driven(**changes) -> LinearPeriodic:
    """One mass with inertia forcing, a load along the speed, a constant load, a wavy spring."""
    terms = [
        Term("M", None, np.array([[2.0]])),
        Term("K", "stiffness", np.array([[1.0]])),
        Term("Kg", "depth", lambda theta: np.cos(theta)[:, None, None]),
        Term("f", "f", lambda theta: np.cos(theta)[:, None]),
        Term("h", "h", lambda theta: np.sin(2 * theta)[:, None]),
        Term("p", "p", np.array([1.0])),
    ]
    values = {**NUMBERS, **changes}
    if values["damping"]:
        terms.append(Term("C", "damping", np.array([[1.0]])))
    return LinearPeriodic(1, tuple(terms), values, lambda given: dict(given))


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


def test_damped_steady_state_is_reached():
    system = _driven(damping=1.0, h=0.0, p=0.0)
    run = simulate(system, 2.0, 40.0, samples=60)
    response = 0.4 * 4.0 / (50 - 2 * 4.0 + 1j * 2.0)
    expected = np.real(response * np.exp(1j * run.theta[-60:]))
    # exp(-t/4) of the free motion is left, t = 40 pi.
    np.testing.assert_allclose(run.q[-60:, 0], expected, atol=1e-12)


def test_forcing_can_be_left_out():
    run = simulate(_driven(), 2.0, 1.0, initial=(0.1, 0.0), forcing=False)
    np.testing.assert_allclose(run.q[:, 0], 0.1 * np.cos(2.5 * run.theta), atol=1e-14)
    with pytest.raises(BadInput, match="no forcing acts"):
        simulate(_driven(), 2.0, 1.0, forcing=False)


def _turned(w0: tuple[float, float]) -> tuple[LinearPeriodic, object]:
    """Return two springs seen in wavy coordinates, z = R(theta) q, and R with its derivative."""
    squares = np.diag(np.square(w0))

    def transform(theta):
        c, s, o = np.cos(theta), np.sin(theta), np.ones_like(theta)
        rows = np.stack([o + 0.3 * c, 0.2 * s, 0.1 * np.sin(2 * theta), o], axis=-1)
        slopes = np.stack([-0.3 * s, 0.2 * c, 0.2 * np.cos(2 * theta), 0 * o], axis=-1)
        return rows.reshape(-1, 2, 2), slopes.reshape(-1, 2, 2)

    def product(first, second, weight=None):
        def function(theta):
            parts = transform(theta)
            left = np.swapaxes(parts[first], 1, 2)
            return left @ (np.eye(2) if weight is None else weight) @ parts[second]

        return function

    terms = (
        Term("M", None, product(0, 0)),
        Term("A", None, product(0, 1)),
        Term("B", None, product(1, 1)),
        Term("K", None, product(0, 0, squares)),
    )
    return LinearPeriodic(2, terms, {}, lambda values: {}), transform


@pytest.mark.parametrize("method", ["auto", "DOP853"])
def test_periodic_mass_and_coriolis_terms(method):
    system, transform = _turned((3.0, 5.0))
    start = transform(np.zeros(1))
    q0, z0 = np.array([0.2, -0.1]), start[0][0] @ np.array([0.2, -0.1])
    run = simulate(system, 1.7, 3.0, method, initial=(q0, 0.0), samples=90, rtol=1e-11)
    rate = 1.7 * (start[1][0] @ q0)  # q' = 0, but R turns
    t = run.time[:, None]
    w0 = np.array([3.0, 5.0])
    z = z0 * np.cos(w0 * t) + rate / w0 * np.sin(w0 * t)
    expected = np.linalg.solve(transform(run.theta)[0], z[:, :, None])[:, :, 0]
    gap = np.max(np.abs(run.q - expected), axis=0) / np.max(np.abs(expected), axis=0)
    assert np.all(gap <= run.error)
    assert np.all(gap < 1e-9)
    assert run.passed, run.checks


def test_against_heyoka():
    hy = pytest.importorskip("heyoka")
    q, v = hy.make_vars("q", "v")
    w = 1.3
    force = 0.4 * w**2 * hy.cos(hy.time) + 3.0 * w * hy.sin(2.0 * hy.time) + 7.0
    spring = 50.0 + 20.0 * hy.cos(hy.time)
    # Per radian: w^2 (2 v') + w 0.6 v + spring q = force.
    system = [(q, v), (v, (force - spring * q - 0.6 * w * v) / (2.0 * w**2))]
    ta = hy.taylor_adaptive(system, [0.1, -0.3 / w], tol=1e-18)
    run = simulate(_driven(damping=0.6, depth=20.0), w, 5.0, initial=(0.1, -0.3))
    _, states = ta.propagate_grid(run.theta)[-2:]
    assert np.max(np.abs(run.q[:, 0] - states[:, 0])) < 1e-11 * np.max(np.abs(states[:, 0]))
    assert np.max(np.abs(run.qd[:, 0] / w - states[:, 1])) < 1e-11 * np.max(np.abs(states[:, 1]))


def test_going_on_from_the_end_equals_one_run():
    whole = simulate(_driven(depth=10.0), 2.0, 2.0, initial=(0.1, 0.0))
    first = simulate(_driven(depth=10.0), 2.0, 0.75, initial=(0.1, 0.0))
    rest = simulate(_driven(depth=10.0), 2.0, 1.25, initial=first.at_end, start=first.theta[-1])
    assert len(first.q) + len(rest.q) == len(whole.q) + 1
    np.testing.assert_allclose(rest.q, whole.q[len(first.q) - 1 :], atol=1e-12)


@pytest.mark.parametrize("period", [np.pi, 4 * np.pi, 2.3])
def test_any_period_of_the_coefficients(period):
    rate = 2 * np.pi / period
    system = LinearPeriodic(
        1,
        (
            Term("M", None, np.eye(1)),
            Term("K", None, lambda theta: (9.0 + np.cos(rate * theta))[:, None, None]),
        ),
        {},
        lambda values: {},
        period=period,
    )
    found = simulate(system, 1.0, 3.0, initial=(1.0, 0.0))
    other = simulate(system, 1.0, 3.0, "DOP853", initial=(1.0, 0.0), rtol=1e-12)
    np.testing.assert_allclose(found.q, other.q, atol=1e-9)


@pytest.mark.parametrize(("samples", "revolutions"), [(360, 3.0), (7, 3.0), (90, 0.37)])
def test_given_angles(samples, revolutions):
    run = simulate(_driven(), 2.0, revolutions, initial=(0.1, 0.0), samples=samples)
    count = int(np.ceil(samples * revolutions))
    even = 2 * np.pi / samples * np.arange(count)
    np.testing.assert_allclose(run.theta[:-1], even, rtol=1e-14)
    assert run.theta[-1] == pytest.approx(2 * np.pi * revolutions, rel=1e-14)
    q, _ = _by_hand(run.theta, 2.0, 0.1, 0.0)
    assert np.max(np.abs(run.q[:, 0] - q)) <= run.error[0] * np.max(np.abs(q))


@pytest.mark.parametrize("start", [0.3, -2.0, 1000.3])
def test_any_start(start):
    """The same angles from another start: the motion of the rest of a longer run."""
    whole = simulate(_driven(depth=10.0), 2.0, 1.0, initial=(0.1, 0.0), start=start)
    rest = simulate(
        _driven(depth=10.0), 2.0, 0.5, initial=(whole.q[180], whole.qd[180]), start=whole.theta[180]
    )
    assert whole.theta[0] == start
    np.testing.assert_allclose(rest.q, whole.q[180:], atol=1e-8)


def test_a_spring_that_jumps_is_met_within_its_error():
    """Stiffness 9 and 25 by turns of half a revolution, at speed 1: sines and cosines by parts."""

    def spring(theta):
        return np.where(np.sin(theta) > 0.0, 9.0, 25.0)[:, None, None]

    terms = (Term("M", None, np.eye(1)), Term("K", None, spring))
    system = LinearPeriodic(1, terms, {}, lambda values: {})
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


# Growth, warnings, checks --------------------------------------------------------------------


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
    return LinearPeriodic(
        2,
        (Term("M", None, np.eye(2)), Term("K", None, np.diag([9.0, 30.0]))),
        {},
        lambda values: {},
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


# The record ----------------------------------------------------------------------------------


def test_record_plots_saves_and_repeats(tmp_path):
    xarray = pytest.importorskip("xarray")
    run = simulate(_beam(0.4), 1.0, 1.0, initial=([0.01, 0.0], 0.0), samples=24)
    again = simulate(_beam(0.4), 1.0, 1.0, initial=([0.01, 0.0], 0.0), samples=24)
    assert isinstance(run, Trajectory)
    assert run.q.tobytes() == again.q.tobytes()
    data = run.to_xarray()
    assert isinstance(data, xarray.Dataset)
    assert data["q"].dims == ("sample", "coordinate")
    assert data["time"].dims == ("sample",)
    ax = run.plot()
    assert len(ax.lines) == 2
    saved = np.load(run.save(tmp_path / "run.npz"))
    np.testing.assert_array_equal(saved["q"], run.q)


def test_a_trajectory_is_pickled_with_its_checks():
    system = load_scene("smith_1972_5152_sixteenth_inch").system()
    run = simulate(system, 34.0, 1.0, samples=24)
    twin = pickle.loads(pickle.dumps(run))
    assert twin.q.tobytes() == run.q.tobytes() and dict(twin.checks) == dict(run.checks)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"method": "rk5"}, "method"),
        ({"speed": 0.0}, "speed"),
        ({"speed": -3.0}, "speed"),
        ({"speed": np.array([1.0, 2.0])}, "speed"),
        ({"speed": "2"}, "speed"),
        ({"revolutions": 0.0}, "revolutions"),
        ({"revolutions": np.nan}, "revolutions"),
        ({"revolutions": "2"}, "revolutions"),
        ({"revolutions": 1e9}, "revolutions"),
        ({"samples": 0}, "samples"),
        ({"samples": 2.5}, "samples"),
        ({"samples": "8"}, "samples"),
        ({"rtol": 2.0}, "rtol"),
        ({"rtol": "1e-3"}, "rtol"),
        ({"initial": 3.0}, "initial"),
        ({"initial": ([1.0, 2.0], 0.0)}, "initial q"),
        ({"initial": (1.0, np.inf)}, "initial qd"),
        ({"initial": ("a", 0.0)}, "initial q"),
        ({"bound": -1.0}, "bound"),
        ({"start": np.inf}, "start"),
        ({"start": "0"}, "start"),
    ],
)
def test_bad_input_is_one_clear_line(changes, word):
    arguments = {"speed": 2.0, "revolutions": 1.0, "initial": (0.1, 0.0), **changes}
    with pytest.raises(BadInput, match=word) as caught:
        simulate(_driven(), **arguments)
    assert "\n" not in str(caught.value)


def test_a_mass_that_is_not_positive_is_refused():
    system = LinearPeriodic(
        1,
        (Term("M", None, lambda theta: np.cos(theta)[:, None, None]), Term("K", None, np.eye(1))),
        {},
        lambda values: {},
    )
    with pytest.raises(BadInput, match="mass matrix M"):
        simulate(system, 1.0, 1.0, initial=(0.1, 0.0))
    with pytest.raises(BadInput, match="no mass term"):
        simulate(
            LinearPeriodic(1, (Term("K", None, np.eye(1)),), {}, lambda values: {}),
            1.0,
            1.0,
            initial=(0.1, 0.0),
        )


def test_provenance_tells_changes_and_versions():
    run = simulate(_driven().with_parameters(stiffness=60.0), 2.0, 1.0)
    assert run.provenance["changed"] == "stiffness=60.0"
    assert run.provenance["numpy"] == np.__version__
