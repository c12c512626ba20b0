"""Periodic motions and multipliers of a large damped system at very many speeds.

The system is truncated to its lowest modes (:mod:`~.truncation`); in ranges of the speed the
transition matrices of what is left are tables in the inverse speed (:mod:`~.tables`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import pairwise

import numpy as np

from ..core.errors import BadInput, bad
from ..core.families import Array, LinearPeriodic
from ..core.trigonometric import even_angles
from .equation import SampledSystem, sampled
from .moving_basis import smooth_basis, still_modes
from .multipliers import conditions
from .prepared import TableMaker, closed
from .tables import Table, flows_at, octaves
from .transition import cheapest
from .truncation import TruncatedSystem, arrays_at, modes_offered, truncated_on

# Speeds whose motions are lifted together.
_TOGETHER = 64
# Even angles at which the modes are carried round, at the least and the most, and the upper
# harmonics of the basis, over the largest, that are small enough.
_CARRIED, _SMOOTH = (128, 1024), 1e-9


@dataclass(frozen=True)
class Growth:
    """Largest multipliers at speeds: modulus, its condition and its error, each ``(ns,)``."""

    modulus: Array
    condition: Array
    error: Array


@dataclass(frozen=True)
class SweptMotions:
    """The forced periodic motions of a truncated system over a range of speeds."""

    truncated: TruncatedSystem  # the system on its lowest modes
    table: Table  # its transition matrices over the inverse speed, the force as last column
    scale: Array  # units of the state
    matrix_error: float  # error of a monodromy matrix over its largest entry
    # Error of a motion over the size of its start and over what the closing of the ring magnifies.
    motion_error: float

    def blocks(self, speeds: Array) -> Iterator[tuple[slice, Array, Array, Array]]:
        """Yield parts of the speeds, motions ``(ns, nt, n)`` of all coordinates, and their errors.

        First those ``(ns,)`` of the truncated system's motion over its largest size, then the
        static answer to what the motions leave of the whole equation, ``(ns, nt, n)``.
        """
        for begin in range(0, len(speeds), _TOGETHER):
            part = slice(begin, begin + _TOGETHER)
            flows = self.table.flows(1.0 / speeds[part])
            z, reach = reduced(self.truncated, flows, self.scale)
            q, rest = self.truncated.lift(z, speeds[part])
            yield part, q, reach * self.motion_error, rest

    def growth(self, speeds: Array) -> Growth:
        """Return the largest multiplier of the truncated system at speeds."""
        products, exponent = self.table.products(1.0 / speeds)
        return growth_of(
            np.ldexp(products, exponent[:, None, None])[:, :-1, :-1], self.matrix_error
        )


def reduced(
    truncated: TruncatedSystem, flows: tuple[Array, Array], scale: Array
) -> tuple[Array, Array]:
    """Return forced periodic motions ``(ns, samples, m)``, and how errors of flows enter them.

    Over the largest size of the motion: that of its start times the reach of the ring.
    """
    m = truncated.size
    states, reach = closed(*flows, 1.0 / scale[-1])
    size = np.max(np.abs(states[:, :, :m]), axis=(1, 2))
    start = np.max(np.abs(states[:, 0]), axis=1)
    return states[:, :, :m] * scale[:m], (reach + 1.0) * start / size


def growth_of(matrices: Array, relative: float) -> Growth:
    """Return the largest multiplier of matrices ``(ns, m, m)`` with that relative error."""
    values, vectors = np.linalg.eig(matrices)
    modulus = np.abs(values)
    which = np.argmax(modulus, axis=1)[:, None]
    condition = np.take_along_axis(conditions(vectors), which, axis=1)[:, 0]
    size = relative * np.maximum(1.0, np.max(np.abs(matrices), axis=(1, 2)))
    return Growth(np.take_along_axis(modulus, which, axis=1)[:, 0], condition, condition * size)


@dataclass(frozen=True)
class Trial:
    """One number of modes at a few speeds.

    ``q``: motions ``(ns, nt, n)``; ``tail``: the upper quarter of the harmonics of the reduced
    motions, over the largest.
    """

    truncated: TruncatedSystem
    q: Array
    growth: Growth
    tail: float


class Truncations:
    """Modal truncations of one system, ``least`` modes or more, by modes and angles made once."""

    def __init__(self, system: LinearPeriodic, least: int = 4) -> None:
        self.system = system
        self.numbers = modes_offered(system, least)
        # A cache of the method would hold the arrays in a circle until one looks for these.
        self._made: dict[tuple[int, int], tuple[TruncatedSystem, SampledSystem] | None] = {}
        self._held = lru_cache(maxsize=None)(partial(still_modes, system))
        self._arrays = lru_cache(maxsize=None)(
            lambda angles: arrays_at(system, even_angles(system.period, angles))
        )

    def at(self, modes: int, angles: int) -> tuple[TruncatedSystem, SampledSystem] | None:
        """Return the truncation to a number of modes; None where these do not stay smooth."""
        key = modes, max(angles, _CARRIED[0])
        if key not in self._made:
            self._made[key] = self._truncated(*key)
        return self._made[key]

    def _truncated(self, modes: int, angles: int) -> tuple[TruncatedSystem, SampledSystem] | None:
        system, every = self.system, modes == self.system.size
        reach = angles, angles if every else _CARRIED[1]
        try:
            basis = smooth_basis(system.period, modes, self._held, reach, _SMOOTH)
        except BadInput:
            return None
        if not (every or basis.tail <= _SMOOTH):
            return None
        made = truncated_on(system, basis, self._arrays(len(basis.theta)))
        return made, sampled(made, forcing=True)

    def usable(self, least: int, angles: int) -> list[int]:
        """Return the next two numbers of modes from one on (one at the end) that are smooth."""
        chosen: list[int] = []
        for number in self.numbers:
            if number >= least and len(chosen) < 2 and self.at(number, angles) is not None:
                chosen.append(number)
        return chosen

    def motions(
        self, modes: int, angles: int, span: tuple[float, float], rtol: float
    ) -> SweptMotions:
        """Return motions over speeds [rad/s]; refuse modes that do not stay smooth."""
        truncated, known = self._required(modes, angles)
        low, high = span
        maker = TableMaker(known, (low * high) ** 0.5, {}, stiff=False)
        # To begin with: at errors of 1e-7 most octaves need no more.
        table, errors, motion = maker.table(1.0 / high, 1.0 / low, angles, rtol, 16)
        worst = float(np.max(motion))
        return SweptMotions(truncated, table, maker.scale, errors.largest, worst)

    def trial(self, modes: int, angles: int, speeds: Array, rtol: float) -> Trial:
        """Return motions and growth at a few speeds, rising."""
        truncated, known = self._required(modes, angles)
        maker = TableMaker(known, float(speeds[-1]), {}, stiff=False)
        way, count = cheapest(maker.equation(1.0 / speeds[:1]), rtol, angles, stiff=False)
        flows = flows_at(maker.equation(1.0 / speeds), count, way, angles)
        z, _ = reduced(truncated, flows, maker.scale)
        waves = np.max(np.abs(np.fft.rfft(z, axis=1)), axis=2)
        upper = np.max(waves[:, 3 * waves.shape[1] // 4 :], axis=1)
        tail = float(np.max(upper / np.max(waves, axis=1)))
        q, _ = truncated.lift(z, speeds)
        return Trial(truncated, q, growth_of(flows[1][:, :-1, :-1], rtol), tail)

    def _required(self, modes: int, angles: int) -> tuple[TruncatedSystem, SampledSystem]:
        made = self.at(modes, angles)
        if made is None:
            expected = "a number of modes that stay smooth over the revolution"
            raise bad("modes", modes, expected, "choose one mode more or less")
        return made


def speed_ranges(speeds: Array) -> list[slice]:
    """Return parts of rising speeds, the ends of each within a fixed ratio."""
    low, high = float(speeds[0]), float(speeds[-1])
    inner = octaves(low, high)[1:-1]
    places = [0, *np.searchsorted(speeds, inner).tolist(), len(speeds)]
    return [slice(a, b) for a, b in pairwise(places) if b > a]
