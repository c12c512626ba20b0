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
    out = np.zeros(multipliers.shape, dtype=np.int8)
    for row, values in enumerate(multipliers):
        if np.all(np.isfinite(values)):
            out[row] = _signs(values, vectors[row], error[row])
    return out


def _signs(values: ComplexArray, vectors: ComplexArray, error: Array) -> Signs:
    signs = np.zeros(len(values), dtype=np.int8)
    # Within ten errors two multipliers are taken as one, and a modulus for 1.
    distance = np.abs(values[:, None] - values)
    near = distance <= 10.0 * (error[:, None] + error)
    on_circle = (np.abs(np.abs(values) - 1.0) <= 10.0 * error) & (error < 0.1)
    for members in _groups(near):
        if not np.all(on_circle[members]):
            continue
        basis = vectors[:, members]
        if len(members) > 1:
            basis, _ = np.linalg.qr(basis)
        levels = np.linalg.eigvalsh(form_matrix(basis))
        # A vector is in error by that of its multiplier, over the distance to the others.
        apart = np.delete(distance[members], members, axis=1)
        slack = 4.0 * float(np.max(error[members])) / float(np.min(apart, initial=2.0))
        if np.all(levels > slack):
            signs[members] = 1
        elif np.all(levels < -slack):
            signs[members] = -1
    return signs


def _groups(linked: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """Return the connected groups of a symmetric relation."""
    reached = linked
    if np.count_nonzero(linked) > len(linked):
        for _ in range(len(linked).bit_length()):
            reached = (reached.astype(int) @ reached.astype(int)) > 0
    firsts = np.argmax(reached, axis=1)
    return [np.flatnonzero(firsts == first) for first in np.unique(firsts)]
