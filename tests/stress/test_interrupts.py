"""An interrupt at any moment leaves whole files, and a manifest that tells the truth."""

import hashlib
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from elastolink import _files
from elastolink.derive.regenerate import main
from elastolink.derive.spec import MANIFEST, read_manifest

CODE = "import sys; from elastolink.derive.regenerate import main; sys.exit(main(sys.argv[1:]))"
MODELS = ["hill_plain", "quick_return_kinematics"]
# Enough to be still at work after the first of them, which is done within seconds.
SEVERAL = ["four_bar_coupler_reduced", "four_bar_forces", "four_bar_kinematics", *MODELS]
SEVERAL += ["quick_return_forces", "quick_return_kinematics", "slider_crank_kinematics"]


def assert_truthful(folder):
    """Every listed module is there, whole, and the text that the manifest says."""
    for entry in read_manifest(folder).values():
        text = (folder / f"{entry.module}.py").read_bytes()
        assert hashlib.sha256(text).hexdigest() == entry.text
    for path in folder.glob("*.py"):
        compile(path.read_text(), str(path), "exec")
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]


class Interrupts:
    """Interrupt the n-th move of a finished file to its place, before or after it."""

    def __init__(self, monkeypatch, number, after):
        self.left, self.after = number, after
        self.replace = Path.replace
        monkeypatch.setattr(Path, "replace", lambda path, target: self.move(path, target))

    def move(self, path, target):
        self.left -= 1
        if self.left == 0 and not self.after:
            raise KeyboardInterrupt
        self.replace(path, target)
        if self.left == 0:
            raise KeyboardInterrupt
        return target


@pytest.mark.parametrize(("number", "after"), [(1, True), (2, False), (4, False)])
def test_an_interrupt_of_a_first_run_leaves_the_truth(number, after, tmp_path, monkeypatch, capsys):
    with monkeypatch.context() as patch:
        Interrupts(patch, number, after)
        assert main([*MODELS, "--jobs", "1", "--out", str(tmp_path)]) == 130
    told = capsys.readouterr().err
    assert told == "regenerate-equations: interrupted; finished files are whole\n"
    assert_truthful(tmp_path)
    assert main([*MODELS, "--jobs", "1", "--out", str(tmp_path)]) == 0
    assert_truthful(tmp_path)
    assert len(read_manifest(tmp_path)) == 2


@pytest.mark.parametrize(("number", "after"), [(1, False), (2, True), (3, False)])
def test_an_interrupt_of_an_update_leaves_the_truth(number, after, tmp_path, monkeypatch):
    """An older text is replaced: at no time does the manifest vouch for the wrong one."""
    assert main([MODELS[1], "--out", str(tmp_path)]) == 0
    path = tmp_path / f"{MODELS[1]}.py"
    old = path.read_bytes() + b"# an older text\n"
    manifest = tmp_path / MANIFEST
    new_hash = hashlib.sha256(path.read_bytes()).hexdigest()
    path.write_bytes(old)
    manifest.write_text(manifest.read_text().replace(new_hash, hashlib.sha256(old).hexdigest()))
    assert_truthful(tmp_path)
    with monkeypatch.context() as patch:
        Interrupts(patch, number, after)
        assert main([MODELS[1], "--force", "--out", str(tmp_path)]) == 130
    assert_truthful(tmp_path)
    assert main([MODELS[1], "--force", "--out", str(tmp_path)]) == 0
    assert_truthful(tmp_path)
    assert path.read_bytes() == old[: -len(b"# an older text\n")]


def test_an_interrupt_while_a_file_is_written_leaves_the_old_one(tmp_path):
    path = tmp_path / "chart.png"
    path.write_bytes(b"old")
    with pytest.raises(KeyboardInterrupt), _files.whole_file(path) as stream:
        stream.write(b"so")
        raise KeyboardInterrupt
    assert [p.name for p in tmp_path.iterdir()] == ["chart.png"]
    assert path.read_bytes() == b"old"


def test_a_full_disk_leaves_the_old_file(tmp_path, monkeypatch, capsys):
    assert main([MODELS[1], "--out", str(tmp_path)]) == 0
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}

    def full(path, target):
        raise OSError(28, "No space left on device", str(path))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "replace", full)
        capsys.readouterr()
        assert main([MODELS[1], "--force", "--out", str(tmp_path)]) == 2
    assert "No space left on device" in capsys.readouterr().err
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before


def test_a_written_file_has_the_rights_of_any_other(tmp_path):
    ordinary, whole = tmp_path / "ordinary", tmp_path / "whole"
    ordinary.write_bytes(b"")
    _files.write_whole(whole, b"")
    assert whole.stat().st_mode == ordinary.stat().st_mode


def working(folder, *options, **more):
    """Return a process at work, as soon as it has finished its first module."""
    process = subprocess.Popen(
        [sys.executable, "-c", CODE, *SEVERAL, "--out", str(folder), *options],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **more,
    )
    assert process.stdout.readline().startswith("[1/")
    return process


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="process groups are interrupted otherwise there")
@pytest.mark.parametrize("jobs", [1, 2])
def test_an_interrupted_process_says_one_line_and_leaves_the_truth(jobs, tmp_path):
    """A full run in a group of its own, as a terminal starts it, and the group interrupted."""

    def heed_interrupts():
        # A runner that ignores interrupts itself hands that on.
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    options = ("--jobs", str(jobs), "--force")
    process = working(tmp_path, *options, start_new_session=True, preexec_fn=heed_interrupts)
    os.killpg(process.pid, signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert err == "regenerate-equations: interrupted; finished files are whole\n"
    assert_truthful(tmp_path)
    assert read_manifest(tmp_path)


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no such signal here")
def test_a_kill_leaves_a_truthful_manifest_and_whole_files(tmp_path):
    """Nothing can be tidied up then; a temporary file may stay, but nothing false is listed."""
    process = working(tmp_path, "--jobs", "1")
    process.kill()
    process.communicate(timeout=60)
    for leftover in tmp_path.glob(".*"):
        leftover.unlink()
    assert_truthful(tmp_path)
