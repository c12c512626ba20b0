"""``elastolink diagnose``: words for people, numbers for programs, a picture, refusals."""

import re
import shlex
from pathlib import Path

import elastolink as el
import numpy as np
import pytest
from command_runs import refused, shown, told

SCENE = "smith_1972_5152_sixteenth_inch"


def test_a_diagnosis_is_printed_and_drawn(capsys, tmp_path):
    command = ("diagnose", SCENE, "--speed", "765 rpm")
    printed = shown(capsys, *command, "--plot", tmp_path / "near.png")
    assert (tmp_path / "near.png").stat().st_size > 5000
    assert "at 765 rpm is unstable" in printed and "with one of" in printed
    result = told(capsys, *command)
    found = el.floquet_multipliers(el.load_scene(SCENE).system(), 765.0 * np.pi / 30.0)
    assert result["growth"] == pytest.approx(float(np.log(np.abs(found.multipliers[0]))), rel=1e-6)
    assert result["stable"] is False
    assert result["nearest"]["region"][0] == "region 4 of mode 1"


def test_the_page_of_diagnoses_tells_what_the_command_does(capsys):
    page = (Path(__file__).parents[3] / "docs" / "diagnosis.md").read_text()
    commands = [line for line in page.splitlines() if line.startswith("elastolink diagnose")]
    outputs = page.split("```text\n")[1:]
    assert len(commands) == len(outputs) == 3
    for line, block in zip(commands, outputs, strict=True):
        words = line.replace("'765 rpm'", "765rpm").replace("'700 rpm'", "700rpm").split()[1:]
        printed = shown(capsys, *words)
        for wanted in block.split("```")[0].strip().splitlines():
            assert wanted in printed


def test_what_is_advised_works_when_it_is_pasted(capsys, tmp_path):
    path = tmp_path / "my own.toml"
    path.write_text(shown(capsys, "new", "coupler"))
    command = ("diagnose", path, "--speed", "766 rpm", "--set", "coupler.damping_ratio=0.001")
    printed = shown(capsys, *command)
    advised = re.findall(r"elastolink (response .*|stabilise .*rpm)", printed)
    assert [words.split()[0] for words in advised] == ["response", "stabilise"]
    assert all("--set=coupler.damping_ratio=0.001" in words for words in advised)
    assert "points on" in shown(capsys, *shlex.split(advised[0]))
    assert printed.startswith("\n".join(told(capsys, *command)["lines"]))


def test_a_region_wider_than_the_window_is_told(capsys, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(shown(capsys, "new", "coupler"))
    printed = shown(capsys, "diagnose", path, "--speed", "1200 rpm")
    assert "unstable: disturbances grow" in printed and "no unstable region" not in printed
    assert "so narrow" not in printed
    advised = re.search(r"reaches far beyond 840 to 1560 rpm: elastolink (.*)", printed).group(1)
    assert "region 1 of mode 1" in shown(capsys, *shlex.split(advised))


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (("--speed", "0 rpm"), "--speed"),
        (("--speed", "765 rpm", "--window", "2"), "window"),
        (("--speed", "765 rpm", "--set", "model.formulation=inextensible"), "linear formulation"),
    ],
)
def test_an_unusable_option_is_one_line(capsys, more, words):
    assert words in refused(capsys, "diagnose", SCENE, *more)
