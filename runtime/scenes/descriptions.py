"""What scenes may hold, for other readers: a JSON Schema for editors, and a page of all keys.

Both are made of the tables that the loader reads.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from importlib import resources
from typing import Any, get_args

from ..core.units import DIMENSIONS, text_pattern
from .layouts import LAYOUTS
from .schema import Key, Kind, Layout, Range, Table
from .validation import KEY_FIELDS

Schema = dict[str, Any]
_TEXT: Schema = {"type": "string"}
_ANY = Layout("", (), ())


def scene_schema() -> Schema:
    """Return the JSON Schema (2020-12) of scene files.

    It refuses nothing that the loader takes.  What the loader alone can judge passes: lengths that
    close, lists that rise, products of units, names that a model file declares.
    """
    definitions: dict[str, Schema] = {}
    mechanisms: dict[str, list[str]] = {}
    cases, every = [], []
    for layout in LAYOUTS:
        label = f"{layout.mechanism}_{layout.formulations[0]}"
        reference = _define(definitions, label, _layout(layout, definitions))
        named: Schema = {"mechanism": {"const": layout.mechanism}}
        named["formulation"] = {"enum": list(layout.formulations)}
        cases.append({"if": _model(named), "then": reference})
        every.append(reference)
        mechanisms.setdefault(layout.mechanism, []).extend(layout.formulations)
    for mechanism, names in mechanisms.items():
        case, known = {"mechanism": {"const": mechanism}}, {"formulation": {"enum": names}}
        cases.append({"if": _model(case), "then": _model(known)})
    definitions["own"] = _own()
    text = json.dumps(definitions)
    for dimension in DIMENSIONS:
        for limit in get_args(Range):
            for single in (True, False):
                name = _quantity(dimension, limit, single=single)
                if f'#/$defs/{name}"' in text:
                    definitions[name] = {
                        "type": ["number", "string"],
                        "pattern": text_pattern(dimension, limit, tolerance=single),
                        **_bounds(limit),
                    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Scene of elastolink",
        "description": "The numbers of one machine, in SI units or as texts with units.",
        **_model({name: _TEXT for name in ("mechanism", "formulation")}),
        "if": {"required": ["schema"]},
        "then": {"$ref": "#/$defs/own"},
        "else": {**_model({"mechanism": {"enum": list(mechanisms)}}), "allOf": cases},
        # Holds always; editors that do not read "if" find here what they can complete.
        "anyOf": [{}, *every],
        "$defs": definitions,
    }


def _model(keys: Schema) -> Schema:
    """Return the schema of a scene whose ``[model]`` has these keys."""
    model = {"type": "object", "required": list(keys), "properties": keys}
    return {"type": "object", "required": ["model"], "properties": {"model": model}}


def _define(definitions: dict[str, Schema], name: str, schema: Schema) -> Schema:
    """Add a definition, once where tables are equal, and return the reference to it."""
    number = 1
    unique = name
    while definitions.setdefault(unique, schema) != schema:
        number += 1
        unique = f"{name}_{number}"
    return {"$ref": f"#/$defs/{unique}"}


def _layout(layout: Layout, definitions: dict[str, Schema]) -> Schema:
    tables: Schema = {"title": _TEXT, "source": _TEXT, "deviations": {"type": "object"}}
    for table in layout.tables:
        schema = _table(table)
        if table.name == "chart":
            schema |= _chart(layout.parameters)
        tables[table.name] = _define(definitions, table.name, schema)
    model = _table(layout.model)
    model["properties"] |= {
        "mechanism": {"const": layout.mechanism},
        "formulation": {"enum": list(layout.formulations)},
    }
    flexible = model["properties"]["flexible"]
    if layout.flexible:
        flexible["allOf"] = [{"contains": {"const": link}} for link in layout.flexible]
        model["required"] += ["flexible"]
    else:
        flexible["maxItems"] = 0
        model["properties"]["modes"] = False
    return {
        "type": "object",
        "required": ["model", *(table.name for table in layout.tables if table.required)],
        "properties": {"model": model, **tables},
        "additionalProperties": False,
    }


def _table(table: Table) -> Schema:
    if table.named:
        one = _table(replace(table, named=False))
        return {"type": "object", "additionalProperties": one}
    groups: list[Schema] = [
        {"oneOf": [{"required": [name]} for name in group]} for group in table.exactly_one
    ]
    groups += [
        {"not": {"required": [first, other]}}
        for group in table.at_most_one
        for i, first in enumerate(group)
        for other in group[i + 1 :]
    ]
    return {
        "type": "object",
        "description": table.meaning,
        "required": [key.name for key in table.keys if key.required],
        "properties": {key.name: _key(key) for key in table.keys},
        "additionalProperties": False,
        **({"allOf": groups} if groups else {}),
    }


def _chart(parameters: Mapping[str, str]) -> Schema:
    """Return what the axes of a chart say of their ranges."""
    cases = []
    for axis in ("x", "y"):
        for name, dimension in parameters.items():
            items = {"$ref": f"#/$defs/{_quantity(dimension, 'any', single=False)}"}
            chosen = {"required": [axis], "properties": {axis: {"const": name}}}
            ranged = {"properties": {f"{axis}_range": {"items": items}}}
            cases.append({"if": chosen, "then": ranged})
    return {"dependentRequired": {"x_range": ["x"], "y_range": ["y"]}, "allOf": cases}


def _quantity(dimension: str, limit: str, *, single: bool) -> str:
    """Return the name of a definition; a ``single`` quantity may have a tolerance."""
    return f"{dimension}_{limit}" + ("" if single else "_listed")


def _bounds(limit: str) -> Schema:
    return {"positive": {"exclusiveMinimum": 0}, "non-negative": {"minimum": 0}}.get(limit, {})


def _key(key: Key) -> Schema:
    single = not key.kind.endswith("s")
    value: Schema = {"type": "string"}
    if key.kind.startswith("count"):
        value = {"type": "integer", **_bounds(key.limit)}
    elif key.kind.startswith("quantit") and key.axis:
        value = {"type": ["number", "string"]}
    elif key.kind.startswith("quantit"):
        name = _quantity(key.dimension, key.limit, single=single)
        value = {"allOf": [{"$ref": f"#/$defs/{name}"}]}
    if key.choices:
        value["enum"] = list(key.choices)
    if key.least is not None:
        value["minimum"] = key.least
    if key.most is not None:
        value["maximum"] = key.most
    if not single:
        value = {"type": "array", "items": value}
        if key.length is not None:
            value |= {"minItems": key.length, "maxItems": key.length}
        elif key.kind == "quantities":
            value["minItems"] = 1
    told: Schema = {"description": ", ".join(filter(None, (key.meaning, _unit(key))))}
    if key.default is not None:
        default = key.default
        told["default"] = list(default) if isinstance(default, tuple) else default
    return {**told, **value}


def _unit(key: Key) -> str:
    """Return what a key takes, in words: kind or unit, and range."""
    unit = "in the axis's unit" if key.axis else f"in {DIMENSIONS[key.dimension].si}"
    unit = unit if unit != "in " else ""
    noun = {"text": "text", "count": "whole number"}.get(key.kind.rstrip("s"), "number")
    if not key.kind.endswith("s"):
        told = noun if noun != "number" or not unit else unit.removeprefix("in ")
    else:
        told = " ".join(filter(None, ("list of", str(key.length or ""), f"{noun}s", unit)))
    limit = {"positive": "above 0", "non-negative": "0 or more"}.get(key.limit)
    least = None if key.least is None else f"at least {key.least}"
    most = None if key.most is None else f"at most {key.most:g}"
    choices = " or ".join(key.choices) or None
    return ", ".join(filter(None, (told, limit, least, most, choices)))


def _own() -> Schema:
    """Return the schema of a scene that declares its own tables in ``[schema]``."""
    model = _table(_ANY.model)
    dimension = {"enum": sorted(DIMENSIONS)}
    kinds = [*get_args(Kind)]
    fields = {name: {} for name in KEY_FIELDS} | {
        "kind": {"enum": kinds},
        "dimension": dimension,
        "limit": {"enum": [*get_args(Range)]},
        "choices": {"type": "array", "items": _TEXT},
    }
    key = {
        "if": {"type": "string"},
        "then": {"enum": [*kinds, *dimension["enum"]]},
        "else": {"type": "object", "properties": fields, "additionalProperties": False},
    }
    declared = {
        "type": "object",
        "description": "tables of the scene, each key with its dimension or kind",
        "properties": {
            "closed_in_modes": {"type": "boolean"},
            "parameters": {"type": "object", "additionalProperties": dimension},
        },
        "additionalProperties": {"type": "object", "additionalProperties": key},
    }
    return {
        "type": "object",
        "required": ["model", "schema"],
        "properties": {"title": _TEXT, "source": _TEXT, "model": model, "schema": declared},
    }


def keys_page() -> str:
    """Return a page, in Markdown, of every key that the loader knows."""
    found: dict[Table, list[Layout]] = {}
    for layout in LAYOUTS:
        for table in layout.tables:
            found.setdefault(table, []).append(layout)
    lines = [
        (resources.files(__package__) / "data" / "keys.md").read_text("utf-8"),
        "| mechanism | formulation | links that bend | tables |",
        "|---|---|---|---|",
    ]
    for layout in LAYOUTS:
        tables = ", ".join(f"`{table.name}`" for table in layout.tables)
        bent, names = ", ".join(layout.flexible), ", ".join(layout.formulations)
        lines.append(f"| {layout.mechanism} | {names} | {bent} | {tables} |")
    lines += ["", *_table_lines(_ANY.model, LAYOUTS)]
    for table, layouts in sorted(found.items(), key=lambda pair: pair[0].name):
        lines += _table_lines(table, layouts)
    made = "Made by `elastolink schema --page` of the tables that the loader reads."
    return "\n".join([*lines, made])


def _default(value: object) -> str:
    if value is None:
        return ""
    return ", ".join(map(str, value)) or "none" if isinstance(value, tuple) else str(value)


def _table_lines(table: Table, layouts: Sequence[Layout]) -> Iterator[str]:
    yield f"## {table.heading}"
    yield ""
    kinds: dict[str, list[str]] = {}
    for layout in layouts:
        kinds.setdefault(layout.mechanism, []).extend(layout.formulations)
    every = len(layouts) == len(LAYOUTS)
    where = "; ".join(f"{one} ({', '.join(names)})" for one, names in kinds.items())
    yield f"{table.meaning[0].upper()}{table.meaning[1:]}. In: {'all scenes' if every else where}."
    yield ""
    yield "| key | takes | default | meaning |"
    yield "|---|---|---|---|"
    for key in table.keys:
        default = "required" if key.required else _default(key.default)
        yield f"| `{key.name}` | {_unit(key)} | {default} | {key.meaning} |"
    yield ""
    for which, groups in (("Exactly", table.exactly_one), ("At most", table.at_most_one)):
        for group in groups:
            yield f"{which} one of {', '.join(f'`{name}`' for name in group)}."
            yield ""
