"""Polynomials on each side of the block, joined with one slope: a basis that converges spectrally.

The bending moment may jump in slope at the block, as the block's force makes it do.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ....generated import quick_return_rod_polynomials as emitted
from ...core.errors import bad
from .inputs import require_modes, require_places
from .jacobi import jacobi
from .segments import LEFT, RIGHT, Samples, joined, nodes, products, require_array

Array = NDArray[np.float64]
_Kernel = Callable[..., tuple[Array, ...]]
# The first shape and the others, between pin and block and beyond.
_KERNELS: Mapping[str, tuple[_Kernel, _Kernel]] = {
    LEFT: (emitted.turn_bay, emitted.bubble_bay),
    RIGHT: (emitted.turn_tail, emitted.bubble_tail),
}

_MOST = 40
_WHY = "round-off takes the low frequencies' digits, and 16 are converged"

# Power of a side's length in an array: one from the integral, one from each factor, one back from
# each derivative.
_POWER = {
    "overlap": 3,
    "drift": 2,
    "drift_drift": 1,
    "bending": -1,
    "bending_drift": -2,
    "tension": 1,
    "moment": 2,
    "mean": 2,
}


class TwoSegmentBasis:
    """Polynomials on both sides of the block, with one slope through it.

    The first shape turns about the block: ``xi s (s - 1) J`` between pin and block,
    ``(1 - xi) s J`` beyond, with s from 0 to 1 on either side and J = 1 at the block.  The others
    live on one side, alternately between pin and block and beyond, and have neither value nor slope
    at the block: ``xi s (1 - s)^2 J`` and ``(1 - xi) s^2 J``.  The J are Jacobi polynomials of the
    weights that make all shapes orthogonal, wherever the block is: ``overlap`` is diagonal.  So the
    first shape changes with the number of shapes; the span grows with it all the same.

    Parameters
    ----------
    size : int
        Number n of shapes, from 1 to 40.

    Raises
    ------
    BadInput
        If the number is not a whole one from 1 to 40.

    Notes
    -----
    The stiffness grows fast with the number of shapes beside the mass, and round-off takes digits
    of the lowest frequency: it is right to 1e-8 with 16 shapes and to 3e-6 with 40 where the block
    is at 0.9 of the rod, the worst of the places tried.
    """

    def __init__(self, size: int) -> None:
        self.size = require_modes(size, _MOST, _WHY)

    def __repr__(self) -> str:
        """Return how the basis is made."""
        return f"TwoSegmentBasis({self.size})"

    @property
    def labels(self) -> tuple[str, ...]:
        """One name per shape."""
        sides = ("bay", "tail")
        return ("turn", *(f"{sides[k % 2]} {k // 2 + 1}" for k in range(self.size - 1)))

    def shapes(self, x: Array, place: Array, derivative: int = 0) -> Array:
        """Return the shapes or a derivative by eta, to the third; see :class:`MovingBasis`.

        Raises
        ------
        BadInput
            If a point or the block is not on the rod, or for a higher derivative.
        """
        return joined(x, _inside(place), self._sampler, derivative)

    def array(self, name: str, place: Array) -> Array:
        """Return the integrals of one name at places xi; see :class:`MovingBasis`.

        Each is a sum of powers of xi and 1 - xi times constant arrays, which exact quadrature
        gives once.

        Raises
        ------
        BadInput
            If there is no array of that name, or the block is not between pin and tip.
        """
        require_array(name)
        xi = _inside(place)
        table = _table(self.size, name)
        parts = [
            length ** _POWER[name] * factor
            for side, length in ((LEFT, xi), (RIGHT, 1 - xi))
            for _, factor in _weights(name, side, xi, xi)
        ]
        found = np.stack(parts, axis=-1) @ table.reshape(len(table), -1)
        return found.reshape(len(xi), *table.shape[1:])

    def _sampler(self, side: str, s: Array, place: Array) -> Samples:
        return _samples(self.size, side, s, place)


def _inside(place: Array) -> Array:
    """Return the block's places, refused where one of the two sides has no length."""
    xi = require_places(place)
    if np.any(xi == 1.0):
        raise bad(
            "place",
            1.0,
            "places x1/L below 1",
            "lengthen the rod: it has to pass the block",
        )
    return xi


def _weights(name: str, side: str, s: Array, xi: Array) -> tuple[tuple[Array, Array], ...]:
    """Return the weight of an integrand as a sum of products of functions of s and of xi.

    All are positive: nothing cancels.
    """
    one, rest = np.ones_like(s), 1 - s
    if name == "tension":
        # (1 - eta^2)/2, with eta = xi s, or with 1 - eta = (1 - xi)(1 - s).
        beyond = (1 - xi) * (1 + xi)
        if side == LEFT:
            return (rest * (1 + s) / 2, np.ones_like(xi)), (s * s / 2, beyond)
        return (rest / 2, beyond), (rest * s / 2, (1 - xi) ** 2)
    if name == "moment":
        if side == LEFT:
            return ((s, xi),)
        return (one, xi), (s, 1 - xi)
    return ((one, np.ones_like(xi)),)


@lru_cache(maxsize=128)
def _table(size: int, name: str) -> Array:
    """Return the constant arrays, those of the bay first, for sides of length 1."""
    s, quadrature = nodes(2 * size + 8)
    found = []
    for side, place in ((LEFT, 1), (RIGHT, 0)):
        samples = _samples(size, side, s[None, :], np.array([[place]], s.dtype))
        found += [
            products(name, samples, (weight * quadrature)[None, :])[0]
            for weight, _ in _weights(name, side, s, s)
        ]
    table = np.stack(found).astype(np.float64)
    table.setflags(write=False)
    return table


def _samples(size: int, side: str, s: Array, place: Array) -> Samples:
    """Return the shapes at points of one side."""
    s, length = np.broadcast_arrays(s, place if side == LEFT else 1 - place)
    turn_kernel, bubble_kernel = _KERNELS[side]
    bay = side == LEFT
    bubbles = size // 2 if bay else (size - 1) // 2
    weight = (3, 2) if bay else (0, 3)
    end = jacobi(bubbles + 1, np.array(1 if bay else 0, s.dtype), *weight)[0][-1]
    turn = [row[..., -1:] / end for row in jacobi(bubbles + 1, s, *weight)]
    s, length = s[..., None], length[..., None]
    shapes = [np.zeros((*s.shape[:-1], size), s.dtype) for _ in Samples._fields]
    for into, value in zip(shapes, turn_kernel(s, length, *turn), strict=True):
        into[..., :1] = value
    if bubbles:
        rows = jacobi(bubbles, s[..., 0], *((4, 2) if bay else (0, 4)))
        for into, value in zip(shapes, bubble_kernel(s, length, *rows), strict=True):
            into[..., 1 if bay else 2 :: 2] = value
    return Samples(*shapes)
