"""Whole-file validation: every value of a scene to SI at once, every problem in one error."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import chain, pairwise
from typing import Any, get_args

from ...derive.spec import ModelSpec
from ..core.errors import BadInput, Problem, bad, refuse, shown
from ..core.units import DIMENSIONS, expected, to_si
from .checks import check_chart, check_geometry, check_measured, check_series, collecting
from .layouts import LAYOUTS
from .linkage_tables import chart_table
from .schema import Key, Kind, Layout, Range, Table

Values = dict[str, dict[str, Any]]


def validate(document: Mapping[str, Any]) -> tuple[Layout, Values]:
    """Check a whole scene and convert its quantities, every problem in one error.

    The values are by table and key: SI floats, tuples of them, counts and texts, defaults filled
    in.
    """
    problems: list[Problem] = []
    layout = find_layout(document, problems)
    if layout is None:
        raise BadInput(*problems)
    _top_level(document, layout, problems)
    values: Values = {}
    for table in layout.all_tables():
        read = _table(document.get(table.name), table, layout, problems)
        if read is not None:
            values[table.name] = read
    if {"formulation", "flexible"} <= set(values.get("model", {})):
        problems += _complete_model(values["model"], layout)
    for check in (check_geometry, check_chart, check_measured, check_series):
        with collecting(problems):
            check(values, layout)
    if not problems:
        problems += _unusable_names(values.get("model", {}))
    refuse(list(dict.fromkeys(problems)))
    return layout, values


def nearest(word: str, known: Iterable[str], otherwise: str, most: int = 3) -> str:
    """Return ``did you mean ...?`` with the nearest known words, or another remedy."""
    words = list(known)
    close = [one for one in words if word and one.startswith(word)][:most]
    close = close or difflib.get_close_matches(word, words, n=most, cutoff=0.6)
    return f"did you mean {' or '.join(close)}?" if close else otherwise


def show(value: object) -> str:
    """Return a value as text that is short enough for one line."""
    if isinstance(value, Mapping):
        return "a table"
    return shown(value)


def find_layout(
    document: Mapping[str, Any], problems: list[Problem] | None = None
) -> Layout | None:
    """Return the layout that a scene's mechanism and formulation call for, as far as they tell.

    Guessed where only the formulation is wrong; what is wrong is added to ``problems``.
    """
    problems = [] if problems is None else problems
    layouts = declared_layout(document, problems) or LAYOUTS
    model = document.get("model")
    mechanisms = list(dict.fromkeys(layout.mechanism for layout in layouts))
    if not isinstance(model, Mapping):
        found = "nothing" if model is None else show(model)
        fix = f"begin with [model] and mechanism = '{mechanisms[0]}'"
        problems.append(Problem("model", found, "a table [model]", fix))
        return None
    mechanism = model.get("mechanism")
    if mechanism not in mechanisms:
        found = "nothing" if mechanism is None else show(mechanism)
        remedy = "use one of these, or declare the tables of your own mechanism in [schema]"
        fix = nearest(str(mechanism), mechanisms, remedy)
        problems.append(Problem("model.mechanism", found, f"one of {mechanisms}", fix))
        return None
    own = [layout for layout in layouts if layout.mechanism == mechanism]
    formulation = model.get("formulation")
    for layout in own:
        if not layout.formulations or formulation in layout.formulations:
            return layout
    names = [name for layout in own for name in layout.formulations]
    if formulation is not None:
        fix = nearest(str(formulation), names, "choose one")
        problems.append(Problem("model.formulation", show(formulation), f"one of {names}", fix))
    bent = set(model.get("flexible") or ()) if isinstance(model.get("flexible"), list) else set()
    bent |= {"coupler"} & set(document)
    return next((layout for layout in own if bent & set(layout.flexible)), own[0])


def _top_level(document: Mapping[str, Any], layout: Layout, problems: list[Problem]) -> None:
    known = [*(table.name for table in layout.all_tables()), "title", "source"]
    for name, value in document.items():
        if name in {"title", "source"} and not isinstance(value, str):
            problems.append(Problem(name, show(value), "a text", "put it in quotes"))
        elif name not in {*known, "schema"}:
            kind = "table" if isinstance(value, Mapping) else "key"
            fix = nearest(name, known, f"remove it, or correct {kind} and mechanism")
            where = f"[{name}]" if kind == "table" else name
            problems.append(Problem(where, f"an unknown {kind}", f"some of {known}", fix))


def _table(
    given: object, table: Table, layout: Layout, problems: list[Problem]
) -> dict[str, Any] | None:
    if given is None:
        if not table.required:
            defaults = {key.name: key.default for key in table.keys if key.default is not None}
            return None if table.named else defaults or None
        need = ", ".join(key.name for key in table.keys if key.required)
        fix = f"add it, with {need}" if need else "add it"
        problems.append(Problem(f"[{table.name}]", "nothing", f"a table: {table.meaning}", fix))
        return None
    if not isinstance(given, Mapping):
        problems.append(Problem(table.name, show(given), "a table", f"write [{table.name}]"))
        return None
    if table.named:
        return _named_tables(given, table, layout, problems)
    _unknown_keys(given, table, layout, problems)
    values: dict[str, Any] = {}
    for key in table.keys:
        where = f"{table.name}.{key.name}"
        if key.name in given or key.default is not None:
            # Defaults are read, too: those that a scene declares may have units.
            value = given.get(key.name, key.default)
            with collecting(problems):
                values[key.name] = _read(value, key, where)
        elif key.required:
            what = f"{key.meaning}: {_expectation(key)}"
            problems.append(Problem(where, "nothing", what, f"add it to [{table.name}]"))
    _groups(given, table, problems)
    return values


def _named_tables(
    given: Mapping[str, Any], table: Table, layout: Layout, problems: list[Problem]
) -> dict[str, Any]:
    """Read every table of ``[table.NAME]``."""
    found = {}
    for name, content in given.items():
        full = f"{table.name}.{name}"
        one = replace(table, name=full, named=False)
        if isinstance(content, Mapping):
            found[name] = _table(content, one, layout, problems)
        else:
            fix = f"write [{table.name}.NAME] above the keys"
            problems.append(Problem(full, show(content), "a table under a name", fix))
    return found


def _unknown_keys(
    given: Mapping[str, Any], table: Table, layout: Layout, problems: list[Problem]
) -> None:
    known = [key.name for key in table.keys]
    if others := [name for name in given if name in table.elsewhere and name not in known]:
        where = ", ".join(f"{table.name}.{name}" for name in others)
        found = "unknown keys" if len(others) > 1 else "an unknown key"
        problems.append(Problem(where, found, f"some of {known}", table.instead))
    for name in given:
        if name in known or name in others:
            continue
        homes = [other.name for other in layout.all_tables() if other.key(name)]
        fix = nearest(name, known, "remove it")
        if homes and not fix.startswith("did"):
            fix = f"move it to [{homes[0]}]"
        where = f"{table.name}.{name}"
        problems.append(Problem(where, "an unknown key", f"some of {known}", fix))


def _groups(given: Mapping[str, Any], table: Table, problems: list[Problem]) -> None:
    for group in table.exactly_one + table.at_most_one:
        present = [name for name in group if name in given]
        if len(present) > 1:
            found, fix = " and ".join(present), f"keep one of {', '.join(present)}"
        elif not present and group in table.exactly_one:
            found, fix = "none of them", f"add {group[0]} or {group[1]}"
        else:
            continue
        which = "exactly one" if group in table.exactly_one else "at most one"
        problems.append(Problem(f"[{table.name}]", found, f"{which} of {', '.join(group)}", fix))


def _expectation(key: Key) -> str:
    if key.kind == "quantity":
        return expected(key.dimension)
    if key.kind == "quantities":
        size = f"{key.length} numbers" if key.length else "numbers"
        return f"a list of {size}, each {expected(key.dimension)}"
    words = {"count": "a whole number", "counts": "a list of whole numbers"}
    if key.kind in words:
        return words[key.kind]
    kind = "a text" if key.kind == "text" else "a list of texts"
    return f"{kind} of {list(key.choices)}" if key.choices else kind


def _read(value: object, key: Key, where: str) -> Any:
    """Return what a file gives for a key, checked and in SI units; every wrong item is told."""
    if not key.kind.endswith("s"):
        return _read_one(value, key, where)
    if not isinstance(value, (list, tuple)):
        raise bad(where, show(value), _expectation(key), "put it in brackets: [...]")
    if key.length is not None and len(value) != key.length:
        raise bad(where, f"{len(value)} values", f"{key.length} values", "correct the list")
    if key.kind == "quantities" and len(value) == 0:
        raise bad(where, "an empty list", _expectation(key), "add a value")
    if key.axis:  # see check_chart
        return tuple(value)
    problems: list[Problem] = []
    found = []
    for i, item in enumerate(value):
        with collecting(problems):
            found.append(_read_one(item, key, f"{where}[{i}]"))
    refuse(problems)
    if key.rising and any(b <= a for a, b in pairwise(found)):
        raise bad(where, show(value), "values that increase", "sort them")
    return tuple(found)


def _read_one(value: object, key: Key, where: str) -> Any:
    if key.kind.startswith("text"):
        if not isinstance(value, str):
            raise bad(where, show(value), _expectation(key), "put it in quotes")
        if key.choices and value not in key.choices:
            fix = nearest(value, key.choices, "choose one of them")
            raise bad(where, show(value), f"one of {list(key.choices)}", fix)
        return value
    if key.kind.startswith("count"):
        # No text and no 2.0, whoever gives it: a count means the same in a file and in Python.
        if isinstance(value, bool) or not isinstance(value, int):
            raise bad(where, show(value), "a whole number", f"write {where} = 1")
        number: float = value
    else:
        number = to_si(value, key.dimension, where)
    if not {"any": True, "positive": number > 0, "non-negative": number >= 0}[key.limit]:
        fix = f"give {DIMENSIONS[key.dimension].words} above 0"
        fix = "correct the sign" if number < 0 else fix
        raise bad(where, show(value), f"a {key.limit} value: {key.meaning}", fix)
    if key.least is not None and number < key.least:
        raise bad(where, show(value), f"at least {key.least}", "make it larger")
    if key.most is not None and number > key.most:
        raise bad(where, show(value), f"at most {key.most}", "make it smaller")
    return number


def _unusable_names(model: Mapping[str, Any]) -> list[Problem]:
    """Return the names in [model] that cannot be part of a module's name."""
    try:
        ModelSpec.from_mapping(model)
    except ValueError as refusal:
        key, _, told = str(refusal).partition(": found ")
        found, _, expected = told.partition("; expected ")
        return [Problem(f"model.{key}", found, expected, "correct it")]
    return []


def _complete_model(model: dict[str, Any], layout: Layout) -> list[Problem]:
    """Fill in terms left out and the mode count; return what the formulation does not allow."""
    problems = []
    flexible = list(layout.flexible)
    if layout.formulations and set(model["flexible"]) != set(flexible):
        found = show(list(model["flexible"]))
        known = f"{flexible}, which formulation '{model['formulation']}' is about"
        problems.append(Problem("model.flexible", found, known, f"write flexible = {flexible}"))
    sets = (layout.named_drops.get(name, (name,)) for name in model.get("drop", ()))
    model["drop"] = tuple(dict.fromkeys(chain.from_iterable(sets)))
    if flexible:
        model.setdefault("modes", 1)
    elif layout.formulations and "modes" in model:
        fix = "no link bends; remove it"
        problems.append(Problem("model.modes", show(model["modes"]), "nothing", fix))
    return problems


KEY_FIELDS = ("meaning", "kind", "dimension", "default", "limit", "choices", "required")


def declared_layout(
    document: Mapping[str, Any], problems: list[Problem]
) -> tuple[Layout, ...] | None:
    """Return the layout that a scene declares for itself, or None where it declares nothing.

    Each table of ``[schema]`` names a table of the scene, and each of its keys says the dimension
    of a number (``length = "length"``), or ``"text"`` or ``"count"``, or gives an inline table of
    the fields of :class:`~elastolink.runtime.scenes.schema.Key`.  A key without a default is
    required.  ``closed_in_modes = true`` says that one module serves any number of modes, and
    ``parameters`` names what a chart may vary, with dimensions.  What is wrong with the declaration
    is added to ``problems``.
    """
    schema = document.get("schema")
    if schema is None:
        return None
    model = document.get("model")
    mechanism = model.get("mechanism") if isinstance(model, Mapping) else None
    if not isinstance(schema, Mapping) or not isinstance(mechanism, str):
        expected = "a table, beside [model] with a mechanism"
        problems.append(Problem("schema", repr(schema)[:60], expected, "add it"))
        return None
    parameters: dict[str, str] = {}
    tables: list[Table] = []
    for name, entry in schema.items():
        if name == "closed_in_modes" and isinstance(entry, bool):
            continue
        if not isinstance(entry, Mapping):
            fix = "write [schema.NAME] and below it KEY = 'length'"
            problems.append(Problem(f"schema.{name}", repr(entry)[:60], "a table", fix))
        elif name == "parameters":
            parameters = {key: str(value) for key, value in entry.items()}
            known = f"one of {sorted(DIMENSIONS)}"
            problems += [
                Problem(f"schema.parameters.{key}", repr(dimension), known, "correct it")
                for key, dimension in parameters.items()
                if dimension not in DIMENSIONS
            ]
        else:
            keys = tuple(_key(name, key, value, problems) for key, value in entry.items())
            tables.append(Table(name, f"declared in [schema.{name}]", keys, required=True))
    if parameters:
        tables.append(chart_table(parameters))
    layout = Layout(
        mechanism,
        (),
        tuple(tables),
        parameters=parameters,
        closed_in_modes=schema.get("closed_in_modes") is True,
        system="scenes.own.own_system",
    )
    return (layout,)


def _key(table: str, name: str, entry: object, problems: list[Problem]) -> Key:
    """Turn one declaration into a key; a wrong one becomes a text, and a problem."""
    before = len(problems)

    def refuse(found: str, expected: str, fix: str) -> None:
        problems.append(Problem(f"schema.{table}.{name}", found, expected, fix))

    if isinstance(entry, str):
        entry = {"kind": entry} if entry in get_args(Kind) else {"dimension": entry}
    if not isinstance(entry, Mapping):
        fix = "write KEY = 'length', or KEY = {dimension = 'length', limit = 'positive'}"
        refuse(repr(entry)[:60], "a dimension or a table", fix)
        entry = {}
    kind, dimension = entry.get("kind", "quantity"), entry.get("dimension", "dimensionless")
    limit, choices = entry.get("limit", "any"), entry.get("choices", [])
    known = (kind, get_args(Kind)), (dimension, sorted(DIMENSIONS)), (limit, get_args(Range))
    for found, allowed in known:
        if not isinstance(found, str) or found not in allowed:
            refuse(repr(found)[:60], f"one of {list(allowed)}", "correct it")
    unknown = sorted(set(entry) - set(KEY_FIELDS))
    if unknown:
        refuse(f"unknown {unknown}", f"some of {KEY_FIELDS}", "remove them")
    if not isinstance(choices, list) or not all(isinstance(choice, str) for choice in choices):
        refuse(repr(choices)[:60], "choices as a list of texts", "correct it")
    if len(problems) > before:
        return Key(name, "declared by the scene", "text", default="")
    default = entry.get("default")
    return Key(
        name,
        str(entry.get("meaning", "declared by the scene")),
        kind,
        dimension,
        required=bool(entry.get("required", default is None)),
        default=tuple(default) if isinstance(default, list) else default,
        limit=limit,
        choices=tuple(choices),
    )
