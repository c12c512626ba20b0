"""The inextensible coupler: another derivation, its linear limit, energy, exact derivatives."""

from itertools import pairwise

import elastolink as el
import numpy as np
import pytest
from bent_rigs import BENT, REFERENCE, Shape, rig, slider_crank
from constrained_coupler import with_constraints
from elastolink.generated import four_bar_kinematics, slider_crank_kinematics
from elastolink.runtime.core.errors import BadInput, SelfCheckFailed
from elastolink.runtime.core.families import LinearPeriodic
from elastolink.runtime.core.families.nonlinear import Drive
from elastolink.runtime.systems import inextensible
from elastolink.runtime.systems.inextensible import InextensibleCoupler, coupler_stations
from straight_rod import projected

RIGS = ("smith_1972_5152_sixteenth_inch", "smith_1972_101104_thirtysecond_inch")
EPS = np.finfo(float).eps


def accelerations(system, q, qd, drive):
    left = system.equations(q, qd, np.zeros_like(q), drive, system.parameters)
    return -np.linalg.solve(left.mass, left.residual[..., None])[..., 0]


@pytest.fixture
def many_stations(monkeypatch):
    """Return a function from modes to rig A58 with as many stations as leave no error."""
    monkeypatch.setattr(inextensible, "_PER_MODE", 10)
    coupler_stations.cache_clear()
    yield rig.__wrapped__
    coupler_stations.cache_clear()


def test_accelerations_are_those_of_another_lagrangian(many_stations):
    """In minimal coordinates and 40 digits, amplitudes of the tangent's angle to 0.4."""
    for state in REFERENCE["states"]:
        q, qd = np.array(state["q"]), np.array(state["rates"])
        system = many_stations("A58", len(q))
        expected = np.array(state["accelerations"])
        found = accelerations(system, q, qd, Drive(*state["theta"]))
        assert found == pytest.approx(expected, rel=0, abs=1e-13 * np.max(np.abs(expected)))


def test_forces_and_followers_are_those_of_another_lagrangian(many_stations):
    for state in REFERENCE["states"]:
        q, qd = np.array(state["q"]), np.array(state["rates"])
        system, drive = many_stations("A58", len(q)), Drive(*state["theta"])
        shape, constrained = placed(system, q, qd, np.array(state["accelerations"]), drive)
        assert shape.driven == pytest.approx(np.array(state["follower"]), rel=1e-11)
        x = with_constraints(system).whole(q, drive, system.parameters)
        xd = np.concatenate([[shape.driven[1], shape.turn[1]], qd])
        time = drive.angle / drive.speed
        xdd, force = constrained.accelerations(x, xd, time)
        assert xdd[0] == pytest.approx(state["follower"][2], rel=1e-10)
        assert force == pytest.approx(np.array(state["force"]), rel=1e-10)


def placed(system, q, qd, qdd, drive):
    """Return the coupler's place and motion by quadrature, and the constrained system."""
    made = with_constraints(system)
    whole = made.whole(q, drive, system.parameters)
    shape = Shape.of(system.parameters, whole, q, qd, qdd, *map(np.asarray, drive))
    return shape, made.make(system.parameters, drive)


@pytest.mark.parametrize("modes", [1, 3, 5])
def test_stations_are_as_many_as_large_motions_need(modes):
    """What is left of the equations is right to 5e-12 with amplitudes up to 0.7 / k^1.5."""
    random, k = np.random.default_rng(9), np.arange(1, modes + 1)
    state = random.uniform(-0.7, 0.7, (3, 50, modes)) / k**1.5
    state *= np.array([1.0, 60.0, 3600.0])[:, None, None]
    drive = Drive(random.uniform(-7.0, 7.0, 50), np.full(50, 60.0), np.zeros(50))
    system = rig.__wrapped__("B58", modes)
    found = system.equations(*state, drive, system.parameters, False).residual
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(inextensible, "_PER_MODE", 12)
        coupler_stations.cache_clear()
        more = rig.__wrapped__("B58", modes)
        exact = more.equations(*state, drive, more.parameters, False).residual
    coupler_stations.cache_clear()
    assert np.max(np.abs(found - exact)) <= 5e-12 * np.max(np.abs(exact))


@pytest.mark.parametrize("modes", range(1, 6))
def test_about_no_deflection_it_is_the_complete_equation(modes):
    """All powers of speed and acceleration, entry by entry: slopes q_k are k pi Y_k / l3."""
    for name in RIGS:
        scene = {"model.modes": modes, "coupler.damping_ratio": 0.02}
        linear = el.load_scene(name, scene).system()
        system = el.load_scene(name, {**scene, **BENT}).system()
        theta = np.random.default_rng(modes).uniform(-7.0, 7.0, 12)
        for speed, acceleration in ((30.0, 0.0), (60.0, 0.0), (30.0, 500.0), (-40.0, -900.0)):
            assert_linear(system, linear, theta, speed, acceleration)


def assert_linear(system, linear: LinearPeriodic, theta, speed, acceleration) -> None:
    still = np.zeros((len(theta), system.size))
    given = np.full(len(theta), speed), np.full(len(theta), acceleration)
    found = system.equations(still, still, still, Drive(theta, *given), system.parameters)
    numbers = system.parameters
    modal_mass = numbers["mass_per_length"] * numbers["coupler"] ** 3 / 2
    rise = np.pi * np.arange(1, system.size + 1)

    def by_deflection(matrix):
        return rise[:, None] * matrix * rise / modal_mass

    assert not any(linear.has(name) for name in ("A", "D", "h", "p")) and linear.is_constant("M")
    mass, stiffness = linear.array("M", theta), linear.array("K", theta)
    assert by_deflection(found.mass) == pytest.approx(mass, rel=0, abs=1e-14)
    damping = linear.array("C", theta)
    assert by_deflection(found.damping) == pytest.approx(damping, abs=4e-14 * np.max(damping))
    bending = np.max(stiffness)
    for power, name in ((speed**2, "B"), (acceleration, "S")):
        stiffness = stiffness - power * linear.array(name, theta)
    assert by_deflection(found.stiffness) == pytest.approx(stiffness, rel=0, abs=4e-15 * bending)
    force = speed**2 * linear.array("f", theta) + acceleration * linear.array("g", theta)
    assert np.max(np.abs(force)) > 1.0
    # Bending rounds with the coupler's angle to the frame.
    allowed = 16 * EPS * bending
    assert -rise * found.residual / modal_mass == pytest.approx(force, rel=0, abs=allowed)


@pytest.mark.parametrize(("modes", "slider"), [(1, 0.01), (3, 0.2), (6, 3.0)])
def test_a_straight_rod_is_that_of_the_hand_derivation(modes, slider):
    system = slider_crank(modes).with_parameters(slider_mass=slider)
    numbers = system.parameters
    theta = np.random.default_rng(6).uniform(-7.0, 7.0, 20)
    still = np.zeros((len(theta), modes))
    speed = 70.0
    found = system.equations(
        still, still, still, Drive(theta, np.full(len(theta), speed), 0.0 * theta), numbers
    )
    hand = [projected(angle, modes, slider) for angle in theta]
    softening, load = np.array([h for h, _ in hand]), np.array([f for _, f in hand])
    modal_mass = numbers["mass_per_length"] * numbers["coupler"] ** 3 / 2
    rise = np.pi * np.arange(1, modes + 1)
    wave = np.arange(1, modes + 1) * np.pi / numbers["coupler"]
    frequencies = numbers["bending_stiffness"] * wave**4 / numbers["mass_per_length"]
    stiffness = rise[:, None] * found.stiffness * rise / modal_mass - np.diag(frequencies)
    size = np.max(frequencies)
    assert stiffness / speed**2 == pytest.approx(softening, rel=0, abs=1e-14 * size)
    force = -rise * found.residual / modal_mass / speed**2
    assert force == pytest.approx(load, rel=0, abs=16 * EPS * size)


def assert_balanced(system, q, qd, qdd, drive) -> None:
    """Assert that the crank's power is the rate of energy and what damping and gravity take.

    By forces: on the crank pin what accelerates the coupler less what pulls at its end.
    """
    numbers = system.parameters
    shape, constrained = placed(system, q, qd, qdd, drive)
    density = numbers["mass_per_length"]
    gravity = numbers["gravity_x"] + 1j * numbers["gravity_y"]
    x = with_constraints(system).whole(q, drive, numbers)
    xd, xdd = (
        np.concatenate([[d, t], r])
        for d, t, r in zip(shape.driven[1:], shape.turn[1:], (qd, qdd), strict=True)
    )
    time = float(drive.angle) / float(drive.speed)
    found = constrained.dynamics(x, xd, time)
    left = (found["mass"] @ xdd)[:, None] + found["rest"] - found["forces"]
    force = np.linalg.solve(found["jacobian"][:, :2].T, left[:2, 0]) @ np.array([1.0, 1j])
    # What is left of the equations in the other coordinates: the force does all.
    assert found["jacobian"].T @ [force.real, force.imag] == pytest.approx(left[:, 0], rel=1e-9)
    _, speeds, bends = shape.places
    inertia = density * shape.integral(bends - gravity)
    power = (np.conj(inertia - force) * shape.pin[1]).real
    kinetic = density * shape.integral((np.conj(bends) * speeds).real)
    weight = -density * shape.integral((np.conj(gravity) * speeds).real)
    angle, rate, bend = shape.driven
    if "slider_mass" in numbers:
        kinetic += numbers["slider_mass"] * bend * rate
        weight -= numbers["slider_mass"] * numbers["gravity_x"] * rate
    else:
        kinetic += numbers["follower_inertia"] * bend * rate
        along = np.conj(gravity) * 1j * np.exp(1j * angle) * rate
        weight -= numbers["follower_first_moment"] * along.real
    length, wave = numbers["coupler"], np.pi * np.arange(1, len(q) + 1)
    bow = np.zeros(len(q))
    bow[0] = np.pi * numbers["bow"] / length
    strain = numbers["bending_stiffness"] / length / 2 * np.sum(wave**2 * (q - bow) * qd)
    drag = numbers["damping"] * length**3 / 2 * np.sum((qd / wave) ** 2)
    terms = np.array([power, -kinetic, -weight, -strain, -drag])
    assert abs(np.sum(terms)) <= 1e-12 * np.sum(np.abs(terms))


@pytest.mark.parametrize("modes", [1, 3])
def test_the_power_of_the_crank_balances(modes):
    more = {"bow": 2e-3, "gravity_x": 3.0, "gravity_y": -9.0}
    follower = {"follower_first_moment": 0.01}
    four_bar = rig("B58", modes).with_parameters(**more, **follower)
    random = np.random.default_rng(modes)
    for system in (four_bar, slider_crank(modes).with_parameters(**more)):
        for _ in range(4):
            q, qd = random.uniform(-0.5, 0.5, (2, modes)) / np.arange(1, modes + 1) ** 1.5
            drive = Drive(random.uniform(-7, 7), 60.0, random.choice([0.0, 900.0]))
            qd = 40.0 * qd
            assert_balanced(system, q, qd, accelerations(system, q, qd, drive), drive)


@pytest.mark.parametrize("assembly", [1.0, -1.0])
def test_ends_of_a_straight_coupler_are_those_of_the_rigid_linkage(assembly):
    """Crank-rocker, drag link and slider-crank, both closures, against the emitted kinematics."""
    made = InextensibleCoupler(1, assembly)
    angle, chord = np.linspace(0.1, 6.2, 40), np.ones(40, dtype=complex)
    for lengths in ((10.0, 1.0, 10.0, 4.0), (1.0, 4.0, 3.0, 3.5)):
        names = ("frame", "crank", "coupler", "follower")
        driven, mean = made.ends(chord, Drive(angle, 1.0), dict(zip(names, lengths, strict=True)))
        winding = float(lengths[1] > lengths[0])
        theta3, theta4, *_ = four_bar_kinematics.motion(angle, *lengths, assembly, winding)
        assert np.exp(1j * driven) == pytest.approx(np.exp(1j * theta4), abs=1e-13)
        assert np.exp(1j * mean) == pytest.approx(np.exp(1j * theta3), abs=1e-13)
    numbers = {"crank": 1.0, "coupler": 4.0, "offset": 0.5, "slider_mass": 1.0}
    driven, mean = made.ends(chord, Drive(angle, 1.0), numbers)
    turned, place, *_ = slider_crank_kinematics.motion(angle, 1.0, 4.0, 0.5, assembly)
    assert driven == pytest.approx(place, abs=1e-13)
    assert np.exp(1j * mean) == pytest.approx(np.exp(1j * turned), abs=1e-13)


@pytest.mark.parametrize("modes", [1, 2, 4])
def test_they_are_those_of_the_constrained_form(modes):
    """All matrices of the module's coordinates, projected: any number of states, and one."""
    more = {"bow": 2e-3, "gravity_x": 3.0, "gravity_y": -9.0}
    random = np.random.default_rng(modes)
    for system in (rig("B58", modes), slider_crank(modes)):
        system = system.with_parameters(**more)
        sizes = np.array([0.2, 8.0, 400.0])[:, None, None, None]
        state = sizes * random.normal(size=(3, 4, 5, modes))
        drive = Drive(*(s * random.normal(size=(4, 5)) for s in (9.0, 60.0, 900.0)))
        found = system.equations(*state, drive, system.parameters)
        expected = with_constraints(system)(*state, drive, system.parameters)
        one = system.equations(*state[:, 1, 2], Drive(*(d[1, 2] for d in drive)), system.parameters)
        for each, alone, wanted in zip(found, one, expected, strict=True):
            assert each.shape == wanted.shape
            size = np.max(np.abs(wanted))
            assert each == pytest.approx(wanted, rel=0, abs=1e-13 * size)
            assert alone == pytest.approx(wanted[1, 2], rel=0, abs=1e-13 * size)


def test_derivatives_are_exact():
    """Residuals are linear in accelerations, quadratic in rates: differences of these round."""
    more = {"bow": 2e-3, "gravity_x": 3.0, "gravity_y": -9.0}
    random = np.random.default_rng(3)
    for system in (rig("A58", 2).with_parameters(**more), slider_crank(3).with_parameters(**more)):
        n = system.size
        state = 0.2 * random.normal(size=(3, n)) * np.array([1.0, 60.0, 3600.0])[:, None]
        drive = Drive(2.2, 50.0, 300.0)

        def residual(change, state=state, drive=drive, system=system):
            moved = state + change
            return system.equations(*moved, drive, system.parameters, False).residual

        found = system.equations(*state, drive, system.parameters)
        for place, (matrix, step) in enumerate(
            ((found.stiffness, 2.0**-6), (found.damping, 8.0), (found.mass, 4096.0))
        ):
            for j in range(n):
                unit = np.zeros((3, n))
                unit[place, j] = step

                def slope(share, unit=unit, step=step):
                    return (residual(share * unit) - residual(-share * unit)) / (2 * share * step)

                # Of the stiffness five differences, without h^2 to h^8.
                expected = slope(1.0)
                if place == 0:
                    rows = [slope(0.5**k) for k in range(5)]
                    for order in range(1, 5):
                        weight = 4.0**order
                        rows = [(weight * b - a) / (weight - 1) for a, b in pairwise(rows)]
                    (expected,) = rows
                size = np.max(np.abs(matrix))
                assert matrix[:, j] == pytest.approx(expected, rel=0, abs=2e-11 * size), place


def test_a_loop_that_cannot_close_is_told():
    system = rig("A58", 1)
    bent = np.array([3.0])  # its ends nearly meet
    with np.errstate(all="ignore"), pytest.raises(SelfCheckFailed, match="cannot be closed"):
        system.equations(bent, bent, bent, Drive(0.0, 1.0), system.parameters)


def test_gravity_asks_for_the_followers_first_moment():
    changes = {**BENT, "gravity.direction": "270 deg"}
    with pytest.raises(BadInput, match=r"follower\.first_moment"):
        el.load_scene(RIGS[0], changes).system()
