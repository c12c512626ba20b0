import json

import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.rigid import trade_off
from elastolink.runtime.scenes import load_scene

SMITH = ["balance", "smith_1972_12_6_12_12", "--speed", "10"]


def run(capsys, *more):
    status = main([*SMITH, *more])
    return status, capsys.readouterr()


def test_case_prints_before_and_after(capsys):
    status, text = run(capsys, "--case", "b", "--offset", "6 in")
    assert status == 0
    row = next(line for line in text.out.splitlines() if line.startswith("shaking_force"))
    # Smith, section on Fig. 21: partial balance halves the force on the frame.
    assert float(row.split()[-1]) == pytest.approx(0.53, abs=0.001)
    assert "crank" in text.out and "follower" in text.out


def test_optimum_as_json_and_picture(capsys, tmp_path):
    picture = tmp_path / "peaks.svg"
    status, text = run(
        capsys,
        *("--offset", "6 in", "--weights", "shaking_force=1,torque=1,f23=1"),
        *("--links", "crank,follower", "--json", "--plot", str(picture)),
    )
    assert status == 0
    found = json.loads(text.out)
    assert found["value"] - found["lower_bound"] < 1e-8
    assert set(found["counterweights"]) == {"crank", "follower"}
    assert picture.stat().st_size > 0


def test_trade_off_lists_curve_and_cases(capsys):
    status, text = run(capsys, "--trade-off", "shaking_force,torque", "--points", "3")
    assert status == 0
    assert all(f"({case})" in text.out for case in "abcd")


def test_marks_of_full_balance_stand_off_the_border():
    machine = load_scene(SMITH[1]).machine()
    ax = trade_off(machine, 10.0, points=2).plot()
    left, right = ax.get_xlim()
    # Cases (c) and (d) lie at zero.
    assert left < -0.02 * (right - left)
