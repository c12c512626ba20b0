"""Barker's fourteen classes of four-bar linkages, and the exact signs that decide between them.

A four-bar linkage can lie flat, and so change its assembly, where one of three sums is zero::

    S_2 = (frame + crank)    - (coupler + follower)
    S_3 = (frame + coupler)  - (crank + follower)
    S_4 = (frame + follower) - (crank + coupler)

named after the link that stands beside the frame.  ``s + l - p - q`` of Grashof's theorem is, up to
its sign, the least of the three in magnitude.  The signs of the three decide everything: the class,
and which links turn fully against which.  They are taken exactly, of the lengths as doubles.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .linkage import EPS, Array

Category = Literal["Grashof", "non-Grashof", "change point"]

LINKS = ("frame", "crank", "coupler", "follower")
_ROLES = ("frame", "input", "coupler", "output")


@dataclass(frozen=True)
class BarkerClass:
    """One of the fourteen rows of Barker's table (Aannaque Table 3.1, corrected)."""

    number: int  # the row, 1 to 14
    category: Category  # s + l below, above or equal to p + q
    characteristic: str  # the link that marks the class, or what does
    class_number: int  # Barker's class within the category
    # name, symbol: Barker's; input, coupler and output link in this order
    name: str
    symbol: str
    also: str  # what else such a linkage is called


def _table() -> tuple[BarkerClass, ...]:
    """Return the fourteen rows."""
    kinds = (
        "crank-crank-crank",
        "crank-rocker-rocker",
        "rocker-crank-rocker",
        "rocker-rocker-crank",
    )
    called = (
        "double crank (drag link)",
        "crank rocker",
        "double rocker with turning coupler",
        "rocker crank",
    )
    letters = ("CCC", "CRR", "RCR", "RRC")
    rows: list[tuple[Category, str, int, str, str, str]] = []
    for i in range(4):
        least = f"{_ROLES[i]} shortest"
        rows.append(("Grashof", least, i + 1, f"Grashof {kinds[i]}", "G" + letters[i], called[i]))
    for i in range(4):
        name = f"Class {i + 1} rocker-rocker-rocker"
        most = f"{_ROLES[i]} longest"
        rows.append(("non-Grashof", most, i + 1, name, f"RRR{i + 1}", "triple rocker"))
    for i in range(4):
        name, symbol = f"Change point {kinds[i]}", "CP" + letters[i]
        also = f"{called[i]} at a change point"
        rows.append(("change point", f"{_ROLES[i]} shortest", i + 1, name, symbol, also))
    pairs, equal = "two pairs of equal links", "four equal links"
    rows.append(
        ("change point", pairs, 5, "Double change point", "CP2X", "parallelogram linkage or kite")
    )
    rows.append(("change point", equal, 6, "Triple change point", "CP3X", "rhombus linkage"))
    return tuple(BarkerClass(number, *row) for number, row in enumerate(rows, start=1))


CLASSES = _table()


def number_of_signs(signs: Sequence[int]) -> int:
    """Return the row of Barker's table for the signs of S_2, S_3, S_4.

    Without zeros, three equal signs mark the frame, otherwise the odd one out marks its link: as
    the shortest of a Grashof linkage where the product of the signs is negative, and otherwise as
    the longest of a non-Grashof one.  Every zero lies on the surface between two such cells; a
    single one belongs to the same shortest link as the Grashof cell that it bounds.
    """
    zeros = list(signs).count(0)
    if zeros >= 2:
        return 11 + zeros
    product = int(np.prod([sign or 1 for sign in signs]))
    cell = [sign or -product for sign in signs]
    if len(set(cell)) == 1:
        link = 0
    else:
        odd = 1 if cell.count(1) == 1 else -1
        link = cell.index(odd) + 1
    grashof = int(np.prod(cell)) < 0
    return link + (9 if zeros else 1 if grashof else 5)


def turning(signs: Sequence[int]) -> dict[tuple[str, str], bool]:
    """Return for each pair of links whether one turns fully against the other.

    Two links turn fully against each other where the vector sum of the two stays, in any direction
    of theirs, within the reach of the sum of the other two.  (The order of the vectors in a loop
    does not matter, so this holds for opposite links as for adjacent ones.)  With the frame and
    link i that is ``S_i <= 0`` and ``S_j S_k >= 0``; with the other two of the links the signs of
    S_i and of the product are reversed.  Equality: the links turn through a change point.
    """
    pairs = {}
    for i in range(3):
        beside = LINKS[i + 1]
        others = tuple(link for link in LINKS[1:] if link != beside)
        product = int(np.prod([sign for j, sign in enumerate(signs) if j != i]))
        pairs["frame", beside] = signs[i] <= 0 <= product
        pairs[others[0], others[1]] = signs[i] >= 0 >= product
    return pairs


def exact_sums(lengths: Sequence[Fraction]) -> tuple[Fraction, Fraction, Fraction]:
    """Return S_2, S_3, S_4 exactly."""
    frame, crank, coupler, follower = lengths
    return (
        frame + crank - coupler - follower,
        frame + coupler - crank - follower,
        frame + follower - crank - coupler,
    )


# Row of the table for each pattern of signs, at 9 (S_2 + 1) + 3 (S_3 + 1) + (S_4 + 1).
_ROWS = np.array(
    [number_of_signs(signs) for signs in itertools.product((-1, 0, 1), repeat=3)], dtype=np.int64
)
# More than the three roundings of a sum of four, over the sum of their magnitudes.
_ROUNDED = 4.0 * EPS


def class_numbers(lengths: Array) -> NDArray[np.int64]:
    """Return the rows of Barker's table of positive lengths (..., 4), 0 where they cannot close.

    Exact for any doubles: a sum whose sign rounding may have changed is taken in fractions.
    """
    flat = lengths.reshape(-1, 4)
    frame, crank, coupler, follower = flat.T
    with np.errstate(over="ignore", invalid="ignore"):
        perimeter = np.sum(flat, axis=1)
        sums = (
            (frame - coupler) + (crank - follower),
            (frame - crank) + (coupler - follower),
            (frame - coupler) + (follower - crank),
            perimeter - 2.0 * np.max(flat, axis=1),
        )
        # Where the perimeter overflows nothing is certain.
        certain = np.min(np.abs(sums), axis=0) > _ROUNDED * perimeter
        two, three, four, spare = np.where(certain, np.sign(sums), 0.0).astype(np.int64)
    rows = np.where(spare > 0, _ROWS[9 * (two + 1) + 3 * (three + 1) + four + 1], 0)
    for i in np.flatnonzero(~certain):
        rows[i] = _class_number([*map(Fraction, flat[i].tolist())])
    return np.asarray(rows.reshape(lengths.shape[:-1]), dtype=np.int64)


def _class_number(lengths: Sequence[Fraction]) -> int:
    """Return the row for one linkage, in exact fractions, 0 where it cannot close."""
    if 2 * max(lengths) >= sum(lengths):
        return 0
    return number_of_signs([(value > 0) - (value < 0) for value in exact_sums(lengths)])
