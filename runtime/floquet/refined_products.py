"""Monodromy matrices by collocation, the segments doubled until they rest."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import bad
from .first_order import CanonicalForm
from .period_products import period_product

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
# Phase that the first try lets pass per segment; collocation of order 16 is then near 1e-9.
PHASE = 3.0
_MOST_SEGMENTS = 2**20
_FEWEST = 16
# Segments from which on a difference that does not shrink is believed to stay.
_FAR = 2**14

Refined = tuple[Array, NDArray[np.int64], Array, NDArray[np.int64]]


def refined_products(form: CanonicalForm, rtol: float) -> Refined:
    """Return scaled monodromy matrices of a batch, powers of two, errors and segments.

    Parameters
    ----------
    form : CanonicalForm
        The systems, ``nb`` of them.
    rtol : float
        Wanted largest error of an entry over the largest entry.

    Raises
    ------
    BadInput
        If more than a million segments would be needed.
    """
    count, m = len(form.speed), form.size
    scaled, exponent = np.zeros((count, m, m)), np.zeros(count, dtype=np.int64)
    error, segments = np.zeros(count), np.zeros(count, dtype=np.int64)
    for group, first in _groups(form):
        part = form.take(group)
        scaled[group], exponent[group], error[group], segments[group] = _refined(part, first, rtol)
    return scaled, exponent, error, segments


def _groups(form: CanonicalForm) -> list[tuple[NDArray[np.intp], int]]:
    """Split the batch by the number of segments to begin with, a power of two."""
    # Eight angles a segment have to see the highest harmonic twice a wave at the least.
    fewest = max(_FEWEST, form.reach / 4)
    wanted = np.maximum(form.needed_rate * form.system.period / PHASE, fewest)
    level = np.ceil(np.log2(wanted)).astype(int)
    if np.max(level, initial=0) >= np.log2(_MOST_SEGMENTS):
        worst = int(np.argmax(level))
        raise bad(
            "speed",
            f"{form.speed[worst]:.6g} rad/s, where the highest mode turns through "
            f"{form.needed_rate[worst] * form.system.period:.3g} rad in a period",
            f"at most {PHASE * _MOST_SEGMENTS / 2:.3g} rad",
            "raise the speed or leave out the highest modes",
        )
    return [(np.flatnonzero(level == value), 2 ** int(value)) for value in np.unique(level)]


def _refined(form: CanonicalForm, first: int, rtol: float) -> Refined:
    """Double the number of segments until each matrix of the batch agrees with its forerunner."""
    count = len(form.speed)
    value, exponent = period_product(form, first)
    error = np.full(count, np.inf)
    used = np.full(count, first, dtype=np.int64)
    open_: NDArray[np.intp] = np.arange(count)
    before = np.ones(count)
    number = first
    while len(open_):
        number *= 2
        part = form.take(open_)
        new, power = period_product(part, number)
        difference = distance(value[open_], exponent[open_], new, power)
        rounding = rounding_error(part, number)
        # The change overestimates the error of the finer result; where it shrinks as fast as the
        # order promises, one more such shrinking is counted on, with a margin.
        gain = np.clip(difference / before[open_], 1e-3, 1.0)
        gain[difference > 1e-3] = 1.0
        error[open_] = difference * gain + rounding
        value[open_], exponent[open_], used[open_] = new, power, number
        # Round-off, not truncation, where halving the segments no longer helps.
        stuck = (difference > 0.25 * before[open_]) & (difference < 1e-3)
        if number >= max(_FAR, 64 * first):
            # Nothing is gained any more, and much is left: a mass that is hardly definite.
            stuck |= difference > 0.5 * before[open_]
        error[open_[stuck]] += 2 * difference[stuck]
        done = (error[open_] <= rtol) | stuck
        before[open_] = difference
        open_ = open_[~done]
        if 2 * number > _MOST_SEGMENTS:
            break
    return value, exponent, error, used


def rounding_error(form: CanonicalForm, segments: int | NDArray[np.int64]) -> Array:
    """Return the error of the scaled matrices that round-off makes, shape ``(nb,)``."""
    # Where the coefficients rest, all segments round alike, so that their errors add up.
    steps = 8.0 + 0.5 * segments
    value: Array = _EPS * (steps + 0.5 * form.activity * form.system.period)
    return value


def distance(
    first: Array, first_power: NDArray[np.int64], second: Array, second_power: NDArray[np.int64]
) -> Array:
    """Return the largest difference of entries over the largest entry of the second."""
    shift = np.clip(first_power - second_power, -1000, 1000)
    aligned = np.ldexp(first, shift[:, None, None])
    top = np.max(np.abs(second), axis=(-2, -1))
    distance: Array = np.max(np.abs(aligned - second), axis=(-2, -1)) / top
    return np.where(np.isfinite(distance), distance, 1.0)
