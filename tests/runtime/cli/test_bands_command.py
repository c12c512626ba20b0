"""``elastolink tolerance-bands``: a table for people, numbers for programs, a picture, refusals."""

import re
from pathlib import Path

import elastolink as el
import numpy as np
import pytest
from command_runs import refused, shown, told

SCENE = "smith_1972_12_6_12_12"
COUPLER = ("--set", "links.coupler=304.8 mm +- 0.1 mm")
COMMAND = ("tolerance-bands", SCENE, "--of", "forces", "--at", "0:350:8deg", "--trials", "4")


def test_a_table_numbers_and_a_picture(capsys, tmp_path):
    more = (*COUPLER, "--set", "deviations.crank.weight=1 %")
    path = tmp_path / "bands.png"
    printed = shown(capsys, *COMMAND, *more, "--row", "torque", "--plot", path)
    assert path.stat().st_size > 5000
    for words in ("worst case from", "95 of 100 from", "torque [N m]", "links.coupler [%]", "held"):
        assert words in printed
    result = told(capsys, *COMMAND, *more)
    assert result["numbers"] == ["links.coupler", "crank.weight"] and result["passed"]
    assert result["half_width"][0] == pytest.approx(1e-4) and result["deviation"][0] is None
    assert np.degrees(result["place"]) == pytest.approx(50.0 * np.arange(8))
    row = result["rows"].index("torque")
    lower, value, upper = (np.array(result[k][row]) for k in ("lower", "value", "upper"))
    assert np.all((lower < value) & (value < upper))


def test_speeds_of_edges(capsys):
    command = ("tolerance-bands", "smith_1972_5152_sixteenth_inch", "--of", "edges")
    more = ("--at", "700:800:2rpm", "--set", "coupler.natural_frequency=26 Hz +- 1 %")
    printed = shown(capsys, *command, *more, "--trials", "1")
    assert "from region 4 of mode 1 [rad/s]" in printed and "100.0" in printed


def test_show_tells_half_widths(capsys):
    assert "coupler = 0.3048 m +- 0.0001" in shown(capsys, "show", SCENE, *COUPLER)
    widths = told(capsys, "show", SCENE, *COUPLER)["tolerances"]
    assert widths == {"links.coupler": pytest.approx(1e-4)}


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ((), "no tolerance"),
        ((*COUPLER, "--at", "0:1"), "--at"),
        ((*COUPLER, "--over", "mass"), "--over"),
        ((*COUPLER, "--row", "nothing", "--plot", "x.png"), "one of"),
        ((*COUPLER, "--trials", "0"), "trials"),
        (("--set", "links.coupler=304.8 mm +- x"), "links.coupler"),
    ],
)
def test_refusals(capsys, more, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert words in refused(capsys, *COMMAND, *more)


def test_the_page_of_tolerances_tells_what_is_read_and_printed(capsys, tmp_path):
    page = (Path(__file__).parents[3] / "docs" / "tolerances.md").read_text()
    blocks = dict(re.findall(r"```(toml|console|text)\n(.*?)```", page, re.DOTALL))
    path = tmp_path / "own.toml"
    path.write_text(
        '[model]\nmechanism = "four_bar"\nflexible = ["coupler"]\nformulation = "complete"\n'
        + blocks["toml"]
        .replace("[links]", "[links]\nframe = '15 in'\nfollower = '6 in'")
        .replace("[coupler]", "[coupler]\nnatural_frequency = '26 Hz'")
        + "[follower]\ninertia = '655e-6 kg*m**2'\n"
    )
    scene = el.load_scene(path)
    assert set(scene.tolerances) == {"links.coupler", "links.crank", "coupler.bending_stiffness"}
    assert scene.deviations["links.frame"] == pytest.approx(3e-5)
    printed = shown(capsys, *blocks["console"].split()[1:]).splitlines()
    words = [" ".join(line.split()) for line in printed]
    for line in blocks["text"].splitlines():
        known = " ".join(line.split())
        if line.startswith(("error", "check")):  # round-off may differ
            known = known.rpartition(":")[0]
        assert any(one.startswith(known) for one in words)
