"""A pin that slides along a beam: the constraint taken into the coordinates.

The pin B lies on the bent axis of the beam.  With t and n along and across the rigid beam, x1 the
rigid place of the pin and v the deflection, its displacement is ``s t + v(x1) n`` to first order:
the one new coordinate is s.  All coordinates are ``Z(theta) y``; with ' = d/dtheta the arrays
become

    M: Z^T M Z,   A: Z^T (M Z' + A Z),   B: Z'^T M Z' + Z'^T A Z + Z^T A^T Z' + Z^T B Z,
    C: Z^T C Z,   D: Z^T (D Z + C Z'),   K: Z^T K Z,   f: Z^T f,   g: Z^T g.

To second order the pin has also moved along the beam, by ``r = s - u(x1)``, to where the deflection
is ``v + v' r``: the force F upon the beam, that of the rigid motion, has the potential
``-F v'(x1) r``, a part of the geometric stiffness.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..core.families import Term
from .elements import placed_shapes

if TYPE_CHECKING:
    from .assembly import AngleArrays, Array

# What a term becomes: its new array, and whether Z or Z' stands to its left and right, or whether
# the transposed of the term stands between.
_RULES = {
    "M": (("M", "Z", "Z"), ("A", "Z", "Z'"), ("B", "Z'", "Z'")),
    "A": (("A", "Z", "Z"), ("B", "Z'", "Z"), ("B", "Z^T", "Z'")),
    "B": (("B", "Z", "Z"),),
    "C": (("C", "Z", "Z"), ("D", "Z", "Z'")),
    "D": (("D", "Z", "Z"),),
    "K": (("K", "Z", "Z"),),
    "Kg": (("Kg", "Z", "Z"),),
}


class Slide:
    """The coordinates of a structure that has one node which slides along a beam."""

    def __init__(self, arrays: AngleArrays) -> None:
        structure = arrays.structure
        node = next(node for node in structure.nodes if node.slides_on is not None)
        self.arrays = arrays
        self.carried = structure.beam(str(node.slides_on))
        self.guided = next(beam for beam in structure.beams if node.name in (beam.start, beam.end))
        self.along = 0.0 if self.guided.start == node.name else self.guided.length
        place = {full: free for free, full in enumerate(arrays.free)}
        self.x, self.y = (place[structure.freedoms.at(node.name, part)] for part in ("x", "y"))
        self.elements = [
            (placed, np.array([place.get(i, -1) for i in placed.indices]))
            for placed in structure.elements
            if placed.beam is self.carried
        ]

    def place(self, theta: Array) -> tuple[Array, Array]:
        """Return the rigid place x1 of the pin on the beam [m] and its derivative."""
        motion = self.arrays.structure.configuration(theta)
        link, pin = motion[self.carried.name], motion[self.guided.name].point(self.along)
        axis = np.stack([np.cos(link.angle), np.sin(link.angle)], axis=-1)
        place = np.sum((pin.position - link.origin) * axis, axis=-1)
        # What the turning of the axis adds is across it: nothing, for the pin lies on it.
        return place, np.sum((pin.velocity - link.velocity) * axis, axis=-1)

    def rows(self, theta: Array, derivative: int) -> tuple[Array, Array]:
        """Return displacements along and across the beam at the pin, or derivatives by the place.

        Rows ``(nt, n)`` for the coordinates at the ends of the elements in the beam's axes.
        """
        place, _ = self.place(theta)
        ends = np.array([placed.start for placed, _ in self.elements])
        number = np.clip(np.searchsorted(ends, place, side="right") - 1, 0, len(ends) - 1)
        found = np.zeros((2, len(theta), len(self.arrays.free) + 1))
        for k in np.unique(number):
            placed, indices = self.elements[k]
            here = np.flatnonzero(number == k)
            xi = np.clip((place[here] - placed.start) / placed.length, 0.0, 1.0)
            for part, shape in zip(found, placed_shapes(placed, xi, derivative), strict=True):
                part[here[:, None], indices] += shape
        # Held coordinates have met in the last column.
        return found[0, :, :-1], found[1, :, :-1]

    def turned(self, row: Array, theta: Array, slope: bool = False) -> Array:
        """Return a row of :meth:`rows` by the fixed axes, or its derivative by the beam's angle."""
        c, s = self._axis(theta)
        if slope:
            c, s = -s, c
        found = np.zeros_like(row) if slope else row.copy()
        for _, indices in self.elements:
            for x, y in (indices[0:2], indices[3:5]):
                # An end that the support holds has no coordinate.
                along = row[:, x] if x >= 0 else 0.0
                across = row[:, y] if y >= 0 else 0.0
                if x >= 0:
                    found[:, x] = c * along - s * across
                if y >= 0:
                    found[:, y] = s * along + c * across
        return found

    def basis(self, theta: Array) -> Array:
        """Return Z at crank angles, ``(nt, n, n - 1)``."""
        c, s = self._axis(theta)
        across = self.turned(self.rows(theta, 0)[1], theta)
        normal = np.stack([-s, c], axis=-1)
        found = normal[:, :, None] * across[:, None, :]
        found[:, 0, self.x] += c
        found[:, 1, self.x] += s
        return self._reduced(found, unit=1.0)

    def basis_slope(self, theta: Array) -> Array:
        """Return Z', ``(nt, n, n - 1)``."""
        c, s = self._axis(theta)
        turn = self.arrays.motion(theta).turning[self.carried.name]
        _, rate = self.place(theta)
        shapes = self.rows(theta, 0)[1]
        across = self.turned(shapes, theta)
        hurried = rate[:, None] * self.turned(self.rows(theta, 1)[1], theta)
        hurried += turn[:, None] * self.turned(shapes, theta, slope=True)
        normal, tangent = np.stack([-s, c], axis=-1), np.stack([c, s], axis=-1)
        found = normal[:, :, None] * hurried[:, None, :]
        found -= (turn[:, None] * tangent)[:, :, None] * across[:, None, :]
        found[:, :, self.x] += turn[:, None] * normal
        return self._reduced(found, unit=0.0)

    def contact(self, rest: Array, theta: Array) -> Array:
        """Return the stiffness of the contact force, by the coordinates before Z: ``(nt, n, n)``.

        ``rest``, ``(nt, n)``, are elastic forces less loads: what the contact does.
        """
        c, s = self._axis(theta)
        force = s * rest[:, self.x] - c * rest[:, self.y]
        relative = -self.turned(self.rows(theta, 0)[0], theta)
        relative[:, self.x] += c
        relative[:, self.y] += s
        slope = self.turned(self.rows(theta, 1)[1], theta)
        half = -force[:, None, None] * slope[:, :, None] * relative[:, None, :]
        return np.asarray(half + np.swapaxes(half, -1, -2))

    def _axis(self, theta: Array) -> Array:
        cosines: Array = self.arrays.motion(theta).products[self.carried.name][:, 1:3].T
        return cosines

    def _reduced(self, rows: Array, unit: float) -> Array:
        """Return the basis: the pin's two rows, all else as it is; y of the pin is gone."""
        count = len(self.arrays.free)
        found = np.zeros((len(rows), count, count))
        others = np.delete(np.arange(count), [self.x, self.y])
        found[:, others, others] = unit
        found[:, [self.x, self.y], :] = rows
        return np.delete(found, self.y, axis=2)


def slid_terms(terms: Iterable[Term], slide: Slide, *, form: str) -> list[Term]:
    """Return terms by the coordinates before Z as terms by those after it.

    Of the instantaneous form neither A, B nor D come of Z', and the damping takes out all of the
    mass matrix's derivative.
    """
    found = []
    for term in terms:
        if term.array not in _RULES:
            found.append(_changed(term, term.array, partial(_slid_vector, term, slide)))
            continue
        for array, left, right in _RULES[term.array]:
            if form == "full" or "Z'" not in (left, right):
                between = partial(_slid_matrix, term, slide, (left, right))
                found.append(_changed(term, array, between))
        if form != "full" and term.array == "M":
            found.append(Term("C", term.scale, partial(_minus_slope, term, slide), term.power + 1))
    return found


def _changed(term: Term, array: str, function: partial[Array]) -> Term:
    return Term(array, term.scale, function, term.power)


def _slid_vector(term: Term, slide: Slide, theta: Array) -> Array:
    return np.asarray(np.einsum("tij,ti->tj", slide.basis(theta), term(theta)))


def _slid_matrix(term: Term, slide: Slide, sides: tuple[str, str], theta: Array) -> Array:
    between = term(theta)
    if sides[0] == "Z^T":
        between = np.swapaxes(between, -1, -2)
    left, right = (
        slide.basis_slope(theta) if side == "Z'" else slide.basis(theta) for side in sides
    )
    return np.asarray(np.swapaxes(left, -1, -2) @ between @ right)


def _minus_slope(term: Term, slide: Slide, theta: Array) -> Array:
    half = _slid_matrix(term, slide, ("Z", "Z'"), theta)
    return np.asarray(-(half + np.swapaxes(half, -1, -2)))
