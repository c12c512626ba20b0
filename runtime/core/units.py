"""Quantities at the edge: numbers in SI units, or text such as ``"15 in"``, to SI floats.

Two rules go beyond a table of units, both about rates of rotation (dimension ``"frequency"``):

- a number of hertz means cycles per second, so that ``"26 Hz"`` becomes ``2 pi 26`` rad/s, and a
  unit that names an angle (``rad/s``, ``deg/s``, ``turn/s``, ``rpm``) is converted as it stands;
- a bare ``"1/s"`` says neither, and is refused.

Pint is imported only for an unusual unit.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache
from types import MappingProxyType
from typing import Any

from .errors import BadInput, Problem, bad, printable, shown


@dataclass(frozen=True)
class Dimension:
    """What kind of quantity is expected."""

    words: str  # the noun with its article, for messages
    si: str  # the SI unit, in a spelling that this module reads
    example: str  # a quantity as a user may write it


DIMENSIONS: Mapping[str, Dimension] = MappingProxyType(
    {
        "dimensionless": Dimension("a plain number", "", "0.02"),
        "length": Dimension("a length", "m", "15 in"),
        "area": Dimension("an area", "m**2", "3 mm**2"),
        "second_moment": Dimension("a second moment of area", "m**4", "2 mm**4"),
        "time": Dimension("a time", "s", "0.5 s"),
        "angle": Dimension("an angle", "rad", "30 deg"),
        "frequency": Dimension("a rate of rotation or a frequency", "rad/s", "500 rpm"),
        "mass": Dimension("a mass", "kg", "0.4 kg"),
        "mass_per_length": Dimension("a mass per length", "kg/m", "0.31 kg/m"),
        "density": Dimension("a density", "kg/m**3", "7850 kg/m**3"),
        "first_moment": Dimension("a first moment of mass", "kg*m", "0.02 kg*m"),
        "inertia": Dimension("a moment of inertia", "kg*m**2", "0.0058 lbf*in*s**2"),
        "force": Dimension("a force", "N", "1 lbf"),
        "moment": Dimension("a moment", "N*m", "3 N*m"),
        "stress": Dimension("a stress or a modulus", "Pa", "207 GPa"),
        "bending_stiffness": Dimension("a bending stiffness", "N*m**2", "171.5 lbf*in**2"),
        "stiffness": Dimension("a spring stiffness", "N/m", "200 N/m"),
        "damping_per_length": Dimension("a damping per length", "N*s/m**2", "0.1 N*s/m**2"),
        "rotational_stiffness": Dimension("a torsional stiffness", "N*m/rad", "3 N*m/rad"),
        "rotational_damping": Dimension("a torsional damping", "N*m*s/rad", "0.1 N*m*s/rad"),
        "damping": Dimension("a viscous damping", "N*s/m", "0.1 N*s/m"),
        "angular_acceleration": Dimension("an angular acceleration", "rad/s**2", "25 rad/s**2"),
        "acceleration": Dimension("an acceleration", "m/s**2", "384 in/s**2"),
    }
)


@dataclass(frozen=True)
class _Unit:
    """A unit, or a product of units."""

    factor: Decimal  # to the SI unit; not a number where it is no multiple of it (degrees Celsius)
    powers: Mapping[str, Fraction]  # of the base dimensions, by pint's names; no zeros
    counts: frozenset[str] = frozenset()  # "cycles" or "angle" where it counts them


_ANGLES = ("radian", "degree", "turn", "arcminute", "arcsecond", "revolution")
_TURN = Decimal("6.283185307179586476925286766559")
_BASE = {
    "m": _Unit(Decimal(1), {"[length]": Fraction(1)}),
    "kg": _Unit(Decimal(1), {"[mass]": Fraction(1)}),
    "s": _Unit(Decimal(1), {"[time]": Fraction(1)}),
    "rad": _Unit(Decimal(1), {}, frozenset(["angle"])),
    "Hz": _Unit(Decimal(1), {"[time]": Fraction(-1)}, frozenset(["cycles"])),
    "percent": _Unit(Decimal("0.01"), {}),
}
# Definitions of the usual units, exact where they are no angles; all others are left to pint, which
# takes half a second to load.
_USUAL = {
    **{"mm": "0.001 m", "cm": "0.01 m", "km": "1000 m", "um": "0.000001 m"},
    **{"in": "0.0254 m", "inch": "1 in", "ft": "12 in", "yd": "36 in"},
    **{"g": "0.001 kg", "tonne": "1000 kg", "lb": "0.45359237 kg", "lbm": "1 lb", "pound": "1 lb"},
    **{"oz": "0.0625 lb", "slug": "1 lbf*s**2/ft"},
    **{"ms": "0.001 s", "min": "60 s", "minute": "60 s", "hour": "3600 s"},
    **{"N": "1 kg*m/s**2", "kN": "1000 N", "dyn": "0.00001 N"},
    **{"lbf": "9.80665 lb*m/s**2", "kgf": "9.80665 N"},
    **{"Pa": "1 N/m**2", "kPa": "1e3 Pa", "MPa": "1e6 Pa", "GPa": "1e9 Pa"},
    **{"psi": "1 lbf/in**2", "ksi": "1000 psi", "J": "1 N*m", "W": "1 J/s"},
    **{"turn": f"{_TURN} rad", "rev": "1 turn", "deg": f"{_TURN / 360} rad", "degree": "1 deg"},
    **{"rpm": "1 turn/min", "kHz": "1000 Hz"},
}
_OPEN = frozenset("*/·(")
_UNSIGNED = r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?"
_NUMBER = re.compile(rf"\s*([+-]?{_UNSIGNED})")
_COMMA = re.compile(r"\s*[+-]?\d+,\d+(?!\d*[,.])")
_TOKEN = re.compile(r"\s*(?:(\*\*|\^)\s*([+-]?\d{1,2})(?!\d)|([*/()·])|([^\W\d_]\w*|1(?!\d)))")


def to_si(value: object, dimension: str = "dimensionless", where: str = "quantity") -> float:
    """Convert a quantity to a float in SI units; a ``"frequency"`` comes back in rad/s.

    It is a number in SI units, or text: a number, a space, and a unit.  A unit is made of names,
    ``*``, ``/``, ``**`` (or ``^``) with whole exponents, parentheses and blanks, which multiply:
    ``"171.5 lbf*in**2"``, ``"0.31 kg/m"``, ``"0.0058 lbf in s^2"``.  The dimension is one of
    :data:`DIMENSIONS`, ``where`` the key concerned, for the message.

    >>> to_si("15 in", "length")
    0.381
    >>> round(to_si("60 rpm", "frequency"), 6), round(to_si("1 Hz", "frequency"), 6)
    (6.283185, 6.283185)
    """
    if dimension not in DIMENSIONS:
        raise bad(where, repr(dimension), f"a dimension of {sorted(DIMENSIONS)}", "rename it")
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise _not_a_quantity(value, dimension, where)
    if isinstance(value, str):
        number, unit = _split(value, dimension, where)
        # A product of decimals is rounded once, so that 3 in is 0.0762 m to the last digit.
        result = _float(
            Fraction(number) * Fraction(_factor(unit, dimension, where, value)) if unit else number
        )
    else:
        result = _float(value)
    if not math.isfinite(result):
        raise bad(where, shown(value), "a finite quantity", _write_like(dimension))
    return result


def describe(value: float, dimension: str) -> str:
    """Return a value in the SI unit of a dimension as text with its unit, and rpm beside rad/s."""
    unit = DIMENSIONS[dimension].si
    text = f"{value:.6g} {unit}".rstrip()
    if dimension == "frequency":
        text += f" ({value * 30.0 / math.pi:.6g} rpm)"
    return text


def expected(dimension: str) -> str:
    """Return in words what a key of this dimension takes, with an example."""
    kind = DIMENSIONS[dimension]
    if not kind.si:
        return f"{kind.words}, such as {kind.example}"
    return f"{kind.words} in {kind.si}, or text such as '{kind.example}'"


@lru_cache(maxsize=128)
def text_pattern(dimension: str, limit: str = "any", *, tolerance: bool = True) -> str:
    """Return a regular expression of the texts that stand for a quantity, for other programs.

    It lets pass what :func:`to_si` reads, and whatever it cannot judge: products of units, and
    units that only pint knows.  The ``limit`` is ``any``, ``positive`` or ``non-negative``; a
    ``tolerance`` may follow.
    """
    zero = r"(?:0+\.?0*|\.0+)(?![\d.])"
    signs = {"positive": rf"\+?(?!{zero})", "non-negative": rf"(?:\+?|-(?={zero}))"}
    sign, number = signs.get(limit, "[+-]?"), rf"{_UNSIGNED}(?!\d|[eE][+-]?\d)"
    known = "|".join(sorted({*_BASE, *_USUAL}, key=lambda name: (-len(name), name)))
    single = rf"(?:1\s*/\s*)?(?:{known})(?:\s*(?:\*\*|\^)\s*[2-4])?"
    other = r"(?:[^\d\s+±,.:%^)-]|1(?!\d))(?:[^+±,.:%]|(?:\*\*|\^)\s*\+)*"
    fitting = "".join(f"{form}|" for form in _fitting_units(dimension))
    unit = rf"(?:{fitting}(?!{single}\s*(?:$|[+±])){other})"
    width = r"(?:(?:\+/?-|±).*)?" if tolerance else ""
    return rf"^\s*{sign}{number}\s*{unit}?\s*{width}$"


def _fitting_units(dimension: str) -> Iterator[str]:
    """Yield regular expressions of the usual units that have a dimension, and of their powers."""
    forms = [(over, power) for over in ("", "1/") for power in ("", "**2", "**3", "**4")]
    for over, power in forms:
        names = []
        for name in (*_BASE, *_USUAL):
            unit = f"{over}{name}{power}"
            if _product(f for f in _factors(unit, "", "") if f[0] != "1").powers != _powers(
                dimension
            ):
                continue
            with suppress(BadInput):
                to_si(f"1 {unit}", dimension)
                names.append(name)
        if names:
            above = r"1\s*/\s*" if over else ""
            exponent = rf"\s*(?:\*\*|\^)\s*{power[2:]}" if power else ""
            yield f"{above}(?:{'|'.join(names)}){exponent}"


def _split(text: str, dimension: str, where: str) -> tuple[str, str]:
    match = _NUMBER.match(text)
    rest = text[match.end() :] if match else ""
    if match is None or rest.strip()[:1] in {"+", "-", ",", "."} or len(text) > 200:
        raise _not_a_quantity(text, dimension, where)
    return match.group(1), rest.strip()


def _float(value: float | str | Fraction) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _factors(unit: str, where: str, text: str) -> list[tuple[str, int]]:
    """Read a unit as names with exponents; parentheses group a denominator."""
    found: list[tuple[str, int]] = []
    outer = [1]
    sign, position, last = 1, 0, "*"
    while position < len(unit):
        match = _TOKEN.match(unit, position)
        if match is None:
            raise _unreadable(unit, where, text)
        _, power, operator, name = match.groups()
        kind = "power" if power else operator or "name"
        misplaced = last in _OPEN and kind in {"*", "/", "·", ")", "power"} and position > 0
        if misplaced or (kind == "power" and last != "name") or (kind == ")" and len(outer) == 1):
            raise _unreadable(unit, where, text)
        if kind == "power":
            found[-1] = (found[-1][0], found[-1][1] * int(power))
        elif kind == "(":
            outer.append(outer[-1] * sign)
        elif kind == ")":
            outer.pop()
        elif kind == "name":
            found.append((name, outer[-1] * sign))
        sign = -1 if kind == "/" else 1
        position, last = match.end(), kind
    if len(outer) != 1 or last in _OPEN or not found:
        raise _unreadable(unit, where, text)
    return found


def _factor(unit: str, dimension: str, where: str, text: str) -> Decimal:
    """Return the factor from a unit to the SI unit of a dimension."""
    factors = [item for item in _factors(unit, where, text) if item[0] != "1"]
    unknown = [name for name, _ in factors if _unit(name) is None]
    if unknown:
        raise BadInput(*(_unknown_unit(name, where, text) for name in dict.fromkeys(unknown)))
    found = _product(factors)
    if found.powers != _powers(dimension) or found.factor.is_nan():
        raise _wrong_dimension(found, dimension, where, text)
    if dimension == "frequency" and "angle" not in found.counts:
        if "cycles" not in found.counts:
            expected = "a rate that says whether it counts cycles or radians"
            raise bad(where, repr(text), expected, "write Hz, rpm or rad/s instead of 1/s")
        return found.factor * _TURN
    return found.factor


def _product(factors: Iterable[tuple[str, int]]) -> _Unit:
    factor, powers, counts = Decimal(1), dict[str, Fraction](), frozenset[str]()
    for name, power in factors:
        unit = _unit(name)
        if unit is not None:
            factor *= unit.factor**power
            counts |= unit.counts
            for base, exponent in unit.powers.items():
                powers[base] = powers.get(base, Fraction(0)) + exponent * power
    return _Unit(factor, {base: power for base, power in powers.items() if power}, counts)


@lru_cache(maxsize=512)
def _unit(name: str) -> _Unit | None:
    """Return a unit by its name: a usual one or, else, one that pint knows; None where unknown."""
    if name in _BASE:
        return _BASE[name]
    if name not in _USUAL:
        return _unit_of_pint(name)
    number, _, units = _USUAL[name].partition(" ")
    defined = _product(_factors(units, name, units))
    return replace(defined, factor=Decimal(number) * defined.factor)


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(cache_folder=None, non_int_type=Decimal)


def _unit_of_pint(name: str) -> _Unit | None:
    import pint

    registry = _registry()
    try:
        unit = registry.parse_units(name)
        zero, one = (registry.Quantity(Decimal(n), unit).to_base_units() for n in (0, 1))
    except (pint.errors.PintError, AttributeError, ValueError, ArithmeticError, TypeError):
        return None
    names = " ".join(unit._units)
    angle = any(mark in names for mark in _ANGLES)
    return _Unit(
        # Offsets and logarithms do not take zero to zero.
        Decimal(one.magnitude) if zero.magnitude == 0 else Decimal("nan"),
        {base: Fraction(power) for base, power in one.dimensionality.items()},
        frozenset(["angle"] if angle else ["cycles"] if "hertz" in names else []),
    )


@lru_cache(maxsize=64)
def _powers(dimension: str) -> Mapping[str, Fraction]:
    unit = DIMENSIONS[dimension].si
    return _product(_factors(unit, dimension, unit)).powers if unit else {}


def _write_like(dimension: str) -> str:
    return f"write it like '{DIMENSIONS[dimension].example}'"


def _not_a_quantity(value: object, dimension: str, where: str) -> BadInput:
    fix = _write_like(dimension)
    if isinstance(value, str) and _COMMA.match(value):
        point = printable(value).replace(",", ".", 1)[:60]
        fix = f"write a point for the comma: '{point}'"
    return bad(where, shown(value), expected(dimension), fix)


def _unreadable(unit: str, where: str, text: str) -> BadInput:
    fix = f"spell the unit {shown(unit)} with names, *, / and ** alone"
    fix = "give one value, no range" if unit.startswith(":") else fix
    return bad(where, shown(text), "one number and one unit", fix)


def _unknown_unit(name: str, where: str, text: str) -> Problem:
    lowered: dict[str, str] = {}
    for unit in (*_BASE, *_USUAL):
        lowered.setdefault(unit.lower(), unit)
    close = difflib.get_close_matches(name.lower(), list(lowered), n=3, cutoff=0.55)
    fix = "check the spelling and the capitals"
    if close:
        fix = "did you mean " + " or ".join(lowered[match] for match in close) + "?"
    return Problem(where, f"unknown unit '{name}' in {shown(text)}", "a unit that pint knows", fix)


def _wrong_dimension(found: _Unit, dimension: str, where: str, text: str) -> BadInput:
    per_gravity = {**found.powers, "[length]": found.powers.get("[length]", 0) - 1}
    per_gravity["[time]"] = found.powers.get("[time]", 0) + 2
    if {base: power for base, power in per_gravity.items() if power} == _powers(dimension):
        told = f"{shown(text)}, which is a weight"
        fix = "a weight divided by gravity is a mass: write lb instead of lbf, or divide by g"
        return bad(where, told, expected(dimension), fix)
    told = f"{shown(text)}, of dimension {_in_words(found.powers)}"
    return bad(where, told, expected(dimension), _write_like(dimension))


def _in_words(powers: Mapping[str, Fraction]) -> str:
    """Return ``[length] ** 2 / [time]`` or the like."""
    above, below = (
        [
            base if abs(power) == 1 else f"{base} ** {abs(power)}"
            for base, power in sorted(powers.items())
            if (power > 0) == up
        ]
        for up in (True, False)
    )
    return " / ".join([" * ".join(above) or ("1" if below else "dimensionless"), *below])
