"""Axial forces of beams in quasi-static equilibrium, and their stiffness (Aannaque 4.37-4.39).

In a linkage whose links are statically determinate they are those of rigid links.  They are found
from the structure at rest under its inertia forces, for unit crank speed.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from .assembly import AngleArrays, Array
from .sliding import Slide
from .turning import in_own_axes, rotation, turned

# Masses that load the beams, each by itself: the beams' own, and the lumped ones.
SOURCES = ("distributed", "lumped", "static")


class AxialForces:
    """Axial forces along every element, and the geometric stiffness that they give.

    Parameters
    ----------
    arrays : AngleArrays
        Of the structure.
    constant_stiffness : ndarray, shape (n, n)
        Of springs.
    lumped_mass : ndarray, shape (N,)
        Lumped mass of every coordinate, held ones included.
    gravity : pair of float
        Acceleration of gravity [m/s^2] in the fixed axes.
    slide : Slide, optional
        Of a structure with a sliding pin.
    """

    def __init__(
        self,
        arrays: AngleArrays,
        constant_stiffness: Array,
        lumped_mass: Array,
        gravity: tuple[float, float],
        slide: Slide | None = None,
    ) -> None:
        self.arrays = arrays
        self.springs = constant_stiffness
        self.lumped = lumped_mass
        self.gravity = gravity
        self.slide = slide
        self.node_forces = _node_forces(arrays)

    def force(self, source: str, theta: Array) -> Array:
        """Return the generalised forces of a source at unit crank speed, ``(nt, n)``."""
        if source == "distributed":
            return self.arrays.inertia_force(theta)
        free = self.arrays.free
        if source == "lumped":
            return np.asarray(-(self.arrays.motion(theta).second * self.lumped)[:, free])
        field = self.weight_field(theta)
        weight = self.arrays.distributed(field, theta) + (self.lumped * field)[:, free]
        return np.asarray(weight + self.node_forces[free])

    def weight_field(self, theta: Array) -> Array:
        """Return gravity as values of all coordinates, ``(nt, N)`` [m/s^2]."""
        x, y = self.gravity
        parts = {"x": x, "y": y}
        found = np.zeros((len(theta), self.arrays.count))
        for i, freedom in enumerate(self.arrays.structure.freedoms.all):
            found[:, i] = parts.get(freedom.part, 0.0)
            if freedom.part == "across":
                c, s = self.arrays.motion(theta).products[freedom.beam][:, 1:3].T
                found[:, i] = c * y - s * x
        return found

    def along(self, source: str, theta: Array) -> Array:
        """Return the axial forces of one source, tension positive.

        Parameters
        ----------
        source : str
            ``distributed`` or ``lumped``: at unit crank speed [N s^2]; ``static``: of weight and
            constant loads [N].
        theta : ndarray
            Crank angles ``(nt,)`` [rad].

        Returns
        -------
        ndarray
            Shape ``(nt, elements, 3)``: factors of 1, xi and xi^2 along each element.
        """
        arrays = self.arrays
        q = np.zeros((len(theta), arrays.count))
        q[:, arrays.free] = self._at_rest(source, theta)[0]
        field = self._body_field(source, theta)
        motion = arrays.motion(theta)
        found = np.zeros((len(theta), len(arrays.local), 3))
        for e, (placed, own) in enumerate(arrays.local):
            c, s = motion.products[placed.beam.name][:, 1:3].T
            mass = placed.beam.section.mass_per_length * placed.length
            ends = []
            for x, y in ((0, 1), (3, 4)):
                pair = field[:, placed.indices[[x, y]]]
                ends.append(mass * (c * pair[:, 0] + s * pair[:, 1]))
            local = in_own_axes(q[:, placed.indices], c, s)
            # The element is held at its first end by minus its axial force there.
            consistent = ends[0] / 3.0 + ends[1] / 6.0
            found[:, e, 0] = -(local @ own.stiffness[0] + consistent)
            found[:, e, 1] = ends[0]
            found[:, e, 2] = (ends[1] - ends[0]) / 2.0
        return found

    def _at_rest(self, source: str, theta: Array) -> tuple[Array, Array]:
        """Return displacements under the loads, and what is left of elastic forces less loads."""
        stiffness = self.arrays.stiffness(theta) + self.springs
        loads = self.force(source, theta)[..., None]
        if self.slide is None:
            solved: Array = np.asarray(np.linalg.solve(stiffness, loads), dtype=float)
            return solved[..., 0], np.zeros(loads.shape[:2])
        basis = self.slide.basis(theta)
        turned = np.swapaxes(basis, -1, -2)
        q: Array = basis @ np.linalg.solve(turned @ stiffness @ basis, turned @ loads)
        rest: Array = stiffness @ q - loads
        return q[..., 0], rest[..., 0]

    def _body_field(self, source: str, theta: Array) -> Array:
        """Return the acceleration that the beams' own mass resists, all coordinates."""
        if source == "distributed":
            return self.arrays.motion(theta).second
        if source == "lumped":
            return np.zeros((len(theta), self.arrays.count))
        return -self.weight_field(theta)

    def geometric(self, source: str, theta: Array) -> Array:
        """Return ``int P v'^2`` of the axial forces of one source, ``(nt, n, n)`` (4.38)."""
        arrays = self.arrays
        forces = self.along(source, theta)
        motion = arrays.motion(theta)
        total = np.zeros((len(theta), arrays.count, arrays.count))
        for e, (placed, _) in enumerate(arrays.local):
            kernel = self._kernels[e]
            weights = forces[:, e, :, None] * motion.products[placed.beam.name][:, None, :]
            rows, columns = np.ix_(placed.indices, placed.indices)
            total[:, rows, columns] += np.tensordot(weights, kernel, axes=2)
        rows, columns = np.ix_(arrays.free, arrays.free)
        found = np.ascontiguousarray(total[:, rows, columns])
        if self.slide is not None:
            found += self.slide.contact(self._at_rest(source, theta)[1], theta)
        return found

    @cached_property
    def _kernels(self) -> list[Array]:
        """Of each element, the geometric arrays turned: ``(3, 6, n, n)``."""
        found = []
        for _, own in self.arrays.local:
            r = rotation(len(own.mass))
            found.append(np.stack([turned(r, part, r) for part in own.geometric]))
        return found


def _node_forces(arrays: AngleArrays) -> Array:
    found = np.zeros(arrays.count)
    for node in arrays.structure.nodes:
        for part, value in zip(("x", "y"), node.force, strict=True):
            found[arrays.structure.freedoms.at(node.name, part)] += value
    return found
