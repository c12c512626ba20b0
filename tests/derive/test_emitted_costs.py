"""Emitted sizes and operation counts stay what they were: a growth is noticed, and where."""

from __future__ import annotations

import json

import pytest
from elastolink.derive.spec import read_manifest
from write_emitted_costs import PACKAGED, STORED, costs

RENEW = "if it is meant, run: python tests/derive/write_emitted_costs.py"
# Words of docstrings may change; a statement more in a function of ten weighs more than that.
_ROOM = 0.02
STORE = json.loads(STORED.read_text())
MODULES = sorted(entry.module for entry in read_manifest(PACKAGED).values())


def complaints(stored, found):
    """Return what differs between stored and found costs of one module."""
    if stored is None:
        return ["is not stored"]
    told = []
    for name in sorted(stored["operations"].keys() | found["operations"].keys()):
        before, now = (costs["operations"].get(name) for costs in (stored, found))
        if before != now:
            told.append(f"{name}: {before} operations stored, {now} found")
    if abs(found["bytes"] - stored["bytes"]) > _ROOM * stored["bytes"]:
        told.append(f"{stored['bytes']} bytes stored, {found['bytes']} found")
    return told


@pytest.fixture(scope="module")
def found():
    return costs()


@pytest.mark.parametrize("module", MODULES)
def test_an_emitted_module_costs_what_it_did(module, found):
    told = complaints(STORE.get(module), found[module])
    assert not told, f"{module}: {'; '.join(told)}; {RENEW}"


def test_the_store_holds_no_module_that_is_gone():
    assert sorted(STORE) == MODULES, RENEW


def test_a_growth_of_any_kind_is_noticed():
    """The guard of the guard: one operation more, a function more, a longer text."""
    stored = {"bytes": 1000, "operations": {"a": 10, "b": 5}}
    assert complaints(stored, {"bytes": 1010, "operations": {"a": 10, "b": 5}}) == []
    for found in (
        {"bytes": 1000, "operations": {"a": 11, "b": 5}},
        {"bytes": 1000, "operations": {"a": 9, "b": 5}},
        {"bytes": 1000, "operations": {"a": 10, "b": 5, "c": 0}},
        {"bytes": 1000, "operations": {"a": 10}},
        {"bytes": 1030, "operations": {"a": 10, "b": 5}},
    ):
        assert len(complaints(stored, found)) == 1
    assert complaints(None, stored) == ["is not stored"]
