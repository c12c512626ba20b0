"""The linear equations of accelerations and multipliers, scaled, with a named refusal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import Problem, RedundantConstraints

Array = NDArray[np.float64]

# A singular value of the scaled Jacobian below this part of the largest counts as zero.
RANK = 1e-11


def powers_of_two(values: Array) -> Array:
    """Return the powers of two next to ``1 / values``; 1 where a value is zero.

    Scaling by them is exact.
    """
    used = np.where((values > 0) & np.isfinite(values), values, 1.0)
    scaled: Array = np.exp2(-np.round(np.log2(used)))
    return scaled


def scaling(mass: Array, jacobian: Array) -> tuple[Array, Array]:
    """Return factors of columns and rows that make masses and constraint rows of unit size.

    Of masses ``(*batch, n, n)`` and a Jacobian ``(*batch, k, n)`` return S ``(*batch, n)``,
    ``q = S q'``, so that the coordinates are measured by their inertia, and R ``(*batch, k)``, so
    that the rows of ``R Phi_q S`` have unit length.
    """
    columns = powers_of_two(np.sqrt(np.abs(np.diagonal(mass, axis1=-2, axis2=-1))))
    rows = powers_of_two(np.linalg.norm(jacobian * columns[..., None, :], axis=-1))
    return columns, rows


def check_rank(jacobian: Array, columns: Array, rows: Array) -> None:
    """Refuse a Jacobian whose rows depend on each other, ``columns`` and ``rows`` as of `scaling`.

    That is where the smallest singular value of the scaled one is below 1e-11 of the largest.
    """
    k, n = jacobian.shape[-2:]
    if k == 0:
        return
    if k > n:
        raise _redundant(f"{k} constraints on {n} coordinates")
    scaled = rows[..., :, None] * jacobian * columns[..., None, :]
    values = np.linalg.svd(scaled, compute_uv=False)
    least = float(np.min(values[..., -1] / np.maximum(values[..., 0], np.finfo(float).tiny)))
    if not least > RANK:
        raise _redundant(f"a Jacobian of reciprocal condition {least:.2g}")


def _redundant(found: str) -> RedundantConstraints:
    expected = "rows that do not depend on each other at every state"
    fix = "drop a redundant constraint, or leave the position where the linkage can branch"
    return RedundantConstraints(Problem("constraints", found, expected, fix))


def kkt_matrix(mass: Array, jacobian: Array) -> Array:
    """Return ``[[M, -Phi_q^T], [Phi_q, 0]]``, shape ``(*batch, n + k, n + k)``."""
    k, n = jacobian.shape[-2:]
    matrix = np.zeros((*mass.shape[:-2], n + k, n + k))
    matrix[..., :n, :n] = mass
    matrix[..., :n, n:] = -np.swapaxes(jacobian, -1, -2)
    matrix[..., n:, :n] = jacobian
    return matrix


def solve_multipliers(
    mass: Array, jacobian: Array, forces: Array, gamma: Array
) -> tuple[Array, Array]:
    """Solve ``M a = Phi_q^T lam + forces``, ``Phi_q a = gamma``.

    The matrix is solved whole, which wants inertia only in what the constraints allow; rows and
    columns are scaled by powers of two.

    Of masses ``(*batch, n, n)``, a Jacobian ``(*batch, k, n)`` and right-hand sides ``(*batch, n)``
    and ``(*batch, k)`` return accelerations and multipliers.  Rows of the Jacobian that depend on
    each other, or a motion that they allow without inertia, raise `RedundantConstraints`.
    """
    columns, rows = scaling(mass, jacobian)
    check_rank(jacobian, columns, rows)
    n = mass.shape[-1]
    scale = np.concatenate([columns, rows], axis=-1)
    matrix = scale[..., :, None] * kkt_matrix(mass, jacobian) * scale[..., None, :]
    right = scale * np.concatenate([forces, gamma], axis=-1)
    try:
        solved = np.linalg.solve(matrix, right[..., None])[..., 0]
    except np.linalg.LinAlgError as singular:
        found = "a motion without inertia that the constraints allow"
        expected = "a mass matrix that is positive on what the constraints leave free"
        fix = "give that motion a mass, or hold it by a constraint"
        raise RedundantConstraints(Problem("mass", found, expected, fix)) from singular
    solved *= scale
    return solved[..., :n], solved[..., n:]
