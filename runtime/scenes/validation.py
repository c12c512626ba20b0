"""Whole-file validation: every value of a scene to SI at once, every problem in one error."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Any

from ..core.errors import BadInput, Problem
from ..core.units import DIMENSIONS, expected, to_si
from .checks import chart_problems, geometry_problems, measured_problems, series_problems
from .declared import declared_layout
from .layouts import LAYOUTS
from .schema import Key, Layout, Table

_Reader = Callable[[object, Key, str, list[Problem]], Any]

Values = dict[str, dict[str, Any]]
_TOP = ("title", "source", "model")


def validate(document: Mapping[str, Any]) -> tuple[Layout, Values]:
    """Check a whole scene and convert its quantities, every problem in one error.

    The values are by table and key: SI floats, tuples of them, counts and texts, defaults filled
    in.
    """
    problems: list[Problem] = []
    layouts = declared_layout(document, problems) or LAYOUTS
    layout = _choose(document, layouts, problems)
    if layout is None:
        raise BadInput(*problems)
    _top_level(document, layout, problems)
    values: Values = {}
    for table in layout.all_tables():
        read = _table(document, table, layout, problems)
        if read is not None:
            values[table.name] = read
    _model_problems(values.get("model", {}), layout, problems)
    for check in (geometry_problems, chart_problems, measured_problems, series_problems):
        problems.extend(check(values, layout))
    if problems:
        raise BadInput(*dict.fromkeys(problems))
    return layout, values


def find_layout(document: Mapping[str, Any]) -> Layout | None:
    """Return the layout that a scene's mechanism and formulation call for, as far as they tell."""
    ignored: list[Problem] = []
    return _choose(document, declared_layout(document, ignored) or LAYOUTS, ignored)


def nearest(word: str, known: Iterable[str], otherwise: str) -> str:
    """Return ``did you mean ...?`` with the nearest known words, or another remedy."""
    close = difflib.get_close_matches(word, list(known), n=3, cutoff=0.6)
    return f"did you mean {' or '.join(close)}?" if close else otherwise


def show(value: object) -> str:
    """Return a value as text that is short enough for one line."""
    if isinstance(value, Mapping):
        return "a table"
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _choose(
    document: Mapping[str, Any], layouts: Sequence[Layout], problems: list[Problem]
) -> Layout | None:
    """Find the layout by mechanism and formulation; guess where only the latter is wrong."""
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
    tables = [table.name for table in layout.all_tables()]
    known = [*tables, "title", "source"]
    for name, value in document.items():
        if name in {"title", "source"}:
            if not isinstance(value, str):
                problems.append(Problem(name, show(value), "a text", "put it in quotes"))
        elif name == "schema":
            continue
        elif name not in known:
            kind = "table" if isinstance(value, Mapping) else "key"
            fix = nearest(name, known, f"remove it, or correct {kind} and mechanism")
            where = f"[{name}]" if kind == "table" else name
            problems.append(Problem(where, f"an unknown {kind}", f"some of {known}", fix))


def _table(
    document: Mapping[str, Any], table: Table, layout: Layout, problems: list[Problem]
) -> dict[str, Any] | None:
    given = document.get(table.name)
    if given is None:
        if not table.required:
            return None if table.named else _defaults(table) or None
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
            read = _READERS[key.kind](value, key, where, problems)
            if read is not None:
                values[key.name] = read
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
            found[name] = _table({full: content}, one, layout, problems)
        else:
            fix = f"write [{table.name}.NAME] above the keys"
            problems.append(Problem(full, show(content), "a table under a name", fix))
    return found


def _defaults(table: Table) -> dict[str, Any]:
    return {key.name: key.default for key in table.keys if key.default is not None}


def _unknown_keys(
    given: Mapping[str, Any], table: Table, layout: Layout, problems: list[Problem]
) -> None:
    known = [key.name for key in table.keys]
    for name in given:
        if name in known:
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


def _quantity(value: object, key: Key, where: str, problems: list[Problem]) -> float | None:
    try:
        number = to_si(value, key.dimension, where)
    except BadInput as error:
        problems.extend(error.problems)
        return None
    return None if _out_of_range(number, value, key, where, problems) else number


def _out_of_range(
    number: float, value: object, key: Key, where: str, problems: list[Problem]
) -> bool:
    low = {"any": True, "positive": number > 0, "non-negative": number >= 0}[key.limit]
    if not low:
        what = f"a {key.limit} value: {key.meaning}"
        fix = (
            "correct the sign" if number < 0 else f"give {DIMENSIONS[key.dimension].words} above 0"
        )
        problems.append(Problem(where, show(value), what, fix))
    elif key.least is not None and number < key.least:
        problems.append(Problem(where, show(value), f"at least {key.least}", "make it larger"))
        return True
    elif key.most is not None and number > key.most:
        problems.append(Problem(where, show(value), f"at most {key.most}", "make it smaller"))
        return True
    return not low


def _list(value: object, key: Key, where: str, problems: list[Problem]) -> Sequence[Any] | None:
    if isinstance(value, (list, tuple)):
        if key.length is not None and len(value) != key.length:
            found = f"{len(value)} values"
            problems.append(Problem(where, found, f"{key.length} values", "correct the list"))
            return None
        return value
    problems.append(Problem(where, show(value), _expectation(key), "put it in brackets: [...]"))
    return None


def _quantities(
    value: object, key: Key, where: str, problems: list[Problem]
) -> tuple[float, ...] | None:
    items = _list(value, key, where, problems)
    if items is None:
        return None
    if len(items) == 0:
        problems.append(Problem(where, "an empty list", _expectation(key), "add a value"))
        return None
    # A chart's own axis decides the dimension of its range; see chart_problems.
    if key.name in {"x_range", "y_range"}:
        return tuple(items)
    numbers = _each(_quantity, items, key, where, problems)
    if numbers is not None and key.rising and any(b <= a for a, b in pairwise(numbers)):
        problems.append(Problem(where, show(value), "values that increase", "sort them"))
        return None
    return numbers


def _count(value: object, key: Key, where: str, problems: list[Problem]) -> int | None:
    # No text and no 2.0, whoever gives it: a count means the same in a file and in Python.
    if isinstance(value, bool) or not isinstance(value, int):
        problems.append(Problem(where, show(value), "a whole number", f"write {where} = 1"))
        return None
    return None if _out_of_range(value, value, key, where, problems) else value


def _text(value: object, key: Key, where: str, problems: list[Problem]) -> str | None:
    if not isinstance(value, str):
        problems.append(Problem(where, show(value), _expectation(key), "put it in quotes"))
        return None
    if key.choices and value not in key.choices:
        fix = nearest(value, key.choices, "choose one of them")
        problems.append(Problem(where, show(value), f"one of {list(key.choices)}", fix))
        return None
    return value


def _each(
    reader: _Reader, value: object, key: Key, where: str, problems: list[Problem]
) -> tuple[Any, ...] | None:
    """Return what a reader makes of every item of a list, or None where one is wrong."""
    items = _list(value, key, where, problems)
    if items is None:
        return None
    read = [reader(item, key, f"{where}[{i}]", problems) for i, item in enumerate(items)]
    found = tuple(item for item in read if item is not None)
    return found if len(found) == len(items) else None


_READERS: dict[str, _Reader] = {
    "quantity": _quantity,
    "quantities": _quantities,
    "count": _count,
    "counts": partial(_each, _count),
    "text": _text,
    "texts": partial(_each, _text),
}


def _model_problems(model: dict[str, Any], layout: Layout, problems: list[Problem]) -> None:
    """Check what the formulation demands of the flexible links, and fill in the mode count."""
    if "formulation" not in model or "flexible" not in model:
        return
    if layout.formulations and set(model["flexible"]) != set(layout.flexible):
        wanted = list(layout.flexible)
        problems.append(
            Problem(
                "model.flexible",
                show(list(model["flexible"])),
                f"{wanted}, which formulation '{model['formulation']}' is about",
                f"write flexible = {wanted}",
            )
        )
    model["drop"] = tuple(
        dict.fromkeys(
            term for name in model.get("drop", ()) for term in layout.named_drops.get(name, (name,))
        )
    )
    if layout.flexible:
        model.setdefault("modes", 1)
    elif layout.formulations and "modes" in model:
        problems.append(
            Problem("model.modes", show(model["modes"]), "nothing", "no link bends; remove it")
        )
