"""The ledger is complete where it must be, well formed, and its page is current."""

import re
from collections import Counter
from dataclasses import replace

import pytest
import sympy as sp
from seed_ledger import DOCUMENTS, HERE, VERDICTS, entries, inventory, title
from write_equations import TARGET, page, row

COVERED, PARTS = inventory()
ENTRIES = entries()
KINDS_OF_WORK = {"foundation", "rigid", "hill", "quick_return", "all_flexible"}
RANGES = {
    ("Smith", "2."): 10,
    ("Smith", "3."): 3,
    ("Smith", "4."): 13,
    ("Smith", "6."): 18,
    ("Smith", "7."): 51,
    ("Smith", "8."): 44,
    ("Smith", "A."): 8,
    ("Aannaque", "3."): 13,
    ("Aannaque", "4."): 41,
    ("Aannaque", "5."): 21,
    ("Aannaque", "6."): 29,
    ("Aannaque", "7."): 11,
    ("Aannaque", "A."): 8,
    ("Aannaque", "B."): 17,
    ("Beale & Scott", ""): 49,
}


def labels(*, covered_only):
    return [
        (part.document, label)
        for part in PARTS
        for label in part.labels
        if part.covers in COVERED or not covered_only
    ]


@pytest.mark.parametrize(("where", "last"), RANGES.items())
def test_inventory_lists_every_number(where, last):
    document, prefix = where
    listed = {label for part in PARTS if part.document == document for label in part.numbered}
    assert {f"{prefix}{i}" for i in range(1, last + 1)} <= listed


def test_inventory_is_well_formed():
    everything = labels(covered_only=False)
    assert len(everything) == len(set(everything))
    assert {part.covers for part in PARTS} == KINDS_OF_WORK
    assert {part.document for part in PARTS} == set(DOCUMENTS)
    assert COVERED and COVERED <= KINDS_OF_WORK
    for part in PARTS:
        assert set(part.scan) <= set(part.labels)


def test_every_label_of_a_covered_part_has_an_entry():
    present = {(entry.document, entry.label) for entry in ENTRIES}
    missing = [title(*key) for key in labels(covered_only=True) if key not in present]
    assert missing == []


def test_every_entry_is_in_the_inventory_once():
    count = Counter((entry.document, entry.label) for entry in ENTRIES)
    known = set(labels(covered_only=False))
    assert [title(*key) for key in count if key not in known] == []
    assert [title(*key) for key, times in count.items() if times > 1] == []


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.title)
def test_entry_is_complete(entry):
    assert entry.verdict in VERDICTS
    assert entry.printed
    if entry.verdict in ("slip", "approximation"):
        assert entry.derived, "a slip or an approximation states what is right"
        assert re.search(r"\d", entry.remark), "and gives a number"
    name, function = entry.test.split("::")
    assert f"def {function}(" in (HERE / name).read_text(encoding="utf-8")
    assert row(entry, derived=False).startswith(f"| {entry.title} |")


def test_a_missing_entry_and_a_bad_cell_are_seen():
    present = {(entry.document, entry.label) for entry in ENTRIES[1:]}
    missing = [key for key in labels(covered_only=True) if key not in present]
    assert missing == [(ENTRIES[0].document, ENTRIES[0].label)]
    with pytest.raises(AssertionError, match="breaks the table"):
        row(replace(ENTRIES[0], remark="a | b"))


def test_page_is_current():
    written = TARGET.read_text(encoding="utf-8")
    if f"SymPy {sp.__version__} wrote" in written:
        assert written == page(), "run tests/seed_equations/write_equations.py"
        return
    # Another SymPy may typeset its own cells otherwise: compare everything but those.
    ours = page(derived=False).splitlines()
    theirs = written.splitlines()
    assert len(ours) == len(theirs)
    for mine, other in zip(ours, theirs, strict=True):
        if "| $...$ |" in mine:
            before, after = mine.split("| $...$ |")
            assert other.startswith(before) and other.endswith(after)
        elif not mine.startswith("SymPy "):
            assert mine == other
