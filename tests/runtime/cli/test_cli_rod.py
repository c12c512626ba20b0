"""``elastolink steady-state``, and ``simulate`` and ``stability`` of the constrained rod."""

from __future__ import annotations

import json

import numpy as np
import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.periodic import floquet_multipliers, steady_state
from elastolink.runtime.scenes import load_scene

SCENE = "beale_1992_flexible_rod"
FREE = ("--set", "model.formulation=free_free", "--set", "model.modes=1")


def test_steady_state_at_one_speed(capsys, tmp_path):
    target = tmp_path / "s.png"
    assert main(["steady-state", SCENE, "--set", "model.modes=2", "--plot", str(target)]) == 0
    printed = capsys.readouterr().out
    system = load_scene(SCENE, {"model.modes": 2}).linear_system()
    peak = float(steady_state(system, 100.0).peak())
    assert f"{peak:.6g}" in printed
    assert "stable" in printed
    assert target.stat().st_size > 5000


def test_steady_state_over_speeds(capsys, tmp_path):
    target = tmp_path / "r.png"
    asked = ["steady-state", SCENE, "--set", "model.modes=1", "--speed", "300:330:4", "--json"]
    assert main([*asked, "--at", "1", "--plot", str(target)]) == 0
    told = json.loads(capsys.readouterr().out)
    system = load_scene(SCENE, {"model.modes": 1}).linear_system()
    wanted = steady_state(system, np.linspace(300.0, 330.0, 4)).peak()
    np.testing.assert_allclose(told["peak_deflection"], wanted, rtol=1e-12)
    assert target.stat().st_size > 5000


def test_constrained_stability_is_near_the_linear_one(capsys):
    assert main(["stability", SCENE, *FREE, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["stable"]
    linear = load_scene(SCENE, {"model.formulation": "free_free_linear", "model.modes": 1})
    phase = np.abs(np.angle(floquet_multipliers(linear.linear_system(), 100.0).multipliers[0]))
    pairs = np.array(told["physical"]["real"]) + 1j * np.array(told["physical"]["imag"])
    # The tip moves by 1.4e-4 of the length here: multipliers differ by the square of that or so.
    assert np.abs(np.angle(pairs[0])) == pytest.approx(float(phase), abs=1e-5)


def test_constrained_motion_shows_its_constraints(capsys):
    assert main(["simulate", SCENE, *FREE, "--revolutions", "0.5"]) == 0
    printed = capsys.readouterr().out
    assert "constraints, level of" in printed
    assert "the end was reached" in printed


def test_beyond_the_linear_range_no_verdict_is_given(capsys):
    changes = ("--set", "links.crank_ratio=0.2", "--set", "model.modes=2", "--speed", "500")
    assert main(["stability", SCENE, *FREE[:2], *changes]) == 1
    told = capsys.readouterr()
    assert "no verdict on the rod: the motion leaves the linear range" in told.out
    assert "linear range" in told.err
