"""``elastolink forces``: its table against the functions, JSON, pictures, and one-line refusals."""

from __future__ import annotations

import argparse
import json

import numpy as np
import pytest
from elastolink.runtime.cli import forces as group
from elastolink.runtime.dynamics import flywheel_inertia, rigid_forces, torque_fluctuation
from elastolink.runtime.errors import BadInput
from elastolink.runtime.scenes import load_scene

SCENE = "smith_1972_12_6_12_12"


def run(*arguments: str) -> int:
    parser = argparse.ArgumentParser()
    group.add(parser.add_subparsers())
    options = parser.parse_args(["forces", *arguments])
    return int(options.run(options))


def test_the_table_gives_the_peaks(capsys) -> None:
    assert run(SCENE, "--speed", "10 rad/s", "--fluctuation", "0.05") == 0
    printed = capsys.readouterr().out
    machine = load_scene(SCENE).machine()
    theta = np.radians(np.linspace(0.0, 360.0, 721))
    found = rigid_forces(machine, theta, 10.0)
    for values in (np.hypot(*found.f34.T), np.hypot(*found.shaking_force.T), found.torque):
        top = int(np.argmax(np.abs(values)))
        assert f"{values[top]:.6g}" in printed
        assert f"{np.degrees(theta[top]):.2f}" in printed
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
    with pytest.raises(BadInput, match="--fluctuation"):
        run(SCENE, "--speed", "1", "--fluctuation", "0.02", *changed)


@pytest.mark.parametrize(
    ("given", "named"),
    [
        (("--speed", "-3"), "--speed"),
        (("--speed", "10 kg"), "--speed"),
        (("--speed", "10", "--angles", "0:90"), "--angles"),
        (("--speed", "10", "--plot", "f.bmp"), "ending"),
        (("--speed", "10", "--fluctuation", "2"), "fluctuation"),
    ],
)
def test_refusals(given, named) -> None:
    with pytest.raises(BadInput, match=named):
        run(SCENE, *given)
