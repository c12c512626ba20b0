"""Scene files to begin one's own with: packaged numbers, the words of the loader's tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import resources
from typing import Any

from ..core.errors import bad
from ..core.units import DIMENSIONS
from .loader import parse
from .schema import Key, Table
from .validation import find_layout, nearest
from .writing import toml_line, toml_lines

_FOLDER = resources.files(__package__) / "data" / "new"
_TAIL = """\
# Lines that begin with # are keys which may be added; docs/scene_keys.md has all of them.
# With `elastolink schema > scene.schema.json`, and #:schema ./scene.schema.json as the first line
# of this file, editors complete and check it.
""".splitlines()


def new_kinds() -> dict[str, str]:
    """Return the kinds of scenes that can be begun, each with its title."""
    kinds = sorted(p.name[:-5] for p in _FOLDER.iterdir() if p.name.endswith(".toml"))
    return {kind: str(_start(kind)[1]["title"]) for kind in kinds}


def new_scene(kind: str) -> str:
    """Return a commented scene file of a kind to begin with.

    Raises ``BadInput`` if there is no such kind.
    """
    known = new_kinds()
    if kind not in known:
        raise bad("KIND", repr(kind), f"one of {list(known)}", nearest(kind, known, "choose one"))
    head, document = _start(kind)
    layout = find_layout(document)
    tables = layout.all_tables() if layout else ()
    lines = [*head, *_TAIL, ""]
    texts = {key: value for key, value in document.items() if not isinstance(value, Mapping)}
    lines += toml_lines(texts)
    if "schema" in document:
        lines += toml_lines({"schema": document["schema"]})
    for table in tables:
        given = document.get(table.name, {})
        for name, content in given.items() if table.named else [(None, given)] * bool(given):
            lines += _commented(table, f"{table.name}.{name}" if name else table.name, content)
    absent = [table for table in tables if table.name not in document]
    if absent:
        lines += ["", "# Tables which may be added:"]
        lines += [f"# {table.heading}  {table.meaning}" for table in absent]
    return "\n".join(lines) + "\n"


def new_model() -> str:
    """Return the model file that stands beside the scene ``own_model``."""
    return (_FOLDER / "own_model.txt").read_text("utf-8")


def _start(kind: str) -> tuple[list[str], dict[str, Any]]:
    """Return the comment at the head of a packaged file, and its tables."""
    text = (_FOLDER / f"{kind}.toml").read_text("utf-8")
    lines = text.splitlines()
    return [line for line in lines if line.startswith("#")], parse(text.encode(), kind)


def _commented(table: Table, name: str, given: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of one table: the keys that are given, then the others as comments."""
    yield ""
    yield f"# {table.meaning[0].upper()}{table.meaning[1:]}."
    yield f"[{name}]"
    lines = {key: toml_line(key, value) for key, value in given.items()}
    for key in table.keys:
        lines.setdefault(key.name, f"# {toml_line(key.name, _example(key))}")
    meanings = {key.name: key.meaning for key in table.keys}
    width = max(map(len, lines.values()))
    for name, line in lines.items():
        rivals = [rival for rival in table.rivals(name) if rival in given and name not in given]
        instead = f"; instead of {rivals[0]}" if rivals else ""
        yield f"{line.ljust(width)}  # {meanings[name]}{instead}"


def _example(key: Key) -> Any:
    """Return the default of a key, or a value that it may have."""
    if key.default is not None:
        return key.default
    one: Any = 1
    if key.kind in {"quantity", "quantities"}:
        unit = DIMENSIONS[key.dimension].si
        one = f"1 {unit}" if unit else 1.0
    elif key.kind in {"text", "texts"}:
        one = key.choices[0] if key.choices else "..."
    return [one] * (key.length or 1) if key.kind.endswith("s") else one
