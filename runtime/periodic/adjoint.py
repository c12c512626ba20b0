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

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .equation import Equation
from .transition import Method, Segments, blocks, stages_of

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
# Entries of weights that are made at once: they stay in the cache.
_BLOCK = 1 << 15


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

    def effect(self, field: str, changes: Array) -> ComplexArray:
        """Return what changes do, ``(c, nb, k)``.

        They are ``(c, nt, n, n)``, or ``(c, nt, n)`` of the force.
        """
        return self._summed(field, changes, lambda values: values).reshape(-1, *self.shape)

    def size(self, field: str, change: Array) -> Array:
        """Return what all terms of the sums add up to without signs, ``(nb, k)``."""
        return self._summed(field, np.abs(change)[None], np.abs).real.reshape(self.shape)

    def _summed(
        self, field: str, changes: Array, of: Callable[[ComplexArray], NDArray[Any]]
    ) -> ComplexArray:
        """Return sums over the nodes of changes between vectors, or their sizes, ``(c, nb k)``."""
        count, nodes = changes.shape[:2]
        total = np.zeros((count, self.shape[0] * self.shape[1]), dtype=complex)
        together = max(1, _BLOCK // (changes[0, 0].size * total.shape[1]))
        for left, right in self.pairs.get(field, ()):
            for begin in range(0, nodes, together):
                some = slice(begin, begin + together)
                entries = of(left[some])
                if right is not None:
                    entries = entries[:, :, None] * of(right[some])[:, None]
                flat = changes[:, some].reshape(count, -1)
                # Real times complex in one product of real arrays.
                table = entries.reshape(flat.shape[1], -1).astype(complex, copy=False)
                total += (flat @ table.view(float)).view(complex)
        return total


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
    solved = [_adjoint(equation, way, left[i], h, after[i]) for i in blocks(equation, way, count)]
    load, momentum = map(np.concatenate, zip(*solved, strict=True))

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
    n, s, k = equation.size, way.stages, after.shape[2]
    stages = stages_of(equation, left, h, way)
    end = way.b @ way.inverse
    # Indices: member, segment, functional (real parts, then imaginary), coordinate, node.
    parts = np.concatenate([after.real, after.imag], axis=2).swapaxes(0, 1)
    row_p = np.ascontiguousarray(parts[..., n : 2 * n])
    shape = (*row_p.shape, s)

    def at_nodes(field: str) -> Array:
        by_row = stages.at_nodes[field].reshape(*shape[:2], n * s, n)
        return np.asarray(end * (row_p @ by_row.mT).reshape(shape))

    right = at_nodes("mass") + h * way.b * parts[..., :n, None]
    if "gyroscopic" in stages.at_nodes:
        right += at_nodes("gyroscopic") @ way.a
    # Equations are (node, coordinate).
    flat = right.reshape(*shape[:3], n * s)
    solved = np.linalg.solve(stages.columns, flat.mT).mT.reshape(*shape[:3], s, n)
    load = (solved[:, :, :k] + 1j * solved[:, :, k:]).swapaxes(0, 1)
    momentum = end[:, None] * after[..., None, n : 2 * n] - way.inverse.T @ load
    return load, momentum
