"""Checks of the numbers and names that machines, loads and counterweights are given."""

from __future__ import annotations

import numpy as np

from ..core.errors import bad, shown
from ..core.inputs import is_one_of, numbers


def finite_number(value: object, where: str) -> float:
    """Return a finite number, or raise BadInput."""
    number = numbers(where, value)
    if number.size != 1 or not np.isfinite(number).all():
        raise bad(where, shown(value), "a finite number", "correct it")
    return float(number.item())


def require_link(link: object, links: tuple[str, ...], where: str) -> None:
    """Raise BadInput where a linkage has no such moving link."""
    if not is_one_of(link, links):
        raise bad(where, repr(link), f"one of {', '.join(links)}", "correct the name")
