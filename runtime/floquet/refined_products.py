"""Monodromy matrices by collocation or exponentials, the segments doubled until they rest.

Collocation of order 16 solves a system of eight states in each segment.  Where the coefficients
hardly change while the fastest mode turns once, a product of five exponentials, of order 6, takes
as few segments at a fraction of the work: a few segments, halved, tell beforehand.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.namespaces import any_entry
from ..integrators import METHODS
from ..integrators.protocol import OneStep
from .first_order import CanonicalForm
from .period_products import GAUSS, period_product

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
# Phase that the first try lets pass per segment; collocation of order 16 is then near 1e-9.
PHASE = 3.0
MOST_SEGMENTS = 2**20
_FEWEST = 16
# Segments from which on a difference that does not shrink is believed to stay.
_FAR = 2**14

# Exponentials are thought of from this size of the state and product of segments and members on;
# from a larger size where collocation needs half the unknowns (q' = U p, p' = V q).
_SIZE, _SIZE_APART, _WORTH = 4, 6, 128
# How many times the segments of collocation they may take, as the sum of local errors tells it,
# which is too large by the sixth power of 2 to 3; more from a size on, unless that is so.
_RATIO, _RATIO_LARGE, _LARGE = 5.2, 9.0, 8
# Steps that are halved to tell, and members of a batch.
_PLACES, _MEMBERS = 8, 4
# Strong damping over the other rates, from which exponentials lose digits of what stays.
_STIFF = 2.0

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
    groups = segment_groups(form)
    return gathered(form, ((own, _refined(form.take(own), n, rtol)) for own, n in groups))


def gathered(form: CanonicalForm, parts: Iterable[tuple[NDArray[np.intp], Refined]]) -> Refined:
    """Return the results for a batch from those for parts of it.

    Parameters
    ----------
    form : CanonicalForm
        The batch.
    parts : iterable
        Pairs of the members of a part and its result.
    """
    count, m = len(form.speed), form.size
    scaled, error = np.zeros((count, m, m)), np.zeros(count)
    exponent, segments = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    for own, found in parts:
        scaled[own], exponent[own], error[own], segments[own] = found
    return scaled, exponent, error, segments


def segment_groups(form: CanonicalForm) -> list[tuple[NDArray[np.intp], int]]:
    """Split the batch by the number of segments to begin with, a power of two."""
    # Eight angles a segment have to see the highest harmonic twice a wave at the least.
    fewest = max(_FEWEST, form.reach / 4)
    wanted = np.maximum(form.needed_rate * form.system.period / PHASE, fewest)
    level = np.ceil(np.log2(wanted)).astype(int)
    if np.max(level, initial=0) >= np.log2(MOST_SEGMENTS):
        worst = int(np.argmax(level))
        raise bad(
            "speed",
            f"{form.speed[worst]:.6g} rad/s, where the highest mode turns through "
            f"{form.needed_rate[worst] * form.system.period:.3g} rad in a period",
            f"at most {PHASE * MOST_SEGMENTS / 2:.3g} rad",
            "raise the speed or leave out the highest modes",
        )
    return [(np.flatnonzero(level == value), 2 ** int(value)) for value in np.unique(level)]


def _refined(form: CanonicalForm, first: int, rtol: float) -> Refined:
    """Return the products of a group by whichever method is worth it."""
    times = worth_exponentials(form, first, rtol)
    if not times:
        return _doubled(form, first, rtol, GAUSS)
    value, exponent, error, used = _doubled(form, first, rtol, METHODS["cf6"], times * first)
    lost = np.flatnonzero(~np.isfinite(error))
    if len(lost):
        found = _doubled(form.take(lost), first, rtol, GAUSS)
        value[lost], exponent[lost], error[lost], used[lost] = found
    return value, exponent, error, used


def _doubled(
    form: CanonicalForm, first: int, rtol: float, method: OneStep, most: int = MOST_SEGMENTS
) -> Refined:
    """Double the number of segments until each matrix of the batch agrees with its forerunner.

    Members that will not with ``most`` segments are given up: their error is infinite.
    """
    count, floor = len(form.speed), max(4.0 * 0.5**method.order, 1e-3)
    value, exponent = period_product(form, first, method)
    error = np.full(count, np.inf)
    used = np.full(count, first, dtype=np.int64)
    open_: NDArray[np.intp] = np.arange(count)
    before = np.ones(count)
    number = first
    while len(open_):
        number *= 2
        part = form.take(open_)
        new, power = period_product(part, number, method)
        difference = distance(value[open_], exponent[open_], new, power)
        rounding = rounding_error(part, number)
        # The change overestimates the error of the finer result; where it shrinks as fast as the
        # order promises, one more such shrinking is counted on, with a margin.
        gain = np.clip(difference / before[open_], floor, 1.0)
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
        if most < MOST_SEGMENTS:
            within = rtol * 2.0**method.order if 2 * number <= most else rtol
            lost = ~done & (error[open_] > within)
            error[open_[lost]] = np.inf
            done |= lost
        open_ = open_[~done]
        if 2 * number > MOST_SEGMENTS:
            break
    return value, exponent, error, used


def worth_exponentials(form: CanonicalForm, segments: int, rtol: float) -> int:
    """Return how many times the segments exponentials may take to be worth it; 0 if they are not.

    Segments at a few places are taken whole and in halves; the differences, summed over the
    period, tell how many segments order 6 needs.
    """
    if form.size < _SIZE or segments * len(form.speed) < _WORTH:
        return 0
    if np.any(form.rate > _STIFF * form.needed_rate):
        return 0
    count = len(form.speed)
    tried = form.take(np.linspace(0, count - 1, min(count, _MEMBERS)).astype(np.intp))
    step = float(form.system.period) / segments
    left = form.system.period * (np.arange(_PLACES) + 0.37) / _PLACES
    values, n = tried.generator(left), form.system.size
    apart = not any_entry(values[..., :n, :n]) and not any_entry(values[..., n:, n:])
    if apart and form.size < _SIZE_APART:
        return 0
    method = METHODS["cf6"]
    whole = method.maps(tried.generator, left, step)
    halves = method.maps(tried.generator, (left[:, None] + [0.0, step / 2]).ravel(), step / 2)
    gap = np.max(np.abs(whole - halves[:, 1::2] @ halves[:, 0::2]), axis=(-2, -1))
    local = float(np.max(np.mean(gap / np.max(np.abs(whole), axis=(-2, -1)), axis=1)))
    large = form.size >= _LARGE and not apart
    ratio = _RATIO_LARGE if large else _RATIO
    # An error below that of round-off is as good as none.
    wanted = max(rtol, float(np.max(rounding_error(tried, segments))))
    if not 4.0 * local * segments <= wanted * ratio**method.order:
        return 0
    return 4 if large else 2


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
