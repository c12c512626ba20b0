"""The records of all figures, read from one file of data for each document.

A record holds the figure's label and title, the function that draws it (``draw``, a module and a
name in it, with ``arguments`` after the axes), its panels and size, and the numbers that the text
quotes; ``common`` holds what these share.  A note ``@name`` stands in the file's table ``notes``,
and ``page`` is a document that its notes and tables make up.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from importlib import import_module, resources
from typing import TYPE_CHECKING, Any

from .records import Drawn, FigureEntry, Page, Quoted

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NAMES = ("smith", "aannaque", "beale")


@cache
def documents() -> Mapping[str, tuple[FigureEntry, ...]]:
    """Return the records of each document, in the order of its figures."""
    return {name: _read(name) for name in NAMES}


def _read(document: str) -> tuple[FigureEntry, ...]:
    content = (resources.files(__package__) / "data" / f"{document}.toml").read_text("utf-8")
    data = tomllib.loads(content)
    notes = data.get("notes", {})
    return tuple(_entry(document, record, notes) for record in data["figure"])


def _entry(document: str, record: dict[str, Any], notes: Mapping[str, str]) -> FigureEntry:
    common = record.pop("common", {})
    draw: Callable[[Sequence[Axes]], Drawn] = partial(
        _draw, record.pop("draw"), record.pop("arguments", ())
    )
    if "page" in record:
        record["page"] = Page(**record["page"])
    for name in {"panels", "size"} & record.keys():
        record[name] = tuple(record[name])
    return FigureEntry(
        document,
        draw=draw,
        quoted=tuple(Quoted(**{**common, **row}) for row in record.pop("quoted", ())),
        notes=tuple(
            notes[note[1:]] if note.startswith("@") else note for note in record.pop("notes", ())
        ),
        **record,
    )


def _draw(place: str, arguments: Sequence[Any], axes: Sequence[Axes]) -> Drawn:
    """Call the function that draws; its module is loaded only now."""
    module, _, name = place.partition(".")
    drawn: Drawn = getattr(import_module(f".{module}", __package__), name)(axes, *arguments)
    return drawn
