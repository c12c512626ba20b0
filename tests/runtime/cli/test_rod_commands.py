"""``elastolink steady-state``, and ``simulate`` and ``stability`` of the constrained rod."""

import numpy as np
import pytest
from command_runs import run, shown, told
from elastolink.runtime.periodic import floquet_multipliers, steady_state
from elastolink.runtime.scenes import load_scene

SCENE = "beale_1992_flexible_rod"
ONE = ("--set", "model.modes=1")
FREE = ("--set", "model.formulation=free_free")


def system(**model):
    return load_scene(SCENE, {f"model.{k}": v for k, v in model.items()}).linear_system()


def test_steady_state_at_one_speed_and_over_speeds(capsys, tmp_path):
    printed = shown(capsys, "steady-state", SCENE, "--set", "model.modes=2")
    peak = float(steady_state(system(modes=2), 100.0).peak())
    assert f"{peak:.6g}" in printed and "stable" in printed
    target = tmp_path / "r.png"
    given = (*ONE, "--speed", "300:330:4", "--at", "1", "--plot", target)
    found = told(capsys, "steady-state", SCENE, *given)
    expected = steady_state(system(modes=1), np.linspace(300.0, 330.0, 4)).peak()
    np.testing.assert_allclose(found["peak_deflection"], expected, rtol=1e-12)
    assert target.stat().st_size > 5000


def test_constrained_stability_is_near_the_linear_one(capsys):
    found = told(capsys, "stability", SCENE, *FREE, *ONE)
    assert found["stable"]
    linear = system(formulation="free_free_linear", modes=1)
    phase = np.abs(np.angle(floquet_multipliers(linear, 100.0).multipliers[0]))
    pair = complex(found["physical"]["real"][0], found["physical"]["imag"][0])
    # The tip moves by 1.4e-4 of the length here: multipliers differ by the square of that or so.
    assert np.abs(np.angle(pair)) == pytest.approx(float(phase), abs=1e-5)


def test_constrained_motion_shows_its_constraints(capsys):
    printed = shown(capsys, "simulate", SCENE, *FREE, *ONE, "--revolutions", "0.5")
    assert "constraints, level of" in printed and "the end was reached" in printed


def test_beyond_the_linear_range_no_verdict_is_given(capsys):
    changes = ("--set", "links.crank_ratio=0.2", "--set", "model.modes=2", "--speed", "500")
    status, out, err = run(capsys, "stability", SCENE, *FREE, *changes)
    assert status == 1 and "linear range" in err
    assert "no verdict on the rod: the motion leaves the linear range" in out
