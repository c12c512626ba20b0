"""Checks of the numbers and names that machines, loads and counterweights are given."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from ..core.errors import Problem, bad
from ..core.inputs import is_finite, is_one_of, numbers


def not_finite(where: str, values: Mapping[str, object], least: float = -math.inf) -> list[Problem]:
    """Return a problem for each value that is no finite number, or below the least."""
    wanted = "a finite number" + ("" if least == -math.inf else f", at least {least:g}")
    return [
        Problem(f"{where}.{name}", repr(value)[:60], wanted, "correct it")
        for name, value in values.items()
        if not (is_finite(value) and value >= least)  # type: ignore[operator]
    ]


def finite_number(value: object, where: str) -> float:
    """Return a finite number, or raise BadInput."""
    number = numbers(where, value)
    if number.size != 1 or not np.isfinite(number).all():
        raise bad(where, repr(value)[:60], "a finite number", "correct it")
    return float(number.item())


def require_link(link: object, links: tuple[str, ...], where: str) -> None:
    """Raise BadInput where a linkage has no such moving link."""
    if not is_one_of(link, links):
        raise bad(where, repr(link), f"one of {', '.join(links)}", "correct the name")
