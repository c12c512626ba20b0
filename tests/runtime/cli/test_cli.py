"""The command line: what each subcommand prints, draws and returns, and how it refuses."""

import json
import os
import re
import subprocess
import sys
import warnings
from pathlib import Path
from types import SimpleNamespace

import elastolink as el
import numpy as np
import pandas
import pytest
from command_runs import refused, run, shown, told
from elastolink.runtime.cli import application, main, options
from elastolink.runtime.core.errors import LinearRangeWarning, SelfCheckFailed
from elastolink.runtime.core.results import Check, Result
from elastolink.runtime.scenes import list_scenes
from fresh_process import python

RIG = "smith_1972_5152_sixteenth_inch"
COMMANDS = re.findall(r"^    ([a-z][a-z-]+) ", application.build_parser().format_help(), re.M)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_a_worked_example_and_the_common_options(capsys, command):
    status, out, _ = run(capsys, command, "--help")
    assert status == 0
    assert f"example:\n  elastolink {command}" in out
    assert "--json" in out and ("--plot FILE" in out) == (command != "schema")


def test_help_and_scenes_load_nothing_heavy():
    code = (
        "import sys\n"
        "from elastolink.runtime.cli import main\n"
        "for arguments in (['--help'], ['scenes'], ['chart', '--help'], ['scenes', '--json']):\n"
        "    try: main(arguments)\n"
        "    except SystemExit: pass\n"
        "heavy = {'pint', 'matplotlib', 'scipy', 'sympy', 'numpy', 'jinja2'} & set(sys.modules)\n"
        "sys.exit(str(heavy) if heavy else 0)\n"
    )
    assert "chart mathieu" in python(code)


def test_the_version_also_without_the_script(capsys):
    assert shown(capsys, "--version").startswith("elastolink ")
    called = [sys.executable, "-m", "elastolink", "--version"]
    assert subprocess.check_output(called, text=True).startswith("elastolink ")


def test_scenes_lists_every_scene(capsys):
    names = list(list_scenes())
    assert [line.split()[0] for line in shown(capsys, "scenes").splitlines()] == names
    rows = told(capsys, "scenes")
    assert [row["name"] for row in rows] == names
    assert all(row["title"] and row["source"] for row in rows)
    assert len(shown(capsys, "scenes", "--long").splitlines()) == 2 * len(names)


def test_show_prints_si_values_and_json_with_what_is_set(capsys):
    pairs = ["links.crank=75 mm", "operation.speed_range=['1 rpm', '2 rpm']", "title=a = b"]
    given = [part for pair in [*pairs, "model.modes=2"] for part in ("--set", pair)]
    out = shown(capsys, "show", RIG, *given)
    assert "crank = 0.075 m" in out and "(1560 rpm)" in out
    table = told(capsys, "show", RIG, *given)
    assert table["links"]["crank"] == 0.075 and list(table) == sorted(table)
    assert table["title"] == "a = b" and table["model"]["modes"] == 2
    assert table["operation"]["speed_range"] == pytest.approx([np.pi / 30, np.pi / 15])


def test_every_problem_is_one_line(capsys):
    sets = ["--set", "links.crank=-1", "--set", "links.frame=3 kg", "--set", "model.modes=0"]
    status, out, err = run(capsys, "show", RIG, *sets)
    assert (status, out, len(err.splitlines())) == (2, "", 3)
    refused(capsys, "show", RIG, "--set", "links.crank=3\nx=1")


@pytest.mark.parametrize("ending", [".png", ".svg", ".pdf"])
def test_pictures_are_whole_and_the_same_bytes_each_time(capsys, tmp_path, ending):
    files = [tmp_path / f"{i}{ending}" for i in (1, 2)]
    for file in files:
        shown(capsys, "kinematics", "smith_1972_2122", "--plot", file)
    assert files[0].read_bytes() == files[1].read_bytes()
    assert sorted(tmp_path.iterdir()) == files


@pytest.mark.parametrize(
    "arguments",
    [pytest.param(["scenes"], marks=pytest.mark.slow), ["show", RIG], ["show", "mathieu"]],
)
def test_scenes_are_drawn(capsys, tmp_path, arguments):
    file = tmp_path / "scene.png"
    shown(capsys, *arguments, "--plot", file)
    assert file.read_bytes()[:4] == b"\x89PNG"


def test_an_unwritable_picture_is_refused_before_any_work(capsys, tmp_path, monkeypatch):
    monkeypatch.setattr(options, "load", lambda _: pytest.fail("work began"))
    for place in ("missing/chart.png", "chart.gif", "chart"):
        for command in ("show", "kinematics", "simulate", "stability", "chart"):
            refused(capsys, command, RIG, "--plot", tmp_path / place)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("where", ["before", "after"])
@pytest.mark.parametrize(
    ("error", "status", "words"),
    [
        (KeyboardInterrupt(), 130, "elastolink show: interrupted; no file is left half written\n"),
        (OSError(28, "No space left on device"), 2, "No space left"),
        (PermissionError(13, "Permission denied", "gallery"), 2, "Permission denied"),
        (SelfCheckFailed("the balance is off"), 2, "the balance is off"),
        (MemoryError(), 2, "memory"),
    ],
)
def test_what_stops_the_work_is_one_line_and_leaves_nothing_behind(
    capsys, tmp_path, monkeypatch, where, error, status, words
):
    def fail(*_):
        raise error

    target = (options, "load") if where == "before" else (Path, "replace")
    monkeypatch.setattr(*target, fail)
    found, out, err = run(capsys, "show", RIG, "--plot", tmp_path / "linkage.png")
    assert found == status and out == "" and words in err and len(err.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


def test_a_bug_keeps_its_traceback(monkeypatch):
    monkeypatch.setattr(options, "load", lambda _: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        main(["show", RIG])


def _result(value):
    return Result(
        method="a test",
        error=np.array([1e-12, np.nan]),
        error_norm="absolute",
        checks={"balance": Check(value, 1.0)},
    )


@pytest.mark.parametrize(("value", "status"), [(0.5, 0), (2.0, 1), (float("nan"), 1)])
def test_a_failed_self_check_gives_status_1(capsys, value, status):
    given = SimpleNamespace(command="chart", plot=None, save=None, json=False)
    assert options.finish(given, _result(value), ["found"]) == status
    out, err = capsys.readouterr()
    assert "error:  1e-12 (estimate; absolute)" in out and out.startswith("found\n")
    assert bool(err) == bool(status)
    given.json = True
    assert options.finish(given, _result(value), []) == status
    content = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert content["error"] == [1e-12, None] and content["passed"] is (status == 0)


def test_warnings_are_one_line_each(capsys, monkeypatch):
    def warn(_):
        warnings.warn("the step is too long", LinearRangeWarning, stacklevel=1)
        raise KeyboardInterrupt

    monkeypatch.setattr(options, "load", warn)
    _, _, err = run(capsys, "show", RIG)
    assert err.splitlines()[0] == "elastolink show: warning: the step is too long"


def test_the_module_folder_holds_for_one_command_only(capsys, monkeypatch, tmp_path):
    seen = []
    monkeypatch.setattr(
        options, "load", lambda _: seen.append(os.environ["ELASTOLINK_GENERATED"]) or {}["stop"]
    )
    monkeypatch.setenv("ELASTOLINK_GENERATED", "before")
    (tmp_path / "manifest.json").write_text("{}")
    with pytest.raises(KeyError):
        main(["show", RIG, "--modules", str(tmp_path)])
    assert seen == [str(tmp_path)] and os.environ["ELASTOLINK_GENERATED"] == "before"


def test_a_reader_that_leaves_early_is_no_error():
    piped = f"set -o pipefail; {sys.executable} -m elastolink show {RIG} | true"
    done = subprocess.run(["bash", "-c", piped], capture_output=True, text=True)
    assert "Traceback" not in done.stderr and "Exception" not in done.stderr


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("0:1:3", "dimensionless", [0.0, 0.5, 1.0]),
        ("0:90:3deg", "angle", [0.0, np.pi / 4, np.pi / 2]),
        ("60rpm:120rpm:2", "frequency", [2 * np.pi, 4 * np.pi]),
        ("1:2:2 Hz", "frequency", [2 * np.pi, 4 * np.pi]),
    ],
)
def test_values_of_an_axis(text, dimension, expected):
    assert options.values(text, dimension, "--x") == pytest.approx(expected)


def test_chart_draws_the_rig_and_lists_its_boundaries(capsys, tmp_path):
    file = tmp_path / "chart.png"
    small = ["--x", "speed=350:950:61rpm", "--y", "follower_inertia=0.0006:0.0022:31kg*m**2"]
    out = shown(capsys, "chart", RIG, *small, "--plot", file)
    assert file.read_bytes()[:4] == b"\x89PNG"
    rows = [line for line in out.splitlines() if line[:1].isdigit()]
    # Region 5 lies near 2/5 of 1560 rpm, from the observed 26 Hz (section 9.5.3).
    fifth = next(row for row in rows if row.startswith("5 "))
    assert float(fifth.split()[1]) == pytest.approx(624, rel=0.02)
    content = told(capsys, "chart", RIG, *small)
    assert np.shape(content["stable"]) == (31, 61) and content["error"] < 1e-9


def test_chart_of_a_hill_equation_starts_at_the_squares(capsys):
    arguments = ["--x", "lam2=0.1:5:41", "--y", "mu=0:1:21"]
    out = shown(capsys, "chart", "mathieu", *arguments)
    rows = [line.split() for line in out.splitlines() if line[:1].isdigit()]
    starts = {int(row[0]): float(row[1]) for row in rows}
    assert {n: starts[n] for n in (1, 2, 3, 4)} == {1: 0.25, 2: 1.0, 3: 2.25, 4: 4.0}


def test_stability_at_one_speed_and_over_a_range(capsys):
    out = shown(capsys, "stability", RIG, "--speed", "332 rpm")
    assert "stable at 34.767 rad/s (332 rpm)" in out
    out = shown(capsys, "stability", RIG, "--speed", "740:780:21rpm")
    assert "speeds stable; unstable ones:" in out and out.count("largest modulus") == 1
    assert "all 3 speeds stable" in shown(capsys, "stability", RIG, "--speed", "400:410:3rpm")
    assert "unstable at 1" in shown(capsys, "stability", "mathieu")
    for speed, stable in (("760 rpm", False), ("300 rpm", True)):
        found = told(capsys, "stability", RIG, "--speed", speed)
        assert found["stable"] is stable and (found["growth"] > 1e-6) is not stable


def test_simulate_from_rest_and_from_a_start(capsys, tmp_path):
    file = tmp_path / "wave.svg"
    out = shown(capsys, "simulate", RIG, "--revolutions", "1", "--plot", file)
    assert "status: the end was reached" in out
    assert file.read_bytes().startswith(b"<?xml")
    start = ("--initial", "1,0", "--revolutions", "1")
    assert told(capsys, "simulate", "mathieu", *start)["q"][0] == [1.0]
    refused(capsys, "simulate", RIG, "--method", "rk5")
    for text in ("1", "a,b", "1,nan", "1,2,3", ""):
        err = refused(capsys, "simulate", "mathieu", "--initial", text)
        assert "expected two finite numbers, such as 0.001,0" in err


def test_one_thread_unless_the_user_says_otherwise_and_the_time_taken(tmp_path):
    code = (
        "import os, sys, time\n"
        "from elastolink.runtime.cli import application\n"
        "from elastolink.runtime.core import progress\n"
        "progress._SILENCE = progress._BETWEEN = 0.01\n"
        "sys.stderr.isatty = lambda: True\n"
        "assert application.main(['scenes', '--json']) == 0\n"
        "with progress.time_taken():\n"
        "    time.sleep(0.5)\n"
        "print(os.environ.get('OPENBLAS_NUM_THREADS'), os.environ['OMP_NUM_THREADS'])\n"
    )
    for given, expected in (({}, "1 1"), ({"OMP_NUM_THREADS": "2"}, "None 2")):
        environment = {k: v for k, v in os.environ.items() if not k.endswith("_NUM_THREADS")}
        done = subprocess.run(
            [sys.executable, "-c", code],
            env={**environment, **given},
            capture_output=True,
            text=True,
            check=True,
        )
        assert done.stdout.splitlines()[-1] == expected
        assert "0 s" in done.stderr


@pytest.mark.parametrize(
    "words",
    [
        ("forces", "slider_crank_example", "--speed", "1000 rpm"),
        ("stability", "smith_1972_5152_sixteenth_inch", "--speed", "300:320:3rpm"),
        ("clearance", "smith_1972_10_8_10_10", "--clearance", "0.1 mm"),
    ],
)
def test_what_is_saved_comes_back(words, capsys, tmp_path):
    table, kept = tmp_path / "kept.csv", tmp_path / "kept.npz"
    shown(capsys, *words, "--save", table)
    said = told(capsys, *words, "--save", kept)
    loaded = el.load(kept)
    assert {**loaded.to_dict(), "passed": loaded.passed}.items() <= said.items()
    rows = pandas.read_csv(table)
    assert 1 < len(rows) <= max(np.size(array) for array in loaded.arrays().values())


def test_what_cannot_be_saved_is_refused_first(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for words, why in (
        (("forces", "nowhere", "--save", "a.txt"), "an ending of"),
        (("forces", "nowhere", "--save", "nowhere/a.csv"), "a writable folder"),
        (("show", "mathieu", "--save", "a.csv"), "unrecognized arguments"),
    ):
        assert why in refused(capsys, *words)
    assert list(tmp_path.iterdir()) == []
