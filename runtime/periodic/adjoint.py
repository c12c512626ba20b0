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

import numpy as np
from numpy.typing import NDArray

from .equation import Equation, waves
from .transition import Method, Segments, stages_of

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def field_weights(
    equation: Equation,
    way: Method,
    segments: Segments,
    rows: ComplexArray,
    states: ComplexArray,
    harmonics: int,
    *,
    begin: float = 0.0,
) -> Mapping[str, ComplexArray]:
    """Return the weights with which changes of the fields enter ``rows dX states``.

    X is the transition matrix of the period in scaled states, by equal segments, with their
    slopes, from an angle ``begin`` [rad].  Of k rows and states of each member, ``(nb, k, m)``,
    come by field the weights of its Fourier coefficients in unscaled coordinates, in the order of
    :func:`~.equation.waves`: ``(nb, k, 2 H + 1, n, n)``, and ``(nb, k, 2 H + 1, n)`` of the force.
    """
    maps, slopes = segments.maps, segments.slopes
    if slopes is None:
        raise ValueError("segments without slopes")
    n, count = equation.size, maps.shape[1]
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
    turned = np.moveaxis(slopes, 1, 0)
    slope = np.einsum("gbsnm,gbkm->gbksn", turned, before)
    place = before[..., None, :n] + h * np.einsum("ls,gbksn->gbkln", way.a, slope)
    load, momentum = _adjoint(equation, way, left, h, after)
    table = waves(harmonics, (left[:, None] + way.c * h).ravel() * (2 * np.pi / equation.period))

    def summed(*pairs: tuple[ComplexArray, ComplexArray]) -> ComplexArray:
        """Return the waves' sums of products of vectors at the nodes, unscaled."""
        unit = equation.scale[:, None, None]
        flat = [_by_angle(one[..., :, None] * two[..., None, :]) for one, two in pairs]
        outer = np.tensordot(table, sum(flat), axes=(0, 0)) if flat else np.zeros(0)
        values = np.moveaxis(outer, 0, 2)
        return np.asarray(values * unit[..., :, None] * unit[..., None, :])

    weights = {
        "mass": summed((momentum, slope)),
        "gyroscopic": summed((momentum, place), (h * slope, load)),
        "damping": summed((-h * load, slope)),
        "stiffness": summed((h * load, place)),
    }
    if equation.forced:
        force = np.tensordot(table, _by_angle(h * load), axes=(0, 0))
        weights["force"] = np.moveaxis(force, 0, 2) * equation.scale[:, None, None]
    return weights


def _by_angle(values: ComplexArray) -> ComplexArray:
    """Return values ``(segment, member, functional, node, ...)`` with the angles first."""
    by_node = np.moveaxis(values, 3, 1)
    return by_node.reshape(-1, *by_node.shape[2:])


def _adjoint(
    equation: Equation, way: Method, left: Array, h: float, after: ComplexArray
) -> tuple[ComplexArray, ComplexArray]:
    """Return lambda and mu of rows at the right ends, ``(segments, nb, k, s, n)`` each."""
    n, s = equation.size, way.stages
    stages = stages_of(equation, left, h, way)
    end = way.b @ way.inverse
    row_q, row_p = (np.moveaxis(after[..., part], 0, 1) for part in (slice(n), slice(n, 2 * n)))
    # Indices: member, segment, coordinate, node, functional.
    right = h * way.b[:, None] * row_q.mT[..., :, None, :]
    through = np.einsum("bgcjr,bgkr->bgcjk", stages.at_nodes["mass"], row_p)
    right = right + end[:, None] * through
    if "gyroscopic" in stages.at_nodes:
        through = np.einsum("bgclr,bgkr->bgclk", stages.at_nodes["gyroscopic"], row_p)
        right = right + np.einsum("l,lj,bgclk->bgcjk", end, way.a, through)
    flat = right.reshape(*right.shape[:2], n * s, -1)
    parts = np.concatenate([flat.real, flat.imag], axis=-1)
    real, imaginary = np.split(np.linalg.solve(stages.columns, parts), 2, axis=-1)
    # Equations are (node, coordinate).
    solved = (real + 1j * imaginary).reshape(*flat.shape[:2], s, n, -1)
    load = np.moveaxis(solved, (1, 4), (0, 2))
    momentum = end[:, None] * after[..., None, n : 2 * n]
    momentum = momentum - np.einsum("lj,gbkln->gbkjn", way.inverse, load)
    return load, momentum
