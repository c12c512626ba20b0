"""Forces of rigid machines: against nine equations, momenta, energies, and symmetries."""

import itertools
import json
import pickle
from dataclasses import replace

import elastolink as el
import numpy as np
import pytest
from balancing_machines import crooked_bodies, nine_equations, smith
from elastolink.runtime.rigid.force_errors import checks
from matplotlib.text import Text
from refusals import refused

TURN = 2.0 * np.pi
THETA = np.linspace(0.0, TURN, 256, endpoint=False)
LINKAGES = {
    "crank rocker": el.FourBar(0.3, 0.1, 0.28, 0.25),
    "crossed": el.FourBar(0.3, 0.1, 0.28, 0.25, "crossed"),
    "drag link": el.FourBar(0.1, 0.3, 0.25, 0.28),
    "slider-crank": el.SliderCrank(0.1, 0.35, 0.04),
    "slider-crank, crossed": el.SliderCrank(0.1, 0.35, -0.04, "crossed"),
    "quick-return": el.QuickReturn(0.3, 0.1, 0.6),
    "quick-return, turning rod": el.QuickReturn(0.1, 0.3, 0.6),
}
EVERY = pytest.mark.parametrize("linkage", LINKAGES.values(), ids=LINKAGES)


def loaded(linkage):
    _, second, third = linkage.links
    return el.Machine(
        linkage,
        crooked_bodies(linkage),
        gravity=(0.5, -9.81),
        loads=(
            el.Load(third, (30.0, -20.0), 1.5, 0.1, 0.03, axes="link"),
            el.Load(second, lambda t: (5.0 * np.cos(t), 2.0), 0.3, 0.05),
        ),
        springs=(
            el.Spring(("frame", 0.1, 0.5), (second, 0.05, 0.02), 300.0, 0.1, 5.0, 2.0),
            el.Spring(("crank", 0.05, 0.0), (third, 0.05, 0.14), 300.0, damping=3.0),
            el.TorsionSpring("crank", second, 3.0, 0.1, 0.3),
            el.TorsionSpring("frame", third, damping=0.2, preload=0.4),
        ),
    )


@pytest.mark.parametrize("acceleration", [0.0, 40.0])
def test_the_machine_of_figs_12_to_16_against_nine_equations(acceleration) -> None:
    machine = smith()
    found = el.rigid_forces(machine, THETA, 10.0, acceleration)
    for name, expected in nine_equations(machine, THETA, 10.0, acceleration).items():
        allowed = 1e-12 * np.max(np.abs(expected))
        np.testing.assert_allclose(getattr(found, name), expected, atol=allowed, err_msg=name)
    assert found.passed


@EVERY
def test_springs_do_not_shake_the_frame(linkage) -> None:
    plain = el.Machine(linkage, crooked_bodies(linkage))
    sprung = el.Machine(linkage, plain.masses, springs=loaded(linkage).springs)
    for function in (el.shaking_force, el.shaking_moment):
        one, other = function(plain, THETA, 9.0), function(sprung, THETA, 9.0)
        for name, values in one.values.items():
            np.testing.assert_array_equal(values, other[name])
    found = el.rigid_forces(sprung, THETA, 9.0)
    assert found.passed
    # Through the pins alone more comes: the springs to the frame carry the rest.
    pins = np.stack([found["x41"] - found["x12"], found["y41"] - found["y12"]], axis=-1)
    assert np.max(np.abs(pins - found.shaking_force)) > 1.0


@EVERY
def test_each_output_alone_is_the_same(linkage) -> None:
    machine = loaded(linkage)
    whole = el.rigid_forces(machine, THETA, 9.0, -5.0)
    scale = max(float(np.max(np.abs(values))) for values in whole.values.values())
    names = set()
    for function in (el.pin_forces, el.driving_torque, el.shaking_force, el.shaking_moment):
        part = function(machine, THETA, 9.0, -5.0)
        assert part.passed
        for name, values in part.values.items():
            np.testing.assert_allclose(values, whole[name], atol=1e-12 * scale, err_msg=name)
        names |= set(part.values)
    assert names == set(whole.values)
    two = el.rigid_forces(machine, THETA, 9.0, -5.0, ("shaking_moment", "torque"))
    assert set(two.values) == {"shaking_moment", "torque"}


@EVERY
@pytest.mark.parametrize(("length", "mass"), [(2.0**-90, 8.0), (1e30, 1e-5)])
def test_unit_systems(linkage, length, mass) -> None:
    """Forces scale as mass times length, moments as mass times length squared."""
    other = replace(linkage, **{name: size * length for name, size in linkage.lengths.items()})
    units = mass * length ** np.array([0, 1, 1, 2])
    scaled = {
        link: el.MassDistribution(*(units * [own.mass, own.along, own.across, own.inertia]))
        for link, own in crooked_bodies(linkage).items()
    }
    one = el.rigid_forces(el.Machine(linkage, crooked_bodies(linkage)), THETA, 4.0, 3.0)
    two = el.rigid_forces(el.Machine(other, scaled), THETA, 4.0, 3.0)
    for name, values in one.values.items():
        moment = name in ("torque", "shaking_moment") or name.startswith("couple")
        unit = mass * length ** (2 if moment else 1)
        size = max(np.max(np.abs(values)), 1e-3)
        np.testing.assert_allclose(two[name] / unit, values, atol=1e-12 * size, err_msg=name)
    assert two.passed


@pytest.mark.parametrize("count", [7, 10_001])
def test_broadcasting_of_speeds_and_accelerations(count) -> None:
    """Of long arrays too, which are computed in parts."""
    machine = loaded(LINKAGES["crank rocker"])
    theta, speed = np.linspace(0.0, 6.0, count), np.array([[3.0], [-5.0]])
    acceleration = np.array([0.0, 4.0])[:, np.newaxis, np.newaxis]
    whole = el.rigid_forces(machine, theta, speed, acceleration)
    assert whole.f23.shape == (2, 2, count, 2)
    assert whole.torque.shape == np.shape(whole.error) == (2, 2, count)
    for i, j, k in itertools.product((0, 1), (0, 1), range(0, count, count // 7)):
        place = i, j, k
        single = el.rigid_forces(machine, theta[k], speed[j, 0], acceleration[i, 0, 0])
        assert single.f23.shape == (2,)
        np.testing.assert_allclose(whole.torque[place], single.torque, rtol=1e-12)
        np.testing.assert_allclose(whole.f41[place], single.f41, rtol=1e-12, atol=1e-11)
    assert whole.passed


# It reaches crank angles of 0.72 to 1.62 rad either way.
ROCKING = el.FourBar(0.3, 0.25, 0.1, 0.3)
STANDARD = {"machine": el.Machine(ROCKING, crooked_bodies(ROCKING)), "theta": 1.0, "speed": 1.0}
test_refusals_name_what_is_wrong = refused(
    lambda given: el.rigid_forces(**STANDARD | given),
    [
        ({"theta": [0.0, 3.0]}, "0.72"),
        ({"acceleration": np.nan}, "acceleration"),
        ({"speed": np.ones(3), "theta": np.ones(2)}, "broadcast"),
        ({"outputs": ("pin",)}, "outputs"),
        ({"outputs": ()}, "outputs"),
        ({"speed": 1e200}, "float"),
        ({"machine": ROCKING}, "machine"),
    ],
)


def test_what_was_not_asked_for_is_refused() -> None:
    found = el.driving_torque(smith(), THETA, 10.0)
    for name in ("f12", "shaking_force", "shaking_moment"):
        with pytest.raises(el.BadInput, match="ask for it"):
            getattr(found, name)
    with pytest.raises(el.BadInput, match="joint"):
        found.plot(joint="13")


def test_files_and_copies(tmp_path) -> None:
    found = el.rigid_forces(smith(), THETA[:6], 10.0)
    single = el.rigid_forces(smith(), 1.0, 10.0, 2.0)
    told = json.loads(single.save(tmp_path / "f.json").read_text())
    assert told["torque"] == float(single.torque)
    assert told["passed"] and "values" not in told
    rows = found.save(tmp_path / "f.csv").read_text().splitlines()
    assert len(rows) == 7
    names = {"theta2 [rad]", "x12 [N]", "torque [N m]", "shaking_moment [N m]", "error"}
    assert names <= set(rows[0].split(","))
    with np.load(found.save(tmp_path / "f.npz")) as stored:
        np.testing.assert_array_equal(stored["y41"], found["y41"])
    copy = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(copy.error, found.error)
    assert copy.passed


def test_pictures() -> None:
    found = el.rigid_forces(smith(), np.linspace(0.0, TURN, 361), 10.0)
    polar = found.plot(joint="34")
    curve = polar.lines[0].get_xydata()
    np.testing.assert_array_equal(curve, found.f34)
    # Every mark has its text, clear of all others.
    assert [item.get_text() for item in polar.texts] == [f"{angle}°" for angle in range(0, 360, 30)]
    polar.figure.draw_without_rendering()
    boxes = [Text.get_window_extent(item) for item in polar.texts]
    assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))
    torque = found.plot(joint="torque")
    np.testing.assert_array_equal(torque.lines[0].get_ydata(), found.torque)
    assert found.plot().get_title() == "force on the frame"
    # A force along one axis, over the turn.
    found = el.rigid_forces(loaded(LINKAGES["slider-crank"]), np.linspace(0.0, 6.0, 61), 5.0)
    axes = found.plot(joint="41")
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), found["y41"])
    assert axes.get_ylabel() == "pin force 41, Y [N]"


@EVERY
@pytest.mark.parametrize("name", ["x12", "y41", "torque"])
def test_a_wrong_force_is_out_of_balance(linkage, name) -> None:
    machine, theta = loaded(linkage), np.linspace(0.1, 6.0, 9)
    given = (machine, theta, np.full(9, 5.0), np.zeros(9))
    values = dict(el.rigid_forces(machine, theta, 5.0).values)
    assert all(check.passed for check in checks(*given, values).values())
    values[name] = values[name] + 1e-9
    assert not checks(*given, values)["equilibrium of the links over its error"].passed


def test_a_peak_between_the_places_is_looked_at() -> None:
    """One angle among a thousand beside a fold."""
    linkage = el.FourBar(0.3, 0.25, 0.1, 0.1)
    low, high = linkage.crank_ranges()[0]
    theta = np.full(1000, 0.5 * (low + high))
    theta[517] = np.nextafter(high, low)
    coupler = el.MassDistribution.uniform_bar(1.0, 0.1)
    assert not el.driving_torque(el.Machine(linkage, {"coupler": coupler}), theta, 1.0).passed
