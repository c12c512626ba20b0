"""Ranges that ``chart``, ``boundaries`` and ``stability`` choose where a scene gives none."""

import math

import numpy as np
import pytest
from command_runs import refused, shown, told
from elastolink.runtime.scenes import list_scenes, load_scene
from elastolink.runtime.scenes.writing import toml_text

RIG = "smith_1972_5152_sixteenth_inch"
ROD = "beale_1992_flexible_rod"
# Slow machines: their modes are far above the speed that they run at.
SLOW = ("beale_1992_bahgat_willmert",)
SCENES = [pytest.param(n, marks=[pytest.mark.slow] * (n in SLOW)) for n in list_scenes()]
RIGID, FRAME, BEAMS = "in which nothing vibrates", "a frame, which has no crank", "at most"


@pytest.fixture
def bare(tmp_path):
    """Return a function that writes a scene without ranges, of one mode, with changes."""

    def write(name, changes=None):
        document = dict(load_scene(name, changes).document)
        document["operation"] = {**document.get("operation", {})}
        document["operation"].pop("speed_range", None)
        document.pop("measured", None)
        if document.pop("chart", None):
            document["chart"] = {"x_points": 41, "y_points": 31}
        if not document["operation"]:
            del document["operation"]
        if document["model"].get("flexible") == ["rod"]:
            document["model"] = {**document["model"], "modes": 1}
        path = tmp_path / "bare.toml"
        path.write_text(toml_text(document), "utf-8")
        return path

    return write


def kind_of(name):
    """Return why a chart of a scene is refused, or nothing."""
    model = load_scene(name).model
    if model["mechanism"] == "frame":
        return FRAME
    if model["formulation"] == "kinematics":
        return RIGID
    return BEAMS if model["formulation"] == "cubic_beams" else ""


@pytest.mark.parametrize("name", SCENES)
def test_a_chart_without_ranges_is_around_the_scene_or_says_why_not(capsys, bare, name):
    path, reason = bare(name), kind_of(name)
    if reason:
        assert reason in refused(capsys, "chart", path)
        return
    lines = shown(capsys, "chart", path).splitlines()
    chosen = [line.partition(" ")[0] for line in lines if ", chosen: 0.5 to 1.5 times" in line]
    found = told(capsys, "chart", path)
    assert chosen == [found["x_name"], found["y_name"]] == lines[2].partition(":")[0].split(" x ")
    scene = load_scene(path)
    pairs = {
        "speed": "operation.speed",
        "follower_inertia": "follower.inertia",
        "crank_ratio": "links.crank_ratio",
        "lam2": "parameters.lam2",
        "mu": "parameters.mu",
    }
    for axis in ("x", "y"):
        value = scene.get(pairs[found[f"{axis}_name"]])
        ends = found[axis][0], found[axis][-1]
        assert ends == pytest.approx((0.5 * value, 1.5 * value), rel=1e-12)


@pytest.mark.parametrize("name", SCENES)
def test_boundaries_without_ranges(capsys, bare, name):
    path, reason = bare(name), kind_of(name)
    if reason:
        assert reason in refused(capsys, "boundaries", path)
        return
    out = shown(capsys, "boundaries", path)
    assert (", chosen: 0.5 to 1.5 times operation.speed in the scene" in out) == ("beale" in name)


@pytest.mark.parametrize("name", SCENES)
def test_stability_without_ranges_is_that_of_the_one_speed(capsys, bare, name):
    path, reason = bare(name), kind_of(name)
    if reason in {RIGID, FRAME}:
        assert reason in refused(capsys, "stability", path)
        return
    found = told(capsys, "stability", path)
    assert found["speed"] == load_scene(path).get("operation.speed", 1.0)


def test_boundaries_of_several_modes_find_what_lies_around_the_speed(capsys, bare):
    path = bare(RIG, {"model.modes": 2, "operation.speed": "700 rpm"})
    speeds = np.array([350.0, 1050.0]) * math.pi / 30.0
    found = told(capsys, "boundaries", path)
    assert found["speed_range"] == pytest.approx(speeds.tolist())
    named = told(capsys, "boundaries", path, "--speed", "350:1050rpm")
    assert len(found["lower"]) > 3 and found["lower"] == pytest.approx(named["lower"], rel=1e-12)


def test_boundaries_of_a_rod_lie_in_the_upper_half_of_its_chart(capsys):
    change = ["--set", "model.modes=1"]
    found = told(capsys, "boundaries", ROD, *change)
    assert found["speed_range"] == [2250.0, 4000.0]
    assert "the upper half of chart.x_range" in shown(capsys, "boundaries", ROD, *change)


def test_the_other_axis_is_not_chosen_twice(capsys, bare):
    given = ["--x", "follower_inertia=0.0004:0.001:21kg*m**2"]
    found = told(capsys, "chart", bare(RIG), *given)
    assert (found["x_name"], found["y_name"]) == ("follower_inertia", "speed")
    assert "chosen" not in shown(capsys, "chart", RIG)


def test_without_a_speed_the_range_is_gone_through(capsys, bare, tmp_path):
    document = dict(load_scene(RIG).document)
    document["operation"] = {"speed_range": ["100 rpm", "900 rpm"]}
    path = tmp_path / "ranged.toml"
    path.write_text(toml_text(document), "utf-8")
    assert "61 speeds, chosen: operation.speed_range" in shown(capsys, "stability", path)
    speeds = np.array(told(capsys, "stability", path)["speed"]) * 30.0 / math.pi
    assert speeds.tolist() == pytest.approx(np.linspace(100.0, 900.0, 61).tolist())
    nothing = bare(RIG, {"operation.speed": None})
    assert "--speed: found nothing" in refused(capsys, "stability", nothing)
    assert "--speed: found nothing" in refused(
        capsys, "boundaries", nothing, "--set", "model.modes=2"
    )
    assert "or operation.speed" in refused(capsys, "chart", nothing)
