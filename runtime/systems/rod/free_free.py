"""Elastic modes of a free-free beam, and the shapes that the paper's conjecture makes of them.

The modes belong to Beale & Scott's section 2.3: orthonormal over unit length, without mean and
without moment about the middle.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from ....generated import beam_free_free_modes as emitted
from ...core.inputs import require_whole
from .basis import Array, require_array, require_places, require_points

_Function = Callable[..., tuple[Array, ...]]
_root_defect: _Function = emitted.root_defect
_mode_constants: _Function = emitted.mode_constants
_modes: _Function = emitted.modes
_slope_products: _Function = emitted.slope_products
_slope_squares: _Function = emitted.slope_squares
# pi to twice the digits of a double: the multiples that roots start from are rounded once.
_PI = Fraction(pi) + Fraction(1.2246467991473532e-16)


@lru_cache(maxsize=32)
def _solved(count: int) -> tuple[Array, Array]:
    """Return the first roots of cos b cosh b = 1, and the parity of their modes."""
    # A root is its start plus an offset: the sum is rounded correctly, or nearly so.
    exact = [_PI * (2 * i + 1) / 2 for i in range(1, count + 1)]
    start = np.array([float(value) for value in exact])
    rest = np.array([float(value - Fraction(float(value))) for value in exact])
    parity = np.where(np.arange(1, count + 1) % 2 == 1, 1.0, -1.0)
    offset = np.zeros(count)
    for _ in range(8):  # Newton's steps
        defect, slope = _root_defect(offset, start, parity)
        offset = offset - defect / slope
    roots = start + (offset + rest)
    for array in (roots, parity):
        array.flags.writeable = False
    return roots, parity


@dataclass(frozen=True)
class FreeFreeModes:
    """Elastic modes 1, 2, ..., ``size`` of a free-free beam of unit length, 1000 at most.

    ``psi_i`` solves ``psi'''' = b_i^4 psi`` with ``psi'' = psi''' = 0`` at both ends and has unit
    square, no mean and no moment about the middle (Beale & Scott (34)-(36)); it is 2 at the right
    end, eta = 1, and 2 or -2 at the left end, eta = 0.
    """

    size: int

    def __post_init__(self) -> None:
        fix = "take fewer: the beam has long ceased to be slender for such modes"
        object.__setattr__(self, "size", require_whole("modes", self.size, 1, 1000, fix))

    @cached_property
    def roots(self) -> Array:
        """Roots b_i of ``cos b cosh b = 1``, Beale & Scott (39), shape ``(size,)``."""
        return _solved(self.size)[0]

    @cached_property
    def parity(self) -> Array:
        """1 for modes that are even about the middle, -1 for odd ones, shape ``(size,)``."""
        return _solved(self.size)[1]

    @cached_property
    def _constants(self) -> tuple[Array, Array, Array, Array]:
        """Phase, amplitude and weight of the modes, and their slope at the right end."""
        # At the left it is -parity times that.
        number = np.arange(1, self.size + 1)
        phase = np.asarray((number + 1) % 4 * (pi / 2), dtype=np.float64)
        amplitude, weight, slope = _mode_constants(self.roots, self.parity)
        return phase, amplitude, weight, slope

    @property
    def left_values(self) -> Array:
        """Values at the left end, shape ``(size,)``."""
        return 2.0 * self.parity

    def __call__(self, eta: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Return the modes and three derivatives along eta, each ``(*eta.shape, size)``.

        ``eta`` has places from the left end over the length, 0 to 1.
        """
        return self.at(np.asarray(eta, dtype=float)[..., None])

    def at(self, eta: float | Array) -> tuple[Array, Array, Array, Array]:
        """Return the modes and three derivatives at one place, or at places of shape (..., 1)."""
        phase, amplitude, weight, _ = self._constants
        return _modes(eta, self.roots, phase, self.parity, amplitude, weight)  # type: ignore[return-value]

    @cached_property
    def slope_integrals(self) -> dict[str, Array]:
        """Integrals over products of slopes, by Green's identity; ``(size, size)`` each.

        With s from the middle: ``plain``, ``first``, ``second`` are ``int s^k psi_i' psi_j' ds``
        for k = 0, 1, 2; ``inward`` and ``retreat`` are what products of two modes add to the
        foreshortening, ``int s alpha ds`` and alpha at the left end, where ``alpha' = -psi_i'
        psi_j' / 2`` has no mean.
        """
        b, p, ends = self.roots, self.parity, self._constants[3]
        rows, columns = np.triu_indices(self.size, 1)
        pairs = (array[pick] for array in (b, ends, p) for pick in (rows, columns))
        products = dict(
            zip(emitted.RETURNS["slope_products"], _slope_products(*pairs), strict=True)
        )
        squares = dict(zip(emitted.RETURNS["slope_squares"], _slope_squares(ends), strict=True))
        integrals = {}
        for name, values in products.items():
            integrals[name] = np.diag(squares.get(name, np.zeros(self.size)))
            integrals[name][rows, columns] = integrals[name][columns, rows] = values
        return integrals

    def tension(self) -> Array:
        """Return ``int (1 - eta^2)/2 psi_i' psi_j'``, the tension of a rod turning about a pin."""
        parts = self.slope_integrals
        return 0.375 * parts["plain"] - 0.5 * parts["first"] - 0.5 * parts["second"]


@dataclass(frozen=True)
class FreeFreeBasis:
    """Free-free modes bent through the pin and the block; see :class:`MovingBasis`.

    ``chi_i = psi_i(eta) - psi_i(0) - (eta / xi) (psi_i(xi) - psi_i(0))``: what the constrained
    equations (42)-(49) become where the rod's angle against its frame is small, the linearisation
    that Beale & Scott conjecture (section 3.1).
    """

    size: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "size", self.modes.size)

    @cached_property
    def modes(self) -> FreeFreeModes:
        """The modes that the shapes are made of."""
        return FreeFreeModes(self.size)

    @property
    def labels(self) -> tuple[str, ...]:
        """One name per shape."""
        return tuple(f"free-free {i}" for i in range(1, self.size + 1))

    def shapes(self, x: Array, place: Array, derivative: int = 0) -> Array:
        """Return the shapes or a derivative by eta, to the third; see :class:`MovingBasis`."""
        fix = "higher ones are not offered"
        derivative = require_whole("derivative", derivative, 0, 3, fix)
        lean, _ = self._lean(place)
        points = require_points(x)
        eta = points[:, None]
        of_mode = self.modes(points)[derivative]
        if derivative == 0:
            return of_mode - self.modes.left_values - eta * lean[:, None, :]
        taken = lean[:, None, :] if derivative == 1 else 0.0
        return np.broadcast_to(of_mode - taken, (len(lean), *of_mode.shape)).copy()

    def array(self, name: str, place: Array) -> Array:
        """Return the integrals of one name; see :class:`MovingBasis`.

        In closed form: the modes are orthonormal and free of mean and moment, so that only the
        straight parts of the shapes are left to integrate.
        """
        require_array(name)
        lean, rate = self._lean(place)
        left, none = np.broadcast_to(self.modes.left_values, lean.shape), np.zeros_like(lean)
        if name == "overlap":
            return np.eye(self.size) + _straight(left, lean, left, lean)
        if name == "drift":
            return _straight(left, lean, none, rate)
        if name == "drift_drift":
            return _straight(none, rate, none, rate)
        if name == "bending":
            elastic = np.diag(self.modes.roots**4)
            return np.broadcast_to(elastic, (len(lean), *elastic.shape)).copy()
        if name == "bending_drift":
            return np.zeros((*lean.shape, self.size))
        if name == "tension":
            # int (1 - eta^2)/2 psi' = -psi(0)/2 by parts, int (1 - eta^2)/2 = 1/3
            cross = _outer(left / 2, lean)
            cross = cross + np.swapaxes(cross, -1, -2)
            return self.modes.tension() + cross + _outer(lean, lean) / 3.0
        return -left / 2 - lean / 3 if name == "moment" else -left - lean / 2

    def _lean(self, place: Array) -> tuple[Array, Array]:
        """Return the slope of the line through pin and block on each mode, and its rate by xi."""
        xi = require_places(place)
        value, slope, _, _ = self.modes(xi)
        lean = (value - self.modes.left_values) / xi[:, None]
        return lean, (slope - lean) / xi[:, None]


def _outer(rows: Array, columns: Array) -> Array:
    return rows[..., :, None] * columns[..., None, :]


def _straight(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Return ``int (a_i + b_i eta) (c_j + d_j eta) d eta``."""
    return _outer(a, c) + (_outer(a, d) + _outer(b, c)) / 2 + _outer(b, d) / 3
