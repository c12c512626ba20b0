"""Measured points: speeds of resonance, ends of unstable regions, and deflections at speeds."""

from __future__ import annotations

import csv
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ..core.errors import BadInput, Problem, bad, refuse
from ..core.families import Array
from ..core.inputs import is_finite
from ..core.plotting import RPM, Axes
from ..core.results import Check, worst_checks
from ..core.units import DIMENSIONS, to_si

KINDS = ("resonance", "unstable from", "unstable to", "deflection", "jump rising", "jump falling")
# Columns of a file by their dimension; None for the one that holds words.
_COLUMNS: Mapping[str, str | None] = {
    "kind": None,
    "speed": "frequency",
    "deflection": "length",
    "speed deviation": "frequency",
    "deflection deviation": "length",
}
_COLOUR = "#5e3c99"
_LINES: tuple[Any, ...] = (":", "--", "-.", "-", (0, (4, 1)), (0, (1, 1)))
_STYLES = dict(zip(KINDS, _LINES, strict=True))
_FORM = "kind, speed [rpm], deflection [mm], speed deviation [rpm], deflection deviation [mm]"


@dataclass(frozen=True)
class Point:
    """One measurement on a running machine.

    Attributes
    ----------
    kind : str
        ``"resonance"``: the speed at which the steady deflection is largest; ``"unstable from"``
        and ``"unstable to"``: a speed at which an unstable region begins or ends, upwards;
        ``"deflection"``: the largest steady deflection at a speed; ``"jump rising"`` and ``"jump
        falling"``: a speed at which the motion jumps as the speed rises or falls.
    speed : float
        Crank speed [rad/s].
    deflection : float, optional
        Largest deflection of the link from its chord [m], of the kind ``"deflection"`` alone.
    deviation : float, optional
        Standard deviation of what is measured [rad/s; m for a deflection].
    given : mapping, optional
        Parameters [SI] that the machine was run with, where they are not those of the scene.

    Raises
    ------
    BadInput
        If the kind is unknown, a number is not positive or finite, or a deflection lacks or is too
        many.

    Examples
    --------
    >>> import elastolink as el
    >>> begins = el.design.Point("unstable from", speed=78.04, deviation=0.16)
    >>> print(begins.kind, begins.speed)
    unstable from 78.04
    """

    kind: str
    speed: float
    deflection: float | None = None
    deviation: float | None = None
    given: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        problems = []
        if not isinstance(self.kind, str) or self.kind not in KINDS:
            problems.append(Problem("kind", repr(self.kind), f"one of {KINDS}", "correct it"))
        for name in ("speed", "deflection", "deviation"):
            value = getattr(self, name)
            if (value is not None or name == "speed") and not (is_finite(value) and value > 0):
                problems.append(Problem(name, repr(value), "a positive number", "correct it"))
        if (self.deflection is not None) != (self.kind == "deflection"):
            found = "none" if self.deflection is None else "one"
            expected = "one for the kind 'deflection' and for no other"
            problems.append(
                Problem("deflection", f"{found} for {self.kind!r}", expected, "mend it")
            )
        if not (isinstance(self.given, Mapping) and all(map(is_finite, self.given.values()))):
            fix = "name each with its value"
            problems.append(Problem("given", repr(self.given), "names of finite numbers", fix))
        refuse(problems)

    @property
    def measured(self) -> float:
        """What is measured: the deflection [m], or the speed [rad/s]."""
        return self.speed if self.deflection is None else self.deflection


def read_points(path: str | os.PathLike[str]) -> tuple[Point, ...]:
    r"""Return the measured points of a CSV file.

    Its first line names the columns with their units: ``kind`` and ``speed [rpm]``, and as far as
    they are known ``deflection [mm]``, ``speed deviation [rpm]``, ``deflection deviation [mm]``;
    others are parameters that the machine was run with, ``follower_inertia [kg m^2]``, in SI units
    where no unit is named.  Empty fields are none; lines that begin with # are left out.

    Parameters
    ----------
    path : path
        The file.

    Returns
    -------
    tuple of Point
        By rows.

    Raises
    ------
    BadInput
        If the file cannot be read, a column is unknown or lacks its unit, or a row is unusable:
        the message names the line.

    Examples
    --------
    >>> import elastolink as el
    >>> from pathlib import Path
    >>> path = Path("points.csv")
    >>> _ = path.write_text("kind, speed [rpm]\nunstable from, 745.2\n")
    >>> print(el.design.read_points(path)[0].kind)
    unstable from
    """
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except (OSError, TypeError, ValueError) as problem:  # ValueError: no text, no path
        reason = getattr(problem, "strerror", None) or problem
        fix = "give the path of a CSV file"
        raise bad("points", f"{path!r}: {reason}", "a text file", fix) from problem
    name = os.fspath(path)
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.split("#")[0].strip()]
    if len(lines) < 2:
        raise bad(name, "no rows", "a first line of names and points below", f"write {_FORM}")
    (number, header), *rows = [(i, _fields(line, f"{name}, line {i}")) for i, line in lines]
    columns = [_column(field, f"{name}, line {number}") for field in header]
    known = [column for column, *_ in columns]
    if len(set(known)) < len(known) or not {"kind", "speed"} <= set(known):
        raise bad(f"{name}, line {number}", ", ".join(header), "kind, speed and more, once", _FORM)
    return tuple(_point(fields, columns, f"{name}, line {i}") for i, fields in rows)


def _fields(line: str, where: str) -> list[str]:
    try:
        return next(csv.reader([line], skipinitialspace=True, strict=True))
    except csv.Error as problem:
        raise bad(where, str(problem), "fields between commas", f"write {_FORM}") from problem


def _column(field: str, where: str) -> tuple[str, str, str | None]:
    """Return name, unit and dimension of a column."""
    form = re.fullmatch(r"([^\[\]]*?)\s*(?:\[\s*([^\[\]]*?)\s*\])?", field.strip())
    if form is None:
        raise bad(where, repr(field.strip()), "a name and its unit in brackets", f"write {_FORM}")
    name, unit = " ".join(form[1].split()), form[2] or ""
    lower = name.lower()
    if lower in _COLUMNS:
        dimension = _COLUMNS[lower]
        if (dimension is not None) != bool(unit):
            raise bad(where, repr(field.strip()), "its unit in brackets", f"write {_FORM}")
        if dimension is not None:
            to_si(f"1 {unit}", dimension, where)
        return lower, unit, dimension
    if not name.isidentifier():
        expected = f"a column of {list(_COLUMNS)}, or a parameter"
        raise bad(where, repr(field.strip()), expected, f"write {_FORM}")
    for dimension in DIMENSIONS:
        with suppress(BadInput):
            to_si(f"1 {unit}".strip(), dimension, where)
            return name, unit, dimension
    raise bad(where, repr(field.strip()), f"a unit of {name} in brackets", "correct the unit")


def _point(
    fields: Sequence[str], columns: Sequence[tuple[str, str, str | None]], where: str
) -> Point:
    if len(fields) != len(columns):
        raise bad(where, f"{len(fields)} fields", f"{len(columns)}", "one for each column")
    kind, values = "", {}
    for text, (name, unit, dimension) in zip(map(str.strip, fields), columns, strict=True):
        if dimension is None:
            kind = " ".join(text.split()).lower()
        elif text:
            to_si(text, "dimensionless", f"{where}, {name}")  # a plain number
            values[name] = to_si(f"{text} {unit}".strip(), dimension, f"{where}, {name}")
    own = "deflection deviation" if kind == "deflection" else "speed deviation"
    other = ({"deflection deviation", "speed deviation"} - {own}).pop()
    if other in values or "speed" not in values:
        found = f"{other} of {kind!r}" if other in values else "no speed"
        raise bad(where, found, f"a speed, and no deviation but the {own}", "correct the row")
    given = {name: value for name, value in values.items() if name not in _COLUMNS}
    try:
        return Point(kind, values["speed"], values.get("deflection"), values.get(own), given)
    except BadInput as refused:
        problems = (replace(p, where=f"{where}, {p.where}") for p in refused.problems)
        raise BadInput(*problems) from refused


@dataclass
class Computed:
    """What is computed at k points, as it is filled in."""

    # Speeds [rad/s] and deflections [m], NaN where there is none; and their errors, (k,).
    values: Array
    errors: Array
    checks: dict[str, Check] = field(default_factory=dict)  # the worst check of each name

    def add(self, checks: Mapping[str, Check]) -> None:
        """Keep the worse of the checks of each name."""
        self.checks = worst_checks([self.checks, checks])


def nearest(i: int, point: Point, speeds: Sequence[float], window: float) -> int:
    """Return which speed is nearest to that of point ``i``; refused where it is not clear."""
    off = [abs(speed - point.speed) for speed in speeds]
    order = sorted(range(len(off)), key=off.__getitem__)
    words = f"{point.kind} at {point.speed * RPM:.6g} rpm"
    fix = "start from other values, or change the window"
    if not off or off[order[0]] > window * point.speed:
        expected = f"a computed one within {100 * window:g} % of the speed"
        raise bad(f"point {i + 1}", words, expected, fix)
    first = order[0]
    others = [k for k in order if abs(speeds[k] - speeds[first]) > 1e-6 * point.speed]
    if others and off[first] > 0.5 * off[others[0]]:
        both = " and ".join(f"{speeds[k] * RPM:.6g}" for k in (first, others[0]))
        found = f"{words}, and computed ones at {both} rpm"
        raise bad(f"point {i + 1}", found, "one that is clearly the nearest", fix)
    return first


def draw_points(ax: Axes, points: Iterable[Point]) -> None:
    """Draw measured points over a crank speed in rpm: lines, with bands of two deviations."""
    for point in checked_points(points):
        speed, style = point.speed * RPM, _STYLES[point.kind]
        ax.axvline(speed, color=_COLOUR, linestyle=style, linewidth=0.9)
        if point.deviation is not None and point.kind != "deflection":
            wide = 2.0 * point.deviation * RPM
            ax.axvspan(speed - wide, speed + wide, color=_COLOUR, alpha=0.12, linewidth=0.0)
        text: dict[str, Any] = {"rotation": 90, "ha": "right", "va": "top", "fontsize": 7}
        text |= {"transform": ax.get_xaxis_transform(), "color": _COLOUR, "clip_on": True}
        ax.text(speed, 0.98, f"measured: {point.kind}", **text)


def checked_points(points: object) -> tuple[Point, ...]:
    """Return points, having checked that they are some."""
    found = tuple(points) if isinstance(points, Iterable) else ()
    if not found or not all(isinstance(point, Point) for point in found):
        raise bad("points", repr(points)[:80], "one Point or more", "make each with Point(...)")
    return found
