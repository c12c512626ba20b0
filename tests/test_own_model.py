"""The worked example of a user's own mechanism: its page runs, its numbers are found by hand."""

import json
import os
import re
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import elastolink as el
import numpy as np
import pytest
from elastolink.derive.regenerate import main
from straight_rod import DAMPING, EI, MU, ROD, projected

DOCS = Path(__file__).parents[1] / "docs"
EXAMPLE = DOCS / "examples"
FILES = ("slider_crank_rod.py", "slider_crank_rod.toml")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a working folder with the example's files and its emitted module."""
    place = tmp_path_factory.mktemp("example")
    for name in FILES:
        shutil.copy(EXAMPLE / name, place)
    assert main(["--model", str(place / FILES[0]), "--out", str(place / "modules")]) == 0
    return place


@pytest.mark.parametrize(("modes", "slider"), [(1, 0.0), (3, 0.2), (6, 3.0)])
def test_the_emitted_arrays_are_those_of_the_hand_derivation(folder, monkeypatch, modes, slider):
    monkeypatch.setenv("ELASTOLINK_GENERATED", str(folder / "modules"))
    changes = {"model.modes": modes, "slider.slider_mass": slider}
    system = el.load_scene(folder / FILES[1], overrides=changes).system()
    theta = np.random.default_rng(5).uniform(-7.0, 7.0, 20)
    hand = [projected(angle, modes, slider) for angle in theta]
    assert not system.has("A")
    softening, load = np.array([h for h, _ in hand]), np.array([f for _, f in hand])
    size = np.abs(softening).max()  # quadrature rounds relative to the largest entry
    assert -system.array("B", theta) == pytest.approx(softening, rel=0.0, abs=1e-13 * size)
    assert system.array("f", theta) == pytest.approx(load, rel=0.0, abs=1e-13)
    wave = np.arange(1, modes + 1) * np.pi / ROD
    assert system.array("M", theta)[0] == pytest.approx(np.eye(modes), abs=0)
    assert system.array("K", theta)[0] == pytest.approx(np.diag(EI * wave**4 / MU), rel=1e-14)
    assert system.array("C", theta)[0] == pytest.approx(np.eye(modes) * DAMPING / MU, rel=1e-15)
    # The slider's mass is a parameter, that the scene gives.
    base = el.load_scene(folder / FILES[1], overrides={"model.modes": modes}).system()
    assert base.with_parameters(slider_mass=slider).array("B", theta) == pytest.approx(
        system.array("B", theta), rel=1e-15
    )


def _blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", (DOCS / "own_model.md").read_text(), re.S)


def _command_folder(place):
    """Make the two commands as an installation does, for this interpreter."""
    place.mkdir()
    for name, module in (
        ("elastolink", "elastolink.runtime.cli"),
        ("regenerate-equations", "elastolink.derive.regenerate"),
    ):
        script = place / name
        call = f"import sys; from {module} import main; sys.exit(main())"
        script.write_text(f"#!{sys.executable}\n{call}\n")
        script.chmod(script.stat().st_mode | stat.S_IXUSR)
    return place


def test_the_page_shows_the_files_as_they_are():
    sources = (EXAMPLE / FILES[0]).read_text()
    shown = [line for line in _blocks("python")[0].splitlines()[1:] if line.strip() != "..."]
    assert len(shown) == 4
    assert all(f"{line}\n" in sources for line in shown)


@pytest.mark.slow
def test_the_commands_of_the_page_run_literally(tmp_path):
    for name in FILES:
        shutil.copy(EXAMPLE / name, tmp_path)
    commands = _command_folder(tmp_path / "bin")
    environment = {
        **os.environ,
        "PATH": f"{commands}{os.pathsep}{os.environ['PATH']}",
        "XDG_CACHE_HOME": str(tmp_path / "cache"),
        "MPLBACKEND": "Agg",
    }
    outputs = []
    for command in "".join(_blocks("sh")).splitlines():
        done = subprocess.run(
            command, shell=True, cwd=tmp_path, env=environment, capture_output=True, text=True
        )
        assert done.returncode == 0, (command, done.stdout, done.stderr)
        outputs.append(done.stdout)
    assert "slider_crank_rod_complete" in outputs[1]
    assert outputs[2].split() == ["current", "slider_crank_rod_complete"]
    assert json.loads(outputs[4])
    assert (tmp_path / "slider_crank.png").stat().st_size > 5000
    assert (tmp_path / "slider_crank.tex").read_text().startswith("\\documentclass")
    program = _blocks("python")[1]
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    printed = done.stdout.splitlines()
    assert printed[0].startswith("True 0.9")
    assert 1e-4 < float(printed[1].split()[0]) < 0.01
