"""Krein signatures of multipliers on the unit circle of a conservative periodic system.

With J = [[0, I], [-I, 0]] the monodromy matrix X of the canonical variables obeys X^T J X = J.
The form kappa(x) = -i x^H J x is real; its sign on the eigenvector of a multiplier on the circle
is the multiplier's signature.  Convention: +1 means that the multiplier moves anticlockwise where
the Hamiltonian grows (a positive definite term is added), and for constant coefficients that
exp(i w T), w > 0, belongs to a motion of positive energy.  Conjugate multipliers have opposite
signatures.  Multipliers that meet can leave the circle only where their signatures differ.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Signs = NDArray[np.int8]
Mask = NDArray[np.bool_]


def form_matrix(vectors: ComplexArray) -> ComplexArray:
    """Return ``-i X^H J X`` of columns ``(..., 2n, k)``, Hermitian, shape ``(..., k, k)``."""
    n = vectors.shape[-2] // 2
    upper, lower = vectors[..., :n, :], vectors[..., n:, :]
    product = np.swapaxes(upper.conj(), -1, -2) @ lower
    value: ComplexArray = -1j * (product - np.swapaxes(product.conj(), -1, -2))
    return value


def signatures_of(vectors: ComplexArray, multipliers: ComplexArray, error: Array) -> Signs:
    """Return the signature of each multiplier of symplectic matrices, shape ``(nb, 2n)``.

    Of unit eigenvectors, ``(nb, 2n, 2n)``, multipliers and their absolute errors, ``(nb, 2n)``.  It
    is 0 off the circle, where errors leave the sign open, and where multipliers that errors do not
    tell apart have a form that is not definite.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = np.abs(multipliers[:, :, None] - multipliers[:, None, :])
        # Within ten errors two multipliers are taken as one, and a modulus for 1.
        near = distance <= 10.0 * (error[:, :, None] + error[:, None, :])
        on_circle = (np.abs(np.abs(multipliers) - 1.0) <= 10.0 * error) & (error < 0.1)
        # A vector is in error by that of its multiplier, over the distance to the others.
        apart = np.min(np.where(np.eye(distance.shape[-1]), 2.0, distance), axis=-1)
        slack = 4.0 * error / np.minimum(apart, 2.0)
    levels = np.diagonal(form_matrix(vectors), axis1=-2, axis2=-1).real
    signs: Array = np.sign(levels) * (on_circle & (np.abs(levels) > slack))
    for row in np.flatnonzero(np.count_nonzero(near, axis=(1, 2)) > distance.shape[-1]).tolist():
        signs[row] = _of_groups(near[row], on_circle[row], distance[row], vectors[row], error[row])
    signs[~np.all(np.isfinite(multipliers), axis=-1)] = 0
    return signs.astype(np.int8)


def _of_groups(
    near: Mask, on_circle: Mask, distance: Array, vectors: ComplexArray, error: Array
) -> Array:
    """Return the signatures of one matrix whose multipliers are not all apart."""
    signs = np.zeros(len(error))
    for members in _groups(near):
        if not np.all(on_circle[members]):
            continue
        basis, _ = np.linalg.qr(vectors[:, members])
        levels = np.linalg.eigvalsh(form_matrix(basis))
        apart = np.delete(distance[members], members, axis=1)
        slack = 4.0 * float(np.max(error[members])) / float(np.min(apart, initial=2.0))
        signs[members] = float(np.all(levels > slack)) - float(np.all(levels < -slack))
    return signs


def _groups(linked: Mask) -> list[NDArray[np.intp]]:
    """Return the connected groups of a symmetric relation."""
    reached = linked
    for _ in range(len(linked).bit_length()):
        reached = (reached.astype(int) @ reached.astype(int)) > 0
    firsts = np.argmax(reached, axis=1)
    return [np.flatnonzero(firsts == first) for first in np.unique(firsts)]
