"""Frames whose members bend but do not stretch (Aannaque 5.4.1)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import MATRICES, LinearPeriodic, Term
from .assembly import Array
from .structure import Structure

# An entry of the elimination so small, its rows being of unit size, is round-off.
_NOTHING = 1e-12


def without_stretching(system: LinearPeriodic) -> LinearPeriodic:
    """Return the vibration of a frame whose members keep their lengths.

    The displacements that follow from the others are eliminated; what is left keeps its labels.

    Parameters
    ----------
    system : LinearPeriodic
        Of a frame that stands still, from :func:`linear_system`.

    Returns
    -------
    LinearPeriodic
        Of fewer coordinates; without ``structure``, whose coordinates are others.

    Raises
    ------
    BadInput
        If the system is not of such a frame, or nothing is left that moves.
    """
    structure = system.structure if isinstance(system, LinearPeriodic) else None
    if structure is None or structure.moving:
        raise bad(
            "without_stretching",
            "a system that is not of a frame standing still",
            "one from linear_system(frame(...))",
            "a moving linkage keeps its axial motion: it is stiff, but cheap to keep",
        )
    kept, spread = _kept(_axial_rows(structure))
    if not kept.size:
        raise bad("frame", "no motion without stretching", "members that bend", "add elements")
    # What watches the deflections is given in all coordinates.
    watch = system.relative_deflection
    return replace(
        system,
        size=len(kept),
        terms=tuple(_reduced(term, spread) for term in system.terms),
        labels=tuple(system.labels[i] for i in kept),
        structure=None,
        relative_deflection=None if watch is None else partial(_watched, watch, spread),
        provenance={**system.provenance, "axial": "rigid"},
    )


def _axial_rows(structure: Structure) -> Array:
    """Return how much each element stretches, per coordinate: ``(elements, n)``."""
    motion = structure.configuration(np.zeros(1))
    freedoms = structure.freedoms
    rows = np.zeros((len(structure.elements), len(freedoms.all)))
    for row, placed in zip(rows, structure.elements, strict=True):
        angle = motion[placed.beam.name].angle[0]
        x1, y1, _, x2, y2 = placed.indices[:5]
        for place, factor in ((x2, np.cos(angle)), (y2, np.sin(angle))):
            row[place] += factor
        for place, factor in ((x1, np.cos(angle)), (y1, np.sin(angle))):
            row[place] -= factor
    return rows[:, freedoms.free]


def _kept(rows: Array) -> tuple[NDArray[np.int64], Array]:
    """Eliminate one coordinate per independent row; return those kept, and all from them."""
    rows = rows.copy()
    count = rows.shape[1]
    gone: list[int] = []
    used: list[int] = []
    for _ in range(len(rows)):
        open_rows = [i for i in range(len(rows)) if i not in used]
        sizes = np.abs(rows[open_rows])
        i, j = np.unravel_index(int(np.argmax(sizes)), sizes.shape)
        if sizes[i, j] < _NOTHING:
            break
        pivot = open_rows[int(i)]
        rows[pivot] /= rows[pivot, j]
        for other in range(len(rows)):
            if other != pivot:
                rows[other] -= rows[other, j] * rows[pivot]
        used.append(pivot)
        gone.append(int(j))
    kept = np.array([j for j in range(count) if j not in gone], dtype=np.int64)
    spread = np.zeros((count, len(kept)))
    spread[kept, np.arange(len(kept))] = 1.0
    for pivot, column in zip(used, gone, strict=True):
        spread[column] = -rows[pivot, kept]
    return kept, spread


def _reduced(term: Term, spread: Array) -> Term:
    value = np.asarray(term.function)
    matrix = term.array in MATRICES
    return replace(term, function=spread.T @ value @ spread if matrix else spread.T @ value)


def _watched(watch: Callable[[Array], Array], spread: Array, theta: Array) -> Array:
    return watch(theta) @ spread
