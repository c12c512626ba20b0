"""The ledger is complete and well formed, its page is current, and a falsified row is seen."""

import re
from collections import Counter
from dataclasses import replace

import pytest
from seed_ledger import DOCUMENTS, TARGET, VERDICTS, entries, frame, inventory, quoted, table, title

ENTRIES = entries()
LABELS = [(part.document, label) for part in inventory() for label in part.labels]
RANGES = {
    "Smith": {"2.": 10, "3.": 3, "4.": 13, "6.": 18, "7.": 51, "8.": 44, "A.": 8},
    "Aannaque": {"3.": 13, "4.": 41, "5.": 21, "6.": 29, "7.": 11, "A.": 8, "B.": 17},
    "Beale & Scott": {"": 49},
}


def test_inventory_lists_every_number():
    for document, chapters in RANGES.items():
        for prefix, last in chapters.items():
            assert {(document, f"{prefix}{i}") for i in range(1, last + 1)} <= set(LABELS)
    assert len(LABELS) == len(set(LABELS))
    for part in inventory():
        assert set(part.scan) <= set(part.labels)


def test_every_label_has_one_row_and_every_row_a_label():
    count = Counter((entry.document, entry.label) for entry in ENTRIES)
    assert [title(*key) for key, times in count.items() if times > 1] == []
    assert [title(*key) for key in set(count) ^ set(LABELS)] == []


@pytest.mark.parametrize("document", DOCUMENTS)
def test_every_transcribed_cell_is_shown(document):
    shown = {entry.label for entry in ENTRIES if entry.document == document}
    assert set(table(document)) == shown | {"letters"}


def test_rows_are_complete():
    for entry in ENTRIES:
        assert entry.verdict in VERDICTS, entry.title
        assert bool(entry.printed) != bool(entry.prose), entry.title
        if entry.verdict in ("slip", "approximation"):
            assert entry.corrected or entry.derived, f"{entry.title}: what is right?"
            assert re.search(r"\d", entry.remark), f"{entry.title}: by how much?"
        assert entry.row(derived=False).startswith(f"| {entry.title} |")
    with pytest.raises(AssertionError, match="breaks the table"):
        replace(ENTRIES[0], remark="a | b").row()


def test_frame_of_the_page_is_current():
    """The rows themselves are compared one by one, each by its own test."""
    rows = {(entry.document, entry.label): entry for entry in ENTRIES}
    ours = frame(rows, lambda entry: f"| {entry.title}")
    theirs = TARGET.read_text(encoding="utf-8").splitlines()
    titles = {line: line.split(" | ")[0] for line in theirs if line.endswith("` |")}
    # Another SymPy may have written the last line.
    assert ours[:-1] == [titles.get(line, line) for line in theirs[:-1]]


def test_a_check_that_reads_nothing_is_seen():
    """Every formula of this row survives as any other: the row's own test would fail."""
    blind = replace(ENTRIES[0], check=lambda entry: None)
    assert all(mutant.survives() for mutant in blind.changed())


def test_quoted_numbers_are_compared_to_half_a_unit_of_their_last_digit():
    quoted([1.2349999, 4.5e-7], "1.23", "4.5e-7")
    for value, text in ((1.2351, "1.23"), (4.56e-7, "4.5e-7"), (1.0, "1.1")):
        with pytest.raises(AssertionError):
            quoted(value, text)
