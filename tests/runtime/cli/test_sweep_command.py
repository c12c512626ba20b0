"""``elastolink sweep``: designs over numbers of a scene, a table of them, stores, refusals."""

import csv
import json
from itertools import product

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.scenes import with_numbers

CHANGES = {"coupler.mass_per_length": 0.0853, "coupler.damping_ratio": 0.05}
SCENE = "smith_1972_5152_sixteenth_inch"
WORDS = ["sweep", SCENE, *(f"--set={key}={value}" for key, value in CHANGES.items())]
OVER = ["--over", "links.coupler=0.36:0.45:2 m", "--over", "links.follower=80:200:4mm"]


def test_designs_in_a_table_the_failed_ones_with_their_errors(tmp_path, capsys):
    table, picture = tmp_path / "designs.csv", tmp_path / "designs.png"
    words = [*WORDS, *OVER, "--speed", "25", "--save", str(table), "--plot", str(picture)]
    assert main(words) == 0
    told = capsys.readouterr()
    assert "8 designs, 3 of them failed" in told.out
    assert told.err.count("points failed") == 1
    rows = list(csv.DictReader(table.read_text().splitlines()))
    assert len(rows) == 8 and picture.stat().st_size > 0
    scene, peaks = el.load_scene(SCENE, CHANGES), {}
    for row in rows:
        keys = ("links.coupler", "links.follower")
        numbers = {key: float(row[f"axis_{key} [m]"]) for key in keys}
        if row["failure"]:
            assert numbers["links.follower"] < 0.13 and row["peak [m]"] == "nan"
            assert "the crank cannot turn fully" in row["failure"]
            continue
        peak = float(el.steady_state(with_numbers(scene, numbers).system(), 25.0).peak())
        assert float(row["peak [m]"]) == pytest.approx(peak, rel=1e-9)
        peaks[peak] = ", ".join(f"{key} {value:.6g} m" for key, value in numbers.items())
    assert len(peaks) == 5
    assert f"3 failed, the first: {rows[0]['failure']}" in told.out
    assert f"least peak: {min(peaks):.6g} m at {peaks[min(peaks)]}" in told.out
    assert f"greatest peak: {max(peaks):.6g} m at {peaks[max(peaks)]}" in told.out


def test_stability_over_speeds_and_lengths_from_a_store(tmp_path, capsys):
    words = [*WORDS, "--of", "floquet_multipliers", "--over", "speed=300:340:3rpm"]
    words += ["--over", "links.crank=60:76:2mm", "--store", str(tmp_path / "kept")]
    assert main([*words, "--estimate"]) == 0
    assert "6 points in 1 pieces" in capsys.readouterr().out
    assert not (tmp_path / "kept").exists()
    assert main(words) == 0
    said = capsys.readouterr().out
    assert "6 stable" in said
    scene = el.load_scene(SCENE, CHANGES)
    most = max(
        el.design.diagnose(with_numbers(scene, {"links.crank": crank}), speed * np.pi / 30.0).growth
        for speed, crank in product((300.0, 320.0, 340.0), (0.06, 0.076))
    )
    assert f"greatest growth: {most:.6g} per turn at speed " in said
    assert main([*words, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["resumed"] == told["pieces"] == 1
    assert told["outputs"]["growth"]["shape"] == [3, 2]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "--over: found nothing"),
        (["--over", "links.cuopler=1:2:3"], "did you mean links.coupler"),
        (["--over", "links.coupler"], "KEY=START:STOP:COUNT"),
        (["--over", "operation.speed=1:2:3"], "operation.speed"),
        ([*OVER, *OVER], "links.coupler twice"),
        (["--over", "speed=30:40:3", "--speed", "35"], "a speed that is not swept"),
        ([*OVER, "--save", "designs.txt"], "an ending of"),
        ([*OVER, "--workers", "0"], "--workers"),
        ([*OVER, "--speed", "25", "--plot", "a.png", "--output", "growth"], "growth"),
    ],
)
def test_wrong_words_are_refused(words, told, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main([*WORDS, *words]) == 2
    said = capsys.readouterr().err
    assert told in said and "Traceback" not in said
    assert not list(tmp_path.iterdir())
