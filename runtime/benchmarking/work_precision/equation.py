"""The equation that every contender solves: y' = L(theta) y, L as a Fourier series.

Peers get the series ready made, and so does the reference; this toolkit starts from its system.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.families import LinearPeriodic
from ...floquet.first_order import CanonicalForm, canonical_form, even_angles

Array = NDArray[np.float64]

_SAMPLES = 1024
_CUT = 1e-14


@dataclass(frozen=True)
class Equation:
    """A linear periodic system at one speed, in scaled canonical variables.

    Attributes
    ----------
    a, b : ndarray, shape (harmonics + 1, m, m)
        Cosine and sine coefficients of L, without entries below 1e-14 of the largest.
    period : float
        Of L [rad].
    size : int
        Number n of coordinates; the state is (q, p) in units of ``scale``, and where forcing acts
        a last component that stays 1.
    scale : ndarray, shape (m,)
        Units of the state.
    form : CanonicalForm
        What it was made of.
    """

    a: Array
    b: Array
    period: float
    size: int
    scale: Array
    form: CanonicalForm

    @classmethod
    def of(
        cls, system: LinearPeriodic, speed: float, *, forced: bool, cut: float = _CUT
    ) -> Equation:
        """Return the equation of a system at a crank speed [rad/s], less entries below ``cut``."""
        form = canonical_form(system, speed, forcing=forced)
        values = form.generator(even_angles(system.period, _SAMPLES))[0]
        table = np.fft.rfft(values, axis=0) / _SAMPLES
        table[1:] *= 2.0
        least = cut * float(np.max(np.abs(table)))
        a, b = (np.where(np.abs(v) > least, v, 0.0) for v in (table.real, -table.imag))
        used = np.flatnonzero(np.any((a != 0.0) | (b != 0.0), axis=(1, 2)))
        count = int(used[-1]) + 1
        return cls(a[:count], b[:count], system.period, system.size, form.scale[0], form)

    @property
    def states(self) -> int:
        """Number m of components of the state."""
        return int(self.a.shape[-1])

    @property
    def harmonics(self) -> int:
        """Highest harmonic of the period."""
        return len(self.a) - 1

    @property
    def rate(self) -> float:
        """Largest rate of change of the state per radian."""
        return float(self.form.rate[0])

    def at(self, theta: float) -> Array:
        """Return L at an angle [rad]."""
        angle = np.arange(len(self.a)) * (theta * 2.0 * np.pi / self.period)
        value: Array = np.tensordot(np.cos(angle), self.a, 1)
        value += np.tensordot(np.sin(angle), self.b, 1)
        return value

    def slope(self, shape: tuple[int, ...]) -> Callable[[float, Array], Array]:
        """Return the function from an angle and a flattened state of a shape to y'."""
        return lambda theta, flat: np.asarray((self.at(theta) @ flat.reshape(shape)).ravel())

    def start(self, q: Array, slope: Array) -> Array:
        """Return the state of coordinates and their derivatives d/dtheta at angle 0."""
        n = self.size
        state = np.ones(self.states)
        state[: 2 * n] = np.concatenate([q, self.form.momentum(0.0, q, slope)])
        state[: 2 * n] /= self.scale[: 2 * n]
        return state

    def coordinates(self, states: Array) -> Array:
        """Return q ``(nt, n)`` of states ``(nt, m)``."""
        found: Array = states[:, : self.size] * self.scale[: self.size]
        return found
