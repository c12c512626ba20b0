"""``elastolink kinematics`` for every linkage: columns, units, drive, animation, refusals."""

from __future__ import annotations

import json

import numpy as np
import pytest
from command_runs import run

SCENES = {
    "smith_1972_2122": ("theta3 [deg]", "omega4", "transmission angle from"),
    "slider_crank_example": ("position [m]", "slider_velocity [m/rad]", "transmission angle from"),
    "quick_return_example": ("slide [m]", "slide_acceleration [m/rad^2]", "speeds over omega2"),
}


@pytest.mark.parametrize("scene", SCENES)
def test_each_linkage_has_its_columns(capsys, scene):
    status, out, err = run(capsys, "kinematics", scene, "--angles", "0:360:5deg")
    assert status == 0 and err == ""
    assert all(word in out for word in SCENES[scene])
    rows = [line for line in out.splitlines() if line[:1].isdigit()]
    assert len(rows) == 5
    # One turn later everything is as before, and no zero has a sign.
    assert rows[0].split()[1:] == rows[-1].split()[1:]
    assert "-0.000000" not in out


@pytest.mark.parametrize("scene", SCENES)
def test_drive_speed_and_acceleration_give_si_rates(capsys, scene):
    drive = ("--speed", "60 rpm", "--acceleration", "180 deg/s**2")
    _, out, _ = run(capsys, "kinematics", scene, "--angles", "30:90:3deg", "--json")
    relative = json.loads(out)
    _, out, _ = run(capsys, "kinematics", scene, "--angles", "30:90:3deg", *drive, "--json")
    driven = json.loads(out)
    assert driven["omega2"] == pytest.approx([2 * np.pi] * 3, rel=1e-15)
    assert driven["alpha2"] == pytest.approx([np.pi] * 3, rel=1e-15)
    name = "4" if "omega4" in driven else "3"
    w, a = (np.array(relative[word + name]) for word in ("omega", "alpha"))
    assert driven["alpha" + name] == pytest.approx(4 * np.pi**2 * a + np.pi * w, rel=1e-13)
    _, out, _ = run(capsys, "kinematics", scene, *drive)
    assert f"omega{name} [deg/s]" not in out and f"omega{name} [rad/s]" in out
    assert "over omega2" not in out


def test_an_animation_is_written_whole(capsys, tmp_path):
    file = tmp_path / "moving.gif"
    status, out, _ = run(capsys, "kinematics", "slider_crank_example", "--animate", file)
    assert status == 0 and "position [m]" in out
    assert file.read_bytes()[:6] == b"GIF89a"
    assert list(tmp_path.iterdir()) == [file]


def test_two_ranges_of_the_crank_are_not_one_motion(capsys):
    """The coupler of 30 mm reaches the guide within 48.6 deg of it, on either side."""
    arguments = ("slider_crank_example", "--set", "links.coupler=0.03 m")
    status, _, err = run(capsys, "kinematics", *arguments, "--angles", "40:140:2deg")
    assert status == 1
    assert "self-check failed: folds within the angles: 2 exceeds 0" in err
