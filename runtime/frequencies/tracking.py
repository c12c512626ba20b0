"""Following modes over the crank angle: which curve a frequency belongs to.

Labels change at crossings alone, so that tracking is finding the crossings.  They are where shapes
of neighbouring rank swap from one angle to the next; angles are added until the assignment of
shapes is clear, and every swap, and every least gap, is looked at closely.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .eigenproblem import HeldModes, assurance
from .encounters import Arrays, Encounter, Modes, describe, least_gap

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Assurance from which a shape is taken for the same as at the next angle.
CLEAR = 0.9
_INTERVALS = 96
# The even angles begin here, in intervals: symmetric mechanisms meet at round angles, where shapes
# of equal frequency are arbitrary.
_OFFSET = 0.2718281828
_MOST_ANGLES = 20000
# Intervals narrower than this, over the period, are not divided; from the other on three and more
# frequencies are taken to meet at one angle.
_NARROWEST = 1e-11
_TIGHT = 1e-7
# A least gap is a veering where two modes trade shapes with each other within this much of the
# period; else it is but a gap.
_TRADE = 0.5
_WIDEST = 0.125
# An encounter this close to the last one, over the period, is the same.
_SAME = 1e-9


@dataclass(frozen=True)
class Walk:
    """A turn of the crank with all encounters of the lowest modes.

    Attributes
    ----------
    encounters : tuple of Encounter
        By angle.
    theta : ndarray
        Crank angles that it took [rad].
    assured : float
        Least assurance of a shape between neighbouring angles.
    """

    encounters: tuple[Encounter, ...]
    theta: Array
    assured: float


def walk(modes: Modes, arrays: Arrays, period: float, count: int) -> Walk:
    """Return a turn of the crank with the encounters of the lowest ``count`` modes.

    Parameters
    ----------
    modes : callable
        Crank angles ``(nt,)`` to frequencies and shapes.
    arrays : callable
        Crank angles to M and K.
    period : float
        Period [rad].
    count : int
        Number of modes.
    """
    step = period / _INTERVALS
    theta = np.asarray(step * (np.arange(_INTERVALS + 1) + _OFFSET), dtype=np.float64)
    held = modes(theta)
    while True:
        theta, held, swaps, assured = _divided(modes, theta, held, period, count)
        found = _swapped(modes, arrays, theta, swaps, period)
        more, hidden = _narrows(modes, arrays, theta, held, count, period, found)
        if not len(hidden) or len(theta) + len(hidden) > _MOST_ANGLES:
            break
        theta, held = _with(modes, theta, held, hidden)
    found += more
    # Where several meet at one angle their order counts.
    found.sort(key=lambda one: one.angle)
    return Walk(tuple(found), theta, assured)


Swaps = list[tuple[int, tuple[int, ...]]]


def _divided(
    modes: Modes, theta: Array, held: HeldModes, period: float, count: int
) -> tuple[Array, HeldModes, Swaps, float]:
    """Return angles among which each assignment of shapes is clear, and the swaps between them."""
    while True:
        width = np.diff(theta)
        unclear, swaps, assured = _status(held, count, width <= _TIGHT * period)
        wide = unclear & (width > _NARROWEST * period)
        new = 0.5 * (theta[:-1] + theta[1:])[wide]
        if not len(new) or len(theta) + len(new) > _MOST_ANGLES:
            return theta, held, swaps, assured
        theta, held = _with(modes, theta, held, new)


def _swapped(
    modes: Modes, arrays: Arrays, theta: Array, swaps: Swaps, period: float
) -> list[Encounter]:
    """Return the encounters at which neighbours in rank swap their shapes."""
    out = []
    for index, ranks in swaps:
        low, high = theta[index], theta[index + 1]
        if len(ranks) == len({*ranks}) and all(k + 1 not in ranks for k in ranks):
            out += [_looked_at(modes, arrays, low, high, k, period) for k in ranks]
            continue
        # Several meet at once: one angle for all, in the order of the swaps.
        angle, doubt = least_gap(modes, float(low), float(high), ranks[0])
        out += [describe(modes, arrays, angle, doubt, k, period) for k in ranks]
    return out


def _looked_at(
    modes: Modes, arrays: Arrays, low: float, high: float, rank: int, period: float
) -> Encounter:
    angle, doubt = least_gap(modes, float(low), float(high), rank)
    return describe(modes, arrays, angle, doubt, rank, period)


def _with(modes: Modes, theta: Array, held: HeldModes, new: Array) -> tuple[Array, HeldModes]:
    """Return angles and modes with more of them, in order."""
    more = modes(new)
    joined = np.concatenate([theta, new])
    order = np.argsort(joined, kind="stable")
    parts = [
        np.concatenate([getattr(held, name), getattr(more, name)])[order]
        for name in ("frequency", "shape", "mass", "error")
    ]
    return joined[order], HeldModes(*parts)


def _status(
    held: HeldModes, count: int, tight: NDArray[np.bool_]
) -> tuple[NDArray[np.bool_], Swaps, float]:
    """Return which intervals are unclear, the swaps of the clear ones, and the least assurance.

    Where three and more meet, only a tight interval is taken for clear.
    """
    from scipy.optimize import linear_sum_assignment

    mac = assurance(held.shape[:-1], held.shape[1:], 0.5 * (held.mass[:-1] + held.mass[1:]))
    own = np.diagonal(mac, axis1=-2, axis2=-1)[:, :count]
    plain = np.all(own >= CLEAR, axis=1)
    unclear = np.zeros(len(mac), dtype=bool)
    swaps: Swaps = []
    least = float(np.min(own[plain], initial=1.0))
    # Frequencies that agree to round-off at both ends leave their shapes open; order stands.
    same = held.frequency[:, 1:] - held.frequency[:, :-1] <= 4 * held.error[:, 1:]
    both = same[:-1] & same[1:]
    for index in np.flatnonzero(~plain):
        _, matched = linear_sum_assignment(-mac[index])
        low = np.flatnonzero((np.arange(len(matched)) < count) | (matched < count))
        open_ = np.append(both[index], False) | np.insert(both[index], 0, False)
        value = mac[index, low, matched[low]][~open_[low]]
        ranks = _neighbour_swaps(matched, low)
        single = all(abs(int(matched[k]) - k) <= 1 for k in low)
        if np.any(value < CLEAR) or not (single or tight[index]):
            unclear[index] = True
            continue
        least = min(least, float(np.min(value, initial=1.0)))
        kept = tuple(k for k in ranks if not both[index, k])
        if kept:
            swaps.append((int(index), kept))
    return unclear, swaps, least


def _neighbour_swaps(matched: Indices, low: Indices) -> tuple[int, ...]:
    """Return the swaps of neighbours, by lower rank and in order, that make an assignment.

    Ranks above those of concern are taken in the order in which they stand.
    """
    rows = np.union1d(low, matched[low])
    target = np.argsort(np.argsort(matched[rows], kind="stable"), kind="stable")
    order, swaps = list(target), []
    for _ in range(len(order)):
        for k in range(len(order) - 1):
            if order[k] > order[k + 1]:
                order[k], order[k + 1] = order[k + 1], order[k]
                swaps.append(int(rows[k]))
    return tuple(swaps)


def _narrows(
    modes: Modes,
    arrays: Arrays,
    theta: Array,
    held: HeldModes,
    count: int,
    period: float,
    known: list[Encounter],
) -> tuple[list[Encounter], Array]:
    """Return the veerings among the least gaps, and angles to add about crossings not yet seen."""
    out: list[Encounter] = []
    hidden: list[float] = []
    size = held.frequency.shape[-1]
    for rank in range(min(count, size - 1)):
        gap = held.frequency[:, rank + 1] - held.frequency[:, rank]
        # The last angle is the first one, a turn later.
        ring = gap[:-1]
        dips = np.flatnonzero((ring < np.roll(ring, 1)) & (ring <= np.roll(ring, -1)))
        for k in dips:
            low = theta[k - 1] if k else theta[-2] - period
            before, here, after = gap[k - 1] if k else gap[-2], gap[k], gap[k + 1]
            rise = max(before, after) ** 2 - here**2
            if here**2 * (theta[k + 1] - low) ** 2 > (2 * _WIDEST * period) ** 2 * rise:
                continue
            found = _looked_at(modes, arrays, low, theta[k + 1], rank, period)
            near = [
                one
                for one in (*known, *out)
                if one.lower == rank + 1
                and abs((one.angle - found.angle + period / 2) % period - period / 2)
                < _SAME * period + 0.25 * one.width
            ]
            trades = found.trade > _TRADE and found.width < _WIDEST * period
            if near:
                continue
            if found.kind == "veering" and trades:
                out.append(found)
            elif found.kind == "crossing" and theta[k + 1] - low > _TIGHT * period:
                # Two crossings between neighbouring angles, or one that only touches.
                angle = low + (found.angle - low) % period
                hidden += [angle - 0.05 * (angle - low), angle + 0.05 * (theta[k + 1] - angle)]
    return out, np.array(hidden)
