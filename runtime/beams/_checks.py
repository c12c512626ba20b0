"""Checks of numbers that several records of this package share."""

from __future__ import annotations

import math
from collections.abc import Iterable
from numbers import Real

import numpy as np

from ..errors import BadInput, Problem


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


def sign_problems(
    where: str, record: object, names: Iterable[str], *, positive: bool, fix: str
) -> list[Problem]:
    """Return what is wrong with attributes that are to be positive, or not negative."""
    expected = "a positive number" if positive else "a number, 0 or more"
    found = []
    for name in names:
        value = getattr(record, name)
        if not (is_finite(value) and (value > 0 or (not positive and value == 0))):
            found.append(Problem(f"{where}.{name}", repr(value), expected, fix))
    return found


def names_problems(where: str, value: object) -> list[Problem]:
    """Return what is wrong with a row of names."""
    if isinstance(value, (tuple, list)) and all(isinstance(name, str) for name in value):
        return []
    return [Problem(where, repr(value), "names in a row", 'write ("x", "y"), for example')]


def positive(where: str, **values: float) -> None:
    """Refuse values that are not positive numbers.

    Raises
    ------
    BadInput
        With every problem.
    """
    problems = [
        Problem(f"{where}: {name}", repr(value), "a positive number", "give it in SI units")
        for name, value in values.items()
        if not (is_finite(value) and value > 0)
    ]
    if problems:
        raise BadInput(*problems)
