"""``elastolink stabilise``: changes for people, numbers for programs, a picture, refusals."""

import re
from pathlib import Path

import pytest
from command_runs import refused, shown, told

COMMAND = ("stabilise", "smith_1972_5152_sixteenth_inch", "--speed", "740rpm:780rpm")


def test_changes_are_printed_drawn_and_told(capsys, tmp_path):
    command = (*COMMAND, "--change", "coupler.thickness", "--margin", "0.02")
    printed = shown(capsys, *command, "--plot", tmp_path / "sizes.png")
    assert (tmp_path / "sizes.png").stat().st_size > 3000
    assert printed.startswith("region 4 of mode 1 (752.87 to 769.07 rpm)")
    assert "ends at 725.18 rpm, 2 % away" in printed
    result = told(capsys, *command)
    assert len(result["changes"]) == 2 and result["passed"]
    for change in result["changes"]:
        stiffness = change["settings"]["coupler.bending_stiffness"]
        assert f"171.5 lbf*in**2 -> {stiffness}" in printed


def test_what_is_not_to_be_had_is_no_failure(capsys):
    printed = shown(
        capsys, *COMMAND, "--change", "links.crank", "--bounds", "links.crank=2.9in:3.1in"
    )
    assert "not to be had with links.crank alone from 2.9 in to 3.1 in: region 4" in printed


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (("--change", "links.rod"), "links.rod"),
        (("--bounds", "links.crank"), "--bounds"),
        (("--bounds", "links.crank=1in:2in"), "hold the present one"),
        (("--margin", "2 mm"), "--margin"),
        (("--stress", "-1 MPa"), "--stress"),
        (("--set", "model.formulation=inextensible"), "nonlinear"),
    ],
)
def test_an_unusable_option_is_one_line(capsys, more, words):
    assert words in refused(capsys, *COMMAND, *more)


def test_the_page_tells_what_the_command_does(capsys):
    page = (Path(__file__).parents[3] / "docs" / "stabilise.md").read_text()
    commands = re.findall(r"```console\n(elastolink .*?)```", page, re.DOTALL)
    texts = re.findall(r"```text\n(.*?)```", page, re.DOTALL)
    assert len(commands) == len(texts) == 2
    for command, text in zip(commands, texts, strict=True):
        printed = shown(capsys, *command.split()[1:])
        for line in text.splitlines():
            assert line in printed or "marched" in line
