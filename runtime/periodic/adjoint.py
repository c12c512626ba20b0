"""What small changes of the coefficients do to a linear periodic system: one adjoint for all.

The equations of the slopes V at the nodes of a segment (:mod:`.transition`) are ``r(V) = 0``, its
right end is a function z(V).  A change of the fields changes both, and with it what a row l sees of
the right end by ``l dz - l (dz/dV) (dr/dV)^-1 dr``: one system of equations with the transposed
matrix, for all changes together.  Rows go back through the segments, states forward:

    l dX x = sum_nodes  mu (dM V + dA Q) + h lambda ((dA^T - dC/w) V + dN Q + dF),
    (dr/dV)^T lambda = (dz/dV)^T l,  mu_j = (b a^-1)_j l_p - sum_l (a^-1)_lj lambda_l.

That is the derivative of the matrix X as it is computed, so that it converges as X does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .equation import Equation
from .transition import Method, Segments, stages_of

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class FieldWeights:
    """With what changes of the fields enter k functionals of each of nb members.

    Attributes
    ----------
    angles : ndarray
        Crank angles [rad] of all nodes of the period, shape ``(nt,)``.
    pairs : mapping
        By field, pairs of vectors in unscaled coordinates between which its change stands, summed
        over the nodes, ``(nt, n, nb k)`` each; the second of the force is None.
    shape : tuple of int
        ``(nb, k)``.
    """

    angles: Array
    pairs: Mapping[str, tuple[tuple[ComplexArray, ComplexArray | None], ...]]
    shape: tuple[int, int]

    def effect(self, field: str, change: Array) -> ComplexArray:
        """Return what a change ``(nt, n, n)``, or ``(nt, n)`` of the force, does, ``(nb, k)``."""
        total = np.zeros(self.shape[0] * self.shape[1], dtype=complex)
        for left, right in self.pairs.get(field, ()):
            if right is None:
                total += np.einsum("tik,ti->k", left, change)
            else:
                # Real times complex in one product of real arrays.
                moved = change @ right.view(float)
                total += np.sum(left * moved.view(complex), axis=(0, 1))
        return total.reshape(self.shape)

    def size(self, field: str, change: Array) -> Array:
        """Return what all terms of the sums add up to without signs, ``(nb, k)``."""
        total = np.zeros(self.shape[0] * self.shape[1])
        for left, right in self.pairs.get(field, ()):
            moved = np.abs(change)[..., None] if right is None else np.abs(change) @ np.abs(right)
            total += np.sum(np.abs(left) * moved, axis=(0, 1))
        return total.reshape(self.shape)


def field_weights(
    equation: Equation,
    way: Method,
    segments: Segments,
    rows: ComplexArray,
    states: ComplexArray,
    *,
    begin: float = 0.0,
) -> FieldWeights:
    """Return the weights with which changes of the fields enter ``rows dX states``.

    X is the transition matrix of the period in scaled states, by equal segments, with their
    slopes, from an angle ``begin`` [rad]; of each member there are k rows and states,
    ``(nb, k, m)``.
    """
    maps, slopes = segments.maps, segments.slopes
    if slopes is None:
        raise ValueError("segments without slopes")
    n, count, shape = equation.size, maps.shape[1], rows.shape[:2]
    h = equation.period / count
    left = begin + h * np.arange(float(count))
    before = np.empty((count, *states.shape), dtype=complex)
    after = np.empty((count, *rows.shape), dtype=complex)
    for i in range(count):
        before[i] = states
        states = states @ maps[:, i].mT
    for i in range(count)[::-1]:
        after[i] = rows
        rows = rows @ maps[:, i]
    # Indices: segment, member, functional, node, coordinate.
    flat = np.moveaxis(slopes, 1, 0).reshape(count, shape[0], way.stages * n, -1)
    slope = (before @ flat.mT).reshape(count, *shape, way.stages, n)
    place = before[..., None, :n] + h * (way.a @ slope)
    load, momentum = _adjoint(equation, way, left, h, after)

    def by_node(values: ComplexArray) -> ComplexArray:
        """Return vectors in unscaled coordinates by node, ``(nt, n, nb k)``."""
        unscaled = values * equation.scale[:, None, None, :]
        turned = unscaled.transpose(0, 3, 4, 1, 2)
        return np.ascontiguousarray(turned.reshape(count * way.stages, n, -1))

    moved, placed, loaded, pushed = map(by_node, (slope, place, h * load, momentum))
    pairs: dict[str, tuple[tuple[ComplexArray, ComplexArray | None], ...]] = {
        "mass": ((pushed, moved),),
        "gyroscopic": ((pushed, placed), (moved, loaded)),
        "damping": ((-loaded, moved),),
        "stiffness": ((loaded, placed),),
    }
    if equation.forced:
        pairs["force"] = ((loaded, None),)
    return FieldWeights((left[:, None] + way.c * h).ravel(), pairs, (shape[0], shape[1]))


def _adjoint(
    equation: Equation, way: Method, left: Array, h: float, after: ComplexArray
) -> tuple[ComplexArray, ComplexArray]:
    """Return lambda and mu of rows at the right ends, ``(segments, nb, k, s, n)`` each."""
    n, s = equation.size, way.stages
    stages = stages_of(equation, left, h, way)
    end = way.b @ way.inverse
    row_q, row_p = (
        np.moveaxis(after[..., part], 0, 1).mT[:, :, None] for part in (slice(n), slice(n, 2 * n))
    )
    # Indices: member, segment, coordinate, node, functional.
    right = h * way.b[:, None] * np.moveaxis(row_q, 2, 3)
    right = right + end[:, None] * (stages.at_nodes["mass"] @ row_p)
    if "gyroscopic" in stages.at_nodes:
        through = end[:, None] * (stages.at_nodes["gyroscopic"] @ row_p)
        right = right + way.a.T @ through
    flat = right.reshape(*right.shape[:2], n * s, -1)
    parts = np.concatenate([flat.real, flat.imag], axis=-1)
    real, imaginary = np.split(np.linalg.solve(stages.columns, parts), 2, axis=-1)
    # Equations are (node, coordinate).
    solved = (real + 1j * imaginary).reshape(*flat.shape[:2], s, n, -1)
    load = np.moveaxis(solved, (1, 4), (0, 2))
    momentum = end[:, None] * after[..., None, n : 2 * n]
    momentum = momentum - way.inverse.T @ load
    return load, momentum
