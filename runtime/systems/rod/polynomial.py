"""The polynomial modes of Beale & Scott (12)-(14), any number of them, well conditioned.

One polynomial runs through the block, times eta up to it and times xi beyond it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ....generated import quick_return_rod_polynomials as emitted
from .inputs import require_modes, require_places
from .jacobi import jacobi
from .segments import LEFT, Samples, integrals, joined, on_side, require_array

Array = NDArray[np.float64]
_bay: Callable[..., tuple[Array, ...]] = emitted.through_bay
_tail: Callable[..., tuple[Array, ...]] = emitted.through_tail

_MOST = 400
_WHY = "their exact integrals take minutes"

# Power of xi that divides an array: what is left is a polynomial that does not vanish at xi = 0.
_POWER = {
    "overlap": 2,
    "drift": 1,
    "drift_drift": 0,
    "bending": 1,
    "bending_drift": 1,
    "tension": 2,
    "moment": 1,
    "mean": 1,
}


class PolynomialBasis:
    """Beale & Scott's polynomial modes, as printed or on an orthogonal basis of their span.

    The shapes are ``e = eta P(eta) (eta - xi)`` between pin and block and ``e = xi P(eta)
    (eta - xi)`` beyond, with P of a degree below n.  Both sides share P: the bending moment cannot
    jump in slope freely at the block, and the error falls only like 1/n.

    Parameters
    ----------
    size : int
        Number n of modes, from 1 to 400.
    orthogonal : bool
        True for Jacobi polynomials P of weight eta on [0, 1]: a constant change of coordinates
        that keeps the mass matrix well conditioned.  False for the powers of eta, the modes
        (12)-(14) themselves over ``L^(i+1)``; past about ten of them the mass matrix is singular to
        double precision.

    Raises
    ------
    BadInput
        If the number is not a whole one from 1 to 400.
    """

    def __init__(self, size: int, orthogonal: bool = True) -> None:
        self.size = require_modes(size, _MOST, _WHY)
        self.orthogonal = orthogonal

    def __repr__(self) -> str:
        """Return how the basis is made."""
        return f"PolynomialBasis({self.size}, orthogonal={self.orthogonal})"

    @property
    def labels(self) -> tuple[str, ...]:
        """One name per shape."""
        word = "Jacobi" if self.orthogonal else "power"
        return tuple(f"{word} {k}" for k in range(self.size))

    def shapes(self, x: Array, place: Array, derivative: int = 0) -> Array:
        """Return the shapes or a derivative by eta, to the third; see :class:`MovingBasis`.

        Beale & Scott (12)-(14).

        Raises
        ------
        BadInput
            If the block is not on the rod, or for a higher derivative.
        """
        return joined(x, place, self._sampler, derivative)

    def array(self, name: str, place: Array) -> Array:
        """Return the integrals of one name at places xi; see :class:`MovingBasis`.

        Beale & Scott (19)-(27), corrected, and what else the canonical form needs.

        Raises
        ------
        BadInput
            If there is no array of that name, or the block is not on the rod.
        """
        require_array(name)
        xi = require_places(place)
        table = _table(self.size, self.orthogonal, name)
        series = _chebyshev(2 * xi - 1, len(table)) @ table.reshape(len(table), -1)
        series *= (xi ** _POWER[name])[:, None]
        return series.reshape(len(xi), *table.shape[1:])

    def _sampler(self, side: str, s: Array, place: Array) -> Samples:
        eta, gap, _ = on_side(side, s, place)
        eta, gap, xi = np.broadcast_arrays(eta, gap, place)
        rows = _polynomials(self.size, self.orthogonal, eta)
        gap, xi = gap[..., None], xi[..., None]
        if side == LEFT:
            return Samples(*_bay(eta[..., None], gap, *rows))
        return Samples(*_tail(gap, xi, *rows))


@lru_cache(maxsize=128)
def _table(size: int, orthogonal: bool, name: str) -> Array:
    """Return the Chebyshev coefficients of an array over a power of xi, from exact integrals."""
    basis = PolynomialBasis(size, orthogonal)
    degree = 2 * size + 4
    half = np.longdouble(0.5)
    angle = (np.arange(degree + 1) + half) * (4 * np.arctan(2 * half) / (degree + 1))
    place = np.cos(angle / 2) ** 2
    values = integrals(name, basis._sampler, place, degree)
    values /= (place ** _POWER[name]).reshape(-1, *[1] * (values.ndim - 1))
    turns = np.cos(np.arange(degree + 1)[:, None] * angle) / (half * (degree + 1))
    turns[0] /= 2
    table = np.tensordot(turns, values, axes=1).astype(np.float64)
    table.setflags(write=False)
    return table


def _chebyshev(x: Array, count: int) -> Array:
    """Return the first Chebyshev polynomials, shape ``(nt, count)``."""
    found = [np.ones_like(x), x]
    for _ in range(count - 2):
        found.append(2 * x * found[-1] - found[-2])
    return np.stack(found[:count], axis=-1)


def _polynomials(size: int, orthogonal: bool, eta: Array) -> tuple[Array, Array, Array, Array]:
    """Return P_k and three derivatives, each of shape ``(*eta.shape, size)``."""
    if orthogonal:
        return jacobi(size, eta, 0, 1)
    found = [np.stack([eta**k for k in range(size)], axis=-1)]
    for _ in range(3):
        before = found[-1]
        found.append(np.zeros_like(before))
        found[-1][..., 1:] = before[..., :-1] * np.arange(1, size)
    return found[0], found[1], found[2], found[3]
