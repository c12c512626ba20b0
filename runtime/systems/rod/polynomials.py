"""Bases of polynomials on both sides of the block, their integrals exact.

Each shape is one polynomial from the pin to the block and another from the block to the tip, so
that every array of a basis is a sum of two integrals of polynomials.  On one polynomial through the
block (Beale & Scott (12)-(14)) the error falls like 1/n; joined with one slope they converge
spectrally, for the bending moment may jump in slope at the block, as the block's force makes it do.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import lru_cache
from math import comb, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....generated import quick_return_rod_polynomials as emitted
from ...core.errors import bad
from .basis import require_array, require_derivative, require_modes, require_places, require_points

Array = NDArray[Any]  # doubles, or long doubles for tables
_Kernel = Callable[..., tuple[Array, ...]]
_through_bay: _Kernel = emitted.through_bay
_through_tail: _Kernel = emitted.through_tail

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
    field = ("value", "slope", "curvature", "shear")[require_derivative(derivative)]
    eta = require_points(x)[None, :]
    xi = require_places(place)[:, None]
    length = np.where(xi < 1, 1 - xi, 1.0)
    left = getattr(sampler(LEFT, np.minimum(eta / xi, 1.0), xi), field)
    right = getattr(sampler(RIGHT, np.maximum(eta - xi, 0.0) / length, xi), field)
    return np.asarray(np.where((eta <= xi)[:, :, None], left, right))


def jacobi(size: int, x: Array, upper: int, lower: int) -> tuple[Array, Array, Array, Array]:
    """Return orthonormal Jacobi polynomials of weight ``(1 - x)^upper x^lower`` on [0, 1].

    Parameters
    ----------
    size : int
        Number of polynomials, degrees 0 to ``size - 1``.
    x : ndarray
        Shape ``(...)``; the work is done in its precision.
    upper, lower : int
        Exponents of the weight at 1 and at 0.

    Returns
    -------
    tuple of ndarray
        The polynomials and their first three derivatives, each of shape ``(..., size)``.
    """
    a, b = upper, lower
    y = 2 * x - 1
    zero = np.zeros_like(y)
    rows = [[np.ones_like(y), zero, zero, zero]]
    if size > 1:
        rows.append([((a + b + 2) * y + (a - b)) / 2, zero + (a + b + 2) / 2, zero, zero])
    for k in range(2, size):
        c = 2 * k + a + b
        first = 2 * k * (k + a + b) * (c - 2)
        slope, middle = (c - 1) * c * (c - 2) / first, (c - 1) * (a * a - b * b) / first
        second = 2 * (k + a - 1) * (k + b - 1) * c / first
        one, two = rows[-1], rows[-2]
        # The m-th derivative of y P is y P^(m) + m P^(m-1).
        rows.append(
            [
                (slope * y + middle) * one[m]
                + (m * slope * one[m - 1] if m else 0.0)
                - second * two[m]
                for m in range(4)
            ]
        )
    norms = np.array([_inverse_norm(k, a, b) for k in range(size)])
    value, first, second, third = (
        np.stack([row[m] for row in rows[:size]], axis=-1) * norms * 2**m for m in range(4)
    )
    return value, first, second, third


def _inverse_norm(k: int, a: int, b: int) -> float:
    """Return one over the norm of a Jacobi polynomial on [0, 1]."""
    square = (2 * k + a + b + 1) * Fraction(comb(k + a + b, a), comb(k + a, a))
    return sqrt(square)


# One polynomial through the block -----------------------------------------------------------------

_MOST_THROUGH = 400
_WHY_THROUGH = "their exact integrals take minutes"

# Power of xi that divides an array: what is left is a polynomial that does not vanish at xi = 0.
_POWER_OF_PLACE = {
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
        self.size = require_modes(size, _MOST_THROUGH, _WHY_THROUGH)
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
        table = _through_table(self.size, self.orthogonal, name)
        series = _chebyshev(2 * xi - 1, len(table)) @ table.reshape(len(table), -1)
        series *= (xi ** _POWER_OF_PLACE[name])[:, None]
        return series.reshape(len(xi), *table.shape[1:])

    def _sampler(self, side: str, s: Array, place: Array) -> Samples:
        eta, gap, _ = on_side(side, s, place)
        eta, gap, xi = np.broadcast_arrays(eta, gap, place)
        rows = _polynomials(self.size, self.orthogonal, eta)
        gap, xi = gap[..., None], xi[..., None]
        if side == LEFT:
            return Samples(*_through_bay(eta[..., None], gap, *rows))
        return Samples(*_through_tail(gap, xi, *rows))


@lru_cache(maxsize=128)
def _through_table(size: int, orthogonal: bool, name: str) -> Array:
    """Return the Chebyshev coefficients of an array over a power of xi, from exact integrals."""
    basis = PolynomialBasis(size, orthogonal)
    degree = 2 * size + 4
    half = np.longdouble(0.5)
    angle = (np.arange(degree + 1) + half) * (4 * np.arctan(2 * half) / (degree + 1))
    place = np.cos(angle / 2) ** 2
    values = integrals(name, basis._sampler, place, degree)
    values /= (place ** _POWER_OF_PLACE[name]).reshape(-1, *[1] * (values.ndim - 1))
    turns = np.cos(np.arange(degree + 1)[:, None] * angle) / (half * (degree + 1))
    turns[0] /= 2
    table = np.tensordot(turns, values, axes=1).astype(np.float64)
    table.setflags(write=False)
    return table


def _chebyshev(x: Array, count: int) -> Array:
    """Return the first Chebyshev polynomials, shape ``(nt, count)``."""
    terms = [np.ones_like(x), x]
    for _ in range(count - 2):
        terms.append(2 * x * terms[-1] - terms[-2])
    return np.stack(terms[:count], axis=-1)


def _polynomials(size: int, orthogonal: bool, eta: Array) -> tuple[Array, Array, Array, Array]:
    """Return P_k and three derivatives, each of shape ``(*eta.shape, size)``."""
    if orthogonal:
        return jacobi(size, eta, 0, 1)
    derivatives = [np.stack([eta**k for k in range(size)], axis=-1)]
    for _ in range(3):
        before = derivatives[-1]
        derivatives.append(np.zeros_like(before))
        derivatives[-1][..., 1:] = before[..., :-1] * np.arange(1, size)
    return derivatives[0], derivatives[1], derivatives[2], derivatives[3]


# Two polynomials with one slope -------------------------------------------------------------------

# The first shape and the others, between pin and block and beyond.
_KERNELS: Mapping[str, tuple[_Kernel, _Kernel]] = {
    LEFT: (emitted.turn_bay, emitted.bubble_bay),
    RIGHT: (emitted.turn_tail, emitted.bubble_tail),
}

_MOST_SEGMENT = 40
_WHY_SEGMENT = "round-off takes the low frequencies' digits, and 16 are converged"

# Power of a side's length in an array: one from the integral, one from each factor, one back from
# each derivative.
_POWER_OF_SIDE = {
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
        self.size = require_modes(size, _MOST_SEGMENT, _WHY_SEGMENT)

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
        table = _segment_table(self.size, name)
        parts = [
            length ** _POWER_OF_SIDE[name] * factor
            for side, length in ((LEFT, xi), (RIGHT, 1 - xi))
            for _, factor in _weights(name, side, xi, xi)
        ]
        values = np.stack(parts, axis=-1) @ table.reshape(len(table), -1)
        return values.reshape(len(xi), *table.shape[1:])

    def _sampler(self, side: str, s: Array, place: Array) -> Samples:
        return _segment_samples(self.size, side, s, place)


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
def _segment_table(size: int, name: str) -> Array:
    """Return the constant arrays, those of the bay first, for sides of length 1."""
    s, quadrature = nodes(2 * size + 8)
    arrays = []
    for side, place in ((LEFT, 1), (RIGHT, 0)):
        samples = _segment_samples(size, side, s[None, :], np.array([[place]], s.dtype))
        arrays += [
            products(name, samples, (weight * quadrature)[None, :])[0]
            for weight, _ in _weights(name, side, s, s)
        ]
    table = np.stack(arrays).astype(np.float64)
    table.setflags(write=False)
    return table


def _segment_samples(size: int, side: str, s: Array, place: Array) -> Samples:
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
