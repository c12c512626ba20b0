"""Harmonic balance of a stiff system: the balance of its slow modes steers that of all freedoms.

The equation of every coordinate is balanced at as many even angles as its motion has harmonics, by
Krylov's method: each step answers what is left over by the slow and the fast modes apart, which is
near to the truth, so that a few steps do whatever the number of freedoms.  Between those angles
the full equation is looked at as well: what it leaves there tells the error.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..periodic.first_order import CanonicalForm
from ..simulation.second_order import even_count
from .request import peaks, resampled
from .slow_modes import slow_modes
from .speed_parts import speed_parts
from .steering import Equation, Steering

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
# Freedoms from which on the balance is steered.
_FEWEST = 6
# Numbers of angles that are balanced, odd and of small factors.
_LADDER = (
    *(27, 33, 39, 45, 55, 65, 77, 91, 105, 125, 147, 175, 209, 245, 297),
    *(351, 429, 525, 637, 775, 945, 1155, 1425),
)
# How many to begin with, and unknowns of the slow modes up to which there are more.
_FIRST = 65
_MOST_UNKNOWNS = 4000
# Angles of the coefficients from which on they are not smooth.
_ROUGH = 4096
# Steps of Krylov's method before it starts anew, how often it does, and by how much it has to
# lessen what is left for that to be worth while.
_STEPS = 24
_STARTS = 6
_GAIN = 0.25
# Largest change, over the motion, by another step of what passes for solved to round-off.
_SETTLED = 1e-5
# An error below which, and a part of the error before above which, it is round-off.
_SMALL = 1e-6
_STUCK = 0.3
# Change by another step over the wanted error.
_SHARE = 0.02
# Of what the harmonics left out amount to, by one answer to the full residual: of a coordinate's
# own, and of the largest of all, over the peaks, since an answer may pass a coordinate by.
_MARGIN = 5.0
_OTHERS = 0.3


@dataclass(frozen=True)
class Steered:
    """A balanced motion.

    Attributes
    ----------
    motion : ndarray
        q at the angles balanced, shape ``(nt, n)``.
    rounding : ndarray
        What another step would change, each coordinate, absolute, shape ``(n,)``.
    beyond : ndarray
        What the harmonics left out amount to, by the full residual at all angles, ``(n,)``.
    condition : float
        Condition number of the balance of the slow modes.
    settled : bool
        Whether the steps have come to an end.
    """

    motion: Array
    rounding: Array
    beyond: Array
    condition: float
    settled: bool


def steered(steering: Steering, start: Array | None, rtol: float) -> Steered:
    """Solve the balance of all coordinates.

    Parameters
    ----------
    steering : Steering
        Its equation, and what answers a residual.
    start : ndarray or None
        A motion at any even angles to begin with.
    rtol : float
        Wanted change of each coordinate by another step, over its own peak.
    """
    eq = steering.coarse
    count, n = eq.force.shape
    motion = np.zeros((count, n)) if start is None else resampled(start, count)
    if not np.isfinite(steering.condition):
        nothing = np.full(n, np.inf)
        return Steered(motion * np.nan, nothing, nothing, np.inf, True)
    before, settled = np.inf, False
    for _ in range(_STARTS):
        change = steering.answer(eq.force - eq.left(motion))
        size = peaks(motion + change)
        left = float(np.max(np.max(np.abs(change), axis=0) / size))
        if left <= rtol or left > _GAIN * before or not np.isfinite(left):
            settled = left <= max(rtol, _SETTLED)
            motion = motion + change
            break
        before = left
        motion = motion + _krylov(steering, change, size, 0.1 * rtol / left)
    # Not NaN where a step was: what is unusable shows in what another would change.
    rounding = np.max(np.abs(steering.answer(eq.force - eq.left(motion))), axis=0)
    fine = steering.fine
    between = steering.beyond(fine.force - fine.left(resampled(motion, len(fine.force))))
    beyond = np.max(np.abs(between), axis=0)
    return Steered(motion, rounding, beyond, steering.condition, settled)


def _krylov(steering: Steering, right: Array, size: Array, wanted: float) -> Array:
    """Solve the answered equation by least residuals (GMRES), coordinates over their peaks."""
    shape = right.shape
    first = (right / size).ravel()
    norm = float(np.linalg.norm(first))
    wanted = float(np.clip(wanted, 16 * _EPS, 0.1))
    basis = np.empty((_STEPS + 1, len(first)))
    basis[0] = first / norm
    across = np.zeros((_STEPS + 1, _STEPS))
    target = np.zeros(_STEPS + 1)
    target[0] = norm
    weights: Array = np.zeros(0)
    for k in range(_STEPS):
        moved = steering.coarse.left(basis[k].reshape(shape) * size)
        image = (steering.answer(moved) / size).ravel()
        for _ in range(2):
            share = basis[: k + 1] @ image
            image = image - share @ basis[: k + 1]
            across[: k + 1, k] += share
        across[k + 1, k] = np.linalg.norm(image)
        table = across[: k + 2, : k + 1]
        weights = np.asarray(np.linalg.lstsq(table, target[: k + 2], rcond=None)[0], dtype=float)
        left = float(np.linalg.norm(target[: k + 2] - table @ weights))
        if left <= wanted * norm or across[k + 1, k] <= _EPS * norm:
            break
        basis[k + 1] = image / across[k + 1, k]
    total: Array = np.asarray(weights, dtype=float) @ basis[: len(weights)]
    found: Array = total.reshape(shape) * size
    return found


@dataclass(frozen=True)
class Balanced:
    """A motion with as many harmonics as it needs.

    Attributes
    ----------
    motion : ndarray
        q at even angles, an odd number of them, shape ``(nt, n)``.
    error : ndarray
        Of each coordinate over its own peak, ``(n,)``.
    rounding : ndarray
        The part of it that round-off leaves, absolute, ``(n,)``.
    condition : float
        Condition number of the balance of the slow modes.
    """

    motion: Array
    error: Array
    rounding: Array
    condition: float

    @property
    def absolute(self) -> Array:
        """Error of each coordinate, ``(n,)``."""
        return self.error * peaks(self.motion)


def balanced_slowly(form: CanonicalForm, rtol: float, first: int | None) -> Balanced | None:
    """Return the balanced motion of a stiff system.

    Parameters
    ----------
    form : CanonicalForm
        A batch of one.
    rtol : float
        Wanted error of each coordinate over its own peak.
    first : int or None
        Number of angles to begin with.

    Returns
    -------
    Balanced or None
        None where there are no slow modes apart from fast ones, or they do not steer.
    """
    if form.system.size < _FEWEST or even_count(form.system) >= _ROUGH:
        return None
    count = _rung(first or _FIRST)
    known: Balanced | None = None
    while True:
        steering = _steering(form, count)
        if steering is None:
            return known
        found = steered(steering, None if known is None else known.motion, _SHARE * rtol)
        if not found.settled:
            return known
        before, known = known, _judged(found)
        worst = float(np.max(known.error))
        if before is not None and _STUCK * float(np.max(before.error)) < worst < _SMALL:
            # What more harmonics do not lessen is round-off, of the coefficients for one.
            return replace(known, rounding=np.maximum(known.rounding, known.absolute))
        floor = known.rounding / peaks(known.motion)
        ended = bool(np.all(known.error <= np.maximum(rtol, 2 * floor)))
        if ended or count >= _LADDER[-1] or not np.isfinite(worst):
            return known
        count = _rung(count + max(2.0, _short(known.motion, worst / rtol)))


def _rung(least: float) -> int:
    """Return the least number of angles of the ladder that is not below one."""
    return next((rung for rung in _LADDER if rung >= least), _LADDER[-1])


def _short(motion: Array, excess: float) -> float:
    """Return how many angles a motion is short of, by how its series falls off.

    Parameters
    ----------
    motion : ndarray, shape (nt, n)
        The motion.
    excess : float
        Its error over the wanted one.
    """
    waves = np.abs(np.fft.rfft(motion, axis=0)) / peaks(motion)
    top = len(waves) - 1
    size = np.max(waves, axis=1)
    ends = [float(np.max(size[k - 3 : k + 1])) for k in (top // 2 + 1, top)]
    rate = np.log(ends[0] / max(ends[1], 1e-300)) / (top - top // 2 - 1)
    # Not much farther at a time than there is anything known.
    return float(np.clip(2.0 * np.log(excess) / max(rate, 1e-3), 0.0, 0.6 * len(motion)))


def _steering(form: CanonicalForm, count: int) -> Steering | None:
    """Return what steers the balance at so many angles; None where nothing does."""
    speed = float(form.speed[0])
    nu = 2 * np.pi / form.system.period
    every = max(2, -(-even_count(form.system) // count))
    parts = speed_parts(form, every * count)
    modes = slow_modes(form, parts, every * count, nu * speed * (count // 2))
    if modes is None or modes.shapes.shape[-1] * count > _MOST_UNKNOWNS:
        return None
    return Steering(Equation.at(parts, speed, every * count, nu), modes, every, speed)


def _judged(found: Steered) -> Balanced:
    """Return a balanced motion with its error."""
    size = peaks(found.motion)
    # Coefficients are rounded as well, which the equations themselves do not show.
    doubt = _MARGIN * _EPS * np.sqrt(found.condition) if np.isfinite(found.condition) else np.inf
    rounding = _MARGIN * found.rounding + doubt * size
    beyond = found.beyond / size
    error = _MARGIN * beyond + _OTHERS * np.max(beyond) + rounding / size
    return Balanced(found.motion, np.nan_to_num(error, nan=np.inf), rounding, found.condition)
