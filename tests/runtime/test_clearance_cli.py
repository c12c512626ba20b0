"""``elastolink clearance``: table, extremes, several curves, refusals."""

from __future__ import annotations

import argparse
import json

import pytest
from elastolink.runtime.cli import clearance
from elastolink.runtime.errors import BadInput

SCENE = "smith_1972_10_8_10_10"


def run(*arguments):
    """Run the subcommand alone and return its status."""
    parser = argparse.ArgumentParser()
    clearance.add(parser.add_subparsers())
    options = parser.parse_args(["clearance", *map(str, arguments)])
    return options.run(options)


def test_table_and_extremes(capsys):
    assert run(SCENE, "--clearance", "0.1 in", "--angles", "0:180:3deg") == 0
    out = capsys.readouterr().out
    first = out.splitlines()[1].split()
    # 0.0503 rad by trial (the ledger of Smith's chapter 3).
    assert first[0] == "0.0000" and float(first[4]) == pytest.approx(2.88, abs=0.005)
    assert "greatest" in out and "least" in out and "check:" in out


@pytest.mark.parametrize(
    ("scene", "unit"),
    [(SCENE, "deg"), ("slider_crank_example", "m"), ("quick_return_example", "deg")],
)
def test_every_linkage(capsys, scene, unit):
    assert run(scene, "--at", "23=0.05 mm", "--at", "41=0.1 mm") == 0
    out = capsys.readouterr().out
    assert f"width [{unit}]" in out and "23: 5e-05 m, 41: 0.0001 m" in out


def test_json_and_picture_of_several(capsys, tmp_path):
    file = tmp_path / "play.svg"
    sizes = ("--clearance", "0.1 in", "--clearance", "0.5 in")
    assert run(SCENE, *sizes, "--joint", "23", "--json", "--plot", file) == 0
    told = json.loads(capsys.readouterr().out)["ranges"]
    assert [sorted(item["clearances"]) for item in told] == [["23"], ["23"]]
    assert told[1]["greatest"]["width"] > 5 * told[0]["greatest"]["width"]
    assert file.read_text().startswith("<?xml")


def test_a_fold_is_told(capsys):
    assert run(SCENE, "--set", "links.coupler=4 in", "--clearance", "0.1 in") == 0
    out = capsys.readouterr().out
    assert "folds" in out and "nan" not in out


@pytest.mark.parametrize(
    "arguments",
    [
        (),
        ("--clearance", "-1 mm"),
        ("--clearance", "1 s"),
        ("--at", "55=1 mm"),
        ("--at", "23"),
        ("--at", "23=1 mm", "--joint", "34"),
        ("--clearance", "1 mm", "--link", "rod"),
    ],
)
def test_refusals(arguments):
    with pytest.raises(BadInput):
        run(SCENE, *arguments)
