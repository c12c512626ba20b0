"""Answers to what is left of a stiff system's equation: fast modes, then slow ones.

The fast modes answer quasi-statically, angle by angle; the slow modes, which move with the
mechanism, by a factorised harmonic balance of their own.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..simulation.second_order import Series
from .balance_matrix import real_matrix
from .request import resampled
from .slow_modes import SlowModes
from .speed_parts import SpeedParts

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

# Condition number from which on single precision does not steer.
_SINGLE = 1e6
# Harmonics above those kept in which a resonance is looked for.
_AHEAD = 16


@dataclass(frozen=True)
class Equation:
    """``M q'' + G q' + H q = F`` at even angles, at one speed, and its slow modes there.

    Attributes
    ----------
    stacked : ndarray
        H, G, M side by side, shape ``(nt, n, 3n)``.
    force : ndarray
        F, shape ``(nt, n)``.
    nu : float
        2 pi over the period.
    """

    stacked: Array
    force: Array
    nu: float

    @classmethod
    def at(cls, parts: SpeedParts, speed: float, count: int, nu: float) -> Equation:
        """Return the equation at a speed [rad/s]."""
        return cls(*parts.at(speed, count), nu)

    def thinned(self, every: int) -> Equation:
        """Return the equation at every so many of the angles."""
        return Equation(np.ascontiguousarray(self.stacked[::every]), self.force[::every], self.nu)

    def left(self, motion: Array) -> Array:
        """Return the left side for a motion, ``(nt, n)`` each."""
        count = len(motion)
        waves = np.fft.rfft(motion, axis=0)
        kappa = (1j * self.nu * np.arange(len(waves)))[:, None]
        rates = np.fft.irfft(np.concatenate([kappa * waves, kappa**2 * waves], axis=1), count, 0)
        values = np.concatenate([motion, rates], axis=1)
        found: Array = (self.stacked @ values[:, :, None])[:, :, 0]
        return found


def at_angles(waves: ComplexArray, count: int) -> Array:
    """Return a real motion at even angles from its harmonics."""
    found: Array = np.fft.irfft(waves * count, n=count, axis=0)
    return found


def harmonics_of(values: Array, harmonics: int) -> ComplexArray:
    """Return harmonics 0 to a number of samples at even angles."""
    found: ComplexArray = (np.fft.rfft(values, axis=0) / len(values))[: harmonics + 1]
    return found


def _times(matrices: Array, vectors: Array) -> Array:
    found: Array = (matrices @ vectors[:, :, None])[:, :, 0]
    return found


@dataclass(frozen=True)
class Steering:
    """Answers of the slow and the fast modes.

    Attributes
    ----------
    fine : Equation
        At several times as many angles as are balanced.
    modes : SlowModes
        The slow modes and the flexibility of the fast ones at the same angles.
    every : int
        How many of those angles are one that is balanced.
    speed : float
        Crank speed [rad/s].
    """

    fine: Equation
    modes: SlowModes
    every: int
    speed: float

    @cached_property
    def coarse(self) -> Equation:
        """The equation at the angles that are balanced."""
        return self.fine.thinned(self.every)

    @cached_property
    def coarse_modes(self) -> SlowModes:
        """The modes there."""
        return self.modes.thinned(self.every)

    @property
    def harmonics(self) -> int:
        """Highest harmonic of the motion."""
        return (len(self.fine.force) // self.every - 1) // 2

    @cached_property
    def reduced(self) -> tuple[Array, Array, Array]:
        """M, G, H on the slow modes, ``(nt, m, m)`` each, in scaled coordinates."""
        eq, modes, n = self.fine, self.modes, self.fine.force.shape[-1]
        stiff, rate, mass = (eq.stacked[:, :, k * n : (k + 1) * n] for k in range(3))
        phi, slope, bend = (part * self.scale for part in (modes.shapes, modes.slopes, modes.bends))
        across = np.swapaxes(phi, -1, -2)
        return (
            across @ (mass @ phi),
            across @ (2.0 * (mass @ slope) + rate @ phi),
            across @ (mass @ bend + rate @ slope + stiff @ phi),
        )

    @cached_property
    def scale(self) -> Array:
        """Scale of the slow coordinates: of unit stiffness, or of unit mass where that is more."""
        return np.asarray(np.maximum(1.0, self.modes.highest / self.speed) ** -1.0)

    @cached_property
    def _kept(self) -> Factors:
        """Balance of the slow modes at the angles balanced, angle by angle."""
        mass, rate, stiff = (part[:: self.every] for part in self.reduced)
        count, m = len(mass), len(self.scale)
        first, second = rates(count, self.fine.nu)
        whole = second[:, None, :, None] * mass[:, :, None]
        whole += first[:, None, :, None] * rate[:, :, None]
        place = np.arange(count)
        whole[place, :, place] += stiff
        return Factors.of(whole.reshape(count * m, count * m))

    @property
    def ahead(self) -> int:
        """Highest harmonic in which what is left beyond those kept is answered."""
        return min(self.harmonics + _AHEAD, (len(self.fine.force) - 1) // 2)

    @cached_property
    def _next(self) -> Factors:
        """Balance of the slow modes in the harmonics above."""
        count = len(self.fine.force)
        mass, rate, stiff = (
            np.fft.rfft(part, axis=0)[: (count + 1) // 2] / count for part in self.reduced
        )
        series = Series(mass, rate, stiff, np.zeros((1, len(self.scale)), dtype=complex), 0.0)
        one = np.ones(len(self.scale))
        return Factors.of(real_matrix(series, self.ahead, self.fine.nu, one, self.harmonics + 1))

    @property
    def condition(self) -> float:
        """Condition number of the balance of the slow modes; inf where singular."""
        return self._kept.condition

    def answer(self, rest: Array) -> Array:
        """Return the motion that answers what is left over at the angles balanced."""
        modes, eq = self.coarse_modes, self.coarse
        fast, load = self._fast(rest, eq, modes)
        slow = self._kept.solve(load.ravel()).reshape(load.shape)
        return fast + _times(modes.shapes, slow * self.scale)

    def beyond(self, rest: Array) -> Array:
        """Return what answers the rest at all angles, with harmonics above those kept."""
        count, kept = len(rest), self.harmonics + 1
        fast, load = self._fast(rest, self.fine, self.modes)
        waves = (np.fft.rfft(load, axis=0) / count)[: self.ahead + 1]
        coarse = at_angles(waves[:kept], 2 * self.harmonics + 1)
        slow = resampled(self._kept.solve(coarse.ravel()).reshape(coarse.shape), count)
        if self.ahead > self.harmonics:
            above = waves[kept:]
            right = np.concatenate([above.real.ravel(), above.imag.ravel()])
            found = self._next.solve(right)
            waves[:kept] = 0.0
            waves[kept:] = (found[: above.size] + 1j * found[above.size :]).reshape(above.shape)
            slow = slow + at_angles(waves, count)
        return fast + _times(self.modes.shapes, slow * self.scale)

    def _fast(self, rest: Array, eq: Equation, modes: SlowModes) -> tuple[Array, Array]:
        """Return what the fast modes answer, and what that leaves to the slow ones."""
        fast = _times(modes.flexibility, rest) * self.speed**2
        pushed = rest - eq.left(fast)
        return fast, _times(np.swapaxes(modes.shapes, -1, -2), pushed) * self.scale


def rates(count: int, nu: float) -> tuple[Array, Array]:
    """Return the matrices of the first two derivatives at an odd number of even angles."""
    waves = nu * np.arange(count // 2 + 1)
    first, second = (np.fft.irfft(part, n=count) for part in (1j * waves, -(waves**2)))
    place = (np.arange(count)[:, None] - np.arange(count)) % count
    return first[place], second[place]


@dataclass(frozen=True)
class Factors:
    """A factorised matrix, in single precision where that is enough to steer by."""

    lower: NDArray[np.floating[Any]]
    pivots: NDArray[np.int32]
    condition: float

    @classmethod
    def of(cls, matrix: Array) -> Factors:
        """Factorise a matrix."""
        found = cls._of(matrix.astype(np.float32))
        return found if found.condition < _SINGLE else cls._of(matrix)

    @classmethod
    def _of(cls, matrix: NDArray[np.floating[Any]]) -> Factors:
        from scipy.linalg import lapack

        single = matrix.dtype == np.float32
        factorise = lapack.sgetrf if single else lapack.dgetrf
        estimate = lapack.sgecon if single else lapack.dgecon
        norm = float(np.max(np.sum(np.abs(matrix), axis=1)))
        # The transpose lies in memory as LAPACK wants it.
        lower, pivots, singular = factorise(matrix.T, overwrite_a=1)
        condition = np.inf
        if not singular and np.all(np.isfinite(lower)):
            reciprocal, _ = estimate(lower, norm)
            condition = 1.0 / float(reciprocal) if reciprocal > 0 else np.inf
        return cls(lower, pivots, condition)

    def solve(self, right: Array) -> Array:
        """Return the solution for one right side."""
        from scipy.linalg import lapack

        solver = lapack.sgetrs if self.lower.dtype == np.float32 else lapack.dgetrs
        # Single numbers do not reach as far down: what is small is brought up to unit size.
        size = float(np.max(np.abs(right))) or 1.0
        found, _ = solver(self.lower, self.pivots, right / size, trans=1)
        return np.asarray(found, dtype=float) * size
