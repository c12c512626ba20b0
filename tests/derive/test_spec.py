"""Specs, choices and manifests: the records that both sides of the house share."""

import json
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest
from elastolink.derive.manifest import manifest_text
from elastolink.derive.spec import MANIFEST, Entry, ModelSpec, cache_folder, read_manifest
from hypothesis import given
from hypothesis import strategies as st

BASE = ModelSpec("four_bar", "complete", flexible=("coupler",))
names = st.text("abcxyz_", min_size=1, max_size=8).map(lambda text: "a" + text)
lists = st.lists(names, max_size=4)
tables = st.fixed_dictionaries(
    {"mechanism": names, "formulation": names},
    optional={
        "flexible": lists,
        "modes": st.none() | st.integers(1, 99),
        "drop": lists,
        "balanced": lists,
        "outputs": lists,
    },
)


@given(tables)
def test_a_spec_survives_its_canonical_text(table):
    spec = ModelSpec.from_mapping(table)
    again = ModelSpec.from_mapping(json.loads(spec.canonical()))
    assert again == spec
    assert (again.key(), again.name()) == (spec.key(), spec.name())
    assert spec.name().isidentifier()


@given(tables, st.randoms())
def test_order_and_repetition_of_names_do_not_matter(table, random):
    shuffled = {
        key: random.sample(value, len(value)) * 2 if isinstance(value, list) else value
        for key, value in table.items()
    }
    assert ModelSpec.from_mapping(shuffled) == ModelSpec.from_mapping(table)


@pytest.mark.parametrize("field", [field.name for field in fields(ModelSpec)])
def test_every_field_counts_in_key_and_name(field):
    value = 7 if field == "modes" else ("other",)
    changed = BASE.with_(**{field: value[0] if field in {"mechanism", "formulation"} else value})
    assert changed.key() != BASE.key()
    assert changed.name() != BASE.name()


def entry(name):
    spec = ModelSpec("a", name)
    return spec.key(), Entry(spec.name(), spec, "c" * 32, "t" * 64)


def test_a_manifest_is_read_as_it_was_written(tmp_path):
    entries = dict(entry(name) for name in ("y", "x", "z"))
    (tmp_path / MANIFEST).write_text(manifest_text(entries))
    assert read_manifest(tmp_path) == entries
    assert manifest_text(dict(reversed(entries.items()))) == manifest_text(entries)


def test_what_another_version_wrote_is_left_out(tmp_path):
    entries = dict(entry(name) for name in ("x", "y"))
    table = json.loads(manifest_text(entries))
    first, second = table["modules"]
    table["modules"][first]["spec"]["colour"] = "red"
    (tmp_path / MANIFEST).write_text(json.dumps(table))
    assert list(read_manifest(tmp_path)) == [second]
    assert read_manifest(tmp_path / "nowhere") == {}


@pytest.mark.parametrize(
    ("environment", "expected"),
    [
        ({"XDG_CACHE_HOME": "/x"}, Path("/x/elastolink/modules")),
        ({"XDG_CACHE_HOME": "", "LOCALAPPDATA": "/l"}, Path("/l/elastolink/modules")),
        ({"XDG_CACHE_HOME": "/x", "LOCALAPPDATA": "/l"}, Path("/x/elastolink/modules")),
    ],
)
def test_the_cache_folder_follows_the_environment(environment, expected, monkeypatch):
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    assert cache_folder() == expected


def test_the_spec_loads_with_the_standard_library_alone():
    code = (
        "import sys\n"
        "for name in 'sympy jinja2 numpy scipy matplotlib pint tqdm mpmath'.split():\n"
        "    sys.modules[name] = None\n"
        "from elastolink.derive.spec import ModelSpec\n"
        "import elastolink.derive.catalogue, elastolink.derive.manifest, elastolink.derive.ir\n"
        "print(ModelSpec('a', 'b').key())\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.strip() == ModelSpec("a", "b").key()
