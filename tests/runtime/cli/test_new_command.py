"""``elastolink new``, ``schema``, ``show --toml``: from no file at all to an answer."""

import json
import re
import shlex
from pathlib import Path

import pytest
from command_runs import refused, run, shown, told
from elastolink.derive import regenerate
from elastolink.runtime.scenes import load_scene
from elastolink.runtime.scenes.beginning import new_kinds, new_scene

DOCS = Path(__file__).parents[3] / "docs"
RIG = "smith_1972_5152_sixteenth_inch"
COMMAND = re.compile(r"^#   elastolink (\S+ mine\.toml.*)$", re.MULTILINE)
COMMANDS = [
    (kind, command)
    for kind in new_kinds()
    for command in COMMAND.findall(new_scene(kind))
    if kind != "own_model"
]


@pytest.fixture
def mine(capsys, tmp_path, monkeypatch):
    """Return a function that writes mine.toml of a kind into the folder that is worked in."""
    monkeypatch.chdir(tmp_path)

    def write(kind):
        Path("mine.toml").write_text(shown(capsys, "new", kind), "utf-8")

    return write


def test_every_kind_tells_commands():
    assert {kind for kind, _ in COMMANDS} == set(new_kinds()) - {"own_model"}


@pytest.mark.parametrize(("kind", "command"), COMMANDS)
def test_a_begun_scene_runs_at_once(capsys, mine, kind, command):
    mine(kind)
    out = shown(capsys, *shlex.split(command))
    assert "error:" in out
    drawn = re.search(r"--plot (\S+)", command)
    assert not drawn or Path(drawn.group(1)).read_bytes()[:4] == b"\x89PNG"


@pytest.mark.parametrize("kind", new_kinds())
def test_every_key_has_its_meaning_and_may_be_added(mine, kind):
    mine(kind)
    scene, text = load_scene("mine.toml"), Path("mine.toml").read_text("utf-8")
    body = text[text.index("\n[model]") :].partition("# Tables which may be added")[0]
    written = re.findall(r"^(?:# )?(\w+) = .*?  # (.+)$", body, re.MULTILINE)
    for name in scene.document:
        table = scene.layout.table(name)
        for key in table.keys if table else ():
            assert any(n == key.name and m.startswith(key.meaning) for n, m in written)


def test_a_model_of_ones_own_takes_two_files(capsys, mine):
    mine("own_model")
    Path("mine.py").write_text(shown(capsys, "new", "own_model", "--model"), "utf-8")
    lines = Path("mine.toml").read_text("utf-8")
    words = re.search(r"^#   regenerate-equations (.*)$", lines, re.MULTILINE).group(1)
    assert regenerate.main([*words.split(), "--jobs", "1"]) == 0
    capsys.readouterr()
    command = COMMAND.search(lines).group(1)
    assert "doubling" in shown(capsys, *shlex.split(command))


def test_kinds_are_listed(capsys):
    assert set(told(capsys, "new")) == set(new_kinds())
    assert [line.split()[0] for line in shown(capsys, "new").splitlines()] == list(new_kinds())
    message = refused(capsys, "new", "cuopler")
    assert "did you mean coupler?" in message and all(kind in message for kind in new_kinds())
    assert "own_model" in refused(capsys, "new", "hill", "--model")
    assert "a KIND" in refused(capsys, "new", "--plot", "x.png")


def test_a_kind_is_drawn(capsys, mine):
    run(capsys, "new", "slider_crank", "--plot", "scene.png")
    assert Path("scene.png").read_bytes()[:4] == b"\x89PNG"


def test_what_schema_prints_is_what_is_committed(capsys):
    assert shown(capsys, "schema") == (DOCS / "scene.schema.json").read_text("utf-8")
    assert told(capsys, "schema") == json.loads(shown(capsys, "schema"))
    assert shown(capsys, "schema", "--page") == (DOCS / "scene_keys.md").read_text("utf-8")
    refused(capsys, "schema", "--page", "--json")


def test_a_shown_scene_is_a_file(capsys, tmp_path):
    changes = ["--set", "links.crank=75 mm", "--set", "coupler.damping_ratio=0.01"]
    path = tmp_path / f"{RIG}.toml"
    path.write_text(shown(capsys, "show", RIG, *changes, "--toml"), "utf-8")
    assert told(capsys, "show", path) == told(capsys, "show", RIG, *changes)
    assert 'crank = "75 mm"' in path.read_text("utf-8")
    refused(capsys, "show", RIG, "--toml", "--json")
