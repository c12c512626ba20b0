"""Motion of constrained systems: methods, constraints, guards, refusals."""

from __future__ import annotations

from dataclasses import replace

import elastolink as el
import numpy as np
import pytest
from constrained_truth import Circle
from elastolink.generated import four_bar_multibody as multibody
from elastolink.runtime.constrained import Guard, constrained_motion
from elastolink.runtime.constrained.equations import Equations, State
from elastolink.runtime.constrained.motion import _figure, _Made
from elastolink.runtime.constrained.steppers import METHODS
from elastolink.runtime.constrained.steppers.coordinate_partitioning import Partition
from elastolink.runtime.constrained.steppers.dormand_prince import march
from elastolink.runtime.constrained.steppers.protocol import Control, natural_scales
from elastolink.runtime.core.errors import BadInput, LinearRangeWarning, RedundantConstraints
from elastolink.runtime.core.families import Constrained

OWN = ("collocation", "projection", "coordinate_partitioning", "lobatto")
CIRCLE = Circle(oblique=np.array([[1.0, 0.3], [0.0, 0.02]]), pivot=np.array([0.4, -0.2]), row=50.0)
TURNING = Circle(start=7.5)


def needs(method: str) -> None:
    if method == "gear_gupta_leimkuhler":
        pytest.importorskip("sksundae")


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("circle", [CIRCLE, TURNING])
def test_every_method_follows_the_elliptic_functions(method, circle):
    needs(method)
    found = constrained_motion(
        circle.system, *circle.state, 3.0, method=method, samples=24, energy=circle.energy
    )
    q, qd = circle.exact(found.time)
    assert found.success
    found.require()
    actual = np.max(np.abs(found.q - q), axis=0)
    assert np.all(actual <= found.error)
    # The tolerance of a step is 1e-9, and the turning bob squares the number of steps, 60.
    assert np.all(found.error <= 1e-5 * np.max(np.abs(q), axis=0))
    np.testing.assert_allclose(found.qd, qd, atol=1e-5 * np.max(np.abs(qd)))
    angle, turning = np.array([circle.angle(t) for t in found.time]).T
    by_hand = circle.multiplier(angle, turning)
    np.testing.assert_allclose(
        found.multipliers[:, 0], by_hand, atol=1e-6 * np.max(np.abs(by_hand))
    )
    for norm in (found.position_norm, found.velocity_norm, found.acceleration_norm):
        assert norm.shape == found.time.shape
        assert np.max(norm) < 1e-14


@pytest.mark.parametrize("method", OWN)
def test_given_times_lie_on_the_motion(method):
    times = np.array([0.13, 0.5, 0.52, 1.9])
    found = constrained_motion(
        CIRCLE.system, *CIRCLE.state, (0.0, 2.0), method=method, samples=times, rtol=1e-11
    )
    np.testing.assert_array_equal(found.time, [0.0, *times, 2.0])
    q, _ = CIRCLE.exact(found.time)
    np.testing.assert_allclose(found.q, q, atol=1e-8 * np.max(np.abs(q)))


def test_a_motion_goes_on_from_its_end():
    first = constrained_motion(CIRCLE.system, *CIRCLE.state, 1.0, rtol=1e-11)
    second = constrained_motion(CIRCLE.system, *first.at_end, (1.0, 2.0), rtol=1e-11)
    q, _ = CIRCLE.exact(second.time)
    np.testing.assert_allclose(second.q, q, atol=1e-8 * np.max(np.abs(q)))


def test_partition_changes_its_choice_on_the_way():
    """The bob passes every direction, so that neither coordinate can stay independent."""
    start = constrained_motion(TURNING.system, *TURNING.state, 0.1, samples=1)
    equations = Equations(TURNING.system, *TURNING.state, 0.0)
    state = equations.state(0.1, *start.at_end)
    control = Control(1e-9, *natural_scales(state, equations.columns))
    chart = Partition(equations, control)
    for step in march(chart, state, 1.1, control):
        arm = step.before.q
        # The dependent coordinate is determined with a slope of at least a third of the best.
        assert np.max(np.abs(arm)) > 0.3
    assert chart.choices >= 4


LENGTHS = {"frame": 1.0, "crank": 0.3, "coupler": 0.9, "follower": 0.8}
SPEED = 6.0


def driven_four_bar() -> Constrained:
    values = dict.fromkeys(multibody.PARAMETERS, 0.0) | LENGTHS
    for n, length in ((2, 0.3), (3, 0.9), (4, 0.8)):
        values[f"mass{n}"] = length
        values[f"along{n}"] = length**2 / 2
        values[f"inertia{n}"] = length**3 / 3
    drive = {
        "drive": lambda q, t: SPEED * t,
        "drive_d1": lambda q, t: SPEED,
        "drive_d2": lambda q, t: 0.0,
    }
    return Constrained.from_module(multibody, values, external=drive)


@pytest.mark.parametrize("method", METHODS)
def test_a_driven_linkage_moves_as_its_kinematics(method):
    """As many constraints as coordinates: nothing is free, and all is to be met."""
    needs(method)
    linkage = el.FourBar(**LENGTHS)
    at_start = linkage.motion(0.0, SPEED)
    system = driven_four_bar()
    guess = np.zeros(9)
    guess[[5, 8]] = at_start.theta3, at_start.theta4
    start = _consistent(system, guess)
    found = constrained_motion(system, *start, 2 * np.pi / SPEED, method=method, samples=36)
    assert found.success
    exact = linkage.motion(SPEED * found.time, SPEED)

    def turned(value, angle):
        return np.max(np.abs(np.exp(1j * (value - angle)) - 1.0))

    assert turned(found.q[:, 5], exact.theta3) < 1e-12
    assert turned(found.q[:, 8], exact.theta4) < 1e-12
    for place, omega, alpha in (
        (5, exact.omega3, exact.alpha3),
        (8, exact.omega4, exact.alpha4),
    ):
        np.testing.assert_allclose(found.qd[:, place], omega, atol=1e-11)
        np.testing.assert_allclose(found.qdd[:, place], alpha, atol=1e-10)


def _consistent(system, guess):
    from elastolink.runtime.constrained import consistent_state

    found = consistent_state(system, guess, np.zeros(system.size))
    return found.q, found.qd


# Guards ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
def test_a_guard_stops_where_it_is_met(method):
    """The swinging bob is to stay left of x = 0.4: where sin(angle) = 0.4 it stops."""
    needs(method)
    circle = Circle()
    guards = (
        Guard(lambda t, q, qd: 0.9 - q[0], "the bob struck the far wall"),
        Guard(lambda t, q, qd: 0.4 - q[0], "the bob struck the wall"),
    )
    found = constrained_motion(
        circle.system, *circle.state, 5.0, method=method, samples=200, guards=guards, rtol=1e-10
    )
    assert found.status == 1
    assert not found.success
    assert not found.passed
    assert found.message.startswith("the bob struck the wall, at t = ")
    np.testing.assert_allclose(found.q[-1, 0], 0.4, atol=1e-9)
    angle, _ = circle.angle(found.time[-1])
    np.testing.assert_allclose(np.sin(angle), 0.4, atol=1e-7)
    assert np.all(np.diff(found.time) > 0)


def test_a_guard_broken_at_the_start_is_refused():
    guard = Guard(lambda t, q, qd: -1.0, "the slider left the rod's end")
    with pytest.raises(BadInput, match="the slider left the rod's end, at the start"):
        constrained_motion(CIRCLE.system, *CIRCLE.state, 1.0, guards=(guard,))
    unclear = Guard(lambda t, q, qd: np.nan, "nothing")
    with pytest.raises(BadInput, match="guards"):
        constrained_motion(CIRCLE.system, *CIRCLE.state, 1.0, guards=(unclear,))


def test_the_linear_range_is_watched():
    circle = Circle(start=0.1)
    with pytest.warns(LinearRangeWarning, match=r"deflection reaches 0\.3"):
        found = constrained_motion(
            circle.system, *circle.state, 2.0, watch=lambda q, t: 10.0 * q[:, 0]
        )
    # The swing of a small pendulum is start / sqrt(gravity).
    expected = 10 * np.sin(2 * np.arcsin(0.05 / np.sqrt(10.0)))
    np.testing.assert_allclose(found.checks["linear range"].value, expected, rtol=1e-3)
    assert not found.passed
    calm = constrained_motion(circle.system, *circle.state, 2.0, watch=lambda q, t: q[:, 0])
    assert calm.checks["linear range"].passed
    assert calm.passed


def repelled() -> Constrained:
    """A free coordinate that grows like cosh(3 t), beside a held one."""

    def dynamics(q, qd, t):
        batch = np.shape(q)[:-1]
        push = np.stack([9.0 * q[..., 0], np.zeros(batch)], axis=-1)
        return {
            "mass": np.broadcast_to(np.eye(2), (*batch, 2, 2)),
            "rest": np.zeros((*batch, 2, 1)),
            "forces": push[..., None],
            "jacobian": np.broadcast_to([[0.0, 1.0]], (*batch, 1, 2)),
            "velocity_rhs": np.zeros((*batch, 1, 1)),
            "gamma": np.zeros((*batch, 1, 1)),
        }

    def violation(q, t):
        return {
            "constraints": np.asarray(q)[..., 1:, None],
            "jacobian": np.broadcast_to([[0.0, 1.0]], (*np.shape(q)[:-1], 1, 2)),
        }

    return Constrained(2, 1, dynamics, violation)


@pytest.mark.parametrize("method", OWN)
def test_divergence_is_named(method):
    found = constrained_motion(
        repelled(), [1.0, 0.0], [0.0, 0.0], 50.0, method=method, bound=1e6, samples=500
    )
    assert found.status == 1
    assert "diverged" in found.message
    stop = np.arccosh(1e6) / 3.0
    assert stop - 0.1 <= found.time[-1] <= stop + 1.0
    assert not found.checks["end reached"].passed


def test_no_time_is_given_twice_where_the_bound_is_passed_at_one():
    """With fixed steps of a quarter the third passes the bound and ends at a wanted time."""
    found = constrained_motion(
        repelled(), [1.0, 0.0], [0.0, 0.0], 4.0, method="lobatto", step=0.25, bound=3.0, samples=16
    )
    assert found.status == 1
    np.testing.assert_array_equal(found.time, [0.0, 0.25, 0.5, 0.75])


def test_a_second_run_that_stops_first_leaves_no_error_figure():
    made = _Made([_state(0.0), _state(1.0)], [0.0, 1.0], 0, 0, "")
    short = _Made([_state(0.0), _state(0.9)], [0.0, 0.9], 0, 1, "diverged")
    assert np.all(np.isinf(_figure(made, short, 1.0)))
    assert np.all(_figure(made, replace(short, status=0), 1.0) < 1.0)


def _state(t: float) -> State:
    return State(t, np.array([1.0]), np.array([0.0]), np.array([0.0]), np.zeros(0))


def escaping() -> Constrained:
    """A free coordinate that leaves to infinity in finite time, x'' = 2 x^3, x = 1/(1 - t)."""

    def dynamics(q, qd, t):
        return dict(repelled().dynamics(q, qd, t)) | {
            "forces": np.stack([2.0 * q[..., 0] ** 3, 0.0 * q[..., 0]], axis=-1)[..., None]
        }

    return Constrained(2, 1, dynamics, repelled().violation)


@pytest.mark.parametrize("method", ["collocation", "projection", "coordinate_partitioning"])
@pytest.mark.parametrize("bound", [1e3, 1e300])
def test_an_escape_in_finite_time_ends_with_a_reason(method, bound):
    found = constrained_motion(
        escaping(), [1.0, 0.0], [1.0, 0.0], 2.0, method=method, bound=bound, samples=2000
    )
    assert not found.success
    assert "diverge" in found.message
    assert 0.99 < found.time[-1] <= 1.001
    assert np.isfinite(found.q).all()


def test_numbers_out_of_range_raise_nothing():
    with np.errstate(over="ignore", invalid="ignore"):
        found = driven_four_bar().dynamics(np.zeros(9), np.full(9, 1e200), 0.0)
    assert not np.isfinite(found["rest"]).all()
    assert np.isfinite(found["mass"]).all()


def folding() -> Constrained:
    """A slider crank of equal links, which can branch where they lie upon each other."""

    def violation(q, t):
        a, b = np.moveaxis(np.asarray(q), -1, 0)
        return {
            "constraints": (np.sin(a) - np.sin(b))[..., None, None],
            "jacobian": np.stack([np.cos(a), -np.cos(b)], axis=-1)[..., None, :],
        }

    def dynamics(q, qd, t):
        q, qd = np.asarray(q), np.asarray(qd)
        batch = q.shape[:-1]
        rate = (np.sin(q) * qd**2 * [1.0, -1.0]).sum(axis=-1)
        return {
            "mass": np.broadcast_to(np.eye(2), (*batch, 2, 2)),
            "rest": np.zeros((*batch, 2, 1)),
            "forces": np.zeros((*batch, 2, 1)),
            "jacobian": violation(q, t)["jacobian"],
            "velocity_rhs": np.zeros((*batch, 1, 1)),
            "gamma": rate[..., None, None],
        }

    return Constrained(2, 1, dynamics, violation, labels=("a", "b"))


@pytest.mark.parametrize("method", OWN)
def test_lost_rank_stops_the_motion(method):
    """Folded links b = pi - a come to a = b = pi/2, where the Jacobian vanishes."""
    start = [0.3, np.pi - 0.3], [1.0, -1.0]
    found = constrained_motion(folding(), *start, 1.2, method=method, samples=12)
    np.testing.assert_allclose(found.q[-1], [1.5, np.pi - 1.5], atol=1e-9)
    assert found.success
    with pytest.raises(RedundantConstraints):
        constrained_motion(folding(), [np.pi / 2, np.pi / 2], [0.0, 0.0], 1.0, method=method)


# Refusals ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("named", "message"),
    [
        ({"span": -1.0}, "span: found -1.0"),
        ({"span": (0.0, np.inf)}, "span: found"),
        ({"span": "long"}, "span: found 'long'"),
        ({"span": (0.0, 1.0, 2.0)}, "span: found"),
        ({"method": "newmark"}, "method: found 'newmark'"),
        ({"rtol": 0.0}, "rtol: found 0.0"),
        ({"rtol": np.nan}, "rtol: found nan"),
        ({"step": -0.1}, "step: found -0.1"),
        ({"step": 1e-12}, "step: found 1e-12"),
        ({"step": 0.1, "method": "gear_gupta_leimkuhler"}, "chooses its steps"),
        ({"stages": 1, "method": "lobatto"}, "stages: found 1"),
        ({"stages": 5}, "a whole number from 6 to 32 for collocation"),
        ({"samples": 0}, "samples: found 0"),
        ({"samples": 2.5}, "samples: found 2.5"),
        ({"samples": "all"}, "samples: found 'all'"),
        ({"samples": [0.5, 0.2]}, "samples: found times"),
        ({"samples": [0.5, 2.0]}, "samples: found times"),
        ({"bound": 0.5}, "bound: found 0.5"),
        ({"q": [0.0, -1.1]}, "off the constraints"),
        ({"qd": [1.0, 1.0]}, "qd: found a start 1 off"),
        ({"q": [[0.0, -1.0]]}, "one motion at a time"),
        ({"q": [np.nan, -1.0]}, "q: found a number that is not finite"),
    ],
)
def test_bad_input_is_refused_in_one_line(named, message):
    given = {"q": [0.0, -1.0], "qd": [1.0, 0.0], "span": 1.0} | named
    with pytest.raises(BadInput, match=message) as refusal:
        constrained_motion(Circle().system, **given)
    assert "\n" not in str(refusal.value)


def test_the_missing_library_is_named(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "sksundae", None)
    monkeypatch.setitem(sys.modules, "sksundae.ida", None)
    with pytest.raises(BadInput, match=r"elastolink\[dae\]"):
        constrained_motion(CIRCLE.system, *CIRCLE.state, 1.0, method="gear_gupta_leimkuhler")


def test_results_are_drawn_and_saved(tmp_path):
    found = constrained_motion(CIRCLE.system, *CIRCLE.state, 1.0, samples=20)
    axes = found.plot()
    assert [line.get_label() for line in axes.get_lines()] == ["a", "b"]
    found.save(tmp_path / "motion.json")
    with np.load(found.save(tmp_path / "motion.npz")) as saved:
        np.testing.assert_array_equal(saved["multipliers"], found.multipliers)
    table = found.save(tmp_path / "motion.csv").read_text().splitlines()
    assert table[0].startswith("sample,") or "q" in table[0]
