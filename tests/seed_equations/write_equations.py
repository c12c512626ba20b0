"""Write docs/equations.md from the ledger: run it by hand after a change of entries."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import sympy as sp
from seed_ledger import VERDICTS, Entry, entries, inventory, title

TESTS = Path(__file__).resolve().parents[1]
TARGET = TESTS.parent / "docs" / "equations.md"
# What pytest's conftest does for the entries' own imports.
sys.path += [str(TESTS / "derive"), str(TESTS / "convergence")]
_HEAD = """# The documents' equations, checked

Each row is one equation of a document: the verdict of the test named in its last cell, the printed
form, the derived or corrected form, and what is wrong or dropped, with its size. Printed forms are
transcribed; where a scan may be at fault and not the author, the row says what the scan has.

- **agrees**: equal to an independent derivation, or to numeric truth.
- **slip**: wrong as printed; the derived cell holds the correction, the remark a counterexample.
- **approximation**: terms are dropped; the remark gives their size in the document's own examples.
- **not legible**: the scan has lost it.

Written by `tests/seed_equations/write_equations.py`; edit the entries, not this file.
"""


def _cell(text: str) -> str:
    assert "|" not in text and "\n" not in text, f"breaks the table: {text!r}"
    return text


def _mathematics(form: str) -> str:
    return f"${_cell(form)}$" if form else ""


def _place(chapter: str) -> str:
    return f"chapter {chapter}" if chapter[0].isdigit() else chapter


def row(entry: Entry, *, derived: bool = True) -> str:
    """Return one row of the table; without its machine-written cell where ``derived`` is False."""
    machine = entry.derived_form() if derived or not callable(entry.derived) else "..."
    cells = (
        _cell(entry.title),
        entry.verdict,
        _mathematics(entry.printed),
        _mathematics(machine),
        _cell(entry.remark),
        f"`{entry.test}`",
    )
    return "| " + " | ".join(cells) + " |"


def page(*, derived: bool = True) -> str:
    """Return the whole page, parts in the order of the inventory."""
    covered, parts = inventory()
    found = {(entry.document, entry.label): entry for entry in entries()}
    count = Counter(entry.verdict for entry in found.values())
    total = ", ".join(f"{count[verdict]} {verdict}" for verdict in VERDICTS)
    lines = [_HEAD, f"{len(found)} rows: {total}.", ""]
    for part in parts:
        if part.covers not in covered:
            continue
        lines += [
            f"## {part.document}, {_place(part.chapter)}",
            "",
            "| equation | verdict | printed | derived or corrected | remark | test |",
            "| --- | --- | --- | --- | --- | --- |",
        ]
        labels = part.labels
        lines += [row(found[part.document, label], derived=derived) for label in labels]
        lines += [""]
    lines += ["## Not covered yet", ""]
    for part in parts:
        if part.covers not in covered:
            amount = len(part.labels)
            name = title(part.document, part.numbered[0]) if part.numbered else part.labels[0]
            place = _place(part.chapter)
            lines.append(f"- {part.document}, {place}: {amount} labels from {name} on")
    lines += ["", f"SymPy {sp.__version__} wrote the machine-derived forms.", ""]
    return "\n".join(lines)


if __name__ == "__main__":
    TARGET.parent.mkdir(exist_ok=True)
    TARGET.write_text(page(), encoding="utf-8")
    sys.stdout.write(f"{TARGET}: written\n")
