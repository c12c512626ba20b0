"""Gauss-Legendre collocation with any number of stages: order 2s, symplectic, A-stable."""

from __future__ import annotations

import numpy as np

from ..errors import bad
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
    if m % 2 == 0 and not values[..., :n, :n].any() and not values[..., n:, n:].any():
        return _condensed(tableau, values[..., :n, n:], values[..., n:, :n], step)
    lead = values.shape[:-3]
    # (..., i, j) block of the system: delta_ij I - h a_ij L_i, laid out as (..., i, row, j, column)
    system = -step * np.einsum("ij,...irc->...irjc", tableau.a, values)
    diagonal = np.arange(stages)
    rows = np.arange(m)
    system[..., diagonal[:, None], rows, diagonal[:, None], rows] += 1.0
    slopes = np.linalg.solve(
        system.reshape(*lead, stages * m, stages * m), values.reshape(*lead, stages * m, m)
    )
    weighted = np.einsum("i,...irc->...rc", step * tableau.b, slopes.reshape(*lead, stages, m, m))
    result: Array = weighted + np.eye(m)
    return result


def _condensed(tableau: GaussTableau, upper: Array, lower: Array, step: float) -> Array:
    """Return the step matrices where q' = U p and p' = V q: half the unknowns, a quarter the work.

    The stage momenta are eliminated: ``Q_i = q + h sum_k a_ik U_k (p + h sum_j a_kj V_j Q_j)``.
    """
    s, n = tableau.stages, upper.shape[-1]
    lead = upper.shape[:-3]
    a, b = step * tableau.a, step * tableau.b
    through = np.einsum("ik,kj->ijk", a, a).reshape(s * s, s) @ upper.reshape(*lead, s, n * n)
    coupling = through.reshape(*lead, s, s, n, n) @ lower[..., None, :, :, :]
    system = -np.moveaxis(coupling, -2, -3).reshape(*lead, s * n, s * n)
    diagonal = np.arange(s * n)
    system[..., diagonal, diagonal] += 1.0
    start = np.zeros((*lead, s, n, 2 * n))
    start[..., :n] = np.eye(n)
    start[..., n:] = (a @ upper.reshape(*lead, s, n * n)).reshape(*lead, s, n, n)
    stages = np.linalg.solve(system, start.reshape(*lead, s * n, 2 * n))
    push = lower @ stages.reshape(*lead, s, n, 2 * n)
    momenta = (a @ push.reshape(*lead, s, 2 * n * n)).reshape(*lead, s, n, 2 * n)
    momenta[..., n:] += np.eye(n)
    out = np.zeros((*lead, 2 * n, 2 * n))
    rise = b @ (upper @ momenta).reshape(*lead, s, 2 * n * n)
    out[..., :n, :] = rise.reshape(*lead, n, 2 * n)
    out[..., n:, :] = (b @ push.reshape(*lead, s, 2 * n * n)).reshape(*lead, n, 2 * n)
    return out + np.eye(2 * n)


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
