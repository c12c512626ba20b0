"""Checks of what functions are given that several packages share."""

from __future__ import annotations

from numbers import Integral
from typing import TypeGuard

import numpy as np
from numpy.typing import NDArray

from .errors import bad
from .namespaces import in_numpy_if_foreign


def is_whole(value: object, least: int, most: int | None = None) -> TypeGuard[int]:
    """Return True for a whole number of any integer type, no truth value, within bounds.

    Parameters
    ----------
    value : object
        What was given.
    least, most : int
        Bounds, both allowed; none above by default.
    """
    if isinstance(value, bool) or not isinstance(value, Integral):
        return False
    number = int(value)
    return least <= number and (most is None or number <= most)


def require_whole(where: str, value: object, least: int, most: int, fix: str = "correct it") -> int:
    """Return a whole number within bounds.

    Parameters
    ----------
    where : str
        What is to be one.
    value : object
        What was given.
    least, most : int
        Bounds, both allowed.
    fix : str
        What to do where it is none.

    Raises
    ------
    BadInput
        If it is none.
    """
    if not is_whole(value, least, most):
        raise bad(where, repr(value), f"a whole number from {least} to {most}", fix)
    return int(value)


def numbers(name: str, value: object) -> NDArray[np.float64]:
    """Return an argument as an array of floats.

    Arrays of other namespaces become NumPy's, wherever NumPy can read them.

    Raises
    ------
    BadInput
        If it is not made of real numbers; text that spells a number is none.
    """
    try:
        given = np.asarray(in_numpy_if_foreign(value))
    except ValueError as ragged:
        raise bad(name, repr(value), "numbers", "correct it") from ragged
    except (TypeError, RuntimeError, BufferError) as unreadable:
        found = f"what NumPy cannot read ({unreadable})"
        raise bad(name, found, "numbers", "convert it to NumPy") from unreadable
    if given.size and given.dtype.kind not in "iuf":
        raise bad(name, repr(value), "real numbers", "give numbers")
    return given.astype(np.float64)
