"""Wrong arguments of every command: status 2 and one printable line, whatever is given."""

import argparse

import pytest
from elastolink.runtime.cli.application import build_parser, main

SCENE = "smith_1972_5152_sixteenth_inch"
COMMANDS = next(
    action.choices
    for action in build_parser()._actions
    if isinstance(action, argparse._SubParsersAction)
)
# Right nowhere: neither a name, a number, a list, a range, an angle nor a file that can be.
WRONG = (
    "9" * 5000,
    "1,5,x",
    "nan",
    "\x1b[31m",
    "[" * 3000,
    "--",
    "\0",
    "1:2:3:4",
    "0:1:9" + "9" * 5000,
)
SETTINGS = (
    'model.drop=["a\'b"]',
    "model=3",
    "model.modes=" + "9" * 5000,
    "links.crank=" + "9" * 5000,
    "links.crank=" + "[" * 3000,
    "links.crank=0,12 m",
    "\x1b[31m.x=1",
    "links.\x1b[31m=1",
)
# Whatever is given names a file or folder to be written, if it can be a name at all.
PATHS = {"store", "out"}


def wrong_calls(name):
    """Yield command lines with one wrong argument each; the others are right or left out."""
    own = [action for action in COMMANDS[name]._actions if action.nargs != 0]
    right = [SCENE for action in own if action.dest == "scene"]
    for action in own:
        values = WRONG
        if action.dest in PATHS:
            values = ("--",)
        elif action.dest == "set":
            values = SETTINGS
        for value in values:
            if action.option_strings:
                yield [name, *right, f"{action.option_strings[-1]}={value}"]
            elif value not in {"--", "[" * 3000}:
                yield [name, value]


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_a_wrong_argument_is_refused_in_one_line(name, capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    for line in wrong_calls(name):
        try:
            status = main(line)
        except SystemExit as left:
            status = left.code
        told = capsys.readouterr()
        given = [text[:60] for text in line]
        assert (status, told.out) == (2, ""), given
        assert told.err.count("\n") == 1, given
        assert told.err[:-1].isprintable(), given
        assert len(told.err) < 1500, given
    assert list(tmp_path.iterdir()) == []
