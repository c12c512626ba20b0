"""Element arrays in the fixed axes, as products of cosine and sine of the beam's angle."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# The products of 1, c = cos(phi) and s = sin(phi), two at a time.
PRODUCTS = ("1", "c", "s", "cc", "cs", "ss")
_PLACE = {"11": 0, "1c": 1, "1s": 2, "cc": 3, "cs": 4, "ss": 5}
# Coordinates of an element at its two ends; further ones are its own and do not turn.
_ENDS = 6


def products(angle: Array) -> Array:
    """Return ``1, c, s, c c, c s, s s`` of angles ``(nt,)``: ``(nt, 6)``."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([np.ones_like(c), c, s, c * c, c * s, s * s], axis=-1)


def rotation(size: int) -> dict[str, Array]:
    """Return R(phi), from fixed to the element's own axes, as factors of 1, c and s (4.26).

    Parameters
    ----------
    size : int
        Number of coordinates of the element: displacement and rotation at both ends, its own.
    """
    fixed = np.zeros((size, size))
    cosine, sine = np.zeros_like(fixed), np.zeros_like(fixed)
    for first in (0, 3):
        u, v, turn = first, first + 1, first + 2
        cosine[u, u] = cosine[v, v] = 1.0
        sine[u, v], sine[v, u] = 1.0, -1.0
        fixed[turn, turn] = 1.0
    own = np.arange(_ENDS, size)
    fixed[own, own] = 1.0
    return {"1": fixed, "c": cosine, "s": sine}


def rotation_slope(size: int) -> dict[str, Array]:
    """Return dR/dphi as factors of c and s."""
    parts = rotation(size)
    return {"c": parts["s"], "s": -parts["c"]}


def in_own_axes(values: Array, c: Array, s: Array) -> Array:
    """Return coordinates of an element ``(nt, n)`` in its own axes.

    Parameters
    ----------
    values : ndarray, shape (nt, n)
        In the fixed axes.
    c, s : ndarray, shape (nt,)
        Cosine and sine of the beam's angle.
    """
    found = values.copy()
    for x, y in ((0, 1), (3, 4)):
        found[:, x] = c * values[:, x] + s * values[:, y]
        found[:, y] = c * values[:, y] - s * values[:, x]
    return found


def turned(left: Mapping[str, Array], matrix: Array, right: Mapping[str, Array]) -> Array:
    """Return ``left^T matrix right`` as factors of the six products, shape ``(6, n, n)``.

    Parameters
    ----------
    left, right : mapping of str to ndarray
        As :func:`rotation` and :func:`rotation_slope` return them.
    matrix : ndarray, shape (n, n)
        In the element's own axes.
    """
    size = matrix.shape[0]
    total = np.zeros((len(PRODUCTS), size, size))
    for a, first in left.items():
        for b, second in right.items():
            total[_PLACE["".join(sorted(a + b))]] += first.T @ matrix @ second
    return total
