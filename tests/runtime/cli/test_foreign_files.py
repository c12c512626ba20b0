"""Every command of docs/commands.md among files of others, which must stay as they are."""

import argparse
import re
import shlex
from pathlib import Path

import pytest
from elastolink.runtime.cli.application import build_parser, main

PAGE = Path(__file__).parents[3] / "docs" / "commands.md"
# Names that commands, stores and galleries have a use for themselves.
FOREIGN = (
    *("manifest.json", "chart.npz", "notes.txt", ".chart.npz.abcdefgh", "motion.png.bak"),
    *("pieces/00000000.npz", "chart/keep.txt", "chart/pieces/keep.npz", "chart.parts/keep.json"),
    *("gallery/keep.html", "generated/keep.py", "derive/keep.py"),
)


def commands() -> list[list[str]]:
    """Return the arguments of each command of the page, and of two that write folders."""
    lines = re.findall(r"^    elastolink (.*?)(?:\s+#.*)?$", PAGE.read_text(), re.MULTILINE)
    found = [shlex.split(line) for line in lines]
    # What takes long and writes nothing, and what takes minutes.
    slow = ("running-speed", "reproduce")
    kept = [words for words in found if words[0] not in slow and "--store" not in words]
    figure = ["reproduce", "smith", "--figure", "13", "--out", "gallery"]
    return [*kept, ["chart", "mathieu", "--store", "sweep"], figure]


def test_every_command_is_on_the_page():
    options = build_parser()._actions
    names = next(one.choices for one in options if isinstance(one, argparse._SubParsersAction))
    assert set(names) == set(re.findall(r"elastolink ([a-z-]+)", PAGE.read_text()))


def contents(folder: Path) -> dict[str, bytes]:
    """Return all files of a folder by their path in it."""
    files = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


@pytest.mark.slow
def test_commands_write_what_they_were_told_and_touch_nothing_else(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for name in FOREIGN:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(f"not yours: {name}".encode())
    foreign, written = contents(tmp_path), set()
    for words in commands():
        before = contents(tmp_path)
        assert main(words) in (0, 1), (words, capsys.readouterr().err)
        after = contents(tmp_path)
        changed = {name for name in after if after[name] != before.get(name)}
        assert not set(before) - set(after), words
        told = set(words)
        assert all(name in told or name.split("/")[0] in told for name in changed), (words, changed)
        written |= changed
    assert {name: contents(tmp_path)[name] for name in foreign} == foreign
    assert {"motion.gif", "curve.png", "sweep/manifest.json", "gallery/index.html"} <= written


@pytest.mark.slow
def test_a_store_where_others_have_files_is_refused(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "chart").mkdir()
    (tmp_path / "chart" / "keep.txt").write_text("not yours")
    before = contents(tmp_path)
    assert main(["chart", "mathieu", "--store", "chart"]) == 2
    assert "something that is no sweep" in capsys.readouterr().err
    assert contents(tmp_path) == before
