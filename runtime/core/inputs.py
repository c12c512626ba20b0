"""Checks of what functions are given that several packages share."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from numbers import Integral, Real
from typing import Any, TypeGuard

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import Problem, bad, refuse, shown


def is_whole(value: object, least: int, most: int | None = None) -> TypeGuard[int]:
    """Return True for a whole number of any integer type, no truth value, within bounds."""
    if isinstance(value, bool) or not isinstance(value, Integral):
        return False
    number = int(value)
    return least <= number and (most is None or number <= most)


def require_whole(where: str, value: object, least: int, most: int, fix: str = "correct it") -> int:
    """Return a whole number within bounds, both allowed; refuse anything else."""
    if not is_whole(value, least, most):
        raise bad(where, repr(value), f"a whole number from {least} to {most}", fix)
    return int(value)


# What a number of a sign is called, and the least one.
_SIGNS = {
    "any": ("a finite number", -math.inf),
    "not negative": ("a finite number, 0 or more", 0.0),
    "positive": ("a positive number", math.ulp(0.0)),
}


def as_numpy(value: Any) -> Any:
    """Return an array of another namespace as NumPy's, from any device; anything else as it is."""
    if not hasattr(value, "__array_namespace__") or isinstance(value, (np.ndarray, np.generic)):
        return value
    # In DLPack's numbering the kind of device whose memory NumPy sees is 1.
    if value.__dlpack_device__()[0] == 1:
        return np.array(np.from_dlpack(value))
    return np.array(np.from_dlpack(value, device="cpu"))


def numbers(name: str, value: object) -> NDArray[np.float64]:
    """Return an argument as an array of floats; refuse what is not made of real numbers.

    Arrays of other namespaces become NumPy's, wherever NumPy can read them; text that spells a
    number is none, nor is what an array masks.
    """
    if np.ma.is_masked(value):
        raise bad(name, "masked entries", "numbers", "leave them out, or fill them with NaN")
    try:
        given = np.asarray(as_numpy(value))
    except ValueError as ragged:
        raise bad(name, repr(value), "numbers", "correct it") from ragged
    except (TypeError, RuntimeError, BufferError) as unreadable:
        found = f"what NumPy cannot read ({unreadable})"
        raise bad(name, found, "numbers", "convert it to NumPy") from unreadable
    if given.size and given.dtype.kind not in "iuf":
        fix = "give numbers"
        if given.dtype.kind == "U" and name.startswith("speed"):
            fix += " in rad/s: 400 rpm is 400 * math.pi / 30"
        raise bad(name, repr(value), "real numbers", fix)
    return given.astype(np.float64)


def is_finite(value: object) -> bool:
    """Return True for a finite real number."""
    if not isinstance(value, Real) or isinstance(value, bool):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer too large for a float
        return False


def are_finite(value: object, count: int) -> bool:
    """Return True for so many finite real numbers in a row."""
    if not isinstance(value, (tuple, list, np.ndarray)):
        return False
    return len(value) == count and all(is_finite(part) for part in value)


def require_flag(where: str, value: object) -> None:
    """Refuse what is neither True nor False."""
    if not isinstance(value, bool | np.bool_):
        raise bad(where, shown(value), "True or False", "choose one")


def require_between(where: str, value: object, least: float, most: float, fix: str) -> None:
    """Refuse what is no number within bounds, both allowed."""
    if not (is_finite(value) and least <= value <= most):  # type: ignore[operator]
        raise bad(where, repr(value), f"a number from {least:g} to {most:g}", fix)


def is_one_of(value: object, names: Iterable[str]) -> bool:
    """Return True for a text that is one of several; no other thing is, nor does it break this."""
    return isinstance(value, str) and value in names


def require_one_of(
    where: str, value: object, names: Iterable[str], fix: str = "correct the name"
) -> None:
    """Refuse what is not one of several texts."""
    known = tuple(names)
    if not is_one_of(value, known):
        raise bad(where, shown(value), f"one of {', '.join(known)}", fix)


def number_problems(
    where: str, given: Mapping[str, Any], sign: str = "any", fix: str = "correct it"
) -> list[Problem]:
    """Return what is wrong with numbers of a sign: ``any``, ``not negative`` or ``positive``."""
    expected, least = _SIGNS[sign]
    return [
        Problem(f"{where}.{name}", shown(value), expected, fix)
        for name, value in given.items()
        if not (is_finite(value) and value >= least)
    ]


def text_problems(where: str, **values: object) -> list[Problem]:
    """Return what is wrong with names: each has to be a text that is not empty."""
    return [
        Problem(f"{where}.{name}", shown(value), "a name in quotes", "name it")
        for name, value in values.items()
        if not (isinstance(value, str) and value)
    ]


def names_problems(where: str, value: object) -> list[Problem]:
    """Return what is wrong with a row of names."""
    if isinstance(value, (tuple, list)) and all(isinstance(name, str) for name in value):
        return []
    return [Problem(where, repr(value), "names in a row", 'write ("x", "y"), for example')]


def names_in_a_row(where: str, value: object) -> tuple[str, ...]:
    """Return a row of names, one alone being a row of one; refuse anything else."""
    row = (value,) if isinstance(value, str) else value
    refuse(names_problems(where, row))
    return tuple(row)  # type: ignore[arg-type]


def require_positive(where: str, **values: Any) -> None:
    """Refuse values that are not positive numbers, all of them in one error."""
    refuse(number_problems(where, values, "positive", "give it in SI units"))


def require_kind(where: str, value: object, kind: type | tuple[type, ...], fix: str) -> None:
    """Refuse what is not an instance of a class, or of one of several."""
    if not isinstance(value, kind):
        names = " or ".join(one.__name__ for one in (kind if isinstance(kind, tuple) else (kind,)))
        raise bad(where, type(value).__name__, f"a {names}", fix)


def require_mapping(where: str, value: object, fix: str) -> None:
    """Refuse what is no mapping from names."""
    if not (isinstance(value, Mapping) and all(isinstance(name, str) for name in value)):
        raise bad(where, repr(value), "a mapping from names", fix)


def numbers_in_a_row(where: str, value: ArrayLike, unit: str = "") -> NDArray[np.float64]:
    """Return finite numbers as a row that is not empty; one alone is a row of one."""
    row = np.atleast_1d(numbers(where, value))
    if row.ndim != 1 or not row.size or not np.all(np.isfinite(row)):
        raise bad(where, repr(value), f"finite numbers in a row{unit}", "correct them")
    return row


def speed_span(speed_range: tuple[float, float]) -> tuple[float, float]:
    """Return a rising pair of positive speeds as floats; refuse anything else."""
    values = numbers("speed_range", speed_range)
    if values.shape != (2,) or not np.all(np.isfinite(values)) or not 0 < values[0] < values[1]:
        expected = "(low, high) in rad/s with 0 < low < high"
        fix = "boundaries accumulate at zero: choose a positive lowest speed"
        raise bad("speed_range", speed_range, expected, fix)
    return float(values[0]), float(values[1])
