"""``elastolink classify, curve, harmonics, balance``: numbers, JSON, pictures, refusals."""

import json
import subprocess
import sys

import numpy as np
import pytest
from command_runs import run
from elastolink.runtime.linkages import classify, coupler_curve, harmonics
from elastolink.runtime.rigid import balance
from elastolink.runtime.scenes import load_scene

SMITH = "smith_1972_12_6_12_12"
ENGINE = "slider_crank_example"
SHAPER = "quick_return_example"


@pytest.mark.parametrize(
    "arguments",
    [
        ("classify", SMITH),
        ("classify", ENGINE),
        ("classify", "--lengths", "12,6,12,12", "--base-plane"),
        ("curve", SMITH, "--point", "0.5,0.3"),
        ("curve", SHAPER, "--point", "1,0", "--link", "rod"),
        ("harmonics", SMITH, "--of", "theta4"),
        ("harmonics", ENGINE, "--of", "torque"),
        ("balance", SMITH, "--case", "b", "--offset", "6 in"),
    ],
)
def test_text_json_and_picture_of_each(capsys, tmp_path, arguments):
    picture = tmp_path / "it.png"
    status, text, err = run(capsys, *arguments, "--plot", picture)
    assert status == 0 and err == ""
    assert "method:" in text and "nan" not in text.lower()
    assert picture.stat().st_size > 5000
    status, out, _ = run(capsys, *arguments, "--plot", picture, "--json")
    told = json.loads(out)
    assert status == 0 and told["passed"] is True


def test_class_of_smiths_linkage(capsys):
    _, out, _ = run(capsys, "classify", SMITH, "--json")
    told = json.loads(out)
    assert told["symbol"] == classify((12.0, 6.0, 12.0, 12.0)).symbol == "GCRR"


def test_the_printed_length_of_a_curve(capsys):
    linkage = load_scene(SMITH).mechanism()
    curve = coupler_curve(linkage, 0.5 * linkage.coupler, 0.25 * linkage.coupler)
    _, out, _ = run(capsys, "curve", SMITH, "--point", "0.5,0.25")
    assert f"length {curve.length:.9g} m" in out


def test_units_of_a_point(capsys):
    first = run(capsys, "curve", SMITH, "--point", "6 in,3 in")[1]
    assert first == run(capsys, "curve", SMITH, "--point", "0.5,0.25")[1]


def test_harmonics_of_the_follower(capsys):
    _, out, _ = run(capsys, "harmonics", SMITH, "--of", "theta4", "--order", "3", "--json")
    told = json.loads(out)
    found = harmonics((load_scene(SMITH).mechanism(), "theta4"), order=3)
    np.testing.assert_allclose(told["b"], found.b, rtol=1e-12, atol=1e-15)
    # Sines are -(l2/l1)^m / m.
    np.testing.assert_allclose(found.b[1:], [-(0.5**m) / m for m in (1, 2, 3)], atol=1e-14)


def test_the_best_counterweights_are_those_of_the_function(capsys):
    _, out, _ = run(capsys, "balance", SMITH, "--weights", "torque=1,f23=1", "--json")
    told = json.loads(out)
    machine = load_scene(SMITH).machine()
    found = balance(machine, 10.0, weights={"torque": 1.0, "f23": 1.0})
    assert told["value"] == pytest.approx(found.value, rel=1e-9)


def test_balance_takes_the_acceleration_of_scene_and_option(capsys):
    machine = load_scene(SMITH).machine()
    wanted = balance(machine, -10.0, acceleration=50.0, case="b").unbalanced
    assert wanted["torque"] != balance(machine, 10.0, case="b").unbalanced["torque"]
    drive = ("balance", SMITH, "--case", "b", "--speed=-10", "--json")
    for more in (("--set", "operation.acceleration=50"), ("--acceleration", "50")):
        _, out, _ = run(capsys, *drive, *more)
        assert json.loads(out)["unbalanced"] == pytest.approx(wanted, rel=1e-12)
    # The option comes before the scene.
    both = ("--set", "operation.acceleration=7", "--acceleration", "50")
    _, out, _ = run(capsys, *drive, *both)
    assert json.loads(out)["unbalanced"] == pytest.approx(wanted, rel=1e-12)


def test_kinematics_takes_the_drive_of_the_scene(capsys):
    linkage = load_scene(SMITH).mechanism()
    angles = ("--angles", "30:90:3deg", "--json")
    for arguments, speed in (
        (("--set", "operation.acceleration=5"), 10.0),
        (("--speed", "0", "--acceleration", "5"), 0.0),
        (("--speed=-3", "--acceleration", "5"), -3.0),
    ):
        _, out, _ = run(capsys, "kinematics", SMITH, *angles, *arguments)
        wanted = linkage.motion(np.radians([30.0, 60.0, 90.0]), speed, 5.0)
        np.testing.assert_allclose(json.loads(out)["alpha4"], wanted.alpha4, rtol=1e-12)


def test_json_of_a_trade_off_holds_the_counterweights(capsys):
    arguments = ("--trade-off", "shaking_force,torque", "--points", "3", "--json")
    _, out, _ = run(capsys, "balance", SMITH, *arguments)
    told = json.loads(out)
    assert len(told["points"]) == 3
    for point, first in zip(told["points"], told["first_values"], strict=True):
        assert point["relative"]["shaking_force"] == pytest.approx(first, rel=1e-12)
        assert all(body["mass"] > 0.0 for body in point["counterweights"].values())
    assert told["points"][0]["counterweights"]


def test_the_command_without_its_script():
    called = [sys.executable, "-m", "elastolink", "--version"]
    done = subprocess.run(called, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and done.stdout.startswith("elastolink ")
