"""Proved, if coarse, positions of all low eigenvalues of Hill's equation, from floating point.

The float eigenvectors X need not be orthonormal: Sylvester's and Ostrowski's theorems relate the
eigenvalues of A to those of X^T A X, which is nearly diagonal, and the rounding of every product
is bounded a priori (n u / (1 - n u) times the product of the absolute values, in any order).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import BadInput, bad
from ...core.periodic_function import PeriodicFunction
from .layout import Truncation, layout, stacked, truncation

Array = NDArray[np.float64]

_U = 0.5 * float(np.finfo(float).eps)
# What the eigenvectors leave out shall not be seen beside the rounding of the trial vectors.
_GOAL = 1e-26
_LOOSEST = 1e-3


@dataclass(frozen=True)
class Spectrum:
    """Low eigenvalues of the equation without its mean, in one of the two problems.

    Attributes
    ----------
    values : ndarray, shape (count,)
        Approximate eigenvalues, rising; each true one lies within ``reach`` of its own.
    vectors : ndarray, shape (size, count)
        Eigenvectors in the basis of :func:`.layout.layout`.
    reach : float
        Proved.
    norm : float
        Of the matrix, a bound.
    odd, harmonic : int
        As in :func:`.layout.layout`.
    """

    values: Array
    vectors: Array
    reach: float
    norm: float
    odd: int
    harmonic: int


def spectrum(
    f: PeriodicFunction, mu: float, odd: int, highest: int, shift: float = 0.0
) -> Spectrum:
    """Return the eigenvalues that belong to regions up to ``highest``, with a proved reach.

    ``highest`` is even for the whole problem and odd for the half-whole one; ``shift`` asks for
    harmonics enough for eigenvalues that damping moves up by so much.

    Raises
    ------
    BadInput
        If more than 2048 harmonics would be needed, or the matrix is so large that rounding
        leaves nothing proved.
    """
    cut = _cut(f, mu, highest, shift)
    harmonic = cut.harmonic + odd
    matrix = stacked(f, odd, harmonic, np.array([mu]))[0]
    values, vectors = np.linalg.eigh(matrix)
    size = len(values)
    wide = float(np.linalg.norm(layout(odd, harmonic).squares))
    wide += np.sqrt(size) * abs(mu) * float(f.amplitudes[1:].sum())
    # Products of n terms, a few roundings more for the entries of the matrix and the scaling.
    gamma = 1.01 * (size + 16) * _U
    overlap = vectors.T @ vectors - np.eye(size)
    tilt = float(np.linalg.norm(overlap)) + 2.0 * gamma * size
    residual = matrix @ vectors - vectors * values
    defect = float(np.linalg.norm(residual)) + 2.0 * gamma * wide * np.sqrt(size)
    largest = float(np.abs(values).max())
    reach = cut.left_out + 1.1 * (tilt * 2.0 * largest + (1.0 + tilt) * defect) / (1.0 - tilt)
    if not (tilt < 0.1 and np.isfinite(reach)):
        raise bad(
            "hill_boundaries(certified=True)",
            f"|mu| = {abs(mu):.3g} with {size} equations",
            "a problem that double precision isolates",
            "take a smaller mu or lower regions",
        )
    count = min(highest + 1, size)
    return Spectrum(values[:count], vectors[:, :count], reach, cut.norm, odd, harmonic)


def _cut(f: PeriodicFunction, mu: float, highest: int, shift: float) -> Truncation:
    """Return the truncation at the finest goal that 2048 harmonics reach."""
    goal = _GOAL * (1.0 + abs(mu) * float(f.amplitudes[1:].sum()))
    while True:
        try:
            return truncation(f, abs(mu), highest, shift, goal)
        except BadInput:
            if goal >= _LOOSEST:
                raise
            goal = min(_LOOSEST, 1e4 * goal)


def cluster(found: Spectrum, wanted: tuple[int, int]) -> tuple[int, int] | None:
    """Return the first and last index of the group that stands clear of all others.

    None where the group reaches the end of what is known.
    """
    level = np.abs(found.values[list(wanted)]).max()
    defect = 64.0 * _U * found.norm
    # The square of the residual over the gap shall stay below a thousandth of a rounding, unless
    # that would join what is well apart.
    sharp = min(defect * defect / (1e-21 * (1.0 + level)), 0.05)
    clear = max(1e-3, 64.0 * found.reach, sharp)
    first, last = wanted
    values = found.values
    while first > 0 and values[first] - values[first - 1] < clear:
        first -= 1
    while last + 1 < len(values) and values[last + 1] - values[last] < clear:
        last += 1
    return None if last + 1 >= len(values) else (first, last)
