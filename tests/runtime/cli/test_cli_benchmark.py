"""The command line of the benchmarks: problems, reports, the regression guard."""

from __future__ import annotations

import json

import pytest
from elastolink.runtime.cli import main

QUICK = ["benchmark", "hill-monodromy", "--methods", "magnus4", "--rounds", "1"]


def test_a_problem_is_told_level_by_level(capsys, tmp_path) -> None:
    """Every point, then the best of both at each level; a picture; ratios to compare with."""
    stored, picture = tmp_path / "ratios.json", tmp_path / "work.png"
    options = ["--peers", "solve_ivp DOP853", "--store", str(stored), "--plot", str(picture)]
    assert main([*QUICK, *options]) == 0
    out = capsys.readouterr().out
    assert "magnus4, fixed steps" in out
    assert "peer over ours" in out
    assert picture.stat().st_size > 10_000
    assert set(json.loads(stored.read_text())) == {"hill-monodromy"}


def test_a_fall_since_a_stored_run_is_status_1(capsys, tmp_path) -> None:
    """A file that claims a million times as much."""
    stored = tmp_path / "ratios.json"
    stored.write_text('{"hill-monodromy": {"1e-04": 1e9}}')
    options = ["--peers", "solve_ivp DOP853", "--compare", str(stored)]
    assert main([*QUICK, *options]) == 1
    assert "regression" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["benchmark", "hil"], "problems"),
        (["benchmark", "hill", "--peers", "matlab"], "peers"),
        (["benchmark", "hill", "--methods", "magnus5"], "methods"),
        (["benchmark", "hill", "--rounds", "0"], "rounds"),
        (["benchmark", "hill", "--compare", "nowhere.json"], "--compare"),
        (["benchmark", "forces", "--peers", "heyoka"], "--peers"),
        (["benchmark", "hill", "--store", "nowhere/ratios.txt", "--plot", "x.what"], "x.what"),
    ],
)
def test_bad_input_is_status_2_in_one_line(capsys, arguments, named) -> None:
    """Before anything is measured."""
    assert main(arguments) == 2
    told = capsys.readouterr().err
    assert named in told
    assert len(told.strip().splitlines()) == 1
