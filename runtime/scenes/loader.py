"""Find a scene, read it, apply overrides, check the whole of it, and hand it over in SI units."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from ..core.errors import Problem, bad, refuse, shown
from .derived import complete
from .scene import ReadOnlyTable, Scene
from .validation import find_layout, nearest, show, validate


def list_scenes() -> tuple[str, ...]:
    """Return the names of the built-in scenes, sorted."""
    folder = resources.files(__package__) / "data"
    return tuple(sorted(p.name[:-5] for p in folder.iterdir() if p.name.endswith(".toml")))


def scene_titles() -> dict[str, tuple[str, str]]:
    """Return title and source of each built-in scene by name, without reading its quantities."""
    found = {}
    for name in list_scenes():
        document = _parse(_built_in(name), name)
        found[name] = (str(document.get("title", "")), str(document.get("source", "")))
    return found


def load_scene(
    name_or_path: str | os.PathLike[str], overrides: Mapping[str, Any] | None = None
) -> Scene:
    """Load a built-in scene or a TOML file, and check every key of it at once.

    Parameters
    ----------
    name_or_path : str or path
        A built-in name (see :func:`list_scenes`), or the path of a file.
    overrides : mapping, optional
        Values that replace the file's, by dotted key:
        ``{"model.modes": 3, "links.crank": "0.12 m"}``.  A value that stands for the same thing as
        another key of the file (``coupler.mass_per_length`` for ``coupler.natural_frequency``)
        replaces that key; None removes a key.

    Returns
    -------
    Scene
        In SI units, with what follows from the given quantities filled in.

    Raises
    ------
    BadInput
        If there is no such scene, or anything in it is wrong; every problem is listed.

    Examples
    --------
    >>> scene = load_scene("smith_1972_5152_sixteenth_inch", {"links.crank": 0.08})
    >>> scene.get("links.crank"), round(scene.get("links.coupler"), 4)
    (0.08, 0.381)
    """
    given = {} if overrides is None else overrides
    if not isinstance(given, Mapping):
        fix = 'say {"links.crank": "0.1 m"}, for example'
        raise bad("overrides", shown(given), "a mapping from keys", fix)
    name, text = _find(name_or_path)
    return scene_from_document(name, _parse(text, name), given)


def scene_from_document(
    name: str, document: Mapping[str, Any], overrides: Mapping[str, Any] | None = None
) -> Scene:
    """Return the scene of tables as a TOML file gives them; else as :func:`load_scene`."""
    tables = {key: dict(v) if isinstance(v, Mapping) else v for key, v in document.items()}
    _override(tables, overrides or {})
    layout, values = validate(tables)
    complete(values, layout)
    read_only = {key: _read_only(key, table) for key, table in values.items()}
    return Scene(
        name=name,
        title=str(tables.get("title", name)),
        source=str(tables.get("source", "")),
        tables=ReadOnlyTable(name, read_only),
        layout=layout,
    )


def _read_only(name: str, table: Mapping[str, Any]) -> ReadOnlyTable:
    """Return a table that cannot be changed, nor can the ones inside it."""
    inner = {
        key: _read_only(f"{name}.{key}", value) if isinstance(value, Mapping) else value
        for key, value in table.items()
    }
    return ReadOnlyTable(name, inner)


def _override(tables: dict[str, Any], overrides: Mapping[str, Any]) -> None:
    """Put the overrides into the tables; a key gives way to one that says the same thing."""
    problems: list[Problem] = []
    for dotted, value in overrides.items():
        table, _, key = str(dotted).partition(".")
        if not key and table not in {"title", "source"}:
            fix = f"write {table or 'links'}.KEY"
            problems.append(Problem(f"override {dotted!r}", "no key", "TABLE.KEY", fix))
            continue
        plain = value.tolist() if hasattr(value, "tolist") else value
        target = tables.setdefault(table, {}) if key else tables
        if isinstance(target, dict) and "." in key:
            # [springs.NAME]: a table under a name, copied so that the caller's stays as it is.
            inner, _, key = key.partition(".")
            named = target.get(inner, {})
            target[inner] = target = dict(named) if isinstance(named, Mapping) else named
        if not isinstance(target, dict):
            problems.append(Problem(f"override {dotted!r}", show(target), "a table", "correct it"))
        elif plain is None:
            target.pop(key, None)
        else:
            target[key or table] = plain
    refuse(problems)
    layout = find_layout(tables)
    for dotted in overrides:
        table, _, key = str(dotted).partition(".")
        known = layout.table(table) if layout else None
        for rival in known.rivals(key) if known else ():
            if f"{table}.{rival}" not in overrides:
                tables[table].pop(rival, None)


def _find(name_or_path: str | os.PathLike[str]) -> tuple[str, bytes]:
    """Return the name and the bytes of a scene."""
    if not isinstance(name_or_path, (str, os.PathLike)):
        expected = "a name or a path"
        raise bad("scene", type(name_or_path).__name__, expected, "name a scene or a TOML file")
    given = os.fspath(name_or_path)
    if given in list_scenes():
        return given, _built_in(given)
    path = Path(given)
    try:
        if path.suffix == ".toml" or path.exists():
            return path.stem, path.read_bytes()
    except OSError as refusal:
        reason = refusal.strerror or "an error"
        raise bad(f"scene {given}", reason, "a readable file", "check the path") from refusal
    except ValueError as refusal:
        raise bad("scene", show(given), "the path of a file", "check it") from refusal
    fix = nearest(given, list_scenes(), "`elastolink scenes` lists them")
    raise bad("scene", show(given), "a built-in scene or a .toml file", fix)


def _built_in(name: str) -> bytes:
    return (resources.files(__package__) / "data" / f"{name}.toml").read_bytes()


def _parse(content: bytes, name: str) -> dict[str, Any]:
    where = f"scene {name}"
    try:
        return tomllib.loads(content.decode())
    except UnicodeDecodeError as error:
        found = f"a byte that is no UTF-8 text at position {error.start}"
        raise bad(where, found, "a TOML file in UTF-8", "save it as UTF-8") from error
    except tomllib.TOMLDecodeError as error:
        raise bad(where, f"broken TOML: {error}", "a TOML file", "mend that line") from error
    except ValueError as error:
        fix = "write it with an exponent: 1e300"
        raise bad(where, "a whole number of thousands of digits", "a TOML file", fix) from error
    except RecursionError as error:
        raise bad(where, "brackets too deeply nested", "a TOML file", "flatten it") from error
