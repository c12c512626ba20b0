"""The tables of docs/rod_convergence.md."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cache, partial

import numpy as np
from documented_tables import table
from orders import slope
from rod_bases import (
    BASES,
    REFERENCE,
    RODS,
    condition,
    deflection_error,
    frequency_error,
    tongue,
)

COUNTS = (2, 3, 4, 6, 8, 12, 16)
PLACES = (0.4, 0.6, 0.8)
KINDS = ("steady", "from rest")
# Below this a difference is round-off, or of the steps of the motion from rest.
FLOORS = {"frequency": 1e-8, "steady": 1e-11, "from rest": 1e-5}
_SINGULAR = 1e15
CONDITIONS = (3, 6, 12, 20)
TONGUES = (
    ("overhang", (2, 3, 4), 3530.0),
    ("two_segment", (4,), 3640.0),
    ("two_segment", (6, 8), 3530.0),
    ("free_free_linear", (3, 4), 3530.0),
    ("polynomial", (3,), 4320.0),
    ("polynomial", (4, 6, 8), 3640.0),
)
Row = tuple[str, ...]


def _cell(value: float, floor: float) -> str:
    return "-" if value < floor else f"{value:.1e}"


def _order(errors: Iterable[float], floor: float) -> str:
    """Return the fitted order, ``spectral`` where it is beyond any that is expected."""
    known = [(n, e) for n, e in zip(COUNTS, errors, strict=True) if n >= 4 and e > floor]
    if len(known) < 3:
        return "-"
    fitted = -slope(*zip(*known, strict=True))
    return "spectral" if fitted > 8 else f"{fitted:.1f}"


def _rows(error: Callable[[str, int], float], bases: Iterable[str], floor: float) -> Iterator[Row]:
    for name in bases:
        errors = [error(name, n) for n in COUNTS]
        yield (name, *(_cell(e, floor) for e in errors), _order(errors, floor))


def _frequency(place: float, mode: int, name: str, n: int) -> float:
    return frequency_error(BASES[name](n), place, mode)


def _deflection(rod: str, kind: str, name: str, n: int) -> float:
    if name == "two_segment" and n == REFERENCE:
        return 0.0
    return deflection_error(rod, BASES[name](n), kind)


def frequency_rows() -> list[Row]:
    """Return the rows of the table of frozen frequencies."""
    moving = [name for name in BASES if name != "overhang"]
    found: list[Row] = []
    for place in PLACES:
        for mode in (1, 2):
            error = partial(_frequency, place, mode)
            rows = _rows(error, moving, FLOORS["frequency"])
            found += [(f"{place:g}", str(mode), *row) for row in rows]
    return found


def deflection_rows() -> list[Row]:
    """Return the rows of the table of tip deflections."""
    found: list[Row] = []
    for rod in RODS:
        for kind in KINDS:
            rows = _rows(partial(_deflection, rod, kind), BASES, FLOORS[kind])
            found += [(rod, kind, *row) for row in rows]
    return found


def condition_rows() -> list[Row]:
    """Return the rows of the table of conditions: the worst of the places."""
    makers = {
        "powers, as printed": partial(BASES["polynomial"], orthogonal=False),
        "the same span, Jacobi": BASES["polynomial"],
        "two segments": BASES["two_segment"],
    }

    def worst(make: Callable, n: int) -> str:
        found = max(condition(make(n), place) for place in PLACES)
        return f"{found:.1e}" if found < _SINGULAR else "singular"

    return [(name, *(worst(make, n) for n in CONDITIONS)) for name, make in makers.items()]


@cache
def _ends(name: str, n: int, around: float) -> np.ndarray:
    return np.array(tongue(BASES[name](n), around))


def tongue_rows() -> list[Row]:
    """Return the rows of the table of the combination tongue."""
    truth = _ends("two_segment", 8, 3530.0)
    found: list[Row] = []
    for name, counts, around in TONGUES:
        for n in counts:
            ends = _ends(name, n, around)
            shift = 100 * (ends.mean() / truth.mean() - 1)
            found.append((name, str(n), *(f"{end:.0f}" for end in ends), f"{shift:+.1f} %"))
    return found


_COUNTED = [f"n = {n}" for n in COUNTS]
TABLES = {
    "frequencies": lambda: table(
        ("x1/L", "frequency", "basis", *_COUNTED, "order"), frequency_rows()
    ),
    "deflections": lambda: table(("rod", "motion", "basis", *_COUNTED, "order"), deflection_rows()),
    "tongue": lambda: table(("basis", "n", "from", "to", "middle off by"), tongue_rows()),
    "conditions": lambda: table(("basis", *(f"n = {n}" for n in CONDITIONS)), condition_rows()),
}
