"""Multipliers of the lowest modes of a stiff system at very many speeds, on a reduced basis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.errors import BadInput
from ..core.families import LinearPeriodic
from ..core.trigonometric import even_angles
from ..periodic import monodromy
from ..periodic.decoupled.frames import held_modes
from ..periodic.first_order import canonical_form

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

# Lowest frequency left out, over the highest wanted and over the highest kept.
_BEYOND, _GAP = 4.0, 1.3
# Relative step of the speed by which frequencies are told.
_STEP = 1e-6


@dataclass(frozen=True)
class SweptModes:
    """The lowest modes of a stiff system over a range of speeds.

    Attributes
    ----------
    system : LinearPeriodic
        On its lowest natural modes.
    highest : float
        Highest speed [rad/s].
    """

    system: LinearPeriodic
    highest: float

    def multipliers(self, speed: Array, count: int) -> tuple[ComplexArray, Array]:
        """Return multipliers and mean frequencies [rad/s] of the lowest modes.

        Parameters
        ----------
        speed : ndarray, shape (ns,)
            Within the range [rad/s].
        count : int
            Number m of modes.

        Returns
        -------
        multipliers, frequency : ndarray
            Shape ``(ns, 2m)``, two to a mode, by rising frequency.  The frequency is the
            multiplier's turn by the time that a period takes.
        """
        system = self.system
        three = np.stack([speed / (1 + _STEP), speed, speed / (1 - _STEP)])
        found = monodromy(system, three.ravel(), rtol=1e-9)
        # The speed's own scale for all three.
        scale = found.scale.reshape(3, len(speed), -1)
        half = system.size
        plain = np.ldexp(found.matrix, found.exponent[:, None, None])
        plain = plain.reshape(3, len(speed), 2 * half, 2 * half)
        # In velocities of time, not of angle, a state is the same at all speeds.
        rate = np.ones((3, len(speed), 2 * half))
        rate[..., half:] = three[..., None]
        own = rate / np.concatenate([scale[1, :, :half], scale[1, :, half:] * speed[:, None]], 1)
        matrix = plain * own[..., :, None] / own[..., None, :]
        values, vectors = np.linalg.eig(matrix[1])
        inverse = np.linalg.inv(vectors)
        change = np.einsum("kij,kjl,kli->ki", inverse, matrix[2] - matrix[0], vectors)
        duration = system.period * (1 / three[2] - 1 / three[0])
        # Conjugates turn against each other.
        frequency = np.abs(np.imag(change / values)) / np.abs(duration)[:, None]
        # A locked pair does not turn on: it takes the frequency of the speeds beside.
        frequency[values.imag == 0.0] = np.nan
        size = np.concatenate([scale[1, :, :half], scale[1, :, half:] * speed[:, None]], 1)
        order = np.argsort(self._level(vectors * size[:, :, None]), axis=-1, kind="stable")
        order = order[:, : 2 * count]
        chosen = np.take_along_axis(values.astype(complex), order, axis=-1)
        rate = np.take_along_axis(frequency, order, axis=-1)
        return chosen, _filled(speed, rate, count)

    def _level(self, states: ComplexArray) -> Array:
        """Return energy over action of states (q, M qd) in columns, by the modes held at 0."""
        form = canonical_form(self.system, np.array([self.highest]), {})
        frequency, shapes, mass, _ = held_modes(form, np.zeros(1))
        half = self.system.size
        rest = np.abs(shapes[0].T @ mass[0] @ states[:, :half]) ** 2
        moved = np.abs(shapes[0].T @ states[:, half:]) ** 2
        rate = np.maximum(frequency[0], 1.0)[:, None]
        energy = rate**2 * rest + moved
        value: Array = np.sum(energy, axis=1) / np.sum(energy / rate, axis=1)
        return value


def _filled(speed: Array, rate: Array, count: int) -> Array:
    """Return frequencies, two to a mode, with those of locked pairs interpolated."""
    out = np.array(rate)
    for mode in range(count):
        own = rate[:, 2 * mode : 2 * mode + 2]
        known = np.all(np.isfinite(own), axis=1)
        order = np.flatnonzero(known)[np.argsort(speed[known])]
        mean = np.mean(own[order], axis=1)
        if len(order):
            filled = np.interp(speed, speed[order], mean)
            out[:, 2 * mode : 2 * mode + 2] = np.where(known, np.mean(own, axis=1), filled)[:, None]
    value: Array = np.where(np.isfinite(out), out, 0.0)
    return value


def swept_modes(system: LinearPeriodic, span: tuple[float, float], count: int) -> SweptModes | None:
    """Return the lowest modes over a range of speeds; None where no few modes stand apart.

    Parameters
    ----------
    system : LinearPeriodic
        Damped or not.
    span : pair of float
        Lowest and highest speed [rad/s].
    count : int
        Number of modes wanted.
    """
    from ..periodic.reduced import reduced_system

    form = canonical_form(system, np.array([span[1]]), {})
    frequency = held_modes(form, even_angles(system.period, 128))[0]
    top, low = np.max(frequency, axis=0), np.min(frequency, axis=0)
    for kept in range(count, system.size):
        apart = low[kept] >= _GAP * top[kept - 1] and low[kept] >= _BEYOND * top[count - 1]
        if not apart:
            continue
        try:
            reduced = reduced_system(system, kept)
        except BadInput:
            continue
        return SweptModes(reduced, span[1])
    return None
