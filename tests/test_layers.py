"""Rooms of ``runtime`` import downwards only, and packages of ``derive`` stand in no circle.

Imports inside functions count; those for type checkers alone do not (:mod:`test_walls` reads them).
"""

from graphlib import CycleError, TopologicalSorter

import pytest
from test_walls import ROOT, imports, relative, sources

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


def edges(folder):
    """Return pairs (importing package, imported package) of a folder, with a file of each."""
    found = {}
    for path in sources(folder):
        own, *inner = path.relative_to(ROOT / folder).parts
        for name, _ in imports(path) if inner else ():
            top, _, target = name.removeprefix("elastolink.").partition(".")
            target = target.partition(".")[0]
            if top == folder and target not in ("", own) and (ROOT / folder / target).is_dir():
                found.setdefault((own, target), relative(path))
    return found


def upward(pairs):
    """Return imports that do not point down the list of layers."""
    place = {name: k for k, name in enumerate(LAYERS)}
    return {pair: where for pair, where in pairs.items() if place[pair[0]] <= place[pair[1]]}


def test_every_room_has_its_place():
    rooms = {p.parent.name for p in (ROOT / "runtime").glob("*/__init__.py")} - {"_root"}
    assert rooms == set(LAYERS)


def test_rooms_import_downwards_only():
    pairs = {p: w for p, w in edges("runtime").items() if p[0] != "_root"}
    assert not upward(pairs)


def test_an_import_upwards_is_seen():
    assert upward({("core", "cli"): "core/one.py"})
    assert ("cli", "core") in edges("runtime")


def test_packages_of_derive_stand_in_no_circle():
    graph = {}
    for importer, target in edges("derive"):
        graph.setdefault(importer, set()).add(target)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as circle:
        pytest.fail(f"a circle: {circle.args[1]}")
