"""Integrals of piecewise polynomial shapes over the rod, exact by Gauss-Legendre nodes.

Each shape of a basis is one polynomial from the pin to the block and another from the block to
the tip; so every array of the basis is a sum of two integrals of polynomials.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import bad
from .basis import MATRIX_ARRAYS, VECTOR_ARRAYS
from .inputs import require_places, require_points
from .jacobi import jacobi

Array = NDArray[Any]  # doubles, or long doubles for tables

LEFT, RIGHT = "left", "right"
# Which two samples of the shapes an array multiplies, or which one a vector integrates.
FACTORS: Mapping[str, tuple[str, ...]] = {
    "overlap": ("value", "value"),
    "drift": ("value", "drift"),
    "drift_drift": ("drift", "drift"),
    "bending": ("curvature", "curvature"),
    "bending_drift": ("curvature", "drift_curvature"),
    "tension": ("slope", "slope"),
    "moment": ("value",),
    "mean": ("value",),
}


class Samples(NamedTuple):
    """Shapes at points of one side of the block, each array of shape ``(nt, nx, n)``.

    Derivatives by eta are ``slope``, ``curvature``, ``shear``; ``drift`` is the derivative by the
    block's place xi at fixed eta, and ``drift_curvature`` its second derivative by eta.
    """

    value: Array
    slope: Array
    curvature: Array
    shear: Array
    drift: Array
    drift_curvature: Array


# From the side, the local coordinates (nx,) on it from 0 to 1, and the places xi (nt, 1).
Sampler = Callable[[str, Array, Array], Samples]


def require_array(name: str) -> None:
    """Refuse the name of an array that no basis has."""
    if name not in FACTORS:
        known = ", ".join((*MATRIX_ARRAYS, *VECTOR_ARRAYS))
        raise bad("array", name, f"one of {known}", "see MovingBasis")


@lru_cache(maxsize=64)
def nodes(degree: int) -> tuple[Array, Array]:
    """Return Gauss-Legendre nodes on [0, 1] and weights, exact to a degree, in long doubles."""
    count = degree // 2 + 1
    start = (1 + np.polynomial.legendre.leggauss(count)[0].astype(np.longdouble)) / 2
    # One step of Newton's takes the nodes from double to the longer precision.
    p, slope, _, _ = (row[:, -1] for row in jacobi(count + 1, start, 0, 0))
    x = start - p / slope
    slope = jacobi(count + 1, x, 0, 0)[1][:, -1]
    return x, (2 * count + 1) / (x * (1 - x) * slope**2)


def on_side(side: str, s: Array, place: Array) -> tuple[Array, Array, Array]:
    """Return eta, eta - xi and the length of the side, without cancellation.

    Parameters
    ----------
    side : str
        ``left`` (pin to block) or ``right`` (block to tip).
    s : ndarray
        Local coordinate from 0 to 1, shape ``(nx,)``.
    place : ndarray
        Shape ``(nt, 1)``.
    """
    if side == LEFT:
        return place * s, -place * (1 - s), place
    length = 1 - place
    return place + length * s, length * s, length


def integrals(name: str, sampler: Sampler, place: Array, degree: int) -> Array:
    """Return one array of a basis at places of the block.

    Parameters
    ----------
    name : str
        An array's name.
    sampler : callable
        The shapes at points of a side.
    place : ndarray
        Shape ``(nt,)``; its precision is that of the work.
    degree : int
        Largest degree in eta of the integrands.
    """
    require_array(name)
    s, weights = (part.astype(place.dtype) for part in nodes(degree))
    total = sum(
        _one_side(name, sampler, side, s, weights, place[:, None]) for side in (LEFT, RIGHT)
    )
    return np.asarray(total)


def _one_side(
    name: str, sampler: Sampler, side: str, s: Array, weights: Array, place: Array
) -> Array:
    """Return the integral from the pin to the block, or from the block to the tip."""
    eta, _, length = on_side(side, s, place)
    samples = sampler(side, s, place)
    weight = weights * length
    if name == "tension":
        weight = weight * ((1 - eta) * (1 + eta) / 2)
    elif name == "moment":
        weight = weight * eta
    return products(name, samples, weight)


def products(name: str, samples: Samples, weight: Array) -> Array:
    """Return the weighted sums over the points that an array is made of.

    Parameters
    ----------
    name : str
        An array's name.
    samples : Samples
        Shapes at the points.
    weight : ndarray
        Shape ``(nt, nx)``.

    Returns
    -------
    ndarray
        Shape ``(nt, n, n)``, or ``(nt, n)`` of a vector.
    """
    first, *second = (getattr(samples, factor) for factor in FACTORS[name])
    weighted = first * weight[:, :, None]
    if not second:
        return np.asarray(weighted.sum(axis=1))
    return np.asarray(np.swapaxes(weighted, 1, 2) @ second[0])


def joined(x: Array, place: Array, sampler: Sampler, derivative: int) -> Array:
    """Return the shapes, or a derivative by eta to the third, at places on the whole rod.

    At the block itself the values are those of the side of the pin.

    Parameters
    ----------
    x : ndarray
        Places eta, shape ``(nx,)``.
    place : ndarray
        Places xi of the block, shape ``(nt,)``.
    sampler : callable
        The shapes at points of a side.
    derivative : int
        0 to 3.

    Raises
    ------
    BadInput
        If a point or the block is not on the rod, or for a higher derivative.
    """
    if derivative not in range(4):
        raise bad("derivative", derivative, "0, 1, 2 or 3", "ask for a derivative by eta")
    eta = require_points(x)[None, :]
    xi = require_places(place)[:, None]
    field = ("value", "slope", "curvature", "shear")[derivative]
    length = np.where(xi < 1, 1 - xi, 1.0)
    left = getattr(sampler(LEFT, np.minimum(eta / xi, 1.0), xi), field)
    right = getattr(sampler(RIGHT, np.maximum(eta - xi, 0.0) / length, xi), field)
    return np.asarray(np.where((eta <= xi)[:, :, None], left, right))
