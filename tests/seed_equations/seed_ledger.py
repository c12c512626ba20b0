"""The equation ledger: what an entry is, how a test establishes one, and what must be there.

A test function carries its entries: ``@establishes("Smith", "2.1", ...)`` stands above the test
that proves the verdict, so that no verdict exists without a test.  ``inventory.toml`` lists what
the documents contain, independently of the entries.
"""

from __future__ import annotations

import importlib.util
import re
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

HERE = Path(__file__).resolve().parent
Verdict = Literal["agrees", "slip", "approximation", "not legible"]
VERDICTS = ("agrees", "slip", "approximation", "not legible")
DOCUMENTS = ("Smith", "Aannaque", "Beale & Scott")
_NUMBERED = re.compile(r"(\d+|[A-Z])\.\d+|\d+")


@dataclass(frozen=True)
class Entry:
    """One equation: what is printed, what is derived, and what the test says about it.

    Attributes
    ----------
    document, label : str
        Where it stands; the label is that of the inventory.
    printed : str
        The printed form in LaTeX.
    verdict : str
        ``agrees``, ``slip``, ``approximation`` or ``not legible``.
    derived : str or callable
        The derived or corrected form in LaTeX, or a function that returns it from SymPy.
    remark : str
        What is wrong or dropped, with a number; sentences of our own.
    test : str
        Name of the test function, with its file.
    """

    document: str
    label: str
    printed: str
    verdict: Verdict
    derived: str | Callable[[], str]
    remark: str
    test: str

    @property
    def title(self) -> str:
        """Return the document and the label, ``Smith (2.1)`` or ``Smith 2.2.2 phi``."""
        return title(self.document, self.label)

    def derived_form(self) -> str:
        """Return the derived form, from SymPy where a function was given."""
        return self.derived() if callable(self.derived) else self.derived


@dataclass(frozen=True)
class Part:
    """A stretch of a document: the labels found in it, and the part of the work that covers it."""

    document: str
    chapter: str
    covers: str
    numbered: tuple[str, ...]
    unnumbered: tuple[str, ...]
    scan: dict[str, str]

    @property
    def labels(self) -> tuple[str, ...]:
        """Return all labels in the order of the inventory."""
        return self.numbered + self.unnumbered


def title(document: str, label: str) -> str:
    """Return how a row of the table begins."""
    return f"{document} ({label})" if _NUMBERED.fullmatch(label) else f"{document} {label}"


def establishes(
    document: str,
    label: str,
    *,
    printed: str,
    verdict: Verdict,
    derived: str | Callable[[], str] = "",
    remark: str = "",
):
    """Record an entry on the test function that proves its verdict."""

    def record(test):
        where = f"{Path(test.__code__.co_filename).name}::{test.__name__}"
        entry = Entry(document, label, printed, verdict, derived, remark, where)
        test.ledger = (entry, *getattr(test, "ledger", ()))
        return test

    return record


def entries() -> tuple[Entry, ...]:
    """Return the entries of every ``test_*.py`` of this folder, in order of file and line."""
    found: list[Entry] = []
    for path in sorted(HERE.glob("test_*.py")):
        if path.name == "test_ledger.py":
            continue
        spec = importlib.util.spec_from_file_location(f"ledger_{path.stem}", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        for name, value in vars(module).items():
            if name.startswith("test_"):
                found.extend(getattr(value, "ledger", ()))
    return tuple(found)


def inventory() -> tuple[frozenset[str], tuple[Part, ...]]:
    """Return the covered parts of the work and the stretches of the documents."""
    table = tomllib.loads((HERE / "inventory.toml").read_text(encoding="utf-8"))
    parts = tuple(
        Part(
            document=row["document"],
            chapter=row["chapter"],
            covers=row["covers"],
            numbered=tuple(row["numbered"]),
            unnumbered=tuple(row.get("unnumbered", ())),
            scan=dict(row.get("scan", {})),
        )
        for row in table["part"]
    )
    return frozenset(table["covered"]), parts
