"""Bases of polynomials on both sides of the block, their integrals exact.

Each shape is one polynomial from the pin to the block and another from the block to the tip, so
that every array of a basis is a sum of two integrals of polynomials.  On one polynomial through the
block (Beale & Scott (12)-(14)) the error falls like 1/n; joined with one slope they converge
spectrally, for the bending moment may jump in slope at the block, as the block's force makes it do.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import comb, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from ....generated import quick_return_rod_polynomials as emitted
from ...core.errors import bad
from ...core.inputs import require_whole
from .basis import require_array, require_places, require_points

Array = NDArray[Any]  # doubles, or long doubles for tables
_Kernel = Callable[..., tuple[Array, ...]]
_through_bay: _Kernel = emitted.through_bay
_through_tail: _Kernel = emitted.through_tail

LEFT, RIGHT = "left", "right"


class Integral(NamedTuple):
    """How an array is made of samples of the shapes."""

    factors: tuple[str, ...]  # which two it multiplies, or which one a vector integrates
    # Of one polynomial through the block the power of xi that divides it: what is left is a
    # polynomial that does not vanish at xi = 0.
    place: int
    # Of two polynomials the power of either side's length: one from the integral, one from each
    # factor, one back from each derivative; beyond the block the tension itself falls to zero.
    sides: tuple[int, int]


INTEGRALS: Mapping[str, Integral] = {
    "overlap": Integral(("value", "value"), 2, (3, 3)),
    "drift": Integral(("value", "drift"), 1, (2, 2)),
    "drift_drift": Integral(("drift", "drift"), 0, (1, 1)),
    "bending": Integral(("curvature", "curvature"), 1, (-1, -1)),
    "bending_drift": Integral(("curvature", "drift_curvature"), 1, (-2, -2)),
    "tension": Integral(("slope", "slope"), 2, (1, 2)),
    "moment": Integral(("value",), 1, (2, 2)),
    "mean": Integral(("value",), 1, (2, 2)),
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
    """Return eta, eta - xi and the length of a side, at ``s`` from 0 to 1, without cancellation."""
    if side == LEFT:
        return place * s, -place * (1 - s), place
    length = 1 - place
    return place + length * s, length * s, length


def integrals(
    name: str, sampler: Sampler, sides: tuple[str, ...], place: Array, degree: int
) -> Array:
    """Return what sides of the block contribute to an array, in the precision of the places.

    At places ``(nt,)``, for integrands up to a degree in eta; shape ``(nt, n, n)`` or ``(nt, n)``.
    """
    s, weights = (part.astype(place.dtype) for part in nodes(degree))
    total: Any = 0
    for side in sides:
        eta, _, length = on_side(side, s, place[:, None])
        weight = weights * length
        if name == "tension":
            weight = weight * ((1 - eta) * (1 + eta) / 2)
        elif name == "moment":
            weight = weight * eta
        samples = sampler(side, s, place[:, None])
        first, *second = (getattr(samples, factor) for factor in INTEGRALS[name].factors)
        weighted = first * weight[:, :, None]
        total += np.swapaxes(weighted, 1, 2) @ second[0] if second else weighted.sum(axis=1)
    return np.asarray(total)


def jacobi(size: int, x: Array, upper: int, lower: int) -> tuple[Array, Array, Array, Array]:
    """Return orthonormal Jacobi polynomials of weight ``(1 - x)^upper x^lower`` on [0, 1].

    Degrees 0 to ``size - 1`` with three derivatives, each of shape ``(*x.shape, size)``, in the
    precision of x.
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
    # One over the norms, exact under the root.
    shares = (Fraction(comb(k + a + b, a), comb(k + a, a)) for k in range(size))
    norms = np.array([sqrt((2 * k + a + b + 1) * share) for k, share in enumerate(shares)])
    value, first, second, third = (
        np.stack([row[m] for row in rows[:size]], axis=-1) * norms * 2**m for m in range(4)
    )
    return value, first, second, third


class _TwoSided(ABC):
    """A basis of polynomials on both sides of the block.

    Each of its arrays is a sum of parts, which are a power of a length times a polynomial in xi.
    """

    size: int

    @abstractmethod
    def _degrees(self, name: str) -> tuple[int, int]:
        """Return the degree of these polynomials in xi, and that of the integrands in eta."""

    @abstractmethod
    def _sampler(self, side: str, s: Array, place: Array) -> Samples:
        """Return the shapes at points of one side."""

    @abstractmethod
    def _parts(self, name: str, xi: Array) -> list[tuple[tuple[str, ...], Array]]:
        """Return the sides that each part belongs to, and its power of a length."""

    def _places(self, place: Array) -> Array:
        return require_places(place)

    def shapes(self, x: Array, place: Array, derivative: int = 0) -> Array:
        """Return the shapes or a derivative by eta, to the third; see :class:`MovingBasis`.

        At the block itself the values are those of the side of the pin.
        """
        order = require_whole("derivative", derivative, 0, 3, "higher ones are not offered")
        field = ("value", "slope", "curvature", "shear")[order]
        eta = require_points(x)[None, :]
        xi = self._places(place)[:, None]
        length = np.where(xi < 1, 1 - xi, 1.0)
        left = getattr(self._sampler(LEFT, np.minimum(eta / xi, 1.0), xi), field)
        right = getattr(self._sampler(RIGHT, np.maximum(eta - xi, 0.0) / length, xi), field)
        return np.asarray(np.where((eta <= xi)[:, :, None], left, right))

    def array(self, name: str, place: Array) -> Array:
        """Return the integrals of one name at places xi; see :class:`MovingBasis`.

        From tables that exact quadrature in long doubles gives once.  Places may be balls, in an
        array of objects: then the tables count as exact.
        """
        require_array(name)
        balls = isinstance(place, np.ndarray) and place.dtype == object
        xi = place if balls else self._places(place)
        table = _table(self, name)
        polynomials = chebvander(2 * xi - 1, table.shape[1] - 1)
        factors = np.stack([factor for _, factor in self._parts(name, xi)], axis=-1)
        terms = (factors[:, :, None] * polynomials[:, None, :]).reshape(len(xi), -1)
        values = terms @ table.reshape(terms.shape[1], -1)
        return values.reshape(len(xi), *table.shape[2:])


@lru_cache(maxsize=128)
def _table(basis: _TwoSided, name: str) -> Array:
    """Return the Chebyshev coefficients of an array's parts, ``(parts, degree + 1, n, n)``."""
    degree, of_integrands = basis._degrees(name)
    count = degree + 1
    half = np.longdouble(0.5)
    angle = (np.arange(count) + half) * (4 * np.arctan(2 * half) / count)
    place = np.cos(angle / 2) ** 2
    turns = np.cos(np.arange(count)[:, None] * angle) / (half * count)
    turns[0] /= 2
    parts = []
    for sides, factor in basis._parts(name, place):
        values = integrals(name, basis._sampler, sides, place, of_integrands)
        values /= factor.reshape(-1, *[1] * (values.ndim - 1))
        parts.append(np.tensordot(turns, values, axes=1))
    table = np.stack(parts).astype(np.float64)
    table.setflags(write=False)
    return table


# One polynomial through the block -----------------------------------------------------------------


@dataclass(frozen=True)
class PolynomialBasis(_TwoSided):
    """Beale & Scott's polynomial modes, as printed or on an orthogonal basis of their span.

    The shapes, 1 to 400, are ``e = eta P(eta) (eta - xi)`` between pin and block and ``e = xi
    P(eta) (eta - xi)`` beyond, with P of a degree below n.  Both sides share P: the bending moment
    cannot jump in slope freely at the block, and the error falls only like 1/n.  The arrays are
    Beale & Scott (19)-(27), corrected, and what else the canonical form needs.

    With ``orthogonal`` the P are Jacobi polynomials of weight eta on [0, 1]: a constant change of
    coordinates that keeps the mass matrix well conditioned.  Else they are powers of eta, the modes
    (12)-(14) themselves over ``L^(i+1)``; past about ten of them the mass matrix is singular to
    double precision.
    """

    size: int
    orthogonal: bool = True

    def __post_init__(self) -> None:
        fix = "take fewer: their exact integrals take minutes"
        object.__setattr__(self, "size", require_whole("modes", self.size, 1, 400, fix))

    @property
    def labels(self) -> tuple[str, ...]:
        """One name per shape."""
        word = "Jacobi" if self.orthogonal else "power"
        return tuple(f"{word} {k}" for k in range(self.size))

    def _degrees(self, name: str) -> tuple[int, int]:
        return 2 * self.size + 4, 2 * self.size + 4

    def _parts(self, name: str, xi: Array) -> list[tuple[tuple[str, ...], Array]]:
        return [((LEFT, RIGHT), xi ** INTEGRALS[name].place)]

    def _sampler(self, side: str, s: Array, place: Array) -> Samples:
        eta, gap, _ = on_side(side, s, place)
        eta, gap, xi = np.broadcast_arrays(eta, gap, place)
        rows = self._polynomials(eta)
        gap, xi = gap[..., None], xi[..., None]
        if side == LEFT:
            return Samples(*_through_bay(eta[..., None], gap, *rows))
        return Samples(*_through_tail(gap, xi, *rows))

    def _polynomials(self, eta: Array) -> tuple[Array, ...]:
        """Return P_k and three derivatives, each of shape ``(*eta.shape, size)``."""
        if self.orthogonal:
            return jacobi(self.size, eta, 0, 1)
        derivatives = [np.stack([eta**k for k in range(self.size)], axis=-1)]
        for _ in range(3):
            before = derivatives[-1]
            derivatives.append(np.zeros_like(before))
            derivatives[-1][..., 1:] = before[..., :-1] * np.arange(1, self.size)
        return tuple(derivatives)


# Two polynomials with one slope -------------------------------------------------------------------

# The first shape and the others, between pin and block and beyond.
_KERNELS: Mapping[str, tuple[_Kernel, _Kernel]] = {
    LEFT: (emitted.turn_bay, emitted.bubble_bay),
    RIGHT: (emitted.turn_tail, emitted.bubble_tail),
}


@dataclass(frozen=True)
class TwoSegmentBasis(_TwoSided):
    """Polynomials on both sides of the block, with one slope through it, 1 to 40 of them.

    The first shape turns about the block: ``xi s (s - 1) J`` between pin and block, ``(1 - xi) s
    J`` beyond, with s from 0 to 1 on either side and J = 1 at the block.  The others live on one
    side, alternately between pin and block and beyond, and have neither value nor slope at the
    block: ``xi s (1 - s)^2 J`` and ``(1 - xi) s^2 J``.  The J are Jacobi polynomials of the weights
    that make all shapes orthogonal, wherever the block is: ``overlap`` is diagonal.  So the first
    shape changes with the number of shapes; the span grows with it all the same.

    The stiffness grows fast with the number of shapes beside the mass, and round-off takes digits
    of the lowest frequency: it is right to 1e-8 with 16 shapes and to 3e-6 with 40 where the block
    is at 0.9 of the rod, the worst of the places tried.
    """

    size: int

    def __post_init__(self) -> None:
        fix = "take fewer: round-off takes the low frequencies' digits, and 16 are converged"
        object.__setattr__(self, "size", require_whole("modes", self.size, 1, 40, fix))

    @property
    def labels(self) -> tuple[str, ...]:
        """One name per shape."""
        sides = ("bay", "tail")
        return ("turn", *(f"{sides[k % 2]} {k // 2 + 1}" for k in range(self.size - 1)))

    def _places(self, place: Array) -> Array:
        xi = require_places(place)
        if np.any(xi == 1.0):
            fix = "lengthen the rod: it has to pass the block"
            raise bad("place", 1.0, "places x1/L below 1", fix)
        return xi

    def _degrees(self, name: str) -> tuple[int, int]:
        # In xi those of the weights alone.
        return {"tension": 2, "moment": 1}.get(name, 0), 2 * self.size + 8

    def _parts(self, name: str, xi: Array) -> list[tuple[tuple[str, ...], Array]]:
        left, right = INTEGRALS[name].sides
        return [((LEFT,), xi**left), ((RIGHT,), (1 - xi) ** right)]

    def _sampler(self, side: str, s: Array, place: Array) -> Samples:
        s, length = np.broadcast_arrays(s, place if side == LEFT else 1 - place)
        turn_kernel, bubble_kernel = _KERNELS[side]
        bay = side == LEFT
        bubbles = self.size // 2 if bay else (self.size - 1) // 2
        weight = (3, 2) if bay else (0, 3)
        end = jacobi(bubbles + 1, np.array(1 if bay else 0, s.dtype), *weight)[0][-1]
        turn = [row[..., -1:] / end for row in jacobi(bubbles + 1, s, *weight)]
        s, length = s[..., None], length[..., None]
        shapes = [np.zeros((*s.shape[:-1], self.size), s.dtype) for _ in Samples._fields]
        for into, value in zip(shapes, turn_kernel(s, length, *turn), strict=True):
            into[..., :1] = value
        if bubbles:
            rows = jacobi(bubbles, s[..., 0], *((4, 2) if bay else (0, 4)))
            for into, value in zip(shapes, bubble_kernel(s, length, *rows), strict=True):
                into[..., 1 if bay else 2 :: 2] = value
        return Samples(*shapes)
