"""Frames that stand still, and frames whose members bend but do not stretch (Aannaque 5.4.1)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import Problem, bad, refuse
from ..core.families import MATRICES, LinearPeriodic, Term
from ..core.inputs import are_finite, names_problems, require_mapping
from ..linkages.linkage import LinkMotion
from .assembly import AngleArrays, Array
from .section import Section
from .structure import Structure, missing_problems, node_value_problems, structure_of


def frame(
    places: Mapping[str, tuple[float, float]],
    members: Mapping[str, tuple[str, str]],
    sections: Section | Mapping[str, Section],
    *,
    supports: Mapping[str, Sequence[str]],
    pins: Sequence[str] = (),
    elements: int | Mapping[str, int | tuple[float, ...]] = 3,
    kind: str = "cubic",
    nodes: Mapping[str, Mapping[str, Any]] | None = None,
    provenance: Mapping[str, str] | None = None,
) -> Structure:
    """Return a frame of beams that stands still.

    Members that meet are rigidly joined, except at the nodes named as pins.

    Parameters
    ----------
    places : mapping of str to pair of float
        Places of the nodes [m].
    members : mapping of str to pair of str
        Names of the nodes at the ends of each beam.
    sections : Section or mapping of str to Section
        Of all members, or by member.
    supports : mapping of str to sequence of str
        By node, what the ground holds: some of ``x``, ``y``, ``rotation``.
    pins : sequence of str
        Nodes at which every member turns by itself.
    elements, kind
        As :func:`linkage_system` takes them.
    nodes : mapping of str to mapping, optional
        By node, further values of :class:`Node`: masses, springs, loads.
    provenance : mapping, optional
        Scene and options to record.

    Returns
    -------
    Structure

    Raises
    ------
    BadInput
        If a name or number is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> bar = el.Section.rectangle(0.02, 0.01, modulus=210e9, density=7850.0)
    >>> clamped = {"A": ("x", "y", "rotation")}
    >>> mast = el.frame({"A": (0, 0), "B": (0, 1)}, {"mast": ("A", "B")}, bar, supports=clamped)
    >>> print(el.wittrick_williams(el.dynamic_stiffness(mast), count=1).hertz.round(3))
    [8.355]
    """
    for where, given in (("places", places), ("members", members), ("supports", supports)):
        require_mapping(where, given, "see the example of frame")
    _check(places, members, sections, elements, nodes, [*supports, *pins])
    ends = {name: (complex(*places[a]), complex(*places[b])) for name, (a, b) in members.items()}
    lengths = {name: abs(end - start) for name, (start, end) in ends.items()}
    own: dict[str, dict[str, Any]] = {}
    for letter in places:
        meeting = tuple(name for name, pair in members.items() if letter in pair)
        joined = () if letter in pins or len(meeting) < 2 else meeting
        own[letter] = {"held": tuple(supports.get(letter, ())), "joined": joined}
        own[letter] |= (nodes or {}).get(letter, {})
    still = {"configuration": partial(_standing, ends), "moving": False}
    told = dict(provenance or {})
    return structure_of(members, lengths, sections, elements, kind, own, provenance=told, **still)


def _standing(
    ends: Mapping[str, tuple[complex, complex]], theta: Array
) -> Mapping[str, LinkMotion]:
    """Return the motion of beams that do not move."""
    still = np.zeros((len(theta), 2))
    none = np.zeros(len(theta))
    found = {}
    for name, (start, end) in ends.items():
        origin = np.broadcast_to([start.real, start.imag], still.shape)
        angle = np.full(len(theta), np.angle(end - start))
        found[name] = LinkMotion(origin, still, still, angle, none, none)
    return found


def _check(
    places: Mapping[str, tuple[float, float]],
    members: Mapping[str, tuple[str, str]],
    sections: Section | Mapping[str, Section],
    elements: object,
    nodes: Mapping[str, object] | None,
    held: Sequence[str],
) -> None:
    problems = node_value_problems(nodes)
    for letter, place in places.items():
        if not are_finite(place, 2):
            problems.append(Problem(f"place of {letter}", repr(place), "two numbers", "correct it"))
    for name, pair in members.items():
        if names_problems("", pair) or len(pair) != 2:
            found, fix = repr(pair), 'say ("A", "B")'
            problems.append(Problem(f"member {name}", found, "the names of two nodes", fix))
    refuse(problems + missing_problems("elements", elements, members))
    ends = {letter for pair in members.values() for letter in pair}
    for word, names in (("members", ends), ("supports, pins, nodes", {*held, *(nodes or {})})):
        strange = sorted(names - set(places))
        if strange:
            fix = "give it a place, or correct the name"
            problems.append(Problem(word, f"node {', '.join(strange)}", "known nodes", fix))
    refuse(problems + missing_problems("sections", sections, members))


def without_stretching(system: LinearPeriodic) -> LinearPeriodic:
    """Return the vibration of a frame whose members keep their lengths.

    The displacements that follow from the others are eliminated; what is left keeps its labels.

    Parameters
    ----------
    system : LinearPeriodic
        Of :func:`elastolink.runtime.beams.linear_system`, of a frame that stands still.

    Returns
    -------
    LinearPeriodic
        Without a ``structure``, whose coordinates are others.

    Raises
    ------
    BadInput
        If the system is of another kind, or nothing is left that moves.

    Examples
    --------
    >>> import elastolink as el
    >>> bar = el.Section.rectangle(0.02, 0.01, modulus=210e9, density=7850.0)
    >>> clamped = {"A": ("x", "y", "rotation")}
    >>> mast = el.frame({"A": (0, 0), "B": (0, 1)}, {"mast": ("A", "B")}, bar, supports=clamped)
    >>> system = el.beams.linear_system(mast)
    >>> print(system.size, el.beams.without_stretching(system).size)
    9 6
    """
    structure = system.structure if isinstance(system, LinearPeriodic) else None
    if structure is None or structure.moving:
        found = "a system that is not of a frame standing still"
        fix = "a moving linkage keeps its axial motion: it is stiff, but cheap to keep"
        raise bad("without_stretching", found, "one from linear_system(frame(...))", fix)
    arrays, stretch = AngleArrays(structure), np.array([[-1.0, 0.0, 0.0, 1.0, 0.0, 0.0]])
    rows = [arrays.rows(placed, stretch, np.zeros(1))[0] for placed in structure.elements]
    kept, spread = eliminated(np.concatenate(rows))
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


def eliminated(rows: Array) -> tuple[NDArray[np.int64], Array]:
    """Eliminate one coordinate for each independent row that is to vanish.

    Return the places of those kept, and what makes all coordinates of them, ``(n, kept)``.
    """
    rows = rows.copy()
    gone: list[int] = []
    used: list[int] = []
    for _ in range(len(rows)):
        sizes = np.abs(rows)
        sizes[used] = 0.0
        pivot, column = np.unravel_index(int(np.argmax(sizes)), sizes.shape)
        # An entry of the elimination so small, its rows being of unit size, is round-off.
        if sizes[pivot, column] < 1e-12:
            break
        rows[pivot] /= rows[pivot, column]
        others = np.arange(len(rows)) != pivot
        rows[others] -= np.outer(rows[others, column], rows[pivot])
        used.append(int(pivot))
        gone.append(int(column))
    kept = np.setdiff1d(np.arange(rows.shape[1]), gone)
    spread = np.zeros((rows.shape[1], len(kept)))
    spread[kept] = np.eye(len(kept))
    spread[gone] = -rows[used][:, kept]
    return kept, spread


def _reduced(term: Term, spread: Array) -> Term:
    value = np.asarray(term.function)
    matrix = term.array in MATRICES
    return replace(term, function=spread.T @ value @ spread if matrix else spread.T @ value)


def _watched(watch: Callable[[Array], Array], spread: Array, theta: Array) -> Array:
    return watch(theta) @ spread
