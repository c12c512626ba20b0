"""The motions of the lowest modes of stiff periodic systems over a turn, speed by speed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.collocation import gauss_maps
from ...core.errors import BadInput, bad
from ...core.families import Array, LinearPeriodic
from ...core.inputs import require_whole
from ...core.trigonometric import even_angles, interpolated
from ..equation import Equation, sampled
from ..multipliers import conditions, eigenvalues
from ..transition import product
from .riccati import Frames, SlowPart, moving_frames, plain_equation, slow_part

ComplexArray = NDArray[np.complex128]

_EPS = float(np.finfo(float).eps)
# Gap above the slow modes, in turns a period, from which decoupling is worth a try.
_WORTH = 20.0
_PHASE = 3.0
# Nodes of the collocation.
_STAGES = 8
_STATIONS = 16
_MOST_SEGMENTS = 2**16
_BLOCK_FLOATS = 4_000_000
# Angles at which frozen modes are looked at.
_ANGLES = 256


@dataclass(frozen=True)
class SlowMonodromy:
    """Monodromy matrix of the slow part at one speed.

    Attributes
    ----------
    matrix : ndarray
        Of the canonical slow coordinates, shape ``(2k, 2k)``.
    stations : ndarray
        Transition matrices from 0 to even angles, ``(ns, 2k, 2k)``.
    segments : int
        Collocation segments.
    integration, residual, rounding : float
        Parts of the error of the matrix, over its largest entry.
    states : ndarray or None
        (q, M q') of the canonical slow coordinates at those angles, ``(ns, 2n, 2k)``.
    """

    matrix: Array
    stations: Array
    segments: int
    integration: float
    residual: float
    rounding: float
    states: Array | None = None

    @property
    def error(self) -> float:
        """Largest error of an entry over the largest entry."""
        return min(self.integration + self.residual + self.rounding, 1.0)

    def multipliers(self) -> tuple[ComplexArray, Array]:
        """Return the eigenvalues of the matrix and their absolute errors, ``(2k,)`` each."""
        m = len(self.matrix)
        norm = float(np.linalg.norm(self.matrix))
        shift = m * self.error * float(np.max(np.abs(self.matrix))) + 4 * m * _EPS * norm
        values, error, _ = eigenvalues(self.matrix[None], np.array([shift]))
        return values[0], error[0]


class SlowModes:
    """The lowest modes of one system, whose moving bases are made once for all speeds.

    The modes far above do not have to be resolved: they are decoupled, exactly but for a residual
    that is measured, by a moving basis and a Riccati equation, and the rest is integrated.

    Parameters
    ----------
    system : LinearPeriodic
        Of any size, damped or not; forcing plays no part.
    """

    def __init__(self, system: LinearPeriodic) -> None:
        self._system, self._known = system, sampled(system)
        # Bases by number of modes; None where there is none.
        self._made: dict[int, Frames | None] = {}
        self._shared = all(term.power == 0 for term in system.terms if term.array == "M")
        # Natural frequencies with the crank held [rad/s], of the first speed.
        self._frequency: Array | None = None

    def motions(self, speed: float, count: int, *, rtol: float = 1e-9) -> SlowMonodromy:
        """Return the monodromy matrix of the slow part at one speed [rad/s], with its states.

        It holds at least ``count`` modes: the fewest that leave the residual below ``rtol``, all
        of them where no gap of the frequencies is wide enough for the speed.

        Raises
        ------
        BadInput
            If the speed or the number of modes is unusable, or there is no basis of all modes.
        """
        n = self._system.size
        require_whole("count", count, 1, n)
        equation = plain_equation(self._known, speed)
        if self._frequency is None:
            self._frequency = frozen_frequencies(equation)
        frequency = self._frequency
        last: SlowMonodromy | None = None
        least = _WORTH * 2 * np.pi / equation.period * speed
        for k in [*(k for k, gap in gap_choices(frequency, count) if gap > least), n]:
            frames = self._frames(k, equation)
            if frames is None:
                continue
            slow = slow_part(equation, frames)
            rate = float(np.max(frequency[:, k - 1])) / speed
            last = integrated(slow, equation.period, rate, rtol)
            last = replace(last, states=_states(equation, frames, slow))
            if last.residual > 0.3 * rtol:
                left = decoupling_error(slow, last, equation.period)
                last = replace(last, residual=left)
            if last.residual <= 0.3 * rtol:
                break
        if last is None:
            raise bad(
                "system", "no basis of its modes", "a regular mass and stiffness", "check them"
            )
        return last

    def _frames(self, k: int, equation: Equation) -> Frames | None:
        """Return the basis for k slow modes; of one speed where the mass depends on it."""
        if k in self._made:
            return self._made[k]
        frames: Frames | None = None
        try:
            frames = moving_frames(equation, k)
        except BadInput:
            if k == equation.size:
                raise
        if self._shared:
            self._made[k] = frames
        return frames


def frozen_frequencies(equation: Equation) -> Array:
    """Return the frequencies of one equation's frozen modes [rad/s], rising, ``(nt, n)``."""
    squares = equation.frozen_modes(even_angles(equation.period, _ANGLES))[0][0]
    whole = np.broadcast_to(squares, (_ANGLES, equation.size))
    return np.asarray(np.sqrt(np.maximum(whole, 0.0)) * equation.speed[0])


def gap_choices(frequency: Array, fewest: int) -> list[tuple[int, float]]:
    """Return numbers of slow modes from ``fewest`` on with the gap above each [rad/s].

    The gap is the least distance over the angles between the k-th frequency and the next one;
    the rest of the modes follows at no less.
    """
    gaps = np.min(np.diff(frequency, axis=1), axis=0)
    return [(k, float(gaps[k - 1])) for k in range(max(fewest, 1), frequency.shape[1])]


def _states(equation: Equation, frames: Frames, slow: SlowPart) -> Array:
    """Return (q, M q') of the canonical slow coordinates at the stations, ``(ns, 2n, 2k)``."""
    every = slice(None, None, len(frames.theta) // _STATIONS)
    theta, basis, n = frames.theta[every], frames.basis[every], equation.size
    scale, embedding = slow.scale[:, None], slow.embedding[every]
    place = basis @ (scale * embedding[:, :n])
    # The momentum goes with the inverse of the transpose of the basis, which is M times the basis.
    momentum = equation.at("mass", theta)[0] @ basis @ (embedding[:, n:] / scale)
    if "gyroscopic" in equation.fields:
        momentum = momentum - equation.at("gyroscopic", theta)[0] @ place
    return np.concatenate([place, momentum], axis=1)


def decoupling_error(slow: SlowPart, found: SlowMonodromy, period: float) -> float:
    """Return the error of the matrix by incomplete decoupling: what the last pass changed.

    The multipliers of the last pass but one, whose error is larger, are compared, each divided by
    its condition number.  Where the first pass made it worse already there is nothing to compare
    with, and the error is 1.
    """
    if not slow.passes:
        return 1.0
    coarse = np.linalg.eigvals(_stations(slow.before, found.segments, period)[-1])
    values, vectors = np.linalg.eig(found.matrix)
    gap = np.min(np.abs(values[:, None] - coarse), axis=1)
    own = conditions(vectors.astype(complex)[None])[0]
    top = max(float(np.max(np.abs(found.matrix))), 1e-300)
    return float(np.max(gap / np.where(np.isfinite(own), own, 1.0))) / top


def integrated(slow: SlowPart, period: float, rate: float, rtol: float) -> SlowMonodromy:
    """Return the monodromy matrix of one slow part, the segments doubled until it rests."""
    reach = len(interpolated(slow.generator, period).coefficients) - 1
    number = _STATIONS
    while number < max(rate * period / _PHASE, reach / 4):
        number *= 2
    before = _stations(slow.generator, number, period)
    last = 1.0
    while True:
        number *= 2
        fine = _stations(slow.generator, number, period)
        top = float(np.max(np.abs(fine[-1])))
        change = float(np.max(np.abs(fine[-1] - before[-1]))) / top
        gain = float(np.clip(change / last, 1e-3, 1.0)) if change < 1e-3 else 1.0
        stuck = change > 0.25 * last and change < 1e-3
        error = 2 * change if stuck else change * gain
        if error <= 0.3 * rtol or stuck or 2 * number > _MOST_SEGMENTS:
            break
        before, last = fine, change
    return SlowMonodromy(
        matrix=fine[-1],
        stations=fine[:-1],
        segments=number,
        integration=error,
        residual=slow.change,
        rounding=period * slow.rounding + _EPS * (8.0 + 0.5 * number),
    )


def _stations(samples: Array, segments: int, period: float) -> Array:
    """Return the transition matrices from 0 to even angles, the period's end among them."""
    series = interpolated(samples, period)
    step, each, m = period / segments, segments // _STATIONS, samples.shape[-1]

    def generator(theta: Array) -> Array:
        return series(theta)[None]

    stretch = max(1, _BLOCK_FLOATS // (_STAGES * m) ** 2)
    whole = np.eye(m)
    rows = [whole]
    for station in range(_STATIONS):
        for left in range(0, each, stretch):
            first = station * each + left
            angles = step * np.arange(first, first + min(stretch, each - left), dtype=float)
            turned, power = product(gauss_maps(_STAGES, generator, angles, step))
            whole = np.ldexp(turned[0], power[0]) @ whole
        rows.append(whole)
    return np.stack(rows)
