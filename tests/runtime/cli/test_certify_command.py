"""``elastolink certify``: what is proved in words and numbers, a picture, refusals, the page."""

import re
import sys
from pathlib import Path

import pytest
from command_runs import refused, shown, told

pytest.importorskip("flint")
SCENE = "smith_1972_5152_sixteenth_inch"
DAMPED = ("--set", "coupler.damping=0.1")


def test_a_range_is_proved_and_said_so(capsys, tmp_path):
    command = ("certify", SCENE, "--speed", "300:320rpm", *DAMPED)
    printed = shown(capsys, *command, "--plot", tmp_path / "proof.png")
    assert re.search(r"proved: stable from 300 to 320 rpm; .* at most 0\.\d+ of itself", printed)
    assert "not proved" not in printed and (tmp_path / "proof.png").stat().st_size > 5000
    result = told(capsys, *command)
    assert result["open"] == result["unstable"] == [] and 0.9 < result["bound"][0] < 1.0


def test_without_python_flint_it_says_what_to_install(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "flint", None)
    complaint = refused(capsys, "certify", SCENE, "--speed", "300:320rpm", *DAMPED)
    assert "python -m pip install python-flint" in complaint and "extra fast" in complaint


@pytest.mark.slow
def test_the_page_tells_what_the_command_does(capsys):
    page = (Path(__file__).parents[3] / "docs" / "certified_stability.md").read_text()
    command = re.search(r"```console\nelastolink (.*)\n```", page).group(1)
    output = re.search(r"```text\n(.*?)\n```", page, re.DOTALL).group(1)
    assert output in shown(capsys, *command.split())


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (("--speed", "300:320rpm"), "no damping"),
        (("--speed", "320:300rpm", *DAMPED), "--speed"),
        (("--speed", "300:320mm", *DAMPED), "--speed"),
        (("--speed", "300:320rpm", "--resolution", "-1 rpm", *DAMPED), "--resolution"),
        (("--speed", "300:320rpm", "--set", "model.modes=4", *DAMPED), "4 coordinates"),
        (("--speed", "300:320rpm", "--set", "model.formulation=inextensible"), "system"),
    ],
)
def test_refusals(capsys, more, words):
    assert words in refused(capsys, "certify", SCENE, *more)
