"""The records of all figures, read from one file of data for each document.

A record holds the figure's label and title, the function that draws it (``draw``, a module and a
name in it, with ``arguments`` after the axes), its panels and size, and what is compared, the
expected value under the name of its kind; ``common`` holds what these share.  A record of a
``kind`` takes what it does not say from the file's table ``kind``, whose quoted numbers follow its
own; a note ``@name`` stands in its table ``notes``; ``page`` is a document that notes and tables
make up.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from importlib import import_module, resources
from typing import Any

from .drawing import Panels
from .records import KINDS, Drawn, FigureEntry, Quoted

NAMES = ("smith", "aannaque", "beale")


@cache
def documents() -> Mapping[str, tuple[FigureEntry, ...]]:
    """Return the records of each document, in the order of its figures."""
    return {name: _read(name) for name in NAMES}


@cache
def contents(document: str) -> Mapping[str, Any]:
    """Return a document's file of data: its records and what else stands printed in it."""
    file = resources.files(__package__) / "data" / f"{document}.toml"
    return tomllib.loads(file.read_text("utf-8"))


def _read(document: str) -> tuple[FigureEntry, ...]:
    data = contents(document)
    notes, kinds = data.get("notes", {}), data.get("kind", {})
    return tuple(
        _entry(document, _merged(kinds.get(record.get("kind", ""), {}), record), notes)
        for record in data["figure"]
    )


def _merged(kind: Mapping[str, Any], record: Mapping[str, Any]) -> dict[str, Any]:
    """Return a record with what its kind adds; tables in both are joined, and quoted numbers."""
    tables = {
        name: {**kind[name], **record[name]}
        for name in kind.keys() & record.keys()
        if isinstance(kind[name], dict)
    }
    quoted = [*record.get("quoted", ()), *kind.get("quoted", ())]
    return {**kind, **record, **tables, "quoted": quoted}


def _entry(document: str, record: dict[str, Any], notes: Mapping[str, str]) -> FigureEntry:
    record.pop("kind", None)
    common = record.pop("common", {})
    place, arguments = record.pop("draw"), record.pop("arguments", ())

    def draw(axes: Panels) -> Drawn | None:
        # The module that draws is loaded only now.
        module, _, name = place.partition(".")
        drawn: Drawn | None = getattr(import_module(f".{module}", __package__), name)(
            axes, *arguments
        )
        return drawn

    for name in {"panels", "size"} & record.keys():
        record[name] = tuple(record[name])
    return FigureEntry(
        document,
        draw=draw,
        quoted=tuple(_quoted(common, row) for row in record.pop("quoted", ())),
        notes=tuple(
            notes[note[1:]] if note.startswith("@") else note for note in record.pop("notes", ())
        ),
        **record,
    )


def _quoted(common: Mapping[str, Any], row: Mapping[str, Any]) -> Quoted:
    """Return one comparison; the key of its expected value is its kind."""
    kind = next(kind for source in (row, common) for kind in KINDS if kind in source)
    given = {**common, **row}
    rest = {name: value for name, value in given.items() if name not in KINDS}
    return Quoted(kind=kind, expected=given[kind], **rest)
