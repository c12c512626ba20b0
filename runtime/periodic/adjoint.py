"""What small changes of the coefficients do to a linear periodic system: one adjoint for all.

The equations of the slopes V at the nodes of a segment (:mod:`.transition`) are ``r(V) = 0``, its
right end is a function z(V).  A change of the fields changes both, and with it what a row l sees of
the right end by ``l dz - l (dz/dV) (dr/dV)^-1 dr``: one system of equations with the transposed
matrix, for all changes together.  Rows go back through the segments, states forward:

    l dX x = sum_nodes  mu (dM V + dA Q) + h lambda ((dA^T - dC/w) V + dN Q + dF),
    (dr/dV)^T lambda = (dz/dV)^T l,  mu_j = (b a^-1)_j l_p - sum_l (a^-1)_lj lambda_l.

That is the derivative of the matrix X as it is computed, so that it converges as X does.

Without damping there is nothing to solve: Gauss's nodes keep the flow symplectic, and what a row
(l_q, l_p) sees goes as the motion from (l_p, -l_q) does.  With its slopes W and places Y at the
nodes ``mu_j = h b_j W_j`` and ``lambda_j = b_j Y_j``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .equation import Equation
from .transition import Method, Segments, Stages, blocks, stages_of

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
# Entries of weights that are made at once: they stay in the cache.
_BLOCK = 1 << 15
# By field, the sign of its change, and vectors between which it stands, summed over the nodes.
_PAIRS = {
    "mass": ((1.0, "momentum", "slope"),),
    "gyroscopic": ((1.0, "momentum", "place"), (1.0, "slope", "load")),
    "damping": ((-1.0, "load", "slope"),),
    "stiffness": ((1.0, "load", "place"),),
    "force": ((1.0, "load", "one"),),
}


@dataclass(frozen=True)
class FieldWeights:
    """With what changes of the fields enter k functionals of each of nb members.

    Attributes
    ----------
    angles : ndarray
        Crank angles [rad] of all nodes of the period, shape ``(nt,)``.
    vectors : mapping
        By the names of :data:`_PAIRS`, vectors in unscaled coordinates, ``(nb k, n, nt)`` each;
        ``one``, of a system with a force, is 1, ``(nb k, 1, nt)``.
    shape : tuple of int
        ``(nb, k)``.
    """

    angles: Array
    vectors: Mapping[str, ComplexArray]
    shape: tuple[int, int]

    def effect(self, field: str, changes: Array) -> ComplexArray:
        """Return what changes do, ``(c, nb, k)``.

        They are ``(c, n, n, nt)``, or ``(c, n, nt)`` of the force; what is constant has one angle.
        """
        count, nodes = len(changes), changes.shape[-1]
        flat = changes.reshape(count, -1, nodes)
        lines = self.shape[0] * self.shape[1]
        total = np.zeros((lines, count, 2))
        together = max(1, _BLOCK // (flat.shape[1] * lines))
        for sign, *names in _PAIRS[field]:
            left, right = (self.vectors[name] for name in names)
            if nodes == 1:
                table = (left @ right.mT).reshape(lines, -1).view(float).reshape(lines, -1, 2)
                total += sign * (flat[..., 0] @ table)
                continue
            for begin in range(0, nodes, together):
                some = slice(begin, begin + together)
                entries = left[:, :, None, some] * right[:, None, :, some]
                # Real times complex in one product of real arrays.
                table = entries.reshape(lines, -1).view(float).reshape(lines, -1, 2)
                total += sign * (flat[..., some].reshape(count, -1) @ table)
        found = np.ascontiguousarray(total.swapaxes(0, 1)).view(complex)
        return found.reshape(count, *self.shape)

    def sizes(self, field: str) -> Array:
        """Return what each entry of a change enters with, without signs, ``(nb, k, n n)``."""
        pairs = ((self._sizes[left], self._sizes[right]) for _, left, right in _PAIRS[field])
        return np.reshape(sum(left @ right.mT for left, right in pairs), (*self.shape, -1))

    @property
    def fields(self) -> tuple[str, ...]:
        """Fields that the system has: a force not always."""
        return tuple(name for name in _PAIRS if name != "force" or "one" in self.vectors)

    @cached_property
    def _sizes(self) -> Mapping[str, Array]:
        return {name: np.abs(vector) for name, vector in self.vectors.items()}


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
    n, count, (nb, k) = equation.size, maps.shape[1], rows.shape[:2]
    h = equation.period / count
    left = begin + h * np.arange(float(count))
    # Real parts, then imaginary ones.
    before, after = (np.empty((count, nb, 2 * k, one.shape[2])) for one in (states, rows))
    np.concatenate([states.real, states.imag], axis=1, out=before[0])
    np.concatenate([rows.real, rows.imag], axis=1, out=after[-1])
    for i, step in enumerate(np.moveaxis(maps, 1, 0)[:-1]):
        np.matmul(before[i], step.mT, out=before[i + 1])
    for i, step in enumerate(np.moveaxis(maps, 1, 0)[:0:-1]):
        np.matmul(after[-1 - i], step, out=after[-2 - i])
    # Indices: segment, member, part, coordinate, node.
    flat = np.moveaxis(slopes, 1, 0).reshape(count, nb, -1, n * way.stages)
    slope = (before @ flat).reshape(count, nb, 2 * k, n, way.stages)
    place = slope @ (h * way.a.T)
    place += before[..., :n, None]
    if way.ends:
        parts, kept = blocks(equation, way, count), segments.stages
        made = kept or (stages_of(equation, left[part], h, way) for part in parts)
        solved = [
            _adjoint(stages, way, h, after[part]) for part, stages in zip(parts, made, strict=True)
        ]
        load, momentum = map(np.concatenate, zip(*solved, strict=True))
    else:
        row = after @ np.moveaxis(maps, 1, 0)
        turned = np.concatenate([row[..., n : 2 * n], -row[..., :n]], axis=-1)
        rate = (turned @ flat[:, :, : 2 * n]).reshape(slope.shape)
        load, momentum = rate @ (h * way.a.T), (h * way.b) * rate
        load += turned[..., :n, None]
        load *= way.b

    def by_node(values: Array, factor: float = 1.0) -> ComplexArray:
        """Return multiples as complex vectors in unscaled coordinates, ``(nb k, n, nt)``."""
        unit = (factor * equation.scale)[:, None, :, None, None]
        turned = values.reshape(count, nb, 2, k, n, way.stages).transpose(2, 1, 3, 4, 0, 5)
        whole = np.empty(turned.shape[1:], dtype=complex)
        for part, target in zip(turned, (whole.real, whole.imag), strict=True):
            np.multiply(part, unit, out=target)
        return whole.reshape(nb * k, n, count * way.stages)

    vectors = {"slope": by_node(slope), "place": by_node(place)}
    vectors |= {"load": by_node(load, h), "momentum": by_node(momentum)}
    if equation.forced:
        vectors["one"] = np.ones_like(vectors["load"][:, :1])
    return FieldWeights((left[:, None] + way.c * h).ravel(), vectors, (nb, k))


def _adjoint(stages: Stages, way: Method, h: float, after: Array) -> tuple[Array, Array]:
    """Return lambda and mu of rows at the right ends, ``(segments, nb, k, n, s)`` each.

    The last node is the right end.
    """
    s, n = way.stages, stages.columns.shape[-1] // way.stages
    # Indices: member, segment, functional, coordinate, node.
    row_q, row_p = (after[..., part].swapaxes(0, 1) for part in (slice(n), slice(n, 2 * n)))
    right = h * row_q
    if "gyroscopic" in stages.at_nodes:
        right += row_p @ stages.at_nodes["gyroscopic"][..., -1, :].mT
    right = right[..., None] * way.b
    right[..., -1] += row_p @ stages.at_nodes["mass"][..., -1, :].mT
    # Equations are (node, coordinate).
    flat = right.reshape(*row_p.shape[:3], n * s)
    unknown = np.linalg.solve(stages.columns, flat.mT).mT
    solved: Array = unknown.reshape(*row_p.shape[:3], s, n).astype(float, copy=False)
    momentum: Array = -way.inverse.T @ solved
    momentum[..., -1, :] += row_p
    return solved.swapaxes(0, 1).mT, momentum.swapaxes(0, 1).mT
