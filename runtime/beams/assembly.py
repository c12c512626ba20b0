"""The arrays of a structure of beams as functions of the crank angle (Aannaque 4.27-4.31).

What turns with a beam is a sum of products of cosine and sine of its angle with constant matrices,
found once; the angles, and how the rigid beams move, are shared by all arrays.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from ..core.trigonometric import Remembered
from ..linkages.linkage import PointMotion
from .elements import ElementArrays, element_arrays
from .structure import Beam, PlacedElement, Structure

Array = NDArray[np.float64]

# Places among the six products of 1, c = cos(phi) and s = sin(phi), two at a time.
_PLACES = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])


def products(angle: Array) -> Array:
    """Return ``1, c, s, c c, c s, s s`` of angles ``(nt,)``: ``(nt, 6)``."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([np.ones_like(c), c, s, c * c, c * s, s * s], axis=-1)


def rotation(size: int) -> Array:
    """Return R(phi), from fixed to the axes of an element, as factors of 1, c and s (4.26).

    Of displacement and rotation at both ends, then the element's own coordinates: ``(3, n, n)``.
    """
    constant, cosine, sine = parts = np.zeros((3, size, size))
    for u, v, turn in ((0, 1, 2), (3, 4, 5)):
        cosine[u, u] = cosine[v, v] = constant[turn, turn] = 1.0
        sine[u, v], sine[v, u] = 1.0, -1.0
    # Beyond the six of its two ends the coordinates of an element are its own and do not turn.
    own = np.arange(6, size)
    constant[own, own] = 1.0
    return parts


def rotation_slope(size: int) -> Array:
    """Return dR/dphi as factors of 1, c and s, ``(3, n, n)``."""
    constant, cosine, sine = rotation(size)
    return np.stack([0.0 * constant, sine, -cosine])


def in_own_axes(values: Array, c: Array, s: Array) -> Array:
    """Return coordinates of an element ``(..., n)`` in its own axes, by cosine and sine.

    With the sine's other sign rows by its own axes become rows by the fixed ones.
    """
    found = values.copy()
    for x, y in ((0, 1), (3, 4)):
        found[..., x] = c * values[..., x] + s * values[..., y]
        found[..., y] = c * values[..., y] - s * values[..., x]
    return found


def turned(left: Array, matrix: Array, right: Array) -> Array:
    """Return ``left^T matrix right`` as factors of the six products, shape ``(6, n, n)``."""
    total = np.zeros((6, *matrix.shape))
    np.add.at(total, _PLACES, left.mT[:, None] @ matrix @ right)
    return total


# The arrays of the distributed mass and stiffness (4.28): M, half of dM/dtheta, A and B; K, C and D
# of Kelvin and Voigt's material.  Each with its power of the beams' turning.
TURNING = {
    "mass": 0,
    "mass slope": 1,
    "coupling": 1,
    "centripetal": 2,
    "stiffness": 0,
    "retarded": 0,
    "retarded slope": 1,
}
# Of a beam: its name, places of its entries in a flat matrix of the free coordinates, and these as
# factors of the six products, ``(6, entries)``.
Kernel = tuple[str, NDArray[np.int64], Array]


@dataclass(frozen=True)
class RigidMotion:
    """How the rigid beams move at crank angles ``(nt,)``, over the crank speed."""

    products: dict[str, Array]  # by beam, those of cosine and sine of its angle, (nt, 6)
    turning: dict[str, Array]  # by beam, d phi/d theta, (nt,)
    # (nt, coordinates): derivatives of the rigid place of each coordinate, held ones included
    first: Array
    second: Array


class AngleArrays:
    """Arrays of a structure at crank angles; what depends on them alone is computed once."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.free = structure.freedoms.free
        self.count = len(structure.freedoms.all)
        # The rigid motion at crank angles (nt,).
        self.motion = Remembered(partial(rigid_motion, structure))
        # The array that elastic, axial and damping forces share.
        self.stiffness = Remembered(self._stiffness)
        self._kernels: dict[str, tuple[Kernel, ...]] = {}

    @cached_property
    def local(self) -> tuple[tuple[PlacedElement, ElementArrays], ...]:
        """Every element with its arrays in its own axes."""
        return tuple(
            (placed, beam_element(placed.beam, placed.length)) for placed in self.structure.elements
        )

    def distributed(self, field: Array, theta: Array) -> Array:
        """Return the distributed mass times values of all coordinates ``(nt, N)``: ``(nt, n)``."""
        motion = self.motion(theta)
        total = np.zeros((len(theta), self.count))
        for placed, kernel in self._mass_of_elements:
            weights = motion.products[placed.beam.name]
            values = weights[:, :, None] * field[:, None, placed.indices]
            total[:, placed.indices] += values.reshape(len(theta), -1) @ kernel
        return total[:, self.free]

    def rows(self, placed: PlacedElement, own: Array, theta: Array) -> Array:
        """Return rows ``(k, m)`` by an element's axes as rows by the fixed ones, ``(nt, k, n)``."""
        c, s = self.motion(theta).products[placed.beam.name][:, 1:3].T[..., None]
        found = np.zeros((len(theta), len(own), self.count))
        turned = in_own_axes(np.tile(own, (len(theta), 1, 1)), c, -s)
        found[:, :, placed.indices[: own.shape[1]]] = turned
        return found[:, :, self.free]

    @cached_property
    def _mass_of_elements(self) -> tuple[tuple[PlacedElement, Array], ...]:
        """Every element with its mass: from products times values to forces, ``(6 m, m)``."""
        made = ((placed, _kernel("mass", placed, own)) for placed, own in self.local)
        return tuple(
            (placed, np.swapaxes(kernel, 1, 2).reshape(-1, kernel.shape[1]))
            for placed, kernel in made
        )

    def _stiffness(self, theta: Array) -> Array:
        found = self.sum("stiffness", theta)
        found.flags.writeable = False  # it is shared
        return found

    def sum(self, name: str, theta: Array) -> Array:
        """Return an array of ``TURNING``, summed over the elements, at angles: ``(nt, n, n)``.

        Rows and columns are those of the free coordinates.
        """
        motion, turning, n = self.motion(theta), TURNING[name], len(self.free)
        total = np.zeros((len(theta), n * n))
        if name not in self._kernels:
            self._kernels[name] = tuple(self._kernels_of_beams(name))
        for beam, places, kernel in self._kernels[name]:
            weights = motion.products[beam]
            if turning:
                weights = weights * motion.turning[beam][:, None] ** turning
            total[:, places] += weights @ kernel
        return total.reshape(-1, n, n)

    def _kernels_of_beams(self, name: str) -> Iterator[Kernel]:
        """Yield an array of each beam by the fixed axes."""
        free = np.full(self.count, -1)
        free[self.free] = np.arange(len(self.free))
        for beam in self.structure.beams:
            places, factors = [], []
            for placed, own in self.local:
                if placed.beam is beam:
                    row, column = np.meshgrid(*[free[placed.indices]] * 2, indexing="ij")
                    there = (row >= 0) & (column >= 0)
                    places.append((row * len(self.free) + column)[there])
                    factors.append(_kernel(name, placed, own)[:, there])
            found, which = np.unique(np.concatenate(places), return_inverse=True)
            kernel = np.zeros((6, len(found)))
            np.add.at(kernel.T, which, np.concatenate(factors, axis=1).T)
            yield beam.name, found, kernel


def _kernel(name: str, placed: PlacedElement, own: ElementArrays) -> Array:
    """Return ``R^T X R`` of an element, or what turning makes of it, as factors of the products."""
    r, slope = rotation(len(own.mass)), rotation_slope(len(own.mass))
    if name == "mass":
        return turned(r, own.mass, r)
    if name == "mass slope":
        return turned(slope, own.mass, r)
    if name == "coupling":
        return turned(r, own.mass, slope) + turned(r, own.coupling, r)
    if name == "centripetal":
        mixed = turned(slope, own.coupling, r)
        total = turned(slope, own.mass, slope) + turned(r, own.centripetal, r)
        return total + mixed + np.swapaxes(mixed, -1, -2)
    stiffness = turned(r, own.stiffness, slope if name == "retarded slope" else r)
    return stiffness if name == "stiffness" else placed.beam.section.retardation * stiffness


def beam_element(beam: Beam, length: float) -> ElementArrays:
    """Return the arrays of one element of a beam, in its own axes."""
    section, sheared = beam.section, beam.kind == "timoshenko"
    return element_arrays(
        beam.kind,
        length=length,
        mass_per_length=section.mass_per_length,
        axial_stiffness=section.axial_stiffness,
        bending_stiffness=section.bending_stiffness,
        shear_stiffness=section.shear_stiffness if sheared else None,
        rotary_inertia=section.rotary_inertia if sheared else 0.0,
    )


def rigid_motion(structure: Structure, theta: Array) -> RigidMotion:
    """Return how the rigid beams of a structure move at crank angles ``(nt,)``."""
    moving = structure.configuration(theta)
    freedoms = structure.freedoms.all
    first = np.zeros((len(theta), len(freedoms)))
    second = np.zeros_like(first)
    for beam in structure.beams if structure.moving else ():
        own = moving[beam.name]
        points: dict[float, PointMotion] = {}
        across = np.stack([-np.sin(own.angle), np.cos(own.angle)], axis=-1)
        for i, freedom in enumerate(freedoms):
            if freedom.beam != beam.name or freedom.part == "curvature":
                continue
            if freedom.part == "rotation":
                first[:, i], second[:, i] = own.speed, own.angular_acceleration
                continue
            if freedom.along not in points:
                points[freedom.along] = own.point(freedom.along)
            point = points[freedom.along]
            for target, rates in ((first, point.velocity), (second, point.acceleration)):
                if freedom.part == "across":
                    target[:, i] = np.sum(rates * across, axis=-1)
                else:
                    target[:, i] = rates[..., 0 if freedom.part == "x" else 1]
    return RigidMotion(
        {beam.name: products(moving[beam.name].angle) for beam in structure.beams},
        {beam.name: moving[beam.name].speed for beam in structure.beams},
        first,
        second,
    )
