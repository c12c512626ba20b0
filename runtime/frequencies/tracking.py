"""Modes followed over the crank angle: crossings, veerings, and the curves between them.

Labels change at crossings alone, so that tracking is finding the crossings.  They are where shapes
of neighbouring rank swap from one angle to the next; angles are added until the assignment of
shapes is clear, and every swap, and every least gap, is examined.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..core.maxima import narrowed
from .held import HeldCrank, HeldModes, assurance

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Encounter:
    """Two neighbouring natural frequencies that cross or veer away from each other.

    Near it the squares differ by ``sqrt(gap^2 + slope^2 (theta - angle)^2)``.  A crossing has no
    gap beyond round-off: each shape goes on along its own curve, and width, coupling, curvature and
    trade are 0.  At a veering the curves stay apart and the modes trade their shapes.
    """

    kind: Literal["crossing", "veering"]
    lower: int  # rank of the lower frequency, from 1
    angle: float  # crank angle of the least gap [rad], within the period
    frequency: float  # mean of the two frequencies there [rad/s]
    gap: float  # their least difference [rad/s]
    gap_error: float  # round-off of it [rad/s]: a gap below is none
    slope: float  # difference of the slopes of the two curves away from it [rad/s per rad]
    width: float  # ``gap/slope`` [rad]: within so much of the angle the shapes trade
    # Rate [rad per rad] at which the two shapes turn into each other at the angle, ``|u_2^T (K' -
    # omega_1^2 M') u_1| / (omega_2^2 - omega_1^2)``.
    coupling: float
    # What the coupling adds to the second derivative of the upper frequency, and takes from the
    # lower [rad/s per rad^2].
    curvature: float
    trade: float  # ``2 coupling width``: 1 where two modes veer and no third takes part


def least_gap(crank: HeldCrank, low: float, high: float, rank: int) -> tuple[float, float]:
    """Return the angle of the least gap above a rank (from 0) within a bracket, and its doubt."""

    def closeness(theta: Array) -> Array:
        frequency = crank.modes(theta[0]).frequency
        return (frequency[:, rank] - frequency[:, rank + 1])[None]

    # About a veering the gap is flat; down to a crossing it falls to nothing.
    (left,), (right,) = narrowed(closeness, np.array([low]), np.array([high]), 26, flat=1e-9)
    return float(0.5 * (left + right)), float(right - left)


def describe(crank: HeldCrank, angle: float, doubt: float, rank: int) -> Encounter:
    """Return the record of the least gap above a rank (from 0), known to be at an angle."""
    period = crank.system.period
    at = crank.modes(np.array([angle]))
    one, two = at.frequency[0, rank : rank + 2]
    gap, frequency = float(two - one), 0.5 * float(one + two)
    step = 1e-3 * period / (2.0 * np.pi)
    # ``|u_2^T (K' - omega_1^2 M') u_1|`` by differences of the fourth order.
    weight = np.array([1.0, -8.0, 8.0, -1.0]) / (12.0 * step)
    mass, stiffness = crank.arrays(angle + step * np.array([-2.0, -1.0, 1.0, 2.0]))
    change = np.tensordot(weight, stiffness - one**2 * mass, axes=1)
    turning = float(abs(at.shape[0, :, rank + 1] @ change @ at.shape[0, :, rank]))
    rate = turning / max(two**2 - one**2, float(np.finfo(float).eps) * two**2)
    # Over a part of what the shapes need to trade the square of the gap is a parabola.
    reach = min(0.25 / rate, step) if rate > 0.0 else step
    around = crank.modes(angle + reach * np.array([-1.0, 0.0, 1.0]))
    square = (around.frequency[:, rank + 1] - around.frequency[:, rank]) ** 2
    slope = float(np.sqrt(max((square[0] + square[2]) / 2.0 - square[1], 0.0)) / reach)
    # Gaps smaller than so many round-offs are none.
    gap_error = 8.0 * float(np.max(around.error[:, rank : rank + 2]))
    # At a veering the gap is flat, and hardly wrong for the angle's doubt.
    drift = slope * doubt
    gap_error += min(drift, drift**2 / gap) if gap > 0.0 else drift
    crossing = gap <= gap_error
    width = 0.0 if crossing or not slope > 0.0 else gap / slope
    coupling = 0.0 if crossing else float(rate)
    return Encounter(
        kind="crossing" if crossing else "veering",
        lower=rank + 1,
        angle=angle % period,
        frequency=frequency,
        gap=gap,
        gap_error=gap_error,
        slope=slope,
        width=width,
        coupling=coupling,
        curvature=turning * coupling / frequency,
        trade=2.0 * coupling * width,
    )


Indices = NDArray[np.int64]

# Assurance from which a shape is taken for the same as at the next angle.
CLEAR = 0.9
_INTERVALS = 96
_MOST_ANGLES = 20000
# In intervals this narrow, over the period, three and more frequencies are taken to meet at one
# angle; those a ten thousandth as wide are not divided.
_TIGHT = 1e-7
# A least gap is a veering where two modes trade shapes with each other within this much of the
# period; else it is but a gap.
_WIDEST = 0.125


@dataclass(frozen=True)
class Walk:
    """A turn of the crank with all encounters of the lowest modes."""

    encounters: tuple[Encounter, ...]  # by angle
    theta: Array  # crank angles that it took [rad]
    assured: float  # least assurance of a shape between neighbouring angles


def walk(crank: HeldCrank, count: int) -> Walk:
    """Return a turn of the crank with the encounters of the lowest ``count`` modes."""
    step = crank.system.period / _INTERVALS
    # Not from 0: symmetric mechanisms meet at round angles, where shapes of equal frequency are
    # arbitrary.
    theta = np.asarray(step * (np.arange(_INTERVALS + 1) + 0.2718281828), dtype=np.float64)
    held = crank.modes(theta)
    while True:
        theta, held, swaps, assured = _divided(crank, theta, held, count)
        found = _swapped(crank, theta, swaps)
        more, hidden = _narrows(crank, theta, held, count, found)
        if not len(hidden) or len(theta) + len(hidden) > _MOST_ANGLES:
            break
        theta, held = _with(crank, theta, held, hidden)
    found += more
    # Where several meet at one angle their order counts.
    found.sort(key=lambda one: one.angle)
    return Walk(tuple(one for one in found if one.lower <= count), theta, assured)


Swaps = list[tuple[int, tuple[int, ...]]]


def _divided(
    crank: HeldCrank, theta: Array, held: HeldModes, count: int
) -> tuple[Array, HeldModes, Swaps, float]:
    """Return angles among which each assignment of shapes is clear, and the swaps between them."""
    tight = _TIGHT * crank.system.period
    while True:
        width = np.diff(theta)
        unclear, swaps, assured = _status(held, count, width <= tight)
        wide = unclear & (width > 1e-4 * tight)
        new = 0.5 * (theta[:-1] + theta[1:])[wide]
        if not len(new) or len(theta) + len(new) > _MOST_ANGLES:
            return theta, held, swaps, assured
        theta, held = _with(crank, theta, held, new)


def _swapped(crank: HeldCrank, theta: Array, swaps: Swaps) -> list[Encounter]:
    """Return the encounters at which neighbours in rank swap their shapes."""
    out = []
    for index, ranks in swaps:
        apart = len(ranks) == len({*ranks}) and all(k + 1 not in ranks for k in ranks)
        # Of several that meet at once there is one angle for all, in the order of the swaps.
        for group in [(k,) for k in ranks] if apart else [ranks]:
            at = least_gap(crank, float(theta[index]), float(theta[index + 1]), group[0])
            out += [describe(crank, *at, k) for k in group]
    return out


def _with(crank: HeldCrank, theta: Array, held: HeldModes, new: Array) -> tuple[Array, HeldModes]:
    """Return angles and modes with more of them, in order."""
    joined = np.concatenate([theta, new])
    order = np.argsort(joined, kind="stable")
    parts = (np.concatenate(pair)[order] for pair in zip(held, crank.modes(new), strict=True))
    return joined[order], HeldModes(*parts)


def _status(
    held: HeldModes, count: int, tight: NDArray[np.bool_]
) -> tuple[NDArray[np.bool_], Swaps, float]:
    """Return which intervals are unclear, the swaps of the clear ones, and the least assurance."""
    # Where three and more meet, only a tight interval is taken for clear.
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
    """Return the swaps of neighbours, by lower rank and in order, that make an assignment."""
    # Ranks above those of concern are taken in the order in which they stand.
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
    crank: HeldCrank, theta: Array, held: HeldModes, count: int, known: list[Encounter]
) -> tuple[list[Encounter], Array]:
    """Return the veerings among the least gaps, and angles to add about crossings not yet seen."""
    out: list[Encounter] = []
    hidden: list[float] = []
    size, period = crank.system.size, crank.system.period
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
            at = least_gap(crank, float(low), float(theta[k + 1]), rank)
            found = describe(crank, *at, rank)
            # An encounter this close to the last one, over the period, is the same.
            near = [
                one
                for one in (*known, *out)
                if one.lower == rank + 1
                and abs((one.angle - found.angle + period / 2) % period - period / 2)
                < 1e-9 * period + 0.25 * one.width
            ]
            trades = found.trade > 0.5 and found.width < _WIDEST * period
            if near:
                continue
            if found.kind == "veering" and trades:
                out.append(found)
            elif found.kind == "crossing" and theta[k + 1] - low > _TIGHT * period:
                # Two crossings between neighbouring angles, or one that only touches.
                angle = low + (found.angle - low) % period
                hidden += [angle - 0.05 * (angle - low), angle + 0.05 * (theta[k + 1] - angle)]
    return out, np.array(hidden)


# Shapes at a crossing are taken this far from it, over the period: there any mixture is one.
_ASIDE = 1e-7


@dataclass(frozen=True)
class Curves:
    """Which curve each rank belongs to; curves are numbered from 0 by rank at a first angle."""

    path: Walk  # a turn with its crossings
    start: float  # first angle [rad]
    # numbers of ranks, and of requested curves
    size: int
    count: int
    period: float  # [rad]

    @cached_property
    def _passed(self) -> tuple[Array, Indices]:
        """Angles of the crossings after the first angle, and the labels between them."""
        crossings = [one for one in self.path.encounters if one.kind == "crossing"]
        after = np.array([(one.angle - self.start) % self.period for one in crossings])
        order = np.argsort(after, kind="stable")
        label = [np.arange(self.size)]
        for index in order:
            new = label[-1].copy()
            k = crossings[index].lower - 1
            new[[k, k + 1]] = new[[k + 1, k]]
            label.append(new)
        return after[order], np.stack(label)

    @property
    def highest(self) -> int:
        """Highest rank, from 0, that a requested curve reaches."""
        _, label = self._passed
        ranks = np.argsort(label, axis=1)
        return int(np.max(ranks[:, : self.count]))

    @property
    def closure(self) -> Indices:
        """Which curve each requested one becomes after a whole turn."""
        # The curve that ends at rank r goes on as the curve that begins there.
        ranks: Indices = np.argsort(self._passed[1][-1])
        return ranks[: self.count]

    @property
    def turns(self) -> int:
        """Whole turns after which every requested curve has come back."""
        step = at = np.argsort(self._passed[1][-1])
        found = 1
        while np.any(at[: self.count] != np.arange(self.count)):
            at, found = step[at], found + 1
        return found

    def labels(self, theta: Array) -> Indices:
        """Return the curve at each rank at crank angles, ``(nt, size)``."""
        after, label = self._passed
        turns = np.floor((theta - self.start) / self.period).astype(int)
        rest = theta - self.start - turns * self.period
        out = label[np.searchsorted(after, rest, side="right")]
        begun = label[-1]
        for turn in np.unique(turns[turns != 0]):
            step = begun if turn > 0 else np.argsort(begun)
            whole = np.arange(self.size)
            for _ in range(abs(int(turn))):
                whole = step[whole]
            rows = turns == turn
            out[rows] = whole[out[rows]]
        return out

    def follow(self, theta: Array, values: Array) -> Array:
        """Return values by rank ``(nt, size)`` along the requested curves, ``(nt, count)``."""
        ranks = np.argsort(self.labels(theta), axis=1)[:, : self.count]
        return np.take_along_axis(values, ranks, axis=1)


def followed_shapes(crank: HeldCrank, curves: Curves, theta: Array) -> tuple[Array, Array]:
    """Return shapes along the curves, ``(nt, n, count)``, and their sign after a turn.

    Their sign is steady within a turn from the first angle on.
    """
    period = curves.period
    turns = np.floor((theta - curves.start) / period)
    rest = theta - curves.start - turns * period
    rest = np.where((rest == 0.0) & (turns == 1.0), period, rest)
    own = (curves.path.theta - curves.start) % period
    places = np.unique(np.concatenate([rest, own, [0.0, period]]))
    aside = curves.start + places
    for one in curves.path.encounters:
        off = (aside - one.angle + period / 2) % period - period / 2
        near = (one.kind == "crossing") & (np.abs(off) < _ASIDE * period)
        aside = np.where(near, aside - off + _ASIDE * period * np.where(off < 0, -1, 1), aside)
    held = crank.modes(aside)
    ranks = np.argsort(curves.labels(aside), axis=1)[:, : curves.count]
    shape = np.take_along_axis(held.shape, ranks[:, None, :], axis=2)
    middle = 0.5 * (held.mass[1:] + held.mass[:-1])
    root = assurance(shape[:-1], shape[1:], middle, squared=False)
    step = np.where(np.diagonal(root, axis1=-2, axis2=-1) < 0, -1.0, 1.0)
    sign = np.concatenate([np.ones((1, curves.count)), np.cumprod(step, axis=0)])
    shape = shape * sign[:, None, :]
    back = assurance(shape[0], shape[-1], held.mass[0], squared=False)
    turned = np.where(np.diagonal(back) < 0, -1.0, 1.0)
    return shape[np.searchsorted(places, rest)], turned
