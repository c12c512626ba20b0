"""What the rods' functions refuse, one line each: modes, places, numbers, terms to drop."""

from __future__ import annotations

import operator
from collections.abc import Collection, Mapping
from numbers import Real
from reprlib import repr as short
from typing import TypeGuard

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import BadInput, Problem, bad
from .basis import Array

# Closer to the pin the integrals of some shapes leave the range of a double.
_NEAREST = 1e-12


def require_modes(modes: object, most: int, why: str) -> int:
    """Return a number of modes as an int, refused where it is none from 1 to the most.

    Parameters
    ----------
    modes : object
        What was given; NumPy's whole numbers are welcome.
    most : int
        Largest number that is offered.
    why : str
        Why there are not more.
    """
    try:
        found = operator.index(modes) if not isinstance(modes, bool) else 0  # type: ignore[arg-type]
    except TypeError:
        found = 0
    if found < 1:
        raise bad("modes", repr(modes), "a whole number from 1", "give the number of shapes")
    if found > most:
        raise bad("modes", found, f"at most {most}: {why}", "take fewer")
    return found


def require_places(place: ArrayLike, alone: bool = False) -> Array:
    """Return the block's places as a vector, refused where the block is not on the rod.

    With ``alone`` a number makes a vector of one.
    """
    expected = f"a vector of places x1/L in 0 < x1/L <= 1, not nearer to the pin than {_NEAREST:g}"
    fix = "keep the block on the rod: a longer rod, or a shorter crank"
    found = as_floats("place", place, expected, alone)
    if found.ndim != 1 or not np.all((found >= _NEAREST) & (found <= 1.0)):
        raise bad("place", _told(found), expected, fix)
    return found


def require_points(x: ArrayLike, where: str = "x", alone: bool = False) -> Array:
    """Return points of the rod as a vector, refused where they are not on it.

    With ``alone`` a number makes a vector of one.
    """
    expected = "a vector of places x/L from 0 to 1"
    found = as_floats(where, x, expected, alone)
    if found.ndim != 1 or not np.all((found >= 0.0) & (found <= 1.0)):
        raise bad(where, _told(found), expected, "stay on the rod")
    return found


def as_floats(where: str, values: ArrayLike, expected: str, alone: bool = False) -> Array:
    """Return values as an array, of one dimension at least with ``alone``; refuse what is none."""
    try:
        return np.array(values, dtype=np.float64, ndmin=int(alone))
    except (TypeError, ValueError, OverflowError):
        raise bad(where, repr(values), expected, "give numbers") from None


def _told(values: Array) -> str:
    """Return shape and range of an array."""
    if not values.size:
        return f"shape {values.shape}"
    if not np.all(np.isfinite(values)):
        return f"shape {values.shape}, not all of it finite"
    return f"shape {values.shape}, values from {np.min(values):.6g} to {np.max(values):.6g}"


def is_finite(value: object) -> TypeGuard[Real]:
    """Return True for a finite real number that a double can hold."""
    try:
        return isinstance(value, Real) and bool(np.isfinite(float(value)))
    except OverflowError:
        return False


def require_numbers(
    values: Mapping[str, object], *, zero: Collection[str] = (), signed: Collection[str] = ()
) -> None:
    """Refuse what is not a finite number above 0, all such at once.

    Parameters
    ----------
    values : mapping
        By name.
    zero : collection of str
        Names of those that may be 0.
    signed : collection of str
        Names of those that may have either sign, but not be 0.
    """
    problems = []
    for name, value in values.items():
        number = float(value) if is_finite(value) else np.nan
        if name in signed:
            usable, expected = abs(number) > 0, "other than 0"
        elif name in zero:
            usable, expected = number >= 0, "from 0"
        else:
            usable, expected = number > 0, "above 0"
        if not usable:
            problems.append(
                Problem(name, short(value), f"a finite number {expected}", "correct it")
            )
    if problems:
        raise BadInput(*problems)


def require_drop(drop: object, known: tuple[str, ...]) -> tuple[str, ...]:
    """Return the terms to leave out, sorted and once each, refused where one is unknown."""
    whole = isinstance(drop, Collection) and not isinstance(drop, str | bytes)
    if not whole or any(name not in known for name in drop):  # type: ignore[attr-defined]
        raise bad("drop", repr(drop), f"some of {known}", "correct it")
    return tuple(name for name in sorted(known) if name in drop)  # type: ignore[operator]
