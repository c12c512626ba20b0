"""``elastolink boundaries`` and ``elastolink perturb``: numbers, JSON, pictures, refusals."""

import math

import elastolink as el
import numpy as np
import pytest
from command_runs import shown, told

RIG = "smith_1972_101104_sixteenth_inch"


def test_hill_scene(capsys) -> None:
    answer = told(capsys, "boundaries", "mathieu", "--mu", "0:0.4:3", "--order", "3")
    f = el.PeriodicFunction(a=[0.0, 1.0])
    exact = el.hill_boundaries(f, [0.0, 0.2, 0.4], (1, 2, 3, 4))
    # The scene's function comes from samples: its coefficients differ in the last place.
    assert np.allclose(answer["lower"], exact.lower, rtol=0.0, atol=1e-14)
    third = el.perturbation_boundaries(f, [0.0, 0.2, 0.4], (1, 2, 3, 4), order=3)
    assert np.allclose(answer["perturbation"][0]["upper"], third.upper, rtol=0.0, atol=1e-14)
    given = ("--mu", "0.2", "--order", "3", "--regions", "1")
    printed = shown(capsys, "boundaries", "mathieu", *given)
    assert f"{exact.lower[0, 1]:.12g}" in printed and "order 3 from" in printed


def test_a_flag_instead_of_a_number(capsys) -> None:
    given = ("--mu", "3", "--order", "2", "--regions", "2")
    printed = shown(capsys, "boundaries", "mathieu", *given)
    assert "outside the range in which its orders converge" in printed


def test_a_range_without_regions_is_told_in_words(capsys) -> None:
    command = ("boundaries", RIG, "--set", "model.modes=2", "--speed", "900:905rpm")
    lines = shown(capsys, *command).splitlines()
    assert lines[0].startswith("none between 900 rpm and 905 rpm; regions narrower than ")
    assert lines[1].startswith("method:") and not any(line.startswith("error") for line in lines)
    assert told(capsys, *command)["lower"] == []


def test_certified(capsys) -> None:
    answer = told(capsys, "boundaries", "mathieu", "--certified", "--regions", "1,2")
    assert answer["error_kind"] == "bound" and max(max(row) for row in answer["error"]) < 1e-14


def test_crank_speeds_of_one_mode(capsys) -> None:
    answer = told(capsys, "boundaries", RIG, "--regions", "2:4")
    system = el.load_scene(RIG).system()
    speeds = el.speed_boundaries(system, speed_range=(40.0, 200.0))
    for row in (answer["lower"], answer["upper"]):
        for (lam2,) in row:
            speed = answer["natural_frequency"] / math.sqrt(lam2)
            assert min(abs(speeds.speed - speed)) < 1e-9 * speed
    printed = shown(capsys, "boundaries", RIG, "--regions", "2:4")
    assert "natural frequency 1560 rpm" in printed


def test_all_regions_of_several_modes(capsys, tmp_path) -> None:
    picture = tmp_path / "edges.png"
    given = ("boundaries", RIG, "--set", "model.modes=2", "--speed", "740rpm:780rpm")
    printed = shown(capsys, *given, "--plot", picture)
    assert "region 4 of mode 1" in printed and "sum of 1 and 2" in printed
    assert picture.stat().st_size > 5000


def test_coefficients(capsys) -> None:
    series = told(capsys, "perturb", "mathieu", "--order", "4", "--regions", "0,1")["series"]
    # NIST DLMF 28.6.1, with a = 4 lam2 and q = 2 mu.
    assert series[0]["upper"][1] == pytest.approx(-0.5, abs=1e-15)
    assert series[0]["upper"][3] == pytest.approx(7 / 32, rel=1e-14)
    printed = shown(capsys, "perturb", "hill_example", "--regions", "1")
    assert "with damping K = 0.04 mu" in printed
    printed = shown(capsys, "perturb", RIG, "--order", "3", "--regions", "4")
    assert "mu multiplies all that changes with the crank angle" in printed


def test_formulas(capsys) -> None:
    text = shown(capsys, "perturb", "mathieu", "--order", "3", "--latex")
    assert text.count("{") == text.count("}") and r"B_{3} &= " in text
