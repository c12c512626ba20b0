"""Numbering of the coordinates of a structure of beams."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad

if TYPE_CHECKING:
    from .structure import Beam, Node

Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Freedom:
    """One coordinate.

    Attributes
    ----------
    label : str
        Its name.
    beam : str
        A beam that has it.
    along : float
        Where on that beam [m].
    part : str
        ``x`` or ``y``: displacement along the fixed axes [m]; ``rotation`` [rad]; ``across``:
        displacement across the beam [m]; ``curvature``: of the beam's deflection [1/m].
    held : bool
        Whether it is 0 at all times.
    """

    label: str
    beam: str
    along: float
    part: str
    held: bool = False


@dataclass(frozen=True)
class PlacedElement:
    """An element of a beam with its coordinates.

    Attributes
    ----------
    beam : Beam
        The beam.
    number : int
        Which of its elements, from 0.
    start, length : float
        Where it begins along the beam, and its length [m].
    indices : ndarray of int
        Places of its coordinates among all, in the element's own order.
    """

    beam: Beam
    number: int
    start: float
    length: float
    indices: Indices


@dataclass(frozen=True)
class Freedoms:
    """All coordinates of a structure, held ones included.

    Attributes
    ----------
    all : tuple of Freedom
        The coordinates.
    free : ndarray of int
        Places of those that are not held.
    elements : tuple of PlacedElement
        The elements, beam by beam.
    places : mapping
        From a node and ``x``, ``y`` or a beam (its rotation there) to the coordinate's place.
    """

    all: tuple[Freedom, ...]
    free: Indices
    elements: tuple[PlacedElement, ...]
    places: dict[tuple[str, str], int]

    @property
    def free_labels(self) -> tuple[str, ...]:
        """Names of the free coordinates."""
        return tuple(self.all[i].label for i in self.free)

    def at(self, node: str, part: str) -> int:
        """Return the place of a coordinate of a node: ``x``, ``y``, or a beam's name (rotation)."""
        return self.places[node, part]


class _Numbering:
    """Coordinates as they are met."""

    def __init__(self) -> None:
        self.found: list[Freedom] = []
        self.places: dict[tuple[str, str], int] = {}

    def add(self, freedom: Freedom) -> int:
        self.found.append(freedom)
        return len(self.found) - 1

    def node(self, node: Node, beams: Sequence[Beam]) -> None:
        """Add the displacement of a node, and the rotations of the beams that meet there."""
        first = beams[0]
        for part in ("x", "y"):
            freedom = Freedom(
                f"{node.name}.{part}", first.name, _end(first, node), part, part in node.held
            )
            self.places[node.name, part] = self.add(freedom)
        for beam in beams:
            shared = beam.name in node.joined
            if shared and node.joined[0] != beam.name:
                continue
            held = "rotation" in node.held and (shared or not node.joined)
            label = f"{node.name}.rotation" if shared else f"{node.name}.{beam.name}"
            place = self.add(Freedom(label, beam.name, _end(beam, node), "rotation", held))
            for name in node.joined if shared else (beam.name,):
                self.places[node.name, name] = place

    def curvature(self, node: Node, beam: Beam) -> int:
        """Add the curvature at the end of a beam: 0 where nothing there takes a moment."""
        own = node.carried_by in (None, beam.name)
        rotation = self.found[self.places[node.name, beam.name]]
        loaded = rotation.held or beam.name in node.joined
        turned = node.inertia or node.stiffness.get("rotation") or node.damping.get("rotation")
        loaded |= bool(own and turned)
        label = f"{node.name}.{beam.name}.curvature"
        freedom = Freedom(label, beam.name, _end(beam, node), "curvature", not loaded)
        return self.add(freedom)

    def beam(self, beam: Beam, nodes: dict[str, Node]) -> list[PlacedElement]:
        """Add the inside of a beam and return its elements."""
        places = beam.places
        points = [self._end_point(beam, beam.start, nodes)]
        for k in range(1, len(places) - 1):
            parts = [(part, part) for part in ("x", "y", "rotation")]
            if beam.kind == "curvature":
                parts.append(("curvature", "curvature"))
            point = [
                self.add(Freedom(f"{beam.name}.{k}.{name}", beam.name, float(places[k]), part))
                for name, part in parts
            ]
            points.append(point)
        points.append(self._end_point(beam, beam.end, nodes))
        found = []
        for k, (start, stop) in enumerate(pairwise(places)):
            left, right = points[k], points[k + 1]
            indices = [*left[:3], *right[:3], *left[3:], *right[3:]]
            if beam.kind == "internal_node":
                middle = float(start + stop) / 2.0
                indices += [
                    self.add(Freedom(f"{beam.name}.{k + 1}m.{part}", beam.name, middle, part))
                    for part in ("across", "rotation")
                ]
            order = np.array(indices, dtype=np.int64)
            found.append(PlacedElement(beam, k, float(start), float(stop - start), order))
        return found

    def _end_point(self, beam: Beam, name: str, nodes: dict[str, Node]) -> list[int]:
        point = [self.places[name, part] for part in ("x", "y", beam.name)]
        if beam.kind == "curvature":
            point.append(self.curvature(nodes[name], beam))
        return point


def number_freedoms(beams: Sequence[Beam], nodes: Sequence[Node]) -> Freedoms:
    """Return the numbering of all coordinates: node by node, then the inside of each beam.

    Raises
    ------
    BadInput
        If nothing is left free.
    """
    numbering = _Numbering()
    for node in nodes:
        numbering.node(node, [b for b in beams if node.name in (b.start, b.end)])
    known = {node.name: node for node in nodes}
    elements = [element for beam in beams for element in numbering.beam(beam, known)]
    free = [i for i, freedom in enumerate(numbering.found) if not freedom.held]
    if not free:
        raise bad("structure", "every coordinate held", "something that moves", "free a node")
    return Freedoms(
        tuple(numbering.found), np.array(free, dtype=np.int64), tuple(elements), numbering.places
    )


def _end(beam: Beam, node: Node) -> float:
    return 0.0 if beam.start == node.name else beam.length
