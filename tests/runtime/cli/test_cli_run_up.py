"""``elastolink run-up``: the scene's motor and flywheel, options, JSON, pictures, refusals."""

from __future__ import annotations

import json
import math

import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.rigid import TorqueLine, run_up
from elastolink.runtime.scenes import load_scene
from elastolink.runtime.scenes.rigid import flywheel, motor

SCENE = "slider_crank_example"
BARE = "smith_1972_12_6_12_12"


def run(*words):
    return main(["run-up", *words])


def test_the_scene_drives_itself(capsys) -> None:
    assert run(SCENE, "--revolutions", "3", "--start-angle", "20 deg") == 0
    printed = capsys.readouterr().out
    scene = load_scene(SCENE)
    assert flywheel(scene) == 0.05
    found = run_up(
        scene.machine(), motor(scene), revolutions=3, theta0=math.radians(20.0), flywheel=0.05
    )
    assert f"{found.speed[-1]:.6g}" in printed
    assert f"{found.speed[-1] * 60 / (2 * math.pi):.6g}" in printed
    assert f"{found.fluctuation:.4g}" in printed
    assert f"{found.time[-1]:.6g}" in printed
    assert "status: finished: the revolutions are made" in printed


def test_a_flywheel_slows_the_run_up(capsys) -> None:
    ends = []
    for inertia in ("0.05 kg*m**2", "0.5 kg*m**2"):
        setting = f"motor.flywheel={inertia}"
        assert run(SCENE, "--revolutions", "2", "--json", "--set", setting) == 0
        ends.append(json.loads(capsys.readouterr().out)["speed"][-1])
    assert ends[1] < 0.5 * ends[0]


def test_options_go_before_the_scene(capsys) -> None:
    given = ("--stall-torque", "30 N*m", "--start-speed", "100 rpm", "--duration", "50 ms")
    assert run(SCENE, *given, "--json") == 0
    told = json.loads(capsys.readouterr().out)
    line = TorqueLine(30.0, motor(load_scene(SCENE)).no_load_speed)
    assert told["speed"][0] == pytest.approx(100.0 * math.pi / 30.0, rel=1e-12)
    assert told["torque"][0] == pytest.approx(line(told["speed"][0]), rel=1e-12)
    assert told["time"][-1] == 0.05
    # Without --revolutions, the duration alone ends it.
    assert told["status"] == "finished"


def test_a_constant_torque_for_a_scene_without_a_motor(tmp_path, capsys) -> None:
    target = tmp_path / "run.png"
    assert run(BARE, "--torque", "5 N*m", "--revolutions", "0.5", "--plot", str(target)) == 0
    printed = capsys.readouterr().out
    assert "less than one made" in printed
    assert target.stat().st_size > 5000


def test_a_weak_motor_is_told(capsys) -> None:
    # In a vertical plane a thousandth of a newton metre lifts nothing.
    weak = ("--torque", "1e-3 N*m", "--set", "gravity.direction=-90 deg")
    assert run(SCENE, *weak, "--start-angle", "20 deg") == 0
    assert "status: stalled: the motor's 0.001 N m cannot start it" in capsys.readouterr().out
