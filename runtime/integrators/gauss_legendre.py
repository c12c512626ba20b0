"""Gauss-Legendre collocation with any number of stages: order 2s, symplectic, A-stable."""

from __future__ import annotations

import numpy as np

from ..core.errors import bad
from ..core.namespaces import any_entry, carried, identity, in_numpy, namespace_of, weighted_sum
from .protocol import Array, Generator, OneStep, at_nodes
from .tableau import GaussTableau, gauss_tableau


def gauss_maps(stages: int, generator: Generator, theta: Array, step: float) -> Array:
    """Return the step matrices of Gauss collocation with ``stages`` stages.

    The stage slopes solve the linear system ``K_i = L_i (I + h sum_j a_ij K_j)``, all steps of the
    stack at once.  Parameters and shapes as in :class:`OneStep`.
    """
    tableau = gauss_tableau(stages)
    values = at_nodes(generator, theta, step * tableau.c)
    m = values.shape[-1]
    n = m // 2
    xp = namespace_of(values)
    if m % 2 == 0 and not any_entry(values[..., :n, :n]) and not any_entry(values[..., n:, n:]):
        return _condensed(tableau, values[..., :n, n:], values[..., n:, :n], step)
    lead, whole = values.shape[:-3], stages * m
    # (..., i, j) block of the system: delta_ij I - h a_ij L_i, laid out as (..., i, row, j, column)
    coefficients = carried(tableau.a, values)[:, None, :, None]
    system = -step * (coefficients * values[..., :, :, None, :])
    system = _plus_identity(xp.reshape(system, (*lead, whole, whole)))
    slopes = xp.linalg.solve(system, xp.reshape(values, (*lead, whole, m)))
    weighted = weighted_sum(step * tableau.b, xp.reshape(slopes, (*lead, stages, m, m)))
    result: Array = weighted + identity(m, values)
    return result


def _plus_identity(matrices: Array) -> Array:
    """Return fresh matrices with 1 added to their diagonals, in place where they are NumPy's."""
    size = matrices.shape[-1]
    if in_numpy(matrices):
        diagonal = np.arange(size)
        matrices[..., diagonal, diagonal] += 1.0
        return matrices
    value: Array = matrices + identity(size, matrices)
    return value


def _condensed(tableau: GaussTableau, upper: Array, lower: Array, step: float) -> Array:
    """Return the step matrices where q' = U p and p' = V q: half the unknowns, a quarter the work.

    The stage momenta are eliminated: ``Q_i = q + h sum_k a_ik U_k (p + h sum_j a_kj V_j Q_j)``.
    """
    s, n = tableau.stages, upper.shape[-1]
    lead = upper.shape[:-3]
    xp = namespace_of(upper)
    weights = step * tableau.a
    twice = np.einsum("ik,kj->ijk", weights, weights).reshape(s * s, s)
    a, b, twice = (carried(part, upper) for part in (weights, step * tableau.b, twice))
    flat = xp.reshape(upper, (*lead, s, n * n))
    through = xp.reshape(twice @ flat, (*lead, s, s, n, n))
    coupling = xp.moveaxis(through @ lower[..., None, :, :, :], -2, -3)
    system = _plus_identity(-xp.reshape(coupling, (*lead, s * n, s * n)))
    start = _beside_identity(xp.reshape(a @ flat, (*lead, s, n, n)))
    stages = xp.linalg.solve(system, xp.reshape(start, (*lead, s * n, 2 * n)))
    push = xp.reshape(lower @ xp.reshape(stages, start.shape), (*lead, s, 2 * n * n))
    both = identity(2 * n, upper)
    momenta = xp.reshape(a @ push, start.shape)
    momenta += both[n:, :]
    rise = b @ xp.reshape(upper @ momenta, push.shape)
    rows = [xp.reshape(part, (*lead, n, 2 * n)) for part in (rise, b @ push)]
    out: Array = xp.concat(rows, axis=-2)
    out += both
    return out


def _beside_identity(right: Array) -> Array:
    """Return ``[1, right]``."""
    n = right.shape[-1]
    if in_numpy(right):
        out = np.empty((*right.shape[:-1], 2 * n))
        out[..., :n], out[..., n:] = np.eye(n), right
        return out
    xp = namespace_of(right)
    value: Array = xp.concat([xp.broadcast_to(identity(n, right), right.shape), right], axis=-1)
    return value


def gauss_legendre(stages: int = 6, name: str = "gauss_legendre") -> OneStep:
    """Return the Gauss-Legendre method with a number of stages.

    Parameters
    ----------
    stages : int
        Number s >= 1 of stages; the order is 2s.
    name : str
        Name of the method.

    Raises
    ------
    BadInput
        If ``stages`` is not a whole number from 1 to 32.
    """
    if stages != int(stages) or not 1 <= stages <= 32:
        raise bad("stages", stages, "a whole number from 1 to 32", "choose 2 to 8")

    def maps(generator: Generator, theta: Array, step: float) -> Array:
        return gauss_maps(int(stages), generator, theta, step)

    return OneStep(name, order=2 * int(stages), maps=maps, explicit=False, symplectic=True)


# Order 12 by the plain name; the others by their order.
METHODS = (gauss_legendre(), *(gauss_legendre(s, f"gauss_legendre{2 * s}") for s in range(2, 9)))
