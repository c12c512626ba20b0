"""Characteristic polynomials of many matrices, and what an error of the matrices does to them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...core.families import Array

_EPS = float(np.finfo(float).eps)
# Round-off of the recursion, over the coefficients where beyond 1, from which eigenvalues do
# better.
_LOST = 1e-11


def characteristic(matrices: Array, *, reduced: bool) -> Array:
    """Return coefficients of the characteristic polynomial of each matrix.

    Parameters
    ----------
    matrices : ndarray, shape (..., 2n, 2n)
        Monodromy matrices.
    reduced : bool
        For a symplectic matrix the coefficients are palindromic; only the first n are returned.

    Returns
    -------
    ndarray, shape (..., n) or (..., 2n)
        ``c_1, c_2, ...`` of ``rho^2n + c_1 rho^(2n-1) + ...``; not finite where they overflow.
    """
    size = matrices.shape[-1]
    return weighed_characteristic(matrices, size // 2 if reduced else size)[0]


def weighed_characteristic(
    matrices: Array, wanted: int, change: Array | None = None
) -> tuple[Array, Array]:
    """Return the first coefficients of characteristic polynomials, and what moves them.

    Faddeev and LeVerrier: ``B_k = X B_(k-1) + c_k``, ``c_k = -tr(X B_(k-1)) / k``.  Its round-off
    grows like powers of X, and where too much of a coefficient would be lost the polynomial is
    made from the eigenvalues instead.

    Parameters
    ----------
    matrices : ndarray, shape (..., m, m)
        The matrices X.
    wanted : int
        How many coefficients.
    change : ndarray, shape (...), optional
        Size of a change of X, by default that of X itself.

    Returns
    -------
    coefficients : ndarray, shape (..., wanted)
        ``c_1, c_2, ...``
    weight : ndarray, shape (..., wanted)
        How far such a change moves each, at first order: ``dc_k = -tr(B_(k-1) dX)``; at least 1.
    """
    m = matrices.shape[-1]
    found, weight = [], []
    with np.errstate(over="ignore", invalid="ignore"):
        size = _norm(matrices)
        change = size if change is None else change
        power = np.broadcast_to(np.eye(m), matrices.shape)
        rough, worst = np.zeros_like(size), np.zeros_like(size)
        for k in range(1, wanted + 1):
            norm = _norm(power)
            rough = size * (rough + _EPS * norm)
            worst = np.maximum(worst, rough / k)
            product = matrices @ power
            coefficient = -np.trace(product, axis1=-2, axis2=-1) / k
            found.append(coefficient)
            weight.append(np.maximum(change * norm, 1.0))
            power = product + coefficient[..., None, None] * np.eye(m)
        coefficients = np.stack(found, axis=-1)
        top = np.maximum(np.max(np.abs(coefficients), axis=-1), 1.0)
        lost = (worst > _LOST * top) & np.all(np.isfinite(coefficients), axis=-1)
    if np.any(lost):
        coefficients[lost] = _from_eigenvalues(matrices[lost], wanted)
    return coefficients, np.stack(weight, axis=-1)


def _norm(matrices: Array) -> Array:
    value: Array = np.sqrt(np.einsum("...ij,...ij->...", matrices, matrices))
    return value


def _from_eigenvalues(matrices: Array, wanted: int) -> Array:
    """Return coefficients as products of eigenvalues, those of balanced matrices."""
    values: NDArray[np.complex128] = np.linalg.eigvals(matrices).astype(complex)
    # The largest first: no partial product is larger than a coefficient of its own.
    order = np.argsort(-np.abs(values), axis=-1)
    values = np.take_along_axis(values, order, axis=-1)
    table = np.zeros((*values.shape[:-1], values.shape[-1] + 1), dtype=complex)
    table[..., 0] = 1.0
    with np.errstate(over="ignore", invalid="ignore"):
        for i in range(values.shape[-1]):
            table[..., 1 : i + 2] -= values[..., i : i + 1] * table[..., : i + 1]
    return np.asarray(table[..., 1 : wanted + 1].real)
