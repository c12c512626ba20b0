"""Exponential of a stack of small matrices by diagonal Pade approximants, scaling and squaring."""

from __future__ import annotations

from functools import cache
from math import factorial

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Largest 1-norm for which the diagonal Pade approximant of a degree is exact to double precision
# (Higham, SIAM J. Matrix Anal. Appl. 26 (2005) 1179, table 2.3).
_REACH = {
    3: 1.495585217958292e-2,
    5: 2.539398330063230e-1,
    9: 2.097847961257068,
    13: 5.371920351148152,
}


@cache
def _pade(degree: int) -> tuple[float, ...]:
    return tuple(
        factorial(2 * degree - k)
        * factorial(degree)
        / (factorial(2 * degree) * factorial(k) * factorial(degree - k))
        for k in range(degree + 1)
    )


def expm(matrices: Array) -> Array:
    """Return the exponentials of square matrices.

    A diagonal approximant maps Hamiltonian matrices to symplectic ones, so the exponential keeps
    that structure to round-off.

    Parameters
    ----------
    matrices : ndarray
        Shape ``(..., m, m)``.

    Returns
    -------
    ndarray
        Same shape.  The whole stack is scaled alike, by its largest 1-norm.
    """
    norm = float(np.max(np.sum(np.abs(matrices), axis=-2), initial=0.0))
    degree = next((d for d, reach in _REACH.items() if norm <= reach), 13)
    halvings = 0 if norm <= _REACH[degree] else int(np.ceil(np.log2(norm / _REACH[degree])))
    scaled = matrices / 2.0**halvings
    coefficients = _pade(degree)
    square = scaled @ scaled
    identity = np.broadcast_to(np.eye(matrices.shape[-1]), matrices.shape)
    even = coefficients[degree - 1] * identity
    odd = coefficients[degree] * identity
    for k in range(degree - 3, -1, -2):
        even = even @ square + coefficients[k] * identity
        odd = odd @ square + coefficients[k + 1] * identity
    odd = scaled @ odd
    result: Array = np.linalg.solve(even - odd, even + odd).astype(float)
    for _ in range(halvings):
        result = result @ result
    return result
