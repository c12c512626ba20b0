"""``elastolink identify``: a table for people, numbers for programs, a picture, refusals.

And measured points beside what is computed in other pictures.
"""

import re
from pathlib import Path

import elastolink as el
import numpy as np
import pytest
from command_runs import refused, shown, told
from elastolink.runtime.core.plotting import new_figure
from elastolink.runtime.design import Point, draw_points

SCENE = "smith_1972_5152_sixteenth_inch"


@pytest.fixture
def measured(tmp_path):
    """Return a file with the computed ends of the region at 760 rpm, of a stiffer coupler."""
    system = el.load_scene(SCENE).system()
    stiffer = 1.02 * system.parameters["bending_stiffness"]
    edges = el.stability_edges(system, (74.0, 85.0), bending_stiffness=stiffer)
    path = tmp_path / "points.csv"
    rows = (
        f"unstable from, {edges.lower[-1]:.12g}, 0.1",
        f"unstable to, {edges.upper[-1]:.12g}, 0.1",
    )
    path.write_text("\n".join(("kind, speed [rad/s], speed deviation [rad/s]", *rows)))
    return path


def test_a_stiffness_is_fitted_printed_and_drawn(capsys, measured, tmp_path):
    command = ("identify", SCENE, measured, "--unknown", "bending_stiffness")
    printed = shown(capsys, *command, "--plot", tmp_path / "residuals.png")
    assert (tmp_path / "residuals.png").stat().st_size > 5000
    result = told(capsys, *command)
    start = el.load_scene(SCENE).system().parameters["bending_stiffness"]
    assert np.array(result["value"]) == pytest.approx([1.02 * start], rel=1e-6)
    assert f"{result['value'][0]:.7g}" in printed and "not decided" not in printed
    assert "unstable from" in printed and "standard error" in printed


def test_what_a_file_does_not_decide_is_said(capsys, measured):
    lines = measured.read_text().splitlines()
    measured.write_text("\n".join(lines[:2]))
    both = ("--unknown", "bending_stiffness", "--unknown", "follower_inertia")
    printed = shown(capsys, "identify", SCENE, measured, *both)
    assert "follower_inertia, bending_stiffness are not decided" in printed


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ((), "unknown"),
        (("--unknown", "mass"), "'mass'"),
        (("--unknown", "damping"), "above 0 to start from"),
        (("--unknown", "bending_stiffness", "--window", "15 mm"), "--window"),
        (
            ("--unknown", "bending_stiffness", "--set", "model.formulation=inextensible"),
            "expected a computed one within 15 % of the speed",
        ),
    ],
)
def test_an_unusable_option_is_one_line(capsys, measured, more, words):
    assert words in refused(capsys, "identify", SCENE, measured, *more)
    assert "none.csv" in refused(capsys, "identify", SCENE, measured.with_name("none.csv"), *more)


def test_the_page_of_measured_points_tells_what_the_command_does(capsys, tmp_path):
    """Its file, command, table, and what one point alone does not decide."""
    page = (Path(__file__).parents[3] / "docs" / "measured_points.md").read_text()
    blocks = dict(re.findall(r"```(csv|console)\n(.*?)```", page, re.DOTALL))
    table, words = re.findall(r"```text\n(.*?)```", page, re.DOTALL)
    path = tmp_path / "points.csv"
    path.write_text(blocks["csv"])
    command = [path if text == path.name else text for text in blocks["console"].split()[1:]]
    printed = shown(capsys, *command).splitlines()
    for line, told_line in zip(printed, table.splitlines(), strict=False):
        numbers, known = line.split(), told_line.split()
        assert numbers[0] == known[0]
        if numbers[0] != "fitted":
            assert [*map(float, numbers[1:])] == pytest.approx([*map(float, known[1:])], rel=0.02)
            assert float(numbers[1]) == pytest.approx(float(known[1]), rel=1e-5)
    path.write_text("\n".join(blocks["csv"].splitlines()[:3]))
    assert " ".join(words.split()) in " ".join(shown(capsys, *command).split())


CHART = ("chart", SCENE, "--x", "speed=700:800:9rpm", "--y", "follower_inertia=0.0006:0.001:5")
RESPONSE = ("response", "smith_1972_101104_thirtysecond_inch")


@pytest.mark.parametrize(
    ("unknown", "words"),
    [
        ([], "unknown: found nothing; expected at least one parameter; give --unknown NAME"),
        (["--unknown", "coupler.bending_stiffness"], "; did you mean bending_stiffness?"),
        (["--unknown", "follower.inertia"], "; did you mean follower_inertia?"),
        (["--unknown", "mass_per_length"] * 2, "different names; name each once"),
    ],
)
def test_unknowns_that_are_refused(capsys, measured, unknown, words):
    assert words in refused(capsys, "identify", SCENE, measured, *unknown)


@pytest.mark.parametrize("command", [CHART, (*RESPONSE, "--speed", "300:310rpm")])
def test_measured_points_stand_in_pictures_over_the_speed(capsys, measured, tmp_path, command):
    """At their speeds in rpm, each with its kind; the file was written with rad/s."""
    path = tmp_path / "picture.svg"
    shown(capsys, *command, "--plot", path)
    alone = path.read_text()
    shown(capsys, *command, "--plot", path, "--points", measured)
    assert alone.count("measured: unstable") == 0
    assert path.read_text().count("measured: unstable") >= 2


def test_the_lines_of_points_are_where_they_were_measured():
    ax = new_figure().add_subplot()
    draw_points(ax, [Point("resonance", 10.0 * np.pi, deviation=np.pi / 15.0)])
    (line,), (band,) = ax.lines, ax.patches
    assert list(line.get_xdata()) == pytest.approx([300.0, 300.0], rel=1e-14)
    assert band.get_x() == pytest.approx(296.0) and band.get_width() == pytest.approx(8.0)


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (CHART, "no --plot"),
        (
            (*CHART[:2], "--x", "mass_per_length=0.08:0.1:3", *CHART[4:], "--plot", "{}"),
            "over mass",
        ),
        (
            (*RESPONSE, "--speed", "300rpm", "--in", "damping=0.1:0.2", "--plot", "{}"),
            "over a para",
        ),
    ],
)
def test_points_have_no_place_in_other_pictures(capsys, measured, tmp_path, command, words):
    path = str(tmp_path / "picture.png")
    given = [text.format(path) for text in command]
    assert words in refused(capsys, *given, "--points", measured)
