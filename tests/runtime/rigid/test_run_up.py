"""Machines under a motor: against solutions by hand, energies, and runs of more digits."""

import math
import pickle

import elastolink as el
import numpy as np
import pytest
from balancing_machines import crooked_bodies
from elastolink.runtime.rigid.one_freedom import OneFreedom
from refusals import refused
from scipy.special import ellipk

ROCKER = el.FourBar(0.3, 0.1, 0.28, 0.25)
LINKAGES = [ROCKER, el.SliderCrank(0.1, 0.35, 0.04), el.QuickReturn(0.3, 0.1, 0.6)]
TURN = 2.0 * np.pi


def machine_on(linkage, **more):
    return el.Machine(linkage, crooked_bodies(linkage), **more)


def disc(inertia=0.05, **more):
    """Return a machine of which the crank alone has inertia."""
    return el.Machine(ROCKER, {"crank": el.MassDistribution(inertia=inertia)}, **more)


SHAPER = machine_on(LINKAGES[2])


def test_a_disc_approaches_the_no_load_speed_exponentially() -> None:
    motor = el.TorqueLine(stall=4.0, no_load_speed=50.0)
    run = el.run_up(disc(), motor, duration=2.0, tolerance=1e-11)
    # J dw/dt = M0 (1 - w/w0)
    expected = 50.0 * -np.expm1(-run.time * 4.0 / (0.05 * 50.0))
    # Ten steps of 1e-11 each, relative to a speed of 50 rad/s.
    np.testing.assert_allclose(run.speed, expected, atol=1e-8)
    np.testing.assert_allclose(run.torque, 4.0 - 0.08 * expected, atol=1e-9)
    assert run.status == "finished"
    assert run.time[-1] == 2.0
    assert run.passed


def test_a_heavy_crank_swings_with_the_period_of_a_pendulum() -> None:
    crank = el.MassDistribution.about_centre(2.0, 0.08, 0.0, 0.003)
    machine = el.Machine(ROCKER, {"crank": crank}, gravity=(0.0, -9.81))
    start = -math.pi / 2 + 1.2
    omega = math.sqrt(2.0 * 9.81 * 0.08 / crank.inertia)
    period = 4.0 * float(ellipk(math.sin(0.6) ** 2)) / omega
    run = el.run_up(
        machine, 0.0, theta0=start, duration=3 * period, reversals=True, tolerance=1e-11
    )
    assert run.status == "finished"
    angle, speed = run.at(np.array([0.5, 1.0, 2.0, 3.0]) * period)
    np.testing.assert_allclose(angle + math.pi / 2, [-1.2, 1.2, 1.2, 1.2], atol=1e-8)
    np.testing.assert_allclose(speed, 0.0, atol=1e-6)
    # Without leave to turn back it is at rest after half a period.
    short = el.run_up(machine, 0.0, theta0=start, duration=3 * period, tolerance=1e-11)
    assert short.status == "stalled"
    assert short.time[-1] == pytest.approx(period / 2, rel=1e-9)


@pytest.mark.parametrize(
    "linkage",
    [LINKAGES[0], *(pytest.param(item, marks=pytest.mark.slow) for item in LINKAGES[1:])],
    ids=lambda item: type(item).__name__,
)
def test_energy_is_what_motor_loads_and_dampers_gave(linkage) -> None:
    last = linkage.links[2]
    machine = machine_on(
        linkage,
        gravity=(0.0, -9.81),
        loads=(el.Load(last, lambda at: -3.0 * at.velocity, given="motion", along=0.02),),
        springs=(
            el.Spring(("frame", 0.1, 0.6), (last, 0.05, 0.0), 40.0, 0.2, damping=1.0),
            el.TorsionSpring("crank", linkage.links[1], damping=0.02),
        ),
    )
    run = el.run_up(machine, el.TorqueLine(8.0, 60.0), revolutions=0.5, flywheel=0.02)
    assert run.status == "finished"
    assert run.revolutions == pytest.approx(0.5, abs=1e-9)
    assert run.passed
    # The forces along the run ask for the motor's torque, less the flywheel's share.
    needed = run.forces().torque + 0.02 * run.acceleration
    np.testing.assert_allclose(needed, run.torque, atol=1e-10)


def heavy_slider(**more):
    """Return a slider-crank whose reduced inertia varies elevenfold in a turn."""
    masses = {
        "crank": el.MassDistribution.uniform_bar(0.3, 0.1),
        "slider": el.MassDistribution(1.0),
    }
    return el.Machine(el.SliderCrank(0.1, 0.3), masses, **more)


def test_a_machine_left_to_itself_keeps_its_energy() -> None:
    run = el.run_up(heavy_slider(), 0.0, speed0=100.0, duration=1.0, tolerance=1e-3)
    # No power flows: the unknown that stands for the energy does not move at all.
    np.testing.assert_allclose(run.energy, run.energy[0], rtol=1e-12)
    assert run.steps >= 12 * run.revolutions


def test_the_fluctuation_is_that_of_the_last_turn() -> None:
    run = el.run_up(heavy_slider(), 0.0, speed0=100.0, revolutions=1.5)
    # The kinetic energy stays: speeds go with the inverse root of the inertia.
    theta = np.linspace(0.0, TURN, 20001)
    speed = 1.0 / np.sqrt(OneFreedom(heavy_slider()).coefficients(theta)[0])
    expected = 2.0 * np.ptp(speed) / (np.max(speed) + np.min(speed))
    # The 2001 times miss a peak by at most the square of their spacing.
    assert run.fluctuation == pytest.approx(expected, rel=1e-4)
    assert el.run_up(heavy_slider(), 0.0, speed0=100.0, revolutions=0.5).fluctuation is None


def test_a_weak_motor_does_not_start() -> None:
    machine = machine_on(ROCKER, gravity=(0.0, -9.81))
    run = el.run_up(machine, 0.01, revolutions=1)
    assert run.status == "stalled"
    assert "cannot start" in run.message
    assert run.time.tolist() == [0.0]
    still = el.run_up(disc(), 0.0, duration=1.0)
    assert (still.status, still.message) == ("stalled", "at rest in equilibrium")


def test_a_load_may_stall_it_on_the_way() -> None:
    brake = el.Load("crank", couple=lambda t: -3.0 * (t > 1.0))
    run = el.run_up(disc(loads=(brake,)), 1.0, revolutions=2, tolerance=1e-9)
    # 1 N m over 1 rad, then -2 N m: at rest after another half radian.
    assert run.status == "stalled"
    # The jump is met within a step, to its tolerance.
    assert run.angle[-1] == pytest.approx(1.5, abs=1e-5)


@pytest.mark.parametrize("linkage", LINKAGES, ids=lambda item: type(item).__name__)
def test_the_tables_are_the_machine(linkage) -> None:
    """Series where the torque depends on the angle alone; else the machine itself."""
    series = el.Spring(("frame", 0.1, 0.6), (linkage.links[2], 0.05, 0.0), 40.0, 0.2)
    for more in (
        {"springs": (series,)},
        {"springs": (el.TorsionSpring("frame", "crank", 2.0),)},
        {"springs": (el.TorsionSpring("frame", "crank", damping=2.0),)},
        {"loads": (el.Load("crank", couple=lambda t: np.cos(t)),)},
        {"loads": (el.Load(linkage.links[2], force=(3.0, -2.0), couple=0.5),)},
    ):
        system = OneFreedom(machine_on(linkage, gravity=(0.0, -9.81), **more), flywheel=0.01)
        inertia, torques = system.tables()
        for theta in (-3.0, 0.1, 2.5, 40.0):
            # The series are good to 1e-12 of their largest values.
            assert inertia(theta) == pytest.approx(system.coefficients(theta)[0] + 0.01, rel=1e-10)
            required, lost = torques(theta, 3.0)
            assert required == pytest.approx(float(system.load(theta, 3.0)), abs=1e-10)
            power = float(system.machine.power(theta, 3.0))
            assert -3.0 * lost == pytest.approx(power, abs=1e-10)


def test_a_rocking_crank_ends_at_its_fold() -> None:
    linkage = el.FourBar(0.3, 0.25, 0.1, 0.3)
    low, high = linkage.crank_ranges()[-1]
    run = el.run_up(machine_on(linkage), 1.0, theta0=(low + high) / 2, duration=5.0)
    assert run.status == "fold"
    assert run.angle[-1] == pytest.approx(high, abs=2e-6)


def test_it_runs_backwards_and_stops_at_a_step_limit() -> None:
    run = el.run_up(disc(), el.TorqueLine(-2.0, -40.0), revolutions=1)
    assert run.revolutions == pytest.approx(-1.0, abs=1e-9)
    assert run.passed
    run = el.run_up(disc(), 1.0, duration=100.0, max_steps=3)
    assert run.status == "step limit"
    assert not run.passed


def test_torques_of_speed_angle_and_time() -> None:
    laws = (
        lambda w: 2.0,
        lambda w, angle: 2.0 + 0.0 * angle,
        lambda w, angle, time: 2.0 + 0.0 * time,
        lambda *given: 2.0,
        2.0,
    )
    ends = [el.run_up(disc(), law, duration=0.5).angle[-1] for law in laws]
    np.testing.assert_allclose(ends, 2.0 / 0.05 * 0.125, rtol=1e-9)


def test_copies_and_pictures() -> None:
    run = el.run_up(disc(), el.TorqueLine(2.0, 40.0), duration=0.5, samples=11)
    copy = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(copy.at(0.25), run.at(0.25))
    line = run.plot().lines[0]
    np.testing.assert_array_equal(line.get_ydata(), run.speed)
    assert set(run.to_dict()) >= {"time", "angle", "speed", "torque", "status"}


test_refusals = refused(
    lambda given: el.run_up(**{"machine": disc(), "torque": 1.0, "tolerance": 1e-6, **given}),
    [
        ({}, "no end"),
        ({"revolutions": -1.0}, "revolutions"),
        ({"duration": 1.0, "speed0": math.inf}, "speed0"),
        ({"duration": 1.0, "tolerance": 1.0}, "tolerance"),
        ({"duration": 1.0, "flywheel": -1.0}, "flywheel"),
        ({"duration": 1.0, "samples": 1}, "samples"),
        ({"duration": 1.0, "torque": "much"}, "torque"),
        ({"duration": 1.0, "torque": lambda: 1.0}, "torque"),
        ({"duration": 1.0, "max_steps": 0}, "max_steps"),
        ({"duration": 1.0, "torque": lambda w: None}, "None from the torque law"),
        ({"duration": 1.0, "torque": lambda w: math.nan if w > 3 else 5.0}, "nan from the torque"),
        ({"duration": 1.0, "speed0": 1e200}, "crank speed of"),
        ({"duration": 1.0, "torque": -1e15, "machine": SHAPER}, "crank speed of .* smaller torque"),
        ({"duration": 1.0, "torque": 1e306, "machine": SHAPER}, "crank speed of .* smaller torque"),
        ({"revolutions": 1, "machine": None}, "machine"),
    ],
)
test_impossible_motors = refused(
    lambda speed: el.TorqueLine(3.0, speed), [(-20.0, "TorqueLine"), (math.inf, "TorqueLine")]
)


@pytest.mark.parametrize(("theta0", "offset"), [(0.0, 0.0), (0.5, 0.0123)])
def test_a_massless_crank_has_no_inertia_at_its_dead_centres(theta0, offset) -> None:
    machine = el.Machine(el.SliderCrank(0.1, 0.3, offset), {"slider": el.MassDistribution(1.0)})
    with pytest.raises(el.BadInput, match="inertia at every crank angle; give the crank"):
        el.run_up(machine, 1.0, duration=1.0, theta0=theta0)
    # A flywheel is inertia enough, however light against the slider's.
    run = el.run_up(machine, 1.0, revolutions=1, theta0=theta0, flywheel=1e-6)
    assert run.status == "finished"
    assert run.passed
