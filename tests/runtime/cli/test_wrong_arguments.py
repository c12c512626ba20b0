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
FOREIGN = (
    *("manifest.json", "nan.npz", "four_bar_forces.py", "pieces/00000000.npz"),
    *("gallery/index.html", "gallery/keep.txt", "nan.parts/manifest.json", "generated/keep.py"),
)


def wrong_calls(name):
    """Yield command lines with one wrong argument each; the others are right or left out."""
    own = [action for action in COMMANDS[name]._actions if action.nargs != 0]
    right = [SCENE for action in own if action.dest == "scene"]
    for action in own:
        values = WRONG
        if action.dest in PATHS:
            values = ("--", "\0")
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
    # A folder full of foreign files, under names that commands have a use for.
    foreign = {tmp_path / place: f"not yours: {place}".encode() for place in FOREIGN}
    for path, content in foreign.items():
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
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
    found = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert found == foreign


# What is given | what the complaint says of it.
WORDS = {
    ("show", "smith_1972_5152"): "did you mean smith_1972_5152_sixteenth_inch or",
    ("show", SCENE, "--set", "links.crank=0,12 m"): "write a point for the comma: '0.12 m'",
    ("clearance", SCENE, "--clearance", "0.1"): "a number with its unit",
    ("clearance", SCENE, "--at", "34=.1e0"): "a number with its unit",
    ("stability", SCENE, "--speed", "1:1e9:1000000000"): "a count from 2 to 100000",
    ("chart", SCENE, "--speed", "1:2:3"): "give one value, no range",
    (
        "show",
        "nowhere.toml",
    ): "no file nowhere.toml; expected a readable file; correct",
    ("stress", SCENE): "begin with `elastolink new beams`",
    ("show", SCENE, "--set", "coupler.width=1", "--set", "coupler.modulus=2"): (
        "coupler.width, coupler.modulus: found unknown keys; expected some of"
    ),
    ("show", SCENE, "--set", "coupler.thickness=1"): "give bending_stiffness, E w t^3 / 12",
}


@pytest.mark.parametrize("line", WORDS, ids=" ".join)
def test_the_complaint_names_what_is_wrong(line, capsys):
    assert main(line) == 2
    assert WORDS[line] in capsys.readouterr().err


# Misspelt command line | the beginning of the complaint | its end.
MISSPELT = """
diagnose x --sped 3 | elastolink diagnose: unrecognized | did you mean --speed? `elastolink diagnose --help` explains
boundaries x --plott y --nonsense | elastolink boundaries: unrec | did you mean --plot? `elastolink boundaries --help` explains
show x --nonsense | elastolink show: unrecognized | arguments: --nonsense; `elastolink show --help` explains
diagnos x | elastolink: argument COMMAND | 'diagnos'; did you mean diagnose? `elastolink --help` explains
stab x | elastolink: argument COMMAND | did you mean stability or stabilise? `elastolink --help` explains
zzz x | elastolink: argument COMMAND | `elastolink --help` explains
"""  # noqa: E501


@pytest.mark.parametrize("line", MISSPELT.strip("\n").splitlines())
def test_a_misspelt_word_is_answered_with_the_nearest(line, capsys):
    command, begins, ends = (part.strip() for part in line.split("|"))
    with pytest.raises(SystemExit):
        main(command.split())
    told = capsys.readouterr().err.rstrip("\n")
    assert told.startswith(begins) and told.endswith(ends)


def test_what_a_scene_holds_does_not_steer_the_terminal(capsys, tmp_path):
    scene = tmp_path / "mine.toml"
    steer = r"\u001b[31m\u0007\u009b\u202e"
    tables = '[model]\nmechanism = "hill"\nformulation = "plain"\n[function]\na = [0.0, 1.0]\n'
    scene.write_text(f'title = "{steer}"\nsource = "{steer}"\n{tables}')
    for line in ("show", str(scene)), ("show", str(scene), "--json"):
        main(line)
        told = capsys.readouterr()
        text = told.out + told.err
        assert text.strip()
        assert text.replace("\n", "").isprintable()


def test_thousands_of_problems_are_counted(capsys, tmp_path):
    scene = tmp_path / "many.toml"
    scene.write_text("".join(f"[t{i}]\n" for i in range(20_000)) + '[model]\nmechanism = "hill"\n')
    assert main(["show", str(scene)]) == 2
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 21
    assert "more problems" in told[-1]
    assert max(map(len, told)) < 1500
