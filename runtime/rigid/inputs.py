"""Checks of the numbers and names that machines, loads and counterweights are given."""

from __future__ import annotations

import math

from ..core.errors import bad, shown


def finite_number(value: object, where: str) -> float:
    """Return a finite number, or raise BadInput."""
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError) as refusal:
        raise bad(where, shown(value), "a number", "correct it") from refusal
    if not math.isfinite(number):
        raise bad(where, shown(value), "a finite number", "correct it")
    return number


def require_link(link: object, links: tuple[str, ...], where: str) -> None:
    """Raise BadInput where a linkage has no such moving link."""
    if link not in links:
        raise bad(where, repr(link), f"one of {', '.join(links)}", "correct the name")
