"""Write docs/rod_convergence.md: run it by hand after a change of a basis of the rod."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from functools import cache, partial
from pathlib import Path

import numpy as np
from rod_bases import (
    BASES,
    REFERENCE,
    RODS,
    condition,
    deflection_error,
    frequency_error,
    order,
    tongue,
)

TARGET = Path(__file__).resolve().parents[2] / "docs" / "rod_convergence.md"
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

_HEAD = """# How the bases of the rod converge

The deflection of the rod from the line through the block is written on shapes that move with the
block (`elastolink.runtime.systems.rod`): `overhang`, the exact modes of the rod held still;
`polynomial`, Beale & Scott's modes (12)-(14); `two_segment`, polynomials on each side of the block
with one slope through it; `free_free_linear`, modes of the free rod carried to the line of the
block. All on the same equations, centrifugal tension kept.

A number in a table is an error; `-` stands for one below what can be told (frequencies 1e-8,
steady motion 1e-11, motion from rest 1e-5). The order k of error ~ n^-k is fitted to what can be
told from four modes on; where the error falls faster than n^-8, `spectral` stands.

Written by `tests/convergence/write_rod_convergence.py`; a test keeps it current.
"""


def _cell(value: float, floor: float) -> str:
    return "-" if value < floor else f"{value:.1e}"


def _order(errors: Iterable[float], floor: float) -> str:
    """Return the fitted order, ``spectral`` where it is beyond any that is expected."""
    known = [(n, e) for n, e in zip(COUNTS, errors, strict=True) if n >= 4 and e > floor]
    if len(known) < 3:
        return "-"
    fitted = order(*zip(*known, strict=True))
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


def _table(heads: Iterable[str], rows: Iterable[Row]) -> list[str]:
    heads = tuple(heads)
    lines = ["| " + " | ".join(heads) + " |", "|" + " --- |" * len(heads)]
    return [*lines, *("| " + " | ".join(row) + " |" for row in rows), ""]


def page() -> str:
    """Return the whole page."""
    counts = tuple(f"n = {n}" for n in COUNTS)
    lines = [
        _HEAD,
        "## Natural frequencies, rod and block held still",
        "",
        "Relative error of the first and second frequency with the block at x1/L, against the",
        "roots of the pinned beam with an overhang; the overhang modes have none.",
        "",
        *_table(("x1/L", "frequency", "basis", *counts, "order"), frequency_rows()),
        "## Tip deflection",
        "",
        "Largest error over the peak. The flexible rod at 100 rad/s, crank over base 0.01; the",
        "stiff one (Bahgat & Willmert, 0.1268 lbm/in read as a mass) at 90 rad/s. `steady`: the",
        f"periodic motion; `from rest`: the first turn. Against two segments, n = {REFERENCE}.",
        "",
        *_table(("rod", "motion", "basis", *counts, "order"), deflection_rows()),
        "## A combination tongue",
        "",
        "The flexible rod with crank over base 0.05: crank speeds [rad/s] about omega1 + omega2",
        "between which the motion grows by more than 1 % a turn, and how far the middle is off",
        "that of eight two-segment polynomials.",
        "",
        *_table(("basis", "n", "from", "to", "middle off by"), tongue_rows()),
        "## Condition of the mass matrix",
        "",
        "Scaled to a unit diagonal, the worst of the places above; `singular`: beyond 1e15.",
        "",
        *_table(("basis", *(f"n = {n}" for n in CONDITIONS)), condition_rows()),
        *_READING,
    ]
    return "\n".join(lines)


_READING = (
    "## Reading",
    "",
    "- Every sum of Beale & Scott's modes has a curvature that jumps at the block in proportion to",
    "  the slope there; the true curvature does not. Their error falls like 1/n: the tip's",
    "  steady deflection is some 15 % off with three modes, still 2 % with twelve.",
    "- With three of them and the block at 0.6 L the first frequency is 5 % too high, the second",
    "  28 %, and so the combination tongue of the two more than 20 %.",
    "- The free rod's modes have a continuous shear at the block, where the block's force makes it",
    "  jump: between second and third order. The overhang modes meet all conditions of the rod",
    "  held still: fourth order and better in the motion. Two segments can meet them: spectral.",
    "- Past some sixteen two-segment polynomials round-off grows with the highest frequency kept.",
    "",
)


if __name__ == "__main__":
    TARGET.write_text(page(), encoding="utf-8")
    sys.stdout.write(f"{TARGET}: written\n")
