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
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .equation import Equation
from .transition import Method, Segments, Stages, blocks, stages_of

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
        over the nodes, ``(nb k, nt, n)`` each; the second of the force is 1, ``(nb k, nt, 1)``.
    shape : tuple of int
        ``(nb, k)``.
    """

    angles: Array
    pairs: Mapping[str, tuple[tuple[ComplexArray, ComplexArray], ...]]
    shape: tuple[int, int]

    def effect(self, field: str, changes: Array) -> ComplexArray:
        """Return what changes do, ``(c, nb, k)``.

        They are ``(c, nt, n, n)``, or ``(c, nt, n)`` of the force; what is constant has one angle.
        """
        count, nodes = changes.shape[:2]
        flat = np.ascontiguousarray(changes.reshape(count, nodes, -1).mT)
        lines = self.shape[0] * self.shape[1]
        total = np.zeros((lines, count, 2))
        together = max(1, _BLOCK // (flat.shape[1] * lines))
        for left, right in self.pairs.get(field, ()):
            if nodes == 1:
                table = (left.mT @ right).reshape(lines, -1).view(float).reshape(lines, -1, 2)
                total += flat[..., 0] @ table
                continue
            for begin in range(0, nodes, together):
                some = slice(begin, begin + together)
                one, other = (np.ascontiguousarray(part[:, some].mT) for part in (left, right))
                entries = one[:, :, None] * other[:, None]
                # Real times complex in one product of real arrays.
                table = entries.reshape(lines, -1).view(float).reshape(lines, -1, 2)
                total += flat[..., some].reshape(count, -1) @ table
        found = np.ascontiguousarray(total.swapaxes(0, 1)).view(complex)
        return found.reshape(count, *self.shape)

    def sizes(self, field: str) -> Array:
        """Return what each entry of a change enters with, without signs, ``(nb, k, n n)``."""
        pairs = self.pairs.get(field, ())
        total: Any = sum(np.abs(left).mT @ np.abs(right) for left, right in pairs)
        return np.reshape(total, (*self.shape, -1)) if pairs else np.zeros((*self.shape, 1))


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
    n, count, (nb, k) = equation.size, maps.shape[1], rows.shape[:2]
    h = equation.period / count
    left = begin + h * np.arange(float(count))
    # Real parts, then imaginary ones.
    before = np.empty((count, nb, 2 * k, states.shape[2]))
    after = np.empty((count, nb, 2 * k, rows.shape[2]))
    state, row = (np.concatenate([one.real, one.imag], axis=1) for one in (states, rows))
    for i in range(count):
        before[i] = state
        state = state @ maps[:, i].mT
    for i in range(count)[::-1]:
        after[i] = row
        row = row @ maps[:, i]
    # Indices: segment, member, part, node, coordinate.
    flat = np.moveaxis(slopes, 1, 0).reshape(count, nb, way.stages * n, -1)
    slope = (before @ flat.mT).reshape(count, nb, 2 * k, way.stages, n)
    place = before[..., None, :n] + h * (way.a @ slope)
    parts, kept = blocks(equation, way, count), segments.stages
    made = kept or (stages_of(equation, left[part], h, way) for part in parts)
    solved = [
        _adjoint(stages, way, h, after[part]) for part, stages in zip(parts, made, strict=True)
    ]
    load, momentum = map(np.concatenate, zip(*solved, strict=True))

    unit = np.tile(equation.scale, (1, way.stages))[:, None, None]

    def by_node(values: Array) -> ComplexArray:
        """Return complex vectors in unscaled coordinates, ``(nb k, nt, n)``."""
        turned = values.reshape(count, nb, 2, k, -1).transpose(2, 1, 3, 0, 4)
        whole = np.empty(turned.shape[1:], dtype=complex)
        for part, target in zip(turned, (whole.real, whole.imag), strict=True):
            np.multiply(part, unit, out=target)
        return whole.reshape(nb * k, count * way.stages, n)

    moved, placed, loaded, pushed = map(by_node, (slope, place, h * load, momentum))
    pairs: dict[str, tuple[tuple[ComplexArray, ComplexArray], ...]] = {
        "mass": ((pushed, moved),),
        "gyroscopic": ((pushed, placed), (moved, loaded)),
        "damping": ((-loaded, moved),),
        "stiffness": ((loaded, placed),),
    }
    if equation.forced:
        pairs["force"] = ((loaded, np.ones_like(loaded[..., :1])),)
    return FieldWeights((left[:, None] + way.c * h).ravel(), pairs, (nb, k))


def _adjoint(stages: Stages, way: Method, h: float, after: Array) -> tuple[Array, Array]:
    """Return lambda and mu of rows at the right ends, ``(segments, nb, k, s, n)`` each."""
    s, n = way.stages, stages.columns.shape[-1] // way.stages
    end = way.b @ way.inverse
    # Indices: member, segment, functional, coordinate, node.
    parts = after.swapaxes(0, 1)
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
    load: Array = solved.swapaxes(0, 1).astype(float, copy=False)
    momentum = end[:, None] * after[..., None, n : 2 * n] - way.inverse.T @ load
    return load, momentum
