"""Periodic solutions by multiple shooting: Gauss-Legendre collocation round a closed period."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..integrators.gauss_legendre import gauss_maps
from ..periodic.first_order import CanonicalForm
from ..periodic.ring import solve_ring

STAGES = 8
Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
# Phase of the highest mode that a segment of the first try covers; collocation of order 16.
_PHASE = 3.0
_FEWEST = 16
_MOST_SEGMENTS = 2**18
# Angles from which on an unresolved tail of harmonics is told, not chased.
_MANY_ANGLES = 4096
# Times as many segments as at first, beyond which a motion that does not settle is left so.
_GIVE_UP = 16
_BLOCK_FLOATS = 4_000_000
# Segments held at a time, all of their collocation matrices and reflections.
_TOO_MANY = 2**26


@dataclass(frozen=True)
class Orbit:
    """Periodic states of a batch at one number of even angles.

    Attributes
    ----------
    states : ndarray
        Scaled states (q/s, p s) at the left ends of the segments, shape ``(nb, segments, 2n)``.
    error : ndarray
        Largest error of each coordinate over its own peak, shape ``(nb, n)``.
    floor : ndarray
        The part of ``error`` that round-off leaves, shape ``(nb, n)``.
    sensitivity : ndarray
        Relative change of the states over one of the flow, shape ``(nb,)``.
    """

    states: Array
    error: Array
    floor: Array
    sensitivity: Array


def first_segments(form: CanonicalForm) -> NDArray[np.int64]:
    """Return the number of segments to begin with, a power of two for each of the batch.

    Raises
    ------
    BadInput
        If a speed is so low that a period needs too many.
    """
    # Eight angles a segment have to see the highest harmonic twice a wave at the least.
    fewest = max(_FEWEST, form.reach / 4)
    rate = form.needed_rate
    wanted = np.maximum(rate * form.system.period / _PHASE, fewest)
    if np.max(wanted, initial=0.0) > _MOST_SEGMENTS / 4:
        worst = int(np.argmax(wanted))
        raise bad(
            "speed",
            f"{form.speed[worst]:.6g} rad/s, where the highest mode turns through "
            f"{rate[worst] * form.system.period:.3g} rad in a period",
            f"at most {_PHASE * _MOST_SEGMENTS / 4:.3g} rad",
            "raise the speed or leave out the highest modes",
        )
    return np.asarray(2 ** np.ceil(np.log2(wanted)).astype(int), dtype=np.int64)


def periodic_orbits(
    form: CanonicalForm,
    segments: int,
    rtol: float,
    tell: Callable[[int], None] | None = None,
) -> list[tuple[int, Orbit]]:
    """Return the periodic solutions of a batch, refined until each agrees with its forerunner.

    Parameters
    ----------
    form : CanonicalForm
        The forced systems; their generator's last component is the constant 1.
    segments : int
        Segments to begin with, a power of two.
    rtol : float
        Wanted error of each coordinate over its own peak.
    tell : callable, optional
        Told each time how many motions are done.

    Returns
    -------
    list of (int, Orbit)
        One for each of the batch, a batch of one, with its number of segments.
    """
    count, n = len(form.speed), form.system.size
    found: list[tuple[int, Orbit] | None] = [None] * count
    if not count:
        return []
    states, _ = _solved(form, segments)
    before, first = np.ones(count), segments
    open_: NDArray[np.intp] = np.arange(count)
    while len(open_):
        segments *= 2
        part = form.take(open_)
        new, sensitivity = _solved(part, segments)
        peak = _peaks(new[..., :n])
        gap = np.max(np.abs(new[:, ::2, :n] - states[..., :n]), axis=1) / peak
        difference = np.max(gap, axis=-1)
        rounding = _rounding(part, segments) * sensitivity
        largest = np.max(peak, axis=-1, keepdims=True)
        floor = rounding[:, None] * largest / peak
        # The change overestimates the error of the finer result; where it shrinks as fast as the
        # order promises, one more such shrinking is counted on, with a margin.
        gain = np.clip(4 * difference / before[open_], 2.0**-14, 1.0)
        gain[~(difference <= 1e-3)] = 1.0
        error = gap * gain[:, None] + floor
        stuck = (difference > 0.25 * before[open_]) & (difference < 1e-3)
        # So near to a resonance that round-off alone moves the motion about.
        stuck |= (difference > 0.25 * before[open_]) & (segments >= _GIVE_UP * first)
        # Round-off, not truncation, where halving the segments no longer helps.
        error[stuck] += 2 * gap[stuck]
        lost = ~np.isfinite(sensitivity)
        error[lost] = np.inf
        # What round-off alone leaves no number of segments lessens.
        wanted = np.maximum(rtol, 2 * floor)
        done = np.all(error <= wanted, axis=-1) | stuck | lost
        # Coefficients with jumps leave a tail that no affordable number of angles removes.
        error += _tail(new[..., :n], peak)
        done &= np.all(error <= wanted, axis=-1) | stuck | lost | (segments >= _MANY_ANGLES)
        done |= 2 * segments > _MOST_SEGMENTS
        before[open_] = difference
        for place in np.flatnonzero(done):
            one = slice(place, place + 1)
            found[open_[place]] = (
                segments,
                Orbit(new[one], error[one], floor[one], sensitivity[one]),
            )
        open_, states = open_[~done], new[~done]
        if tell is not None:
            tell(count - len(open_))
    return [item for item in found if item is not None]


def _solved(form: CanonicalForm, segments: int) -> tuple[Array, Array]:
    """Return periodic states at the left ends of the segments and the sensitivities."""
    m = form.size
    step = float(form.system.period) / segments
    together = int(np.clip(_TOO_MANY // (segments * 8 * m * m), 1, len(form.speed)))
    stretch = max(1, _BLOCK_FLOATS // ((STAGES * m) ** 2 * together))
    parts = []
    for begin in range(0, len(form.speed), together):
        part = form.take(slice(begin, begin + together))
        maps = np.concatenate(
            [
                gauss_maps(
                    STAGES,
                    part.generator,
                    step * np.arange(left, min(left + stretch, segments), dtype=np.float64),
                    step,
                )
                for left in range(0, segments, stretch)
            ],
            axis=1,
        )
        parts.append(solve_ring(maps[..., :-1, :-1], maps[..., :-1, -1]))
    return np.concatenate([p[0] for p in parts]), np.concatenate([p[1] for p in parts])


def _rounding(form: CanonicalForm, segments: int) -> Array:
    """Return the relative error of the flow that round-off makes in each segment, ``(nb,)``."""
    # Segments round alike where the coefficients rest; the ring's solution feels their sum.
    value: Array = _EPS * (8.0 + 0.5 * form.activity * form.system.period / segments)
    spread: Array = value * np.sqrt(segments)
    return spread


def _peaks(values: Array) -> Array:
    """Return the largest size of each coordinate, at least round-off of the largest of all."""
    peak = np.max(np.abs(values), axis=1)
    largest = np.max(peak, axis=-1, keepdims=True)
    size = np.maximum(peak, _EPS * largest)
    positive: Array = np.where(size > 0, size, 1.0)
    return positive


def _tail(values: Array, peak: Array) -> Array:
    """Return the sum of the upper third of the Fourier amplitudes over the peak, ``(nb, n)``.

    What the interpolation between the angles leaves out is of this size.
    """
    amplitude = np.abs(np.fft.rfft(values, axis=1)) / values.shape[1]
    upper = 2 * amplitude[:, 2 * amplitude.shape[1] // 3 :].sum(axis=1)
    # Round-off of the transform is no tail.
    tail: Array = np.maximum(upper / peak - 4 * _EPS * np.sqrt(values.shape[1]), 0.0)
    return tail
