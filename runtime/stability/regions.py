"""Unstable regions along the speed, and their checks against Floquet multipliers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.families import Array, LinearPeriodic
from ..core.results import Check
from ..periodic import FloquetMultipliers, floquet_multipliers

# Growth, over its error, from which a verdict tells.
_TELLING = 20.0
# Share of the way to the next end at which an end is looked at.
_BESIDE = 0.01


class Regions(NamedTuple):
    """Regions with their ends and labels, see :class:`~.edges.StabilityEdges`.

    ``begin`` and ``end`` are as far as the region is known to reach: its ends where it has them,
    else the last speed at which it was seen.
    """

    lower: Array
    upper: Array
    error: Array
    multiplier: NDArray[np.complex128]
    modes: NDArray[np.int64]
    harmonic: NDArray[np.int64]
    detuning: Array
    begin: Array
    end: Array
    kind: NDArray[np.str_]

    @property
    def middle(self) -> Array:
        """Middle of each, or the one end that there is, or of where it was seen."""
        low = np.where(np.isfinite(self.lower), self.lower, self.upper)
        high = np.where(np.isfinite(self.upper), self.upper, self.lower)
        seen = 0.5 * (self.begin + self.end)
        return np.asarray(np.where(np.isfinite(low + high), 0.5 * (low + high), seen))

    def take(self, index: NDArray[np.intp]) -> Regions:
        """Return some of the regions, in the order given."""
        columns: Sequence[Any] = self
        return Regions(*(values[index] for values in columns))

    def overlapping(self, low: float, high: float) -> Regions:
        """Return those that reach into a range, by rising speed."""
        kept = np.flatnonzero((self.end >= low) & (self.begin <= high))
        return self.take(kept[np.argsort(self.middle[kept], kind="stable")])


def joined(first: Regions, second: Regions) -> Regions:
    """Return the regions of both."""
    return Regions(*(np.concatenate(both) for both in zip(first, second, strict=True)))


# ---------------------------------------------------------------- checks


def edge_checks(
    system: LinearPeriodic,
    regions: Regions,
    span: tuple[float, float],
    parameters: Mapping[str, float],
) -> dict[str, Check]:
    """Return ``samples`` and ``verdicts``, the numbers of speeds that contradict the regions."""
    begin, end = np.maximum(regions.begin, span[0]), np.minimum(regions.end, span[1])
    regions = regions._replace(begin=begin, end=end)
    speeds = np.linspace(*span, 64)
    found = floquet_multipliers(system, speeds, **parameters)
    missed = speeds[~_covered(regions, speeds) & _grows(found)]
    # Deep inside a region something grows.
    calm = speeds[_within(regions, speeds) & found.stable]
    narrow = _narrow(system, regions, parameters)
    counted = _counts(system, regions, span, parameters)
    return {
        "samples": Check(float(len(missed) + len(calm)), 0.0),
        "verdicts": Check(float(len(narrow) + len(counted)), 0.0),
    }


def _narrow(system: LinearPeriodic, regions: Regions, parameters: Mapping[str, float]) -> Array:
    """Return middles of regions that do not grow there as much as their width promises."""
    with np.errstate(invalid="ignore"):
        whole = np.flatnonzero(regions.upper - regions.lower > 4 * regions.error)
    if not len(whole):
        return np.zeros(0)
    low, high = regions.lower[whole], regions.upper[whole]
    middle: Array = 0.5 * (low + high)
    inside = floquet_multipliers(system, middle, **parameters)
    expected = _growth(regions, whole)
    told = expected > _TELLING * np.max(inside.error, axis=-1)
    grown = np.max(inside.exponents.real, axis=-1)
    if _damped(inside):
        expected = np.zeros_like(expected)
    return np.asarray(middle[told & (grown <= 0.1 * expected)])


def _growth(regions: Regions, index: NDArray[np.intp]) -> Array:
    """Return the growth in a period at the middle of regions, n pi b / (2 w) at a width b."""
    width = (regions.end - regions.begin)[index]
    value: Array = 0.5 * np.pi * np.maximum(regions.harmonic[index], 1) * width
    return value / regions.end[index]


def _counts(
    system: LinearPeriodic,
    regions: Regions,
    span: tuple[float, float],
    parameters: Mapping[str, float],
) -> Array:
    """Return places between ends at which not as many multipliers grow as regions cover.

    The places are beside each end and in the middle between each two.  A principal region stands
    for one multiplier, any other for two, which holds too where four meet off the circle.
    """
    wide = np.flatnonzero(regions.end - regions.begin > 4 * regions.error)
    begin, end, error = regions.begin[wide], regions.end[wide], regions.error[wide]
    ends = np.concatenate([span, begin, end])
    slack = np.concatenate([np.zeros(2), error, error])
    order = np.argsort(ends, kind="stable")
    ends, slack = ends[order], slack[order]
    gap = np.diff(ends)
    spread = 4 * (slack[1:] + slack[:-1] + 16 * np.finfo(float).eps * ends[1:])
    speeds = np.concatenate([(ends[:-1] + p * gap)[p * gap > spread] for p in (_BESIDE, 0.5)])
    near = ends[1:] - _BESIDE * gap
    speeds = np.unique(np.concatenate([speeds, near[_BESIDE * gap > spread]]))
    if not len(speeds):
        return speeds
    found = floquet_multipliers(system, speeds, **parameters)
    modulus, blur = np.abs(found.multipliers), np.max(found.error, axis=-1)
    covers = (speeds[:, None] > begin) & (speeds[:, None] < end)
    weight = np.where(regions.kind[wide] == "principal", 1, 2)
    expected = covers.astype(int) @ weight
    fewest = np.sum(modulus > 1.0 + 4 * found.error, axis=-1)
    most = np.sum(modulus > 1.0 - 4 * found.error, axis=-1)
    if not _damped(found):
        # All that is not off the circle lies on it: only what should grow by more is missed.
        with np.errstate(divide="ignore", invalid="ignore"):
            part = (speeds[:, None] - begin) / (end - begin)
            rate = _growth(regions, wide) * 2 * np.sqrt(np.maximum(part * (1 - part), 0.0))
        least = np.min(np.where(covers, rate, np.inf), axis=1, initial=np.inf)
        most = np.where(least > _TELLING * blur, fewest, np.maximum(fewest, expected))
    if np.any(_ragged(regions, span)):
        # Kinds that go over into each other are seen from sample to sample only.
        fewest, most, expected = (np.minimum(n, 1) for n in (fewest, most, expected))
    return np.asarray(speeds[(fewest > expected) | (most < expected)])


def _ragged(regions: Regions, span: tuple[float, float]) -> NDArray[np.bool_]:
    """Return which regions lack an end within the range."""
    value: NDArray[np.bool_] = np.isnan(regions.lower) & (regions.begin > span[0])
    return value | (np.isnan(regions.upper) & (regions.end < span[1]))


def _within(regions: Regions, speed: Array) -> NDArray[np.bool_]:
    """Return which speeds lie in a region, and not beside an end of it."""
    width = regions.end - regions.begin
    low = regions.begin + np.where(np.isnan(regions.lower), 0.0, 0.25 * width)
    high = regions.end - np.where(np.isnan(regions.upper), 0.0, 0.25 * width)
    inside = (speed[:, None] > low) & (speed[:, None] < high) & (width > 4 * regions.error)
    return np.asarray(np.any(inside, axis=1))


def _damped(found: FloquetMultipliers) -> bool:
    """Return True where the multipliers do not multiply to 1."""
    total = np.sum(found.exponents.real, axis=-1)
    return bool(np.any(np.abs(total) > 1e-6))


def _grows(found: FloquetMultipliers) -> NDArray[np.bool_]:
    """Return where a multiplier is outside the circle by more than its error explains."""
    return np.asarray(np.any(np.abs(found.multipliers) > 1.0 + 4 * found.error, axis=-1))


def _covered(regions: Regions, speed: Array) -> NDArray[np.bool_]:
    """Return which speeds lie in some region, or within the error of its ends."""
    low, high = regions.begin - 2 * regions.error, regions.end + 2 * regions.error
    return np.asarray(np.any((speed[:, None] >= low) & (speed[:, None] <= high), axis=1))
