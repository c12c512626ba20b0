"""Rooms of ``runtime`` import downwards only, and packages of ``derive`` stand in no circle.

Imports inside functions count; those for type checkers alone do not.
"""

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
# From bottom to top; `docs/architecture.md` shows the same.
LAYERS = (
    "core",
    "linkages",
    "rigid",
    "beams",
    "systems",
    "scenes",
    "hill",
    "periodic",
    "recovery",
    "constrained",
    "frequencies",
    "stability",
    "design",
    "sweeps",
    "gallery",
    "cli",
)

pytestmark = pytest.mark.smoke


def imported(path, root):
    """Yield the packages below ``root`` that a module imports, as their first names."""
    package, tree = path.relative_to(root).parent.parts, ast.parse(path.read_text())
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            node.body = [ast.Pass()]
    for node in ast.walk(tree):
        if not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        climbed = len(package) - (node.level - 1)
        if climbed < 0:
            continue
        target = (*package[:climbed], *(node.module or "").split("."))
        names = [target[0]] if target[0] else [alias.name for alias in node.names]
        for name in names:
            if not package or name != package[0]:
                yield name


def edges(root):
    """Return pairs (importing package, imported package) with a file of each."""
    found = {}
    for path in sorted(root.rglob("*.py")):
        parts = path.relative_to(root).parts
        if len(parts) < 2:
            continue
        for name in imported(path, root):
            if (root / name).is_dir():
                found.setdefault((parts[0], name), path.relative_to(ROOT))
    return found


def upward(pairs):
    """Return imports that do not point down the list of layers."""
    place = {name: k for k, name in enumerate(LAYERS)}
    return {pair: where for pair, where in pairs.items() if place[pair[0]] <= place[pair[1]]}


def test_every_room_has_its_place():
    rooms = {p.parent.name for p in (ROOT / "runtime").glob("*/__init__.py")} - {"_root"}
    assert rooms == set(LAYERS)


def test_rooms_import_downwards_only():
    pairs = {p: w for p, w in edges(ROOT / "runtime").items() if p[0] != "_root"}
    assert not upward(pairs)


def test_an_import_upwards_is_seen(tmp_path):
    (tmp_path / "core").mkdir()
    (tmp_path / "cli").mkdir()
    (tmp_path / "core" / "one.py").write_text("def f():\n    from ..cli import main\n")
    names = list(imported(tmp_path / "core" / "one.py", tmp_path))
    assert names == ["cli"]
    assert upward({("core", "cli"): "core/one.py"})
    quiet = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from ..cli import main\n"
    (tmp_path / "core" / "two.py").write_text(quiet)
    assert not list(imported(tmp_path / "core" / "two.py", tmp_path))


def test_packages_of_derive_stand_in_no_circle():
    graph = {}
    for importer, target in edges(ROOT / "derive"):
        graph.setdefault(importer, set()).add(target)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as circle:
        pytest.fail(f"a circle: {circle.args[1]}")
