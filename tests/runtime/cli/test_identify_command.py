"""``elastolink identify``: a table for people, numbers for programs, a picture, refusals."""

import elastolink as el
import numpy as np
import pytest
from command_runs import refused, shown, told

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
        (("--unknown", "bending_stiffness", "--set", "model.formulation=inextensible"), "system"),
    ],
)
def test_an_unusable_option_is_one_line(capsys, measured, more, words):
    assert words in refused(capsys, "identify", SCENE, measured, *more)
    assert "none.csv" in refused(capsys, "identify", SCENE, measured.with_name("none.csv"), *more)
