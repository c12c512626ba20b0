"""``elastolink clearance``: text, JSON, several curves in one picture, refusals."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.linkages.clearance import clearance_range
from elastolink.runtime.scenes import load_scene

SCENE = "smith_1972_10_8_10_10"


def run(*words):
    return main(["clearance", *words])


def test_text_names_extremes(capsys):
    assert run(SCENE, "--clearance", "0.1 in") == 0
    text = capsys.readouterr().out
    # Smith's linkage at theta2 = 0: sin mu = 0.198997, c / (l4 sin mu) = 0.0503 rad = 2.88 deg.
    (greatest,) = (line.split() for line in text.splitlines() if line.startswith("greatest"))
    assert float(greatest[1]) == 0.0
    assert float(greatest[2]) == pytest.approx(2.8795, abs=5e-5)
    assert "method:" in text and "error:" in text


@pytest.mark.parametrize(
    ("scene", "unit"),
    [(SCENE, "deg"), ("slider_crank_example", "m"), ("quick_return_example", "deg")],
)
def test_every_linkage(capsys, scene, unit):
    assert run(scene, "--at", "23=0.05 mm", "--at", "41=0.1 mm") == 0
    out = capsys.readouterr().out
    assert f"width [{unit}]" in out and "23: 5e-05 m, 41: 0.0001 m" in out


def test_json_is_the_result(capsys):
    assert (
        run(SCENE, "--clearance", "0.1 in", "--joint", "23", "--angles", "0:90:4deg", "--json") == 0
    )
    told = json.loads(capsys.readouterr().out)
    angles = np.radians([0.0, 30.0, 60.0, 90.0])
    expected = clearance_range(load_scene(SCENE).mechanism(), 0.00254, angles, joint="23")
    assert told["width"] == pytest.approx(expected.width.tolist(), rel=1e-14)
    assert told["clearances"] == {"23": 0.00254}
    assert told["passed"]


def test_several_joints_add(capsys):
    assert run(SCENE, "--at", "23=0.04 in", "--at", "41=0.06 in", "--json") == 0
    together = json.loads(capsys.readouterr().out)
    assert run(SCENE, "--clearance", "0.1 in", "--json") == 0
    alone = json.loads(capsys.readouterr().out)
    assert together["width"] == pytest.approx(alone["width"], rel=1e-13)


def test_several_clearances_share_a_picture(capsys, tmp_path):
    path = tmp_path / "fig10.svg"
    sizes = ("--clearance", "0.1 in", "--clearance", "0.5 in")
    assert run(SCENE, *sizes, "--plot", str(path)) == 0
    assert "<svg" in path.read_text()
    assert capsys.readouterr().out.count("greatest") == 2
    assert run(SCENE, *sizes, "--json") == 0
    first, second = json.loads(capsys.readouterr().out)["ranges"]
    assert second["greatest"]["width"] > 4 * first["greatest"]["width"]


def test_a_fold_is_told(capsys):
    # Coupler and follower 0.02 in longer than frame and crank together: in line at 180 deg.
    lengths = ("frame=3 in", "crank=1 in", "coupler=2.02 in", "follower=2 in")
    words = [word for text in lengths for word in ("--set", f"links.{text}")]
    assert run(SCENE, *words, "--clearance", "0.1 in") == 0
    assert "other assembly" in capsys.readouterr().out
    assert run(SCENE, *words, "--clearance", "0.001 in") == 0
    assert "other assembly" not in capsys.readouterr().out


def test_slider_in_metres(capsys):
    assert run("slider_crank_example", "--clearance", "0.1 mm") == 0
    text = capsys.readouterr().out
    assert "slider" in text and "width [m]" in text
    (least,) = (line.split() for line in text.splitlines() if line.startswith("least"))
    # In line with the guide the whole clearance goes into the slider's movement.
    assert float(least[2]) == pytest.approx(1e-4, rel=1e-4)
    assert math.isclose(float(least[1]) % 180.0, 0.0, abs_tol=1e-9)
