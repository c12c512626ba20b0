"""Tolerances in a scene: ``"381 mm +- 0.1 mm"`` is a value with bounds to either side of it."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping
from typing import Any

from ..core.errors import BadInput, Problem, bad, refuse, shown
from ..core.units import to_si
from .checks import check_geometry, collecting
from .schema import Key, Layout

_MARKED = re.compile(r"(\s*[-+]?\.?\d.*?)\s*(?:\+/?-|±)\s*(.*)")
_UNIT = re.compile(r"\s*[-+]?[\d.]+(?:[eE][-+]?\d+)?\s*(.*?)\s*")
Widths = dict[str, float]


def separated(tables: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, str]]:
    """Return the tables with values alone, and half-widths as texts by dotted key.

    A unit that stands once, behind either of the two, holds for both.
    """
    marked: dict[str, str] = {}

    def plain(where: str, value: Any) -> Any:
        if isinstance(value, Mapping):
            return {key: plain(f"{where}.{key}", item) for key, item in value.items()}
        if isinstance(value, (list, tuple)):
            return [plain(f"{where}[{i}]", item) for i, item in enumerate(value)]
        found = _MARKED.fullmatch(value) if isinstance(value, str) and "." in where else None
        if found is None:
            return value
        middle, width = found.groups()
        unit, other = (
            number and number.group(1) for number in map(_UNIT.fullmatch, (middle, width))
        )
        marked[where] = f"{width} {unit}" if other == "" and unit else width
        return f"{middle} {other}" if unit == "" and other and other != "%" else middle

    return {name: plain(name, table) for name, table in tables.items()}, marked


def flat(table: object, where: str = "") -> Iterator[tuple[str, Any]]:
    """Yield dotted keys and values of tables inside each other."""
    if isinstance(table, Mapping):
        for key, value in table.items():
            yield from flat(value, f"{where}.{key}" if where else key)
    elif where:
        yield where, table


def half_widths(
    marked: Mapping[str, Any], values: Mapping[str, Any], layout: Layout, table: str = ""
) -> Widths:
    """Return half-widths in SI units by dotted key, or those of a table; those of 0 left out.

    Per cent are of the value.  A bound may not take it out of its range, nor three deviations.
    """
    found: Widths = {}
    problems: list[Problem] = []
    for where, text in marked.items():
        key, value = layout.key(where), dict(flat(values)).get(where)
        told = table + where
        with collecting(problems):
            if key is None or key.kind != "quantity" or value is None:
                expected = "one at a single quantity that the scene gives"
                raise bad(told, f"a tolerance, {shown(text)}", expected, "take it away")
            found[where] = _width(told, text, value, key, 3.0 if table else 1.0)
    refuse(problems)
    return {where: width for where, width in found.items() if width > 0.0}


def _width(where: str, text: Any, value: float, key: Key, reach: float) -> float:
    if isinstance(text, str) and text.endswith("%"):
        width = abs(value) * to_si(text[:-1], "dimensionless", where) / 100.0
    else:
        width = to_si(text, key.dimension, where)
    if width < 0.0:
        raise bad(where, shown(text), "a half-width of 0 or more", "correct the sign")
    left = value - reach * width
    if width and key.limit != "any" and (left < 0.0 or (left == 0.0 and key.limit == "positive")):
        expected = f"{reach:g} times that less than the value, {value:.6g} in SI units"
        raise bad(where, shown(text), expected, "narrow it: the sign would change")
    return width


def require_assembly(values: Mapping[str, Any], widths: Widths, layout: Layout) -> None:
    """Refuse tolerances of lengths within which a linkage does not close, or its crank not turn.

    What :func:`check_geometry` asks for is linear in each length: the corners tell.
    """
    names = [where.removeprefix("links.") for where in widths if where.startswith("links.")]
    for signs in itertools.product((-1.0, 1.0), repeat=len(names)) if names else ():
        moved = {k: s * widths[f"links.{k}"] for k, s in zip(names, signs, strict=True)}
        try:
            links = {k: v + moved[k] if k in moved else v for k, v in values["links"].items()}
            check_geometry({"links": links}, layout)
        except BadInput as refusal:
            wrong, fix = refusal.problems[0], f"narrow the tolerances of {', '.join(names)}"
            told = f"within the tolerances {wrong.found}"
            raise bad(wrong.where, told, wrong.expected, fix) from refusal
