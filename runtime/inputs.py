"""Checks of what functions are given that several packages share."""

from __future__ import annotations

from numbers import Integral
from typing import TypeGuard


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
