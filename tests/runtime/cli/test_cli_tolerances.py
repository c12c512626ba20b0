"""``elastolink tolerances``: its table against the function, JSON, pictures, one-line refusals."""

from __future__ import annotations

import json

import numpy as np
from elastolink.runtime.cli import main
from elastolink.runtime.linkages.length_tolerances import tolerances
from elastolink.runtime.scenes import load_scene

SCENE = "smith_1972_12_6_12_12"
WIDTHS = {"crank": 5e-5, "coupler": 1e-4}
GIVEN = ("--tolerance", "crank=0.05 mm", "--tolerance", "coupler=0.1 mm")


def run(*words):
    return main(["tolerances", *words])


def test_the_table_gives_the_worst_and_where(capsys) -> None:
    assert run(SCENE, *GIVEN, "--monte-carlo", "200") == 0
    printed = capsys.readouterr().out
    theta = np.radians(np.linspace(0.0, 360.0, 721))
    found = tolerances(load_scene(SCENE).mechanism(), WIDTHS, theta)
    for name in ("theta4", "alpha3"):
        row = found.place(name)
        top = int(np.argmax(found.worst_case[row]))
        line = next(line for line in printed.splitlines() if line.startswith(name))
        assert f"{found.worst_case[row, top]:.5g}" in line
        assert f"{np.degrees(theta[top]):.2f}" in line
        assert f"{found.root_sum_square[row].max():.5g}" in line
    assert "200 random linkages of 200" in printed
    assert printed.count("agrees: ") == 2


def test_forces_as_json(capsys) -> None:
    more = ("--forces", "--speed", "10", "--acceleration", "3", "--masses", "bars", "--json")
    given = (*GIVEN, "--tolerance", "coupler.mass=1 g", "--angles", "0:90:4deg")
    assert run(SCENE, *given, *more) == 0
    told = json.loads(capsys.readouterr().out)
    machine = load_scene(SCENE).machine()
    widths = {**WIDTHS, "coupler.mass": 1e-3}
    theta = np.radians([0.0, 30.0, 60.0, 90.0])
    found = tolerances(machine, widths, theta, 10.0, 3.0, masses="bars")
    assert told["outputs"][-1] == "shaking_moment"
    np.testing.assert_allclose(told["sensitivity"], found.sensitivity, rtol=1e-12, atol=1e-14)


def test_a_picture(tmp_path) -> None:
    path = tmp_path / "band.png"
    assert run(SCENE, *GIVEN, "--output", "omega4", "--plot", str(path)) == 0
    assert path.stat().st_size > 5000


def test_a_crank_that_only_rocks_stays_off_its_folds(capsys) -> None:
    assert run(SCENE, *GIVEN, "--set", "links.crank=14 in") == 0
    assert "theta4" in capsys.readouterr().out
