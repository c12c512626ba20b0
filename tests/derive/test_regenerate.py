"""The regenerate-equations command: the same bytes always, nothing done twice, clear refusals."""

import importlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import elastolink.generated
import pytest
import sympy
from elastolink.derive import jobs, manifest
from elastolink.derive.catalogue import CATALOGUE
from elastolink.derive.jobs import jobs_of
from elastolink.derive.regenerate import main
from elastolink.derive.spec import MANIFEST, ModelSpec, read_manifest
from elastolink.runtime.scenes import list_scenes, load_scene

PACKAGED = Path(elastolink.generated.__path__[0])
SCENES = Path(__file__).parents[2] / "runtime" / "scenes" / "data"
QUICK = "hill_plain"  # the cheapest model to derive
FEW = [QUICK, "beam_shapes_cubic", "four_bar_coupler_reduced", "slider_crank_multibody"]

OWN_MODEL = '''"""Two coupled oscillators of the user's own."""
import sympy as sp
from elastolink.derive import authoring as au

t = sp.Symbol("t", real=True)
theta, rate, acceleration = sp.symbols("theta rate acceleration", real=True)
k, = PARAMETERS = au.symbols([au.scalar("k", "1/s^2", "Stiffness")])
p, q = (sp.Function(name)(t) for name in ("p", "q"))

def energies(spec):
    potential = k * ((p - q) ** 2 + p**2 + sp.cos(theta) * q**2) / 2
    return au.Lagrangian((p, q), t, (p.diff(t) ** 2 + q.diff(t) ** 2) / 2 - potential)

def discretise(spec, equations):
    crank = au.CrankMotion(theta, rate, acceleration)
    return au.StagedSystem(au.linear_periodic(equations, crank), au.Steps(), PARAMETERS, (theta,))

def describe(spec):
    return au.Description(
        "Two oscillators", ("nowhere",), (au.angle("theta", "Angle"),),
        parameters=(au.scalar("k", "1/s^2", "Stiffness"),),
    )

MODEL = au.Model("pair", ("plain",), energies, describe, discretise)
SPECS = (au.ModelSpec("pair", "plain"),)
'''
ALL = sorted(spec.name() for entry in CATALOGUE for spec in entry.specs)


def run(*arguments, cwd, seed="0", blocked=(), **environment):
    """Run the command in a fresh interpreter, with some modules made impossible to import."""
    block = f"import sys; sys.modules.update(dict.fromkeys({list(blocked)!r}));"
    code = "from elastolink.derive.regenerate import main; sys.exit(main(sys.argv[1:]))"
    return subprocess.run(
        [sys.executable, "-c", block + code, *map(str, arguments)],
        cwd=cwd,
        env={**os.environ, "PYTHONHASHSEED": seed, **environment},
        capture_output=True,
        text=True,
        timeout=300,
    )


def texts(folder):
    return {p.name: p.read_bytes() for p in folder.iterdir() if p.suffix in {".py", ".json"}}


@pytest.fixture(scope="session")
def emitted(tmp_path_factory):
    """Return a folder that holds what is packaged, which :func:`derived` proves to be current."""
    folder = tmp_path_factory.mktemp("emitted") / "one"
    return shutil.copytree(PACKAGED, folder, ignore=shutil.ignore_patterns("__*"))


def derived(folder, names, jobs, seed):
    """Return what a fresh process emits into a folder."""
    done = run(*names, "--out", folder, "--jobs", jobs, cwd=folder.parent, seed=seed)
    assert done.returncode == 0, done.stderr
    return texts(folder)


@pytest.fixture
def copy(emitted, tmp_path):
    return Path(shutil.copytree(emitted, tmp_path / "copy"))


@pytest.fixture
def checkout(emitted, tmp_path, monkeypatch):
    """Return the generated folder of something that looks like a checkout; work inside it."""
    project = tmp_path / "project"
    (project / "docs").mkdir(parents=True)
    (project / "pyproject.toml").write_text('[project]\nname = "elastolink"\n')
    shutil.copytree(emitted, project / "generated")
    monkeypatch.chdir(project / "docs")
    return project / "generated"


@pytest.fixture
def own(tmp_path):
    file = tmp_path / "pair.py"
    file.write_text(OWN_MODEL)
    return file


def test_the_packaged_modules_are_as_derived_now(emitted, tmp_path):
    """The same bytes whatever the seed of hashes and the number of processes.

    The rest of the modules is derived anew by ``regenerate-equations --check`` in each run of CI.
    """
    packaged = texts(emitted)
    assert len(packaged) == 1 + len(ALL)
    if b"SymPy " + sympy.__version__.encode() not in packaged[f"{QUICK}.py"]:
        pytest.skip("bytes are compared under the locked SymPy only")
    found = derived(tmp_path / "found", FEW, 2, "4711")
    assert len(found) == 1 + len(FEW)
    found.pop(MANIFEST)
    assert all(packaged[name] == text for name, text in found.items())


def test_nothing_to_do_imports_nothing_but_the_standard_library(copy, tmp_path):
    before = {p: p.stat().st_mtime_ns for p in copy.iterdir()}
    blocked = ("sympy", "jinja2", "numpy", "scipy", "mpmath", "matplotlib")
    done = run("--out", copy, cwd=tmp_path, blocked=blocked)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("nothing to do")
    assert {p: p.stat().st_mtime_ns for p in copy.iterdir()} == before
    listed = run("--out", copy, "--list", cwd=tmp_path, blocked=blocked)
    assert {line.split()[0] for line in listed.stdout.splitlines()} == {"current"}
    # The guard of this test: deriving does need SymPy.
    forced = run("--out", copy, "--force", QUICK, cwd=tmp_path, blocked=blocked)
    assert forced.returncode != 0


@pytest.mark.smoke
def test_only_what_is_stale_is_derived(copy, capsys):
    (copy / f"{QUICK}.py").unlink()
    assert main(["--out", str(copy)]) == 0
    assert capsys.readouterr().out.splitlines() == [f"[1/1] {QUICK}"]


def test_an_edited_file_is_told_and_mended(copy, emitted, capsys):
    path = copy / f"{QUICK}.py"
    path.write_text(path.read_text().replace("FAMILY = ", "FAMILY  = "))
    assert main(["--out", str(copy), "--list", QUICK]) == 0
    assert capsys.readouterr().out.split() == ["stale", QUICK]
    assert main(["--out", str(copy), "--check", QUICK]) == 1
    shown = capsys.readouterr().out.splitlines()
    assert f"--- {QUICK}.py (found)" in shown
    (family,) = (line for line in path.read_text().splitlines() if line.startswith("FAMILY"))
    assert f"-{family}" in shown
    assert f"+{family.replace('  =', ' =')}" in shown
    assert path.read_text() != (emitted / path.name).read_text()  # --check writes nothing
    assert main(["--out", str(copy), QUICK]) == 0
    assert texts(copy) == texts(emitted)
    path.unlink()
    assert main(["--out", str(copy), "--check", QUICK]) == 1
    assert "+FAMILY = " in capsys.readouterr().out
    assert not path.exists()


def test_stale_modules_of_a_checkout_are_shown_and_removed(checkout, monkeypatch, capsys):
    """In a checkout of a few models, as a check derives them all."""
    monkeypatch.setattr(jobs, "CATALOGUE", [e for e in CATALOGUE if e.specs[0].name() == QUICK])
    assert main([]) == 0
    assert [path.stem for path in checkout.glob("*.py")] == [QUICK]
    own = checkout / "written_by_hand.py"
    own.write_text("import math\n")
    before = texts(checkout)
    dropped = checkout / "five_bar_dream.py"
    dropped.write_text('"""Emitted by regenerate-equations."""\nx = 1\n')
    capsys.readouterr()
    assert main(["--check", "--jobs", "1"]) == 1
    shown = capsys.readouterr().out
    assert "--- five_bar_dream.py (found)" in shown
    assert "-x = 1" in shown
    assert "1 differ" in shown
    assert main([]) == 0
    assert capsys.readouterr().out == "removed five_bar_dream.py\n"
    assert texts(checkout) == before


def test_a_cache_keeps_what_the_user_emitted(emitted, own, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    cache = tmp_path / "cache" / "elastolink" / "modules"
    shutil.copytree(emitted, cache)
    assert main(["--model", str(own)]) == 0
    assert main([]) == 0
    assert "nothing to do" in capsys.readouterr().out
    assert (cache / "pair_plain.py").exists()
    assert len(read_manifest(cache)) == len(read_manifest(emitted)) + 1


def test_a_manifest_that_cannot_be_read_is_written_anew(copy, emitted, capsys):
    for content in ("<<<<<<< HEAD\n{", "[]", '{"modules": 3}', '{"modules": {"k": 3}}', "\x00"):
        (copy / MANIFEST).write_text(content)
        assert read_manifest(copy) == {}
        assert main(["--out", str(copy), QUICK]) == 0
        assert capsys.readouterr().out == f"[1/1] {QUICK}\n"
        assert [entry.module for entry in read_manifest(copy).values()] == [QUICK]


@pytest.mark.parametrize("content", ['{"name": "a web page"}', "", "[" * 100_000])
def test_a_foreign_manifest_is_not_replaced(tmp_path, content, capsys):
    manifest = tmp_path / MANIFEST
    manifest.write_text(content)
    assert main(["--out", str(tmp_path), QUICK]) == 2
    assert "not emitted" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == [MANIFEST]
    assert manifest.read_text() == content


def test_a_spec_as_json_and_a_scene_ask_for_the_same(tmp_path, capsys):
    table = {"mechanism": "four_bar", "formulation": "reduced", "flexible": ["coupler"]}
    table |= {"modes": 3, "outputs": ["stability"]}
    scene = tmp_path / "mine.toml"
    scene.write_text("[model]\n" + "".join(f"{k} = {json.dumps(v)}\n" for k, v in table.items()))
    name = "four_bar_coupler_reduced_for_stability"
    for arguments in (["--spec", json.dumps(table)], ["--scene", str(scene)]):
        folder = tmp_path / arguments[0]
        assert main([*arguments, "--out", str(folder)]) == 0
        assert capsys.readouterr().out == f"[1/1] {name}\n"
        text = (folder / f"{name}.py").read_text()
        assert "forcing" not in text.split('"""')[2]
        assert "def modal_vectors" not in text
    assert texts(tmp_path / "--spec") == texts(tmp_path / "--scene")


@pytest.mark.parametrize("name", list_scenes())
def test_built_in_scenes_ask_for_what_they_load(name):
    (job,) = jobs_of([], [str(SCENES / f"{name}.toml")], [], None)
    assert job.spec == load_scene(name).model_spec()


def test_a_users_own_model_is_emitted_and_follows_its_file(own, tmp_path, capsys):
    folder = tmp_path / "out"
    assert main(["--model", str(own), "--out", str(folder)]) == 0
    assert "cos(theta)" in (folder / "pair_plain.py").read_text()
    assert main(["--model", str(own), "--out", str(folder)]) == 0
    assert capsys.readouterr().out.splitlines()[1].startswith("nothing to do")
    own.write_text(OWN_MODEL.replace("sp.cos(theta)", "sp.sin(theta)"))
    assert main(["--model", str(own), "--out", str(folder), "pair_plain"]) == 0
    assert "sin(theta)" in (folder / "pair_plain.py").read_text()


def test_the_hash_follows_everything_that_can_change_a_byte(tmp_path, monkeypatch):
    derive = Path(manifest.__file__).parent
    home = tmp_path / "derive"
    shutil.copytree(derive, home, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(derive.parent / "templates", tmp_path / "templates")
    source = home / "models" / "hill.py"
    monkeypatch.setattr(manifest, "_HERE", home)

    def content(**changes):
        manifest._shared_sources.cache_clear()
        return manifest.content_hash(ModelSpec("hill", "plain", **changes), [source])

    try:
        first = content()
        for path in (tmp_path / "templates" / "module.py.j2", home / "lowering.py", source):
            path.write_bytes(path.read_bytes() + b"\n")
            assert content() != first
            path.write_bytes(path.read_bytes()[:-1])
            assert content() == first
        assert content(outputs=("stability",)) != first
        for path in (home / "regenerate.py", home / "models" / "coupler.py"):
            path.write_bytes(path.read_bytes() + b"\n")
            assert content() == first
    finally:
        manifest._shared_sources.cache_clear()


@pytest.mark.parametrize("entry", CATALOGUE, ids=lambda entry: entry.module)
def test_the_catalogue_says_what_the_models_say(entry):
    file, _, name = entry.module.partition(":")
    module = importlib.import_module(file, "elastolink.derive")
    model = getattr(module, name or "MODEL")
    assert (entry.mechanism, entry.formulations) == (model.mechanism, model.formulations)
    assert entry.closed_in_modes == model.closed_in_modes
    assert all(path.exists() for path in entry.paths())
    assert all(spec.formulation in entry.formulations for spec in entry.specs)
    assert all(entry.choices.unknown(spec) is None for spec in entry.specs)
    terms = getattr(module, "TERMS", model.choices.drop)
    assert set(entry.choices.drop) == set(terms)


@pytest.mark.parametrize("entry", CATALOGUE, ids=lambda entry: entry.module)
def test_the_hash_covers_every_model_file_that_is_read(entry):
    """A model file imports its neighbours; each of them is among its sources."""
    file = entry.module.partition(":")[0]
    wanted, pending = set(), {Path(file.rpartition(".")[2] + ".py")}
    while pending:
        name = str(pending.pop())
        wanted.add(name)
        text = (entry.paths()[0].parent / name).read_text()
        near = re.findall(r"^from \.(\w+) import", text, re.M)
        groups = re.findall(r"^from \. import (.+)", text, re.M)
        near += [n.split()[0] for group in groups for n in group.split(",")]
        pending |= {Path(f"{n}.py") for n in near} - {Path(n) for n in wanted}
    assert wanted == set(entry.sources)


BAD_MODEL = {
    "syntax": ("def (:\n", "SyntaxError"),
    "import": ("import elastolink.derive.no_such_thing\n", "no_such_thing' (line 1)"),
    "name": ("x = 1\ny = undefined_thing\n", "undefined_thing' is not defined (line 2)"),
    "nothing": ("x = 1\n", "defines no MODEL"),
    "no specs": (OWN_MODEL.replace("SPECS =", "SPECKS ="), "defines no SPECS"),
    "refusal": (
        OWN_MODEL.replace(
            "    potential =", "    raise ValueError('springs\\nare out')\n    potential ="
        ),
        "model pair_plain: springs are out (line 11)",
    ),
    "not linear": (
        OWN_MODEL.replace("(p - q) ** 2", "(p - q) ** 4"),
        "have no place in the arrays",
    ),
    "not printable": (
        OWN_MODEL.replace("sp.cos(", "sp.gamma("),
        "has no form in an emitted module",
    ),
}


def spec(**changes):
    table = {"mechanism": "four_bar", "formulation": "complete", "flexible": ["coupler"]}
    return json.dumps({k: v for k, v in (table | changes).items() if v is not None})


BAD_ARGUMENTS = {
    "unknown model": (["no_such"], "unknown models ['no_such']"),
    "jobs": (["--jobs", "0"], "--jobs"),
    "option": (["--forse"], "--forse"),
    "missing scene": (["--scene", "none.toml"], "none.toml"),
    "missing model": (["--model", "none.py"], "none.py"),
    "no json": (["--spec", "{"], "--spec {"),
    "no table": (["--spec", "[1]"], "expected a table"),
    "unknown key": (["--spec", spec(mode=2)], "unknown keys ['mode']"),
    "missing key": (["--spec", spec(formulation=None)], "missing keys ['formulation']"),
    "modes": (["--spec", spec(modes=0)], "modes: found 0"),
    "modes as a truth": (["--spec", spec(modes=True)], "modes: found True"),
    "path as a name": (["--spec", spec(mechanism="../x")], "mechanism: found '../x'"),
    "unknown term": (["--spec", spec(drop=["spni"])], "drop: found ['spni']"),
    "rigid coupler": (["--spec", spec(flexible=[])], "flexible: found none"),
    "unknown output": (["--spec", spec(outputs=["torque"])], "outputs: found ['torque']"),
    "unknown formulation": (["--spec", spec(formulation="exact")], "four_bar/exact"),
    "out is a file": (["--out", "file.txt", QUICK], "file.txt: found a file"),
    "check and no room": (["--latex", "missing/x.tex", QUICK], "missing"),
}


BAD_SCENE = {
    "no TOML": ("model = [", "scene file mine.toml: "),
    "no text": (b"\xff\xfe", "scene file mine.toml: "),
    "no model": ("[links]\ncrank = 1\n", "has no [model] table"),
    "no name": ("[model]\nmechanism = 3\nformulation = 'x'\n", "mechanism: found 3"),
    "no table": ("model = 3\n", "expected a table"),
}
REFUSALS = {
    **{f"model, {k}": ("pair.py", text, ["--model"], e) for k, (text, e) in BAD_MODEL.items()},
    **{f"scene, {k}": ("mine.toml", text, ["--scene"], e) for k, (text, e) in BAD_SCENE.items()},
    **{k: ("file.txt", "kept", arguments, e) for k, (arguments, e) in BAD_ARGUMENTS.items()},
}


@pytest.mark.parametrize("case", REFUSALS)
def test_misuse_is_refused_in_one_line(case, tmp_path, monkeypatch, capsys):
    name, content, arguments, expected = REFUSALS[case]
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    content = content if isinstance(content, bytes) else content.encode()
    (tmp_path / name).write_bytes(content)
    try:
        status = main(arguments if name == "file.txt" else [*arguments, name])
    except SystemExit as stop:  # argparse leaves this way
        status = stop.code
    error = capsys.readouterr().err
    assert status == 2
    assert error.startswith("regenerate-equations: ")
    assert expected in error
    assert error.count("\n") == 1
    assert (tmp_path / name).read_bytes() == content
    assert not list(tmp_path.glob("cache/**/*.py"))


def test_a_refusal_in_a_worker_is_one_line_too(own, tmp_path):
    own.write_text(
        OWN_MODEL.replace(
            "    potential =", "    if spec.drop:\n        raise ValueError('no')\n    potential ="
        )
        .replace("discretise)", 'discretise, choices=au.Choices(drop=("a", "b")))')
        .replace("SPECS = (", 'SPECS = (au.ModelSpec("pair", "plain", drop=("a",)), ')
    )
    done = run("--model", own, "--out", tmp_path / "out", "--jobs", 2, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr == "regenerate-equations: model pair_plain_without_a: no (line 12)\n"


def test_models_of_one_name_are_refused(own, tmp_path, capsys):
    specs = 'au.ModelSpec("pair", "plain", outputs=("stability",))'
    specs += ', au.ModelSpec("pair", "plain_for_stability")'
    text = OWN_MODEL.replace('("plain",)', '("plain", "plain_for_stability")')
    own.write_text(text.partition("SPECS")[0] + f"SPECS = ({specs})\n")
    assert main(["--model", str(own), "--out", str(tmp_path / "out")]) == 2
    assert "would both be called ['pair_plain_for_stability']" in capsys.readouterr().err


def test_a_module_that_was_not_emitted_stays(tmp_path, capsys):
    mine = tmp_path / f"{QUICK}.py"
    mine.write_text("MINE = 1\n")
    assert main(["--out", str(tmp_path), QUICK]) == 2
    assert f"{mine}: found a file that was not emitted" in capsys.readouterr().err
    assert texts(tmp_path) == {mine.name: b"MINE = 1\n"}
