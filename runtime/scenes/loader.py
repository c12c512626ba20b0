"""Find a scene, read it, apply overrides, check the whole of it, and hand it over in SI units."""

from __future__ import annotations

import math
import os
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from functools import reduce
from importlib import resources
from operator import getitem
from pathlib import Path
from typing import Any

from ...derive.spec import BEAM_FORMULATIONS
from ..core.errors import Problem, bad, refuse, shown
from .beam_tables import complete_beams, complete_crank, complete_rod
from .checks import check_body, check_geometry, collecting
from .scene import ReadOnlyTable, Scene
from .schema import Layout
from .tolerances import flat, half_widths, require_assembly, separated
from .validation import find_layout, nearest, show, validate


def list_scenes() -> tuple[str, ...]:
    """Return the names of the built-in scenes, sorted.

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> import elastolink as el
    >>> print("smith_1972_5152_sixteenth_inch" in el.list_scenes())
    True
    """
    folder = resources.files(__package__) / "data"
    return tuple(sorted(p.name[:-5] for p in folder.iterdir() if p.name.endswith(".toml")))


def scene_titles() -> dict[str, tuple[str, str]]:
    """Return title and source of each built-in scene by name, without reading its quantities."""
    found = {}
    for name in list_scenes():
        document = parse(_built_in(name), name)
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
        replaces that key; None removes a key.  Values may carry tolerances: ``"0.12 m +- 1 mm"``.

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
    >>> import elastolink as el
    >>> scene = el.load_scene("smith_1972_5152_sixteenth_inch", {"links.crank": "80 mm"})
    >>> print(scene.get("links.crank"), round(scene.get("links.coupler"), 4))
    0.08 0.381
    """
    given = {} if overrides is None else overrides
    if not isinstance(given, Mapping):
        fix = 'say {"links.crank": "0.1 m"}, for example'
        raise bad("overrides", shown(given), "a mapping from keys", fix)
    name, text = _find(name_or_path)
    return scene_from_document(name, parse(text, name), given)


def scene_from_document(
    name: str, document: Mapping[str, Any], overrides: Mapping[str, Any] | None = None
) -> Scene:
    """Return the scene of tables as a TOML file gives them; else as :func:`load_scene`."""
    tables = {key: dict(v) if isinstance(v, Mapping) else v for key, v in document.items()}
    _override(tables, overrides or {})
    whole = tables
    tables, marked = separated(tables)
    schema = tables.get("schema")
    own = isinstance(schema, Mapping) and "deviations" in schema
    spread = {} if own else dict(flat(tables.pop("deviations", {})))
    layout, values = validate(tables)
    problems: list[Problem] = []
    with collecting(problems):
        widths = half_widths(marked, values, layout)
        require_assembly(values, widths, layout)
    with collecting(problems):
        deviations = half_widths(spread, values, layout, "deviations.")
    refuse(problems)
    title, source = str(tables.get("title", name)), str(tables.get("source", ""))
    bounds = ReadOnlyTable("tolerances", widths), ReadOnlyTable("deviations", deviations)
    bare = Scene(name, title, source, ReadOnlyTable(name, {}), layout, whole, values)
    return replace(with_numbers(bare, {}), tolerances=bounds[0], deviations=bounds[1])


def with_numbers(scene: Scene, numbers: Mapping[str, Any], *, checked: bool = True) -> Scene:
    """Return a scene with other numbers, exact ones, by dotted key [SI].

    The keys are some of ``scene.given``; what follows from them is filled in anew.  Numbers that
    are no floats, such as Taylor models, are not ``checked`` for lengths that close.
    """
    given = _copied(scene.given)
    for where, number in numbers.items():
        table, _, name = where.rpartition(".")
        reduce(getitem, table.split("."), given)[name] = number
    values = _copied(given)
    if checked:
        check_geometry(values, scene.layout)
    complete(values, scene.layout, checked=checked)
    tables = ReadOnlyTable(scene.name, {k: ReadOnlyTable(k, table) for k, table in values.items()})
    document = _copied(scene.document)
    _override(document, numbers)
    return Scene(scene.name, scene.title, scene.source, tables, scene.layout, document, given)


def _copied(values: Mapping[str, Any]) -> dict[str, Any]:
    return {k: _copied(v) if isinstance(v, Mapping) else v for k, v in values.items()}


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
        reason, fix = refusal.strerror or "an error", "give another path"
        if isinstance(refusal, FileNotFoundError):
            reason = f"no file {given}"
            fix = "correct the path, or write one: elastolink new coupler > mine.toml"
        raise bad("scene", reason, "a readable file", fix) from refusal
    except ValueError as refusal:
        raise bad("scene", show(given), "the path of a file", "check it") from refusal
    fix = nearest(given, list_scenes(), "`elastolink scenes` lists them")
    raise bad("scene", show(given), "a built-in scene or a .toml file", fix)


def _built_in(name: str) -> bytes:
    return (resources.files(__package__) / "data" / f"{name}.toml").read_bytes()


def parse(content: bytes, name: str) -> dict[str, Any]:
    """Return the tables of a TOML file; what is broken in it is refused."""
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


Values = dict[str, dict[str, Any]]


def complete(values: Values, layout: Layout, *, checked: bool = True) -> None:
    """Fill in what the given quantities determine; refuse those that contradict each other."""
    if layout.mechanism == "hill":
        function = values["function"]
        a, b = function["a"], function.get("b", ())
        function["a"] = a + (0.0,) * (len(b) - len(a))
        function["b"] = b + (0.0,) * (len(a) - len(b))
    if layout.formulations == tuple(BEAM_FORMULATIONS):
        complete_beams(values, layout.flexible)
    if "rod" in layout.flexible:
        complete_crank(values["links"])
        complete_rod(values["rod"])
    if not layout.links:
        return
    balanced = values["model"]["balanced"]
    expected, fix = "0, since model.balanced names this link", "remove one of the two"
    contradictions = [
        Problem(f"{link}.{key}", f"{values[link][key]:g}", expected, fix)
        for link in balanced
        for key in ("first_moment", "centre_along")
        if values.get(link, {}).get(key, 0.0) != 0.0
    ]
    refuse(contradictions)
    if "coupler" in layout.flexible:
        _flexible_bar(values["coupler"], values["links"]["coupler"])
    gravity = values["gravity"]["acceleration"]
    problems: list[Problem] = []
    for link in layout.links:
        if link in values:
            # A slider and a block have no length: their mass is at the pin unless they say more.
            length = values["links"].get(link, 0.0)
            with collecting(problems):
                _complete_bar(link, values[link], length, gravity, balanced=link in balanced)
                if checked:
                    check_body(link, values[link])
    refuse(problems)


def _flexible_bar(bar: dict[str, Any], length: float) -> None:
    """Mass per length and frequency from each other, and the damping both ways.

    ``Omega = (pi/l)^2 sqrt(EI/mu)`` (Smith 6.12, 6.13), and ``c = 2 zeta mu Omega``.
    """
    wave = math.pi / length
    stiffness = bar["bending_stiffness"]
    if "mass_per_length" in bar:
        bar["natural_frequency"] = wave**2 * (stiffness / bar["mass_per_length"]) ** 0.5
    else:
        bar["mass_per_length"] = stiffness * wave**4 / bar["natural_frequency"] ** 2
    critical = 2.0 * bar["mass_per_length"] * bar["natural_frequency"]
    if "damping_ratio" in bar:
        bar["damping"] = bar["damping_ratio"] * critical
    else:
        bar.setdefault("damping", 0.0)
        bar["damping_ratio"] = bar["damping"] / critical
    bar["mass"] = bar["mass_per_length"] * length


def _complete_bar(
    link: str, bar: dict[str, Any], length: float, gravity: float, *, balanced: bool
) -> None:
    """Mass, first moments and inertia from whatever gives them; a uniform bar's by default."""
    if "weight" in bar:
        bar["mass"] = bar["weight"] / gravity
    if "density" in bar:
        absent = [key for key in ("width", "thickness") if key not in bar]
        if absent:
            fix = f"add {' and '.join(absent)}, or give mass instead of density"
            raise bad(f"{link}.density", "no section", "width and thickness beside it", fix)
        bar["mass"] = bar["density"] * bar["width"] * bar["thickness"] * length
    given = sorted({"centre_along", "centre_across", "inertia_about_centre"} & set(bar))
    if given and "mass" not in bar:
        expected = "mass, weight or density beside it"
        raise bad(f"{link}.{given[0]}", "no mass", expected, "add the mass")
    if balanced:
        bar["first_moment"] = 0.0
    if "mass" not in bar:
        return
    mass = bar["mass"]
    # About the first joint, from centre and inertia about it.
    bar.setdefault("first_moment", mass * bar.get("centre_along", length / 2.0))
    if "centre_across" in bar:
        bar["transverse_moment"] = mass * bar["centre_across"]
    if "inertia_about_centre" in bar:
        squares = bar["first_moment"] ** 2 + bar.get("transverse_moment", 0.0) ** 2
        bar["inertia"] = bar["inertia_about_centre"] + squares / mass
    bar.setdefault("inertia", mass * length**2 / 3.0)
