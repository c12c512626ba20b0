"""``elastolink forces``: its table against the functions, JSON, pictures, and one-line refusals."""

from __future__ import annotations

import json

import numpy as np
import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.rigid import balance, flywheel_inertia, rigid_forces, torque_fluctuation
from elastolink.runtime.scenes import load_scene

SCENE = "smith_1972_12_6_12_12"


def run(*words):
    return main(["forces", *words])


def test_the_table_gives_the_peaks(capsys) -> None:
    assert run(SCENE, "--speed", "10 rad/s", "--fluctuation", "0.05") == 0
    printed = capsys.readouterr().out
    machine = load_scene(SCENE).machine()
    # A million samples miss a peak by less than 1e-11 of it; the crank angle by 2e-4 degrees.
    theta = np.linspace(0.0, 2.0 * np.pi, 1_000_001)
    found = rigid_forces(machine, theta, 10.0)
    for values in (np.hypot(*found.f12.T), np.hypot(*found.shaking_force.T), found.torque):
        top = int(np.argmax(np.abs(values[:500_000])))
        assert f" {values[top]:.6g} " in printed
        assert f" {np.degrees(theta[top]):.2f}\n" in printed
    assert f"{torque_fluctuation(machine, 10.0).energy_fluctuation:.6g} J" in printed
    assert f"flywheel {flywheel_inertia(machine, 10.0, 0.05).inertia:.6g}" in printed


def test_json_and_acceleration(capsys) -> None:
    assert (
        run(SCENE, "--speed", "10", "--acceleration", "30", "--angles", "0:90:4deg", "--json") == 0
    )
    told = json.loads(capsys.readouterr().out)
    machine = load_scene(SCENE).machine()
    found = rigid_forces(machine, np.radians([0.0, 30.0, 60.0, 90.0]), 10.0, 30.0)
    np.testing.assert_allclose(told["x23"], found["x23"], rtol=1e-12)
    np.testing.assert_allclose(told["torque"], found.torque, rtol=1e-12)


@pytest.mark.parametrize("joint", ["34", "frame", "torque"])
def test_pictures(joint, tmp_path, capsys) -> None:
    target = tmp_path / "f.png"
    assert (
        run("slider_crank_example", "--speed", "90", "--joint", joint, "--plot", str(target)) == 0
    )
    assert target.stat().st_size > 5000
    assert "couple of the slide" in capsys.readouterr().out


def test_a_rocking_crank_is_told_so(capsys) -> None:
    changed = ["--set", "links.crank='14 in'", "--set", "links.frame='30 in'"]
    assert run(SCENE, "--speed", "1", *changed) == 0
    assert "does not turn fully" in capsys.readouterr().out
    assert run(SCENE, "--speed", "1", "--fluctuation", "0.02", *changed) == 2
    assert "--fluctuation" in capsys.readouterr().err


def test_json_holds_all_that_is_printed(capsys) -> None:
    assert run(SCENE, "--speed", "10", "--fluctuation", "0.02", "--json") == 0
    told = json.loads(capsys.readouterr().out)
    machine = load_scene(SCENE).machine()
    wheel = flywheel_inertia(machine, 10.0, 0.02)
    assert told["flywheel"]["inertia"] == wheel.inertia
    assert told["energy_fluctuation"] == wheel.torque.energy_fluctuation
    assert told["mean_torque"] == 0.0
    peaks, truth = told["peaks"], balance(machine, 10.0, case="a").unbalanced
    assert {name: abs(peak["value"]) for name, peak in peaks.items()} == pytest.approx(
        truth, rel=1e-11
    )
    # The true peak of f12, by another search of many more samples: not 37.9685.
    assert peaks["f12"]["value"] == pytest.approx(37.9688, abs=5e-5)


@pytest.mark.parametrize(
    ("given", "drive"),
    [
        (("--speed=-10",), (-10.0, 0.0)),
        (("--speed", "0", "--acceleration", "5"), (0.0, 5.0)),
        (("--speed", "10", "--set", "operation.acceleration=30"), (10.0, 30.0)),
    ],
)
def test_any_drive(given, drive, capsys) -> None:
    assert run(SCENE, *given, "--angles", "0:90:4deg", "--json") == 0
    told = json.loads(capsys.readouterr().out)
    found = rigid_forces(load_scene(SCENE).machine(), np.radians([0.0, 30.0, 60.0, 90.0]), *drive)
    np.testing.assert_allclose(told["torque"], found.torque, rtol=1e-12)


def test_a_peak_at_the_end_of_the_range(capsys) -> None:
    assert run(SCENE, "--speed", "10", "--angles", "60:90:4deg", "--json") == 0
    peak = json.loads(capsys.readouterr().out)["peaks"]["f12"]
    found = rigid_forces(load_scene(SCENE).machine(), np.radians([60.0, 90.0]), 10.0)
    assert peak["value"] == pytest.approx(np.hypot(*found.f12.T).max(), rel=1e-12)
