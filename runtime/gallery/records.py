"""Records of all figures, read from one file of data for each document, and what drawing gives.

A record holds the figure's label and title, the function that draws it (``draw``, a module and a
name in it, with ``arguments`` after the axes and the ``looks`` of its curves, where a record has
them), its panels and size, and what is compared, by what each number is, the expected value under
the name of its kind; ``common`` holds what these share.
A record of a ``kind`` takes what it does not say from the file's table ``kind``, whose quoted
numbers follow its own; one with a list ``each`` stands for so many figures, each of which adds to
it.  A text ``@name`` is that of the file's table ``notes``, ``<name>`` within a text that of the
figure's ``texts``; ``page`` is a document that notes and tables make up.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from importlib import import_module, resources
from math import nan
from textwrap import fill
from typing import Any, Literal, SupportsFloat

from ..core.results import Check, Result
from .drawing import Axes, Panels

DOCUMENTS = ("smith", "aannaque", "beale")
Relation = Literal["=", "<", ">"]
Kind = Literal["printed", "words", "check"]

# Of each kind of comparison: what it is, and what its expected number is called.
KINDS: Mapping[Kind, tuple[str, str]] = {
    "printed": ("numbers that the documents print", "printed"),
    "words": ("statements in words, read as numbers", "read as"),
    "check": ("printed tables checked as a whole", "expected"),
}


@dataclass(frozen=True)
class Quoted:
    """One statement of a document, as a number beside the one that is computed here."""

    number: str  # what is compared, in a few words
    expected: float = nan
    computed: float = nan  # not a number in a record that was not drawn
    tolerance: float = 0.0  # largest deviation at which the two agree, in the same unit
    meaning: str = ""  # where the tolerance comes from, or how words were read as a number
    where: str = ""  # section of the document
    relation: Relation = "="  # whether the value should be as expected, below it, or above it
    unit: str = ""  # of the values; empty for a ratio
    differs: str = ""  # why the two are known to differ; empty where they should agree
    kind: Kind = "check"  # whether printed, read from words, or the worst number of a table

    @property
    def deviation(self) -> float:
        """Computed less expected; for an inequality, by how much it is missed."""
        gap = self.computed - self.expected
        if self.relation == "<":
            return max(gap, 0.0)
        if self.relation == ">":
            return min(gap, 0.0)
        return gap

    @property
    def agrees(self) -> bool:
        """True where the deviation is within the tolerance."""
        return bool(abs(self.deviation) <= self.tolerance)

    @property
    def share(self) -> float:
        """Size of the deviation over the tolerance; infinite where none is allowed."""
        return Check(abs(self.deviation), self.tolerance).share

    @property
    def check(self) -> Check:
        """The self-check: agreement, or, where a difference is known, that it is still there."""
        if self.differs:
            return Check(float(self.agrees), 0.5)
        return Check(abs(self.deviation), self.tolerance)

    @property
    def verdict(self) -> str:
        """The outcome in a word or two."""
        if self.agrees:
            return "agrees, against the remark" if self.differs else "agrees"
        return "known to differ" if self.differs else "DIFFERS"

    def to_dict(self) -> dict[str, Any]:
        """Return the row as plain numbers and texts."""
        return {**asdict(self), "deviation": float(self.deviation), "agrees": self.agrees}


def counts(rows: Sequence[Quoted]) -> list[str]:
    """Return for each kind of comparison, in words, how many there are and how they come out."""
    lines = []
    for kind, (what, _) in KINDS.items():
        chosen = [row for row in rows if row.kind == kind]
        agree = sum(row.agrees for row in chosen)
        known = sum(bool(row.differs) and not row.agrees for row in chosen)
        if chosen:
            lines.append(
                f"{what}: {len(chosen)}, of which {agree} agree, {known} are known to differ and "
                f"{len(chosen) - agree - known} differ without a reason"
            )
    return lines


@dataclass(frozen=True)
class Table:
    """A table of finished texts: as many cells in each row as there are headings."""

    title: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    @classmethod
    def of(
        cls,
        title: str,
        columns: Mapping[str, str],
        rows: Iterable[Sequence[Any]],
        words: Mapping[str, object],
    ) -> Table:
        """Return the table of a record: its cells as texts, words in the braces of its headings.

        From the heading of each column to the format of its numbers, empty for texts and counts.
        """
        title, *header = (text.format_map(words) for text in (title, *columns))
        texts = tuple(
            tuple(
                f"{float(cell):{form}}" if form and not isinstance(cell, str) else str(cell)
                for cell, form in zip(row, columns.values(), strict=True)
            )
            for row in rows
        )
        return cls(title, tuple(header), texts)

    def markdown(self) -> list[str]:
        """Return the lines of the table under its title; an empty cell shows a dash."""
        head = [f"## {self.title}", "", "| " + " | ".join(self.header) + " |"]
        head.append("|" + " --- |" * len(self.header))
        return head + ["| " + " | ".join(cell or "–" for cell in row) + " |" for row in self.rows]


@dataclass(frozen=True)
class Drawn:
    """What drawing a figure gives beside the picture, for its record."""

    values: Sequence[SupportsFloat] = ()  # of the quoted numbers, in their order
    # What stands in the braces of notes and of the titles of tables.
    words: Mapping[str, object] = field(default_factory=dict)
    tables: Sequence[Iterable[Sequence[Any]]] = ()  # rows of each table, cells numbers and texts


@dataclass(frozen=True)
class FigureEntry:
    """The record of one figure or table of a document."""

    document: str  # its short name
    label: str  # the figure's number there, such as 27(c); a name for a table of our own
    title: str
    draw: Callable[[Panels], Drawn | None]
    panels: tuple[int, int] = (1, 1)  # rows and columns of axes
    size: tuple[float, float] = (7.2, 4.6)  # width and height of the picture [in]
    projection: str | None = None  # of the axes: "3d" for a picture in space
    axes: Mapping[str, Any] = field(default_factory=dict)  # settings of all panels, see dress
    panel: Sequence[Mapping[str, Any]] = ()  # further settings of each
    legend: int = 4  # columns of the legend below the panels; 0 for none
    quoted: tuple[Quoted, ...] = ()  # numbers of the text that the figure bears on
    notes: tuple[str, ...] = ()  # what the document leaves open and what was chosen for it
    tables: Sequence[Mapping[str, Any]] = ()  # "title" and "columns" of each, see Table.of
    # The document of ours that notes and tables make up, if any: its "file", the "intro" in
    # Markdown that stands before them, and which note is the "first" in it.
    page: Mapping[str, Any] = field(default_factory=dict)

    @property
    def stem(self) -> str:
        """Name of the picture's file, without its ending."""
        plain = (re.sub(r"\W", "", part) for part in self.label.split("."))
        parts = (re.sub(r"^\d+", lambda digits: digits[0].zfill(2), part) for part in plain)
        return "_".join([self.document, *parts])

    def show(self, axes: Panels) -> Shown:
        """Draw the figure and put the computed values beside the quoted ones."""
        drawn = self.draw(axes) or Drawn()
        words = drawn.words
        rows = tuple(
            replace(row, computed=float(value))
            for row, value in zip(self.quoted, drawn.values, strict=True)
        )
        notes = tuple(note.format_map(words) if words else note for note in self.notes)
        tables = tuple(
            Table.of(**one, rows=cells, words=words)
            for one, cells in zip(self.tables, drawn.tables, strict=True)
        )
        return Shown(self, rows, notes, tables)


@cache
def documents() -> Mapping[str, tuple[FigureEntry, ...]]:
    """Return the records of each document, in the order of its figures."""
    return {name: _read(name) for name in DOCUMENTS}


@cache
def contents(document: str) -> Mapping[str, Any]:
    """Return a document's file of data: its records and what else stands printed in it."""
    file = resources.files(__package__) / "data" / f"{document}.toml"
    return tomllib.loads(file.read_text("utf-8"))


def _read(document: str) -> tuple[FigureEntry, ...]:
    data = contents(document)
    notes, kinds = data.get("notes", {}), data.get("kind", {})
    records = (
        _merged(_merged(kinds.get(record.get("kind"), {}), record), one)
        for record in data["figure"]
        for one in record.get("each", [{}])
    )
    return tuple(
        _entry(document, _filled(record, record.get("texts", {}), notes)) for record in records
    )


def _merged(base: Mapping[str, Any], record: Mapping[str, Any]) -> dict[str, Any]:
    """Return a record with what its base adds; tables in both are joined, and quoted numbers."""
    tables = {
        name: {**base[name], **record[name]}
        for name in base.keys() & record.keys()
        if isinstance(base[name], dict)
    }
    # Those of the record come first.
    own, others = (part.get("quoted", {}) for part in (record, base))
    quoted = {number: {**others.get(number, {}), **own.get(number, {})} for number in own | others}
    return {**base, **record, **tables, "quoted": quoted}


def _filled(value: Any, texts: Mapping[str, Any], notes: Mapping[str, str]) -> Any:
    """Return a value with a figure's texts where ``<name>`` stood, and notes where ``@name`` did.

    What is ``<name>`` alone becomes what the figure says, be it a text or not.
    """
    if isinstance(value, dict):
        return {_filled(k, texts, notes): _filled(v, texts, notes) for k, v in value.items()}
    if isinstance(value, list):
        return [_filled(item, texts, notes) for item in value]
    if not isinstance(value, str):
        return value
    if value.startswith("@"):
        value = notes[value[1:]]
    if alone := re.fullmatch(r"<(\w+)>", value):
        return texts[alone[1]]
    return re.sub(r"<(\w+)>", lambda match: str(texts[match[1]]), value)


def _entry(document: str, record: dict[str, Any]) -> FigureEntry:
    for name in ("kind", "each", "texts"):
        record.pop(name, None)
    common = record.pop("common", {})
    place, arguments = record.pop("draw"), record.pop("arguments", ())
    looks = {"looks": record.pop("looks")} if "looks" in record else {}

    def draw(axes: Panels) -> Drawn | None:
        # The module that draws is loaded only now.
        module, _, name = place.partition(".")
        make = getattr(import_module(f".{module}", __package__), name)
        drawn: Drawn | None = make(axes, *arguments, **looks)
        return drawn

    for name in {"panels", "size"} & record.keys():
        record[name] = tuple(record[name])
    return FigureEntry(
        document,
        draw=draw,
        quoted=tuple(
            _comparison(number, common, row) for number, row in record.pop("quoted").items()
        ),
        notes=tuple(record.pop("notes", ())),
        **record,
    )


def _comparison(number: str, common: Mapping[str, Any], row: Mapping[str, Any]) -> Quoted:
    """Return the comparison of one number; the key of its expected value is its kind."""
    kind = next(kind for source in (row, common) for kind in KINDS if kind in source)
    given = {**common, **row}
    rest = {name: value for name, value in given.items() if name not in KINDS}
    return Quoted(number, kind=kind, expected=float(given[kind]), **rest)


@dataclass(frozen=True)
class Shown:
    """A figure that was drawn: its record, with the computed numbers and words in place."""

    entry: FigureEntry
    quoted: tuple[Quoted, ...] = ()
    notes: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()

    @property
    def files(self) -> dict[str, str]:
        """Texts to write beside the picture, by the names of their files."""
        page = self.entry.page
        if not page:
            return {}
        lines = [page["intro"]]
        for note in self.notes[page["first"] :]:
            lines += [fill(note, 110), ""]
        for table in self.tables:
            lines += [*table.markdown(), ""]
        return {page["file"]: "\n".join(lines)}


@dataclass(frozen=True, kw_only=True)
class Gallery(Result):
    """Figures that were redrawn, and every number of the text beside the computed one.

    The ``error`` is the largest deviation over its tolerance among the numbers that should agree;
    ``folder`` is where the pictures and ``index.html`` were written, empty where nothing was.
    """

    shown: tuple[Shown, ...] = field(default=(), repr=False)
    folder: str = ""
    files: tuple[str, ...] = ()

    @property
    def rows(self) -> tuple[tuple[FigureEntry, Quoted], ...]:
        """All quoted numbers, each with its figure."""
        return tuple((item.entry, row) for item in self.shown for row in item.quoted)

    def to_dict(self) -> dict[str, Any]:
        """Return the checks and all rows, ready for JSON."""
        out = super().to_dict()
        out["figures"] = [
            {
                "document": item.entry.document,
                "figure": item.entry.label,
                "title": item.entry.title,
                "notes": list(item.notes),
                "quoted": [row.to_dict() for row in item.quoted],
            }
            for item in self.shown
        ]
        return out

    def lines(self) -> list[str]:
        """Return the rows as lines of text, one for each quoted number."""
        out = []
        for item in self.shown:
            out.append(f"{item.entry.document} {item.entry.label}: {item.entry.title}")
            for row in item.quoted:
                sign = "" if row.relation == "=" else f"{row.relation} "
                unit = f" {row.unit}" if row.unit else ""
                out.append(
                    f"  {row.number}: {KINDS[row.kind][1]} {sign}{row.expected:.4g}{unit}, "
                    f"computed {row.computed:.4g}: {row.verdict}"
                )
        out += ["", *counts([row for _, row in self.rows])]
        if self.folder:
            out += ["", f"{len(self.files)} files in {self.folder}, first index.html"]
        return out

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the deviation of each quoted number over its tolerance and return the axes."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        rows = self.rows
        for known, colour, label in (
            (False, "#1f5a8c", "should agree"),
            (True, "#b5541c", "known to differ"),
        ):
            chosen = {i: row.share for i, (_, row) in enumerate(rows) if bool(row.differs) is known}
            ax.plot(list(chosen.values()), list(chosen), "o", color=colour, ms=4, label=label)
        ax.axvline(1.0, color="0.5", lw=0.8)
        ax.set_xscale("symlog", linthresh=0.1)
        ax.set_yticks(range(len(rows)), [entry.label for entry, _ in rows], fontsize=6)
        ax.invert_yaxis()
        ax.set_xlabel("deviation over tolerance")
        ax.legend(loc="best")
        return ax
