"""Free motions of the lowest modes of a stiff system, and what the modes left out would change.

A motion of the truncated system, lifted, leaves a force r of the whole equation unmet.  With the
motion's adjoint (a, b)(theta), whose product with the motion (z, p) is 1, it changes the exponent
in first order by the mean over the period of

    b^T Phi^T r.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.inputs import require_whole
from ..core.trigonometric import differentiated
from .equation import equation_of, sampled
from .moving_basis import still_modes
from .swept_motions import Truncations
from .tables import flows_at, products_to
from .transition import cheapest, segments_of
from .truncation import TruncatedSystem

ComplexArray = NDArray[np.complex128]

_EPS = float(np.finfo(float).eps)
# Error of the transition matrices for free motions, of which some decay, and for small changes.
_FINE, _RTOL = 1e-13, 1e-10
# Error of the exponents by the modes left out that is small enough, that from which a better one
# must not be dear, and the largest that will do.  Table 4.1's four-bar at 84 rad/s: 5 of 9 modes
# 5e-7, 4 of them 4e-6; 7 of 27 7e-7.
_ENOUGH, _FAIR, _MOST = 1e-6, 1e-5, 1e-3
# How many times the work of the first number of modes that will do a better one may cost.
_DEARER = 10.0
# The first order is right to a digit or two where the modes left out are twice as fast; nearer ones
# double it.
_MARGIN = 2.0
# Speeds, over the highest, of which that farthest from a resonance tells the change: where two
# motions are nearly one, what a force does to them says little about the modes left out.
_BESIDE = (1.0, 0.997, 0.992)
# Angles a turn of the fastest motion, of the motions' samples; fewest and most of them.
_ANGLES, _FEWEST, _FINEST = 4, 128, 4096
# Multipliers below that are round-off of the others.
_DEAD = 1e-9


@dataclass(frozen=True)
class FreeMotions:
    """The free motions of the lowest modes at one speed, one to a multiplier."""

    multipliers: ComplexArray  # what each motion is multiplied by in a period, (2m,)
    # All coordinates and their derivatives by the angle, at even angles, without what the modes
    # left out add, (nt, n, 2m).
    q: ComplexArray
    slope: ComplexArray


def free_motions(truncated: TruncatedSystem, speed: float, angles: int) -> FreeMotions:
    """Return the free motions of a truncated system at a crank speed [rad/s], at even angles."""
    equation = equation_of(sampled(truncated), np.array([speed]))
    way, segments = cheapest(equation, _FINE, angles, stiff=False)
    flows, whole = (part[0] for part in flows_at(equation, segments, way, angles))
    multipliers, vectors = np.linalg.eig(whole)
    states, every = flows @ vectors, slice(None, None, len(truncated.theta) // angles)
    m, unit, theta = truncated.size, equation.scale[0][:, None], truncated.theta[every]
    z, rate = unit * states[:, :m], unit * (equation.generator(theta)[0, :, :m] @ states)
    basis = truncated.modes[every]
    slope = differentiated(truncated.modes, truncated.period)[every] @ z + basis @ rate
    return FreeMotions(multipliers.astype(complex), basis @ z, slope)


def exponent_changes(truncated: TruncatedSystem, speed: float) -> Array:
    """Return how much of each exponent the modes left out change, to first order, ``(2m,)``.

    At a crank speed [rad/s] at which the angles of the truncated system resolve its motions; NaN of
    motions that decay below round-off in a period.
    """
    equation = equation_of(sampled(truncated), np.array([speed]))
    period, m, theta = truncated.period, truncated.size, truncated.theta
    way, segments = cheapest(equation, _RTOL, len(theta), stiff=False)
    maps = segments_of(equation, segments, way).maps
    flows, whole = (part[0] for part in products_to(maps, len(theta)))
    # From each angle to the end: transposed, the segments backwards.
    back = products_to(maps[:, ::-1].mT, len(theta))[0][0].mT
    left_over = np.concatenate([whole[None], back[:0:-1]])
    multipliers, vectors = np.linalg.eig(whole)
    alive = np.abs(multipliers) > _DEAD
    multipliers, adjoint = multipliers[alive].astype(complex), np.linalg.inv(vectors)[alive]
    exponents = np.log(multipliers) / period
    states = flows @ vectors[:, alive] * np.exp(-np.multiply.outer(theta, exponents))[:, None]
    # Each motion about its strongest wave.
    waves = np.sum(np.abs(np.fft.fft(states[:, :m], axis=0)) ** 2, axis=1)
    numbers = np.fft.fftfreq(len(theta), 1.0 / len(theta))[np.argmax(waves, axis=0)]
    shift = 2j * np.pi / period * numbers
    exponents = exponents + shift
    states = states[:, :m] * np.exp(-np.multiply.outer(theta, shift))[:, None]
    unit = equation.scale[0][:, None]
    rest = truncated.unmet_free(unit * states, exponents, speed)
    push = unit * (np.swapaxes(truncated.modes, -1, -2) @ rest) / speed**2
    pushed = np.einsum("tji,tij->tj", (adjoint @ left_over)[:, :, m:], push)
    pushed *= np.exp(np.multiply.outer(theta, exponents)) / multipliers
    changes = np.full(2 * m, np.nan)
    size = np.maximum(np.abs(exponents), 1.0 / period)
    changes[alive] = np.abs(np.mean(pushed, axis=0)) / size
    return changes


class LowestModes:
    """Truncations of a stiff system, ``least`` modes or more, whose exponents are known."""

    def __init__(self, system: LinearPeriodic, least: int = 4) -> None:
        self.truncations = Truncations(system, min(least, system.size))
        still = still_modes(system, _FEWEST)
        self._top = np.sqrt(np.max(still.squares, axis=0))
        # Entries are rounded as the stiffest mode's are, those of slow modes too: of their
        # exponents, (n,), this relative error is a sixteenth or less.
        slowest, stiffest = np.min(still.squares, axis=0), np.max(still.squares)
        self.rounding = _EPS / 16.0 * stiffest / np.maximum(slowest, _EPS * stiffest)

    def at(self, modes: int, speed: float) -> TruncatedSystem | None:
        """Return the truncation whose angles resolve its motions at a speed [rad/s].

        None where the modes do not stay smooth.
        """
        turns = float(self._top[modes - 1]) / speed * self.truncations.system.period / (2 * np.pi)
        angles = _FEWEST
        while angles < min(_ANGLES * turns, _FINEST):
            angles *= 2
        made = self.truncations.at(modes, angles)
        return None if made is None else made[0]

    def error(self, modes: int, speed: float) -> float:
        """Return the largest relative change of an exponent by the modes left out; an estimate.

        Of two motions that are nearly one, as beside a resonance, of their half sum.
        """
        truncated = self.at(modes, _BESIDE[-1] * speed)
        if truncated is None:
            return np.inf
        changes = [exponent_changes(truncated, part * speed) for part in _BESIDE]
        return _MARGIN * float(np.min(np.nanmax(changes, axis=1)))

    def chosen(self, speed: float) -> tuple[int, float]:
        """Return the number of modes for speeds up to one [rad/s], and the error of exponents.

        The least number with an error below 1e-6; where that takes over ten times the work of the
        first below 1e-5, the best until there; where none is below, the best.
        """
        best, dearest = (self.truncations.system.size, np.inf), np.inf
        for modes in self.truncations.numbers:
            work = float(self._top[modes - 1]) * modes**3
            if work > dearest:
                break
            error = self.error(modes, speed)
            best = min(best, (modes, error), key=lambda choice: choice[1])
            if error <= _ENOUGH:
                break
            if error <= _FAIR:
                dearest = min(dearest, _DEARER * work)
        return best

    def required(self, speed: float, modes: int | None = None) -> tuple[TruncatedSystem, float]:
        """Return the truncation for speeds up to one [rad/s], and the error of exponents.

        Raises ``BadInput`` if the number of modes is none of 1 to n, they do not stay smooth over
        the period, or the error is above 1e-3.
        """
        if modes is None:
            modes, error = self.chosen(speed)
        else:
            modes = require_whole("modes", modes, 1, self.truncations.system.size)
            error = self.error(modes, speed)
        made = self.at(modes, _BESIDE[-1] * speed)
        if made is None:
            fix = "choose one mode more or less"
            raise bad("modes", modes, "a number of modes that stay smooth over the period", fix)
        if not error <= _MOST:
            raise bad(
                "modes",
                f"{modes} at {speed:.4g} rad/s, where those left out change exponents by "
                f"{error:.1e} of themselves",
                f"a number of modes with an error below {_MOST}",
                "keep more modes, lower the speed, or use the whole system",
            )
        return made, error
