"""Commands for rigid linkages beside the functions that they call: text, JSON, pictures, drive."""

import math

import elastolink as el
import numpy as np
import pytest
from command_runs import run, shown, told

SMITH, ENGINE, SHAPER = "smith_1972_12_6_12_12", "slider_crank_example", "quick_return_example"
LOOSE = "smith_1972_10_8_10_10"
QUARTER, ANGLES = ("--angles", "0:90:4deg"), np.radians([0.0, 30.0, 60.0, 90.0])
TWO = ("--at", "23=0.05 mm", "--at", "41=0.1 mm")
COLUMNS = {
    "smith_1972_2122": ("theta3 [deg]", "omega4", "transmission angle from"),
    ENGINE: ("position [m]", "slider_velocity [m/rad]", "transmission angle from"),
    SHAPER: ("slide [m]", "slide_acceleration [m/rad^2]", "speeds over omega2"),
}


def machine():
    return el.load_scene(SMITH).machine()


def motor():
    table = el.load_scene(ENGINE)["motor"]
    return el.TorqueLine(table["stall_torque"], table["no_load_speed"])


def line_of(text, start):
    return next(line for line in text.splitlines() if line.startswith(start))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("classify", SMITH), ["GCRR"]),
        (("classify", ENGINE), []),
        (("classify", "--lengths", "12,6,12,12", "--base-plane"), ["GCRR"]),
        (("curve", SMITH, "--point", "0.5,0.3"), []),
        (("curve", SHAPER, "--point", "1,0", "--link", "rod"), []),
        (("harmonics", SMITH, "--of", "theta4"), []),
        (("harmonics", ENGINE, "--of", "torque"), []),
        (("balance", SMITH, "--case", "b", "--offset", "6 in"), []),
        (("run-up", SMITH, "--torque", "5 N*m", "--revolutions", "0.5"), ["less than one made"]),
        (("forces", ENGINE, "--speed", "90", "--joint", "34"), ["couple of the slide"]),
        (("forces", ENGINE, "--speed", "90", "--joint", "frame"), []),
        (("forces", ENGINE, "--speed", "90", "--joint", "torque"), []),
        *(
            (("clearance", scene, *TWO), [f"width [{unit}]", "23: 5e-05 m, 41: 0.0001 m"])
            for scene, unit in ((LOOSE, "deg"), (ENGINE, "m"), (SHAPER, "deg"))
        ),
    ],
)
def test_text_json_and_picture_of_each(capsys, tmp_path, arguments, words):
    picture = tmp_path / "it.png"
    text = shown(capsys, *arguments, "--plot", picture)
    assert "method:" in text and "nan" not in text.lower()
    assert picture.stat().st_size > 5000
    assert told(capsys, *arguments, "--plot", picture)["passed"] is True
    assert all(word in text for word in words)


@pytest.mark.parametrize("scene", COLUMNS)
def test_each_linkage_has_its_columns(capsys, scene):
    out = shown(capsys, "kinematics", scene, "--angles", "0:360:5deg")
    assert all(word in out for word in COLUMNS[scene])
    rows = [line for line in out.splitlines() if line[:1].isdigit()]
    assert len(rows) == 5
    # One turn later everything is as before, and no zero has a sign.
    assert rows[0].split()[1:] == rows[-1].split()[1:]
    assert "-0.000000" not in out


@pytest.mark.parametrize("scene", COLUMNS)
def test_drive_speed_and_acceleration_give_si_rates(capsys, scene):
    drive = ("--speed", "60 rpm", "--acceleration", "180 deg/s**2")
    driven = told(capsys, "kinematics", scene, "--angles", "30:90:3deg", *drive)
    assert driven["omega2"] == pytest.approx([2 * np.pi] * 3, rel=1e-15)
    assert driven["alpha2"] == pytest.approx([np.pi] * 3, rel=1e-15)
    name = "4" if "omega4" in driven else "3"
    out = shown(capsys, "kinematics", scene, *drive)
    assert f"omega{name} [deg/s]" not in out and f"omega{name} [rad/s]" in out
    assert "over omega2" not in out


def test_an_animation_is_written_whole(capsys, tmp_path):
    file = tmp_path / "moving.gif"
    assert "position [m]" in shown(capsys, "kinematics", ENGINE, "--animate", file)
    assert file.read_bytes()[:6] == b"GIF89a"
    assert list(tmp_path.iterdir()) == [file]


def test_two_ranges_of_the_crank_are_not_one_motion(capsys):
    """The coupler of 30 mm reaches the guide within 48.6 deg of it, on either side."""
    arguments = (ENGINE, "--set", "links.coupler=0.03 m", "--angles", "40:140:2deg")
    status, _, err = run(capsys, "kinematics", *arguments)
    assert status == 1
    assert "self-check failed: folds within the angles: 2 exceeds 0" in err


@pytest.mark.parametrize(
    ("given", "drive"),
    [
        (("--speed=-10",), (-10.0, 0.0)),
        (("--speed", "0", "--acceleration", "5"), (0.0, 5.0)),
        (("--speed", "10", "--set", "operation.acceleration=30"), (10.0, 30.0)),
        (("--set", "operation.acceleration=7", "--acceleration", "50"), (10.0, 50.0)),
    ],
)
def test_the_drive_is_that_of_the_option_or_else_of_the_scene(given, drive, capsys):
    forces = told(capsys, "forces", SMITH, *given, *QUARTER)
    found = el.rigid_forces(machine(), ANGLES, *drive)
    np.testing.assert_allclose(forces["torque"], found.torque, rtol=1e-12)
    np.testing.assert_allclose(forces["x23"], found["x23"], rtol=1e-12)
    moved = told(capsys, "kinematics", SMITH, *given, *QUARTER)
    expected = el.load_scene(SMITH).mechanism().motion(ANGLES, *drive).alpha4
    np.testing.assert_allclose(moved["alpha4"], expected, rtol=1e-12)
    if drive[0]:
        balanced = told(capsys, "balance", SMITH, "--case", "b", *given)["unbalanced"]
        expected = el.balance(machine(), drive[0], acceleration=drive[1], case="b").unbalanced
        assert balanced == pytest.approx(expected, rel=1e-12)


def test_length_of_a_curve_units_of_its_point_and_harmonics(capsys):
    linkage = el.load_scene(SMITH).mechanism()
    curve = el.coupler_curve(linkage, 0.5 * linkage.coupler, 0.25 * linkage.coupler)
    out = shown(capsys, "curve", SMITH, "--point", "0.5,0.25")
    assert f"length {curve.length:.9g} m" in out
    assert out == shown(capsys, "curve", SMITH, "--point", "6 in,3 in")
    found = told(capsys, "harmonics", SMITH, "--of", "theta4", "--order", "3")
    # Sines are -(l2/l1)^m / m.
    np.testing.assert_allclose(found["b"][1:], [-(0.5**m) / m for m in (1, 2, 3)], atol=1e-14)


def test_the_table_and_the_json_of_forces_give_the_peaks(capsys):
    printed = shown(capsys, "forces", SMITH, "--speed", "10 rad/s", "--fluctuation", "0.05")
    # A million samples miss a peak by less than 1e-11 of it; the crank angle by 2e-4 degrees.
    theta = np.linspace(0.0, 2.0 * np.pi, 1_000_001)
    found = el.rigid_forces(machine(), theta, 10.0)
    for values in (np.hypot(*found.f12.T), np.hypot(*found.shaking_force.T), found.torque):
        top = int(np.argmax(np.abs(values[:500_000])))
        assert f" {values[top]:.6g} " in printed
        assert f" {np.degrees(theta[top]):.2f}\n" in printed
    wheel = el.flywheel_inertia(machine(), 10.0, 0.05)
    assert f"{wheel.torque.energy_fluctuation:.6g} J" in printed
    assert f"flywheel {wheel.inertia:.6g}" in printed
    as_json = told(capsys, "forces", SMITH, "--speed", "10", "--fluctuation", "0.05")
    assert as_json["flywheel"]["inertia"] == wheel.inertia
    assert as_json["energy_fluctuation"] == wheel.torque.energy_fluctuation
    assert as_json["mean_torque"] == 0.0
    sizes = {name: abs(peak["value"]) for name, peak in as_json["peaks"].items()}
    assert sizes == pytest.approx(el.balance(machine(), 10.0, case="a").unbalanced, rel=1e-11)
    # And one at the end of a range.
    peak = told(capsys, "forces", SMITH, "--speed", "10", "--angles", "60:90:4deg")["peaks"]["f12"]
    ends = el.rigid_forces(machine(), np.radians([60.0, 90.0]), 10.0)
    assert peak["value"] == pytest.approx(np.hypot(*ends.f12.T).max(), rel=1e-12)


def test_a_rocking_crank_is_told_so(capsys):
    changed = ("--speed", "1", "--set", "links.crank='14 in'", "--set", "links.frame='30 in'")
    assert "does not turn fully" in shown(capsys, "forces", SMITH, *changed)
    status, _, err = run(capsys, "forces", SMITH, "--fluctuation", "0.02", *changed)
    assert status == 2 and "--fluctuation" in err


def test_a_case_of_balancing_before_and_after(capsys):
    text = shown(capsys, "balance", SMITH, "--speed", "10", "--case", "b", "--offset", "6 in")
    # Smith, section on Fig. 21: partial balance halves the force on the frame.
    assert float(line_of(text, "shaking_force").split()[-1]) == pytest.approx(0.53, abs=0.001)
    assert "crank" in text and "follower" in text
    # In the picture of a trade-off, cases (c) and (d) lie at zero: off the border.
    left, right = el.trade_off(machine(), 10.0, points=2).plot().get_xlim()
    assert left < -0.02 * (right - left)


def test_the_best_counterweights_are_those_of_the_function(capsys, tmp_path):
    picture = tmp_path / "peaks.svg"
    weights = "shaking_force=1,torque=1,f23=1"
    given = ("--offset", "6 in", "--weights", weights, "--links", "crank,follower")
    found = told(capsys, "balance", SMITH, *given, "--plot", picture)
    expected = el.balance(
        machine(),
        10.0,
        weights=dict.fromkeys(("shaking_force", "torque", "f23"), 1.0),
        links=["crank", "follower"],
        bounds=el.Bounds(offset=6 * 0.0254),
    )
    assert found["value"] == pytest.approx(expected.value, rel=1e-9)
    assert found["value"] - found["lower_bound"] < 1e-8
    assert set(found["counterweights"]) == {"crank", "follower"}
    assert picture.stat().st_size > 0


def test_forces_that_grow_for_want_of_a_weight_are_told(capsys):
    plain = shown(capsys, "balance", SMITH, "--speed", "10")
    advice = line_of(plain, "shaking_force, ").rpartition("--weights ")[2]
    assert advice == "f23=1,torque=1,shaking_moment=1,shaking_force=1"
    weighed = shown(capsys, "balance", SMITH, "--speed", "10", "--weights", advice)
    force = next(line.split() for line in weighed.splitlines() if line.startswith("shaking_force"))
    assert float(force[4]) < 1.0


def test_a_trade_off_lists_curve_cases_and_counterweights(capsys):
    asked = ("balance", SMITH, "--trade-off", "shaking_force,torque", "--points", "3")
    text = shown(capsys, *asked)
    assert all(f"({case})" in text for case in "abcd") and "follower along [m]" in text
    found = told(capsys, *asked)
    for point, first in zip(found["points"], found["first_values"], strict=True):
        assert point["relative"]["shaking_force"] == pytest.approx(first, rel=1e-12)
        assert all(body["mass"] > 0.0 for body in point["counterweights"].values())
    assert len(found["points"]) == 3 and found["points"][0]["counterweights"]


def test_the_scene_drives_itself(capsys):
    given = ("--revolutions", "3", "--start-angle", "20 deg")
    printed = shown(capsys, "run-up", ENGINE, *given)
    scene = el.load_scene(ENGINE)
    assert scene.get("motor.flywheel") == 0.05
    start = math.radians(20.0)
    found = el.run_up(scene.machine(), motor(), revolutions=3, theta0=start, flywheel=0.05)
    assert f"{found.speed[-1]:.6g}" in printed
    assert f"{found.speed[-1] * 60 / (2 * math.pi):.6g}" in printed
    assert f"{found.fluctuation:.4g}" in printed
    assert f"{found.time[-1]:.6g}" in printed
    assert "status: finished: the revolutions are made" in printed
    heavy = told(capsys, "run-up", ENGINE, *given, "--set", "motor.flywheel=0.5 kg*m**2")
    assert heavy["speed"][-1] < 0.5 * found.speed[-1]


def test_options_of_the_motor_go_before_the_scene(capsys):
    given = ("--stall-torque", "30 N*m", "--start-speed", "100 rpm", "--duration", "50 ms")
    found = told(capsys, "run-up", ENGINE, *given)
    line = el.TorqueLine(30.0, motor().no_load_speed)
    assert found["speed"][0] == pytest.approx(100.0 * math.pi / 30.0, rel=1e-12)
    assert found["torque"][0] == pytest.approx(line(found["speed"][0]), rel=1e-12)
    # Without --revolutions, the duration alone ends it.
    assert found["time"][-1] == 0.05 and found["status"] == "finished"
    # In a vertical plane a thousandth of a newton metre lifts nothing.
    weak = ("--torque", "1e-3 N*m", "--set", "gravity.direction=-90 deg", "--start-angle", "20 deg")
    text = shown(capsys, "run-up", ENGINE, *weak)
    assert "status: stalled: the motor's 0.001 N m cannot start it" in text


def test_clearance_as_text_and_json(capsys):
    text = shown(capsys, "clearance", LOOSE, "--clearance", "0.1 in")
    # Smith's linkage at theta2 = 0: sin mu = 0.198997, c / (l4 sin mu) = 0.0503 rad = 2.88 deg.
    greatest = line_of(text, "greatest").split()
    assert float(greatest[1]) == 0.0
    assert float(greatest[2]) == pytest.approx(2.8795, abs=5e-5)
    found = told(capsys, "clearance", LOOSE, "--clearance", "0.1 in", "--joint", "23", *QUARTER)
    expected = el.clearance_range(el.load_scene(LOOSE).mechanism(), 0.00254, ANGLES, joint="23")
    assert found["width"] == pytest.approx(expected.width.tolist(), rel=1e-14)
    assert found["clearances"] == {"23": 0.00254}
    both = told(capsys, "clearance", LOOSE, "--at", "23=0.04 in", "--at", "41=0.06 in", *QUARTER)
    assert both["width"] == pytest.approx(found["width"], rel=1e-13)
    least = line_of(shown(capsys, "clearance", ENGINE, "--clearance", "0.1 mm"), "least").split()
    # In line with the guide the whole clearance goes into the slider's movement, in metres.
    assert float(least[2]) == pytest.approx(1e-4, rel=1e-4)
    assert math.isclose(float(least[1]) % 180.0, 0.0, abs_tol=1e-9)


def test_several_clearances_share_a_picture(capsys, tmp_path):
    path = tmp_path / "fig10.svg"
    asked = ("clearance", LOOSE, "--clearance", "0.1 in", "--clearance", "0.5 in")
    assert shown(capsys, *asked, "--plot", path).count("greatest") == 2
    assert "<svg" in path.read_text()
    first, second = told(capsys, *asked)["ranges"]
    assert second["greatest"]["width"] > 4 * first["greatest"]["width"]


def test_a_fold_by_clearance_is_told(capsys):
    # Coupler and follower 0.02 in longer than frame and crank together: in line at 180 deg.
    lengths = ("frame=3 in", "crank=1 in", "coupler=2.02 in", "follower=2 in")
    words = [word for text in lengths for word in ("--set", f"links.{text}")]
    for size, folds in (("0.1 in", True), ("0.001 in", False)):
        out = shown(capsys, "clearance", LOOSE, *words, "--clearance", size)
        assert ("other assembly" in out) == folds
