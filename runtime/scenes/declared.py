"""The ``[schema]`` table: how a scene of the user's own mechanism declares what it holds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..core.errors import Problem
from ..core.units import DIMENSIONS
from .linkage_tables import chart_table
from .schema import Key, Layout, Table

_KINDS = ("quantity", "quantities", "count", "counts", "text", "texts")
_FIELDS = ("meaning", "kind", "dimension", "default", "limit", "choices", "required")
_LIMITS = ("any", "positive", "non-negative")


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
    closed = schema.get("closed_in_modes") is True
    return (Layout(mechanism, (), tuple(tables), parameters=parameters, closed_in_modes=closed),)


def _key(table: str, name: str, entry: object, problems: list[Problem]) -> Key:
    """Turn one declaration into a key; a wrong one becomes a text, and a problem."""
    before = len(problems)

    def refuse(found: str, expected: str, fix: str) -> None:
        problems.append(Problem(f"schema.{table}.{name}", found, expected, fix))

    if isinstance(entry, str):
        entry = {"kind": entry} if entry in _KINDS else {"dimension": entry}
    if not isinstance(entry, Mapping):
        fix = "write KEY = 'length', or KEY = {dimension = 'length', limit = 'positive'}"
        refuse(repr(entry)[:60], "a dimension or a table", fix)
        entry = {}
    kind, dimension = entry.get("kind", "quantity"), entry.get("dimension", "dimensionless")
    limit, choices = entry.get("limit", "any"), entry.get("choices", [])
    for found, allowed in ((kind, _KINDS), (dimension, sorted(DIMENSIONS)), (limit, _LIMITS)):
        if not isinstance(found, str) or found not in allowed:
            refuse(repr(found)[:60], f"one of {list(allowed)}", "correct it")
    unknown = sorted(set(entry) - set(_FIELDS))
    if unknown:
        refuse(f"unknown {unknown}", f"some of {_FIELDS}", "remove them")
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
