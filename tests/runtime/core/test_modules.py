"""Finding emitted modules: order of folders, honesty about old and edited ones, the way out."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import elastolink as el
import elastolink.generated
import numpy as np
import pytest
from elastolink._files import run_module
from elastolink.derive.regenerate import main
from elastolink.derive.spec import MANIFEST, ModelSpec, read_manifest
from elastolink.runtime.core import modules
from elastolink.runtime.core.modules import find_module

PACKAGED = Path(elastolink.generated.__path__[0])
HILL = ModelSpec("hill", "plain")
EXAMPLES = Path(__file__).parents[3] / "docs" / "examples"
SCENE = "smith_1972_5152_sixteenth_inch"
MODEL = str(EXAMPLES / "slider_crank_rod.py")


@pytest.fixture(autouse=True)
def empty_cache(tmp_path, monkeypatch):
    """Keep the user's own cache out of these tests."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("ELASTOLINK_GENERATED", raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path / "cache" / "elastolink" / "modules"


def test_the_packaged_modules_are_found():
    found = find_module(HILL)
    assert found.module.__name__ == "elastolink.generated.hill_plain"
    assert found.folder == PACKAGED
    assert found.entry.content == found.module.CONTENT
    assert found.provenance == {"module": "hill_plain", "module_hash": found.entry.content}


def test_the_first_folder_that_has_it_wins(tmp_path, monkeypatch, empty_cache):
    for folder in ("given", "named", empty_cache):
        assert main(["hill_plain", "--out", str(folder)]) == 0
    monkeypatch.setenv("ELASTOLINK_GENERATED", "named")
    assert find_module(HILL, ["given"]).folder == Path("given")
    assert find_module(HILL).folder == Path("named")
    monkeypatch.delenv("ELASTOLINK_GENERATED")
    found = find_module(HILL)
    assert found.folder == empty_cache
    assert find_module(HILL, ["given"]).module is found.module  # equal texts are loaded once
    (empty_cache / "hill_plain.py").unlink()
    assert find_module(HILL).folder == PACKAGED


def test_a_module_for_any_number_of_modes_serves_each():
    spec = ModelSpec("four_bar", "reduced", flexible=("coupler",), modes=4)
    assert find_module(spec).entry.module == "four_bar_coupler_reduced"


def test_an_old_module_in_the_cache_is_not_used(empty_cache, capsys):
    """What another version of the sources emitted counts as missing."""
    assert main(["hill_plain"]) == 0
    manifest = empty_cache / MANIFEST
    manifest.write_text(
        re.sub(r'"content": "\w+"', f'"content": "{"0" * 32}"', manifest.read_text())
    )
    assert find_module(HILL).folder == PACKAGED
    assert main(["hill_plain"]) == 0
    assert find_module(HILL).folder == empty_cache


def test_an_old_module_is_mentioned_where_there_is_no_other(empty_cache):
    table = '{"mechanism": "hill", "formulation": "plain", "outputs": ["stability"]}'
    assert main(["--spec", table]) == 0
    spec = HILL.with_(outputs=("stability",))
    assert find_module(spec).folder == empty_cache
    manifest = empty_cache / MANIFEST
    manifest.write_text(re.sub(r'"content": "\w+"', '"content": "0"', manifest.read_text()))
    with pytest.raises(el.BadInput, match="only an outdated one in"):
        find_module(spec)


def test_an_edited_module_is_refused(empty_cache):
    assert main(["hill_plain"]) == 0
    path = empty_cache / "hill_plain.py"
    path.write_text(path.read_text().replace("lam2", "lam_2"))
    with pytest.raises(el.BadInput, match="changed by hand") as caught:
        find_module(HILL)
    assert str(path) in str(caught.value)
    assert main(["hill_plain"]) == 0
    assert find_module(HILL).folder == empty_cache


def test_a_module_that_another_thread_has_but_begun_is_not_taken(empty_cache, monkeypatch):
    assert main(["hill_plain"]) == 0
    name = find_module(HILL).module.__name__
    monkeypatch.setattr(modules, "_LOADED", {})
    monkeypatch.setitem(sys.modules, name, ModuleType(name))
    assert hasattr(find_module(HILL).module, "PARAMETERS")


def test_a_file_is_run_as_it_is_now_and_leaves_nothing_beside_it(tmp_path, monkeypatch):
    """Bytecode is taken for that of another text which is as old, to the second, and as long."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(sys, "pycache_prefix", None)
    path = tmp_path / "made.py"
    for text in ("cos", "sin"):
        path.write_text(f'word = "{text}"\n')
        os.utime(path, (0, 0))
        made = run_module("made", path)
        assert made.word == text
        assert sys.modules.pop("made").__file__ == str(path)
    path.write_text("word = 1 / 0\n")
    with pytest.raises(ZeroDivisionError):
        run_module("made", path)
    assert "made" not in sys.modules and [*tmp_path.iterdir()] == [path]


def test_a_broken_manifest_is_as_good_as_none(tmp_path, monkeypatch):
    (tmp_path / MANIFEST).write_text("{")
    monkeypatch.setenv("ELASTOLINK_GENERATED", str(tmp_path))
    assert find_module(HILL).folder == PACKAGED


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """Return a folder with two modules of a packaged model and one of a user's own."""
    folder = tmp_path_factory.mktemp("emitted") / "sound"
    table = '{"mechanism": "hill", "formulation": "plain", "outputs": ["stability"]}'
    for what in (["hill_plain"], ["--spec", table], ["--model", MODEL]):
        assert main([*what, "--out", str(folder)]) == 0
    return folder


def damaged(rows, rng):
    """Return the rows of a manifest with one thing changed, or some in the place of others."""
    rows = json.loads(json.dumps(rows))
    keys, fields = sorted(rows), ["spec", "module", "content", "text"]
    others = [keys[int(k)] for k in rng.permutation(len(keys))]
    odd = (None, 3, "x", [], {}, "../x", "a\0b", "x" * 5000)[rng.integers(8)]
    match rng.integers(5):
        case 0:
            return {key: rows[other] for key, other in zip(keys, others, strict=True)}
        case 1:
            swapped = rng.permutation(fields)[: rng.integers(1, 4)]
            return {
                key: rows[key] | {field: rows[other][field] for field in swapped}
                for key, other in zip(keys, others, strict=True)
            }
        case 2:
            rows[keys[0]][fields[rng.integers(4)]] = odd
        case 3:
            spec = rows[keys[rng.integers(3)]]["spec"]
            spec[sorted(spec)[rng.integers(len(spec))]] = odd
        case 4:
            rows[keys[rng.integers(3)]] = odd
    return rows


@pytest.mark.parametrize("seed", range(5))
def test_damaged_manifests_and_modules_are_never_believed(sound, tmp_path, monkeypatch, seed):
    """What is found is the module of its spec, or another folder's; the command mends the rest."""
    rng = np.random.default_rng(seed)
    entries = read_manifest(sound)
    monkeypatch.setenv("ELASTOLINK_GENERATED", str(tmp_path / "bad"))
    for turn in range(12):
        shutil.rmtree("bad", ignore_errors=True)
        shutil.copytree(sound, "bad")
        manifest = Path("bad", MANIFEST)
        held = json.loads(manifest.read_bytes())
        if turn % 4:
            manifest.write_text(json.dumps(held | {"modules": damaged(held["modules"], rng)}))
        else:
            one, other = rng.permutation(sorted(Path("bad").iterdir()))[:2]
            cut = one.read_bytes()[: rng.integers(len(one.read_bytes()))]
            one.write_bytes(cut if turn % 8 else other.read_bytes())
        for entry in entries.values():
            try:
                found = find_module(entry.spec)
            except el.BadInput as refusal:
                assert str(refusal).isprintable()
                continue
            assert found.provenance == {"module": entry.module, "module_hash": entry.content}
            assert found.entry.spec == entry.spec
        if main(["hill_plain", "--out", "bad"]) == 0:
            (key,) = [key for key in entries if entries[key].module == "hill_plain"]
            assert read_manifest(Path("bad"))[key] == entries[key]
            assert find_module(HILL).folder == tmp_path / "bad"


def test_a_model_that_nothing_can_derive_is_refused_at_once():
    with pytest.raises(el.BadInput) as caught:
        el.load_scene(SCENE, overrides={"model.drop": ["spni"]}).system()
    (problem,) = caught.value.problems
    assert (problem.where, problem.found) == ("model.drop", "['spni']")
    assert "'spin'" in problem.expected


def test_a_users_own_model_is_asked_for_by_its_file():
    with pytest.raises(el.BadInput) as caught:
        el.load_scene(EXAMPLES / "slider_crank_rod.toml").system()
    fix = caught.value.problems[0].fix
    assert fix == "run: regenerate-equations --model FILE.py, with the file of slider_crank"


def command_of(problem: el.BadInput) -> list[str]:
    """Return the arguments of the command that an error names, read as a shell does."""
    words = shlex.split(str(problem).rpartition("run: ")[2])
    assert words[0] == "regenerate-equations"
    return words[1:]


OVERRIDES = [
    {"model.outputs": ["stability"]},
    {"model.drop": ["spin", "axial_inertia"], "model.formulation": "complete"},
    {"model.balanced": ["coupler"], "coupler.first_moment": None, "model.modes": 2},
]


@pytest.mark.slow
@pytest.mark.parametrize("overrides", OVERRIDES, ids=lambda o: next(iter(o)))
def test_the_command_that_an_error_names_makes_the_module(overrides, tmp_path, empty_cache):
    scene = el.load_scene(SCENE, overrides=overrides)
    with pytest.raises(el.BadInput, match="no emitted module") as caught:
        scene.system()
    code = "import sys; from elastolink.derive.regenerate import main; sys.exit(main(sys.argv[1:]))"
    done = subprocess.run(
        [sys.executable, "-c", code, *command_of(caught.value)],
        cwd=tmp_path,
        env=os.environ.copy(),
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert scene.system().provenance["module"] == scene.model_spec().name()
    assert (empty_cache / f"{scene.model_spec().name()}.py").exists()


def test_the_command_reaches_past_a_checkout_that_is_not_searched(
    tmp_path, monkeypatch, empty_cache
):
    """Inside a checkout modules go to its own folder; an installed package does not look there."""
    (tmp_path / "generated").mkdir()
    (tmp_path / "pyproject.toml").write_text('name = "elastolink"\n')
    scene = el.load_scene(SCENE, overrides={"model.outputs": ["stability"]})
    with pytest.raises(el.BadInput) as caught:
        scene.system()
    arguments = command_of(caught.value)
    assert arguments[:2] == ["--out", str(empty_cache)]
    assert main(arguments) == 0
    assert not list((tmp_path / "generated").iterdir())
    # The forcing, which was not asked for, is not there.
    slim, full = scene.system(), el.load_scene(SCENE).system()
    assert full.has("f")
    assert not any(slim.has(name) for name in ("f", "h", "g", "p"))
    assert (slim.array("B", [0.3, 4.0]) == full.array("B", [0.3, 4.0])).all()


def test_a_folder_may_move(tmp_path, monkeypatch):
    assert main(["hill_plain", "--out", "here"]) == 0
    shutil.move("here", "there")
    assert find_module(HILL, ["there"]).folder == Path("there")
