"""Frequencies of the running mechanism, each named by the mode whose shape its motion has.

Exponents are known up to multiples of the speed alone, and those of different modes pass each other
all the time as the speed changes.  What tells them apart is not how near they lie but how the
mechanism moves: at each speed each motion is taken apart, along the whole turn, into the modes of
the mechanism held still.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.families import LinearPeriodic
from ..floquet.decoupled.exponents import SlowModes, SlowMonodromy
from ..floquet.first_order import even_angles
from .eigenproblem import HeldModes, held_modes

Array = NDArray[np.float64]

_RTOL = 1e-8
# Motions whose phases are this close turn alike: pairs of which one grows and one decays.
_ALIKE = 1e-6


@dataclass(frozen=True)
class Running:
    """Frequencies of the running mechanism at several speeds.

    Attributes
    ----------
    frequency : ndarray
        By mode [rad/s], ``(ns, modes)``.
    growth : ndarray
        Real parts of the exponents [1/s], ``(ns, modes)``.
    share : ndarray
        Share of each motion that is its mode's, ``(ns, modes)``.
    away : float
        Largest distance from the expected frequency, over half the speed.
    """

    frequency: Array
    growth: Array
    share: Array
    away: float


def running_frequencies(system: LinearPeriodic, speeds: Array, held: Array, rest: Array) -> Running:
    """Return the frequencies of the running mechanism, named by the shapes of its motions.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    speeds : ndarray
        Crank speeds [rad/s], ``(ns,)``.
    held : ndarray
        Frequencies [rad/s] that the multiples of the speed are chosen by, ``(ns, modes)``; where
        they are NaN those of the speed before count.
    rest : ndarray
        Those before the first speed, ``(modes,)``.
    """
    slow, turn = SlowModes(system, {}), 2.0 * np.pi / system.period
    frequency, growth, share = np.empty((3, *held.shape))
    count, before, farthest = held.shape[1], rest, 0.0
    modes: HeldModes | None = None
    for row, speed in enumerate(speeds):
        found = slow.motions(float(speed), count, rtol=_RTOL)
        if modes is None:
            modes = held_modes(system, even_angles(system.period, len(found.stations)), {})
        phase, rate, share[row] = _named(found, modes, float(speed), count)
        expected = np.where(np.isfinite(held[row]), held[row], before)
        spacing = speed * turn
        away = phase * speed / system.period - expected
        away -= spacing * np.round(away / spacing)
        frequency[row], growth[row] = expected + away, rate * speed / system.period
        farthest = max(farthest, float(np.max(np.abs(away))) / (0.5 * spacing))
        before = frequency[row]
    return Running(frequency, growth, share, farthest)


def _named(
    found: SlowMonodromy, held: HeldModes, speed: float, count: int
) -> tuple[Array, Array, Array]:
    """Return phase and growth over a period of each mode's motion, and its share of it."""
    from scipy.optimize import linear_sum_assignment

    values, vectors = np.linalg.eig(found.matrix)
    shares = _shares(found, vectors, held, speed)[:, :count]
    motion, mode = linear_sum_assignment(-shares)
    chosen = np.empty(count, dtype=np.int64)
    chosen[mode] = motion
    phase, rate = np.angle(values), np.log(np.abs(values))
    own = shares[chosen, np.arange(count)]
    # Where a motion locks to the speed it grows in one form and decays in another: both are told
    # as the one that grows.
    turned = np.abs(np.exp(1j * phase[:, None]) - np.exp(1j * phase[chosen]))
    alike = (turned <= _ALIKE) & (shares >= 0.5 * own)
    return phase[chosen], np.max(np.where(alike, rate[:, None], -np.inf), axis=0), own


def _shares(found: SlowMonodromy, vectors: Array, held: HeldModes, speed: float) -> Array:
    """Return the share of each motion in each held mode, turning forward, ``(2k, n)``.

    A motion ``x e^(i w t)`` of a mode with unit mass has the action ``|w x - i v|^2 / (4 w)``; what
    turns backward, its conjugate, has none.  Shares are means over the turn.
    """
    if found.states is None:
        return np.zeros((vectors.shape[-1], held.frequency.shape[-1]))
    motion = found.states @ (found.stations @ vectors)
    half = motion.shape[1] // 2
    across = np.swapaxes(held.shape, -1, -2)
    place = across @ held.mass @ motion[:, :half]
    rate = speed * (across @ motion[:, half:])
    omega = held.frequency[:, :, None]
    forward, backward = (
        np.abs(omega * place - sign * 1j * rate) ** 2 / omega for sign in (1.0, -1.0)
    )
    whole = np.sum(forward + backward, axis=1, keepdims=True)
    return np.asarray(np.mean(forward / whole, axis=0).T)
