"""Speeds at which a multiplier crosses the unit circle, whichever it is, and what that encloses.

The m-th largest of the log moduli is continuous in the speed, whatever the multipliers do, and
changes its sign where the number outside the circle passes m.  Where the multiplier crosses tells
the kind: at +1, at -1, or with its conjugate elsewhere.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.families import Array, LinearPeriodic
from ..core.maxima import bracketed_roots
from ..core.results import Check
from ..frequencies.multiplier_maxima import refined_maxima
from ..periodic import FloquetMultipliers, floquet_multipliers
from ..periodic.multipliers import conditions
from ..periodic.over_speed import MatricesOverSpeed
from .labels import Regions, held_modes, joined, meeting_labels, pair_shares
from .pairs import TOGETHER, perturbation_size, phase_grid

ComplexArray = NDArray[np.complex128]
Index = NDArray[np.intp]

_EPS = float(np.finfo(float).eps)
# Places at which growth is looked for, in half widths from the middle of the undamped region.
_PLACES = np.linspace(-1.5, 1.5, 13)


class Levels(NamedTuple):
    """Log moduli, falling, with errors and multipliers, all of shape ``(k, 2n)``.

    ``size`` is the error of the monodromy matrices, shape ``(k,)``.
    """

    value: Array
    noise: Array
    multiplier: ComplexArray
    size: Array

    @property
    def outside(self) -> NDArray[np.bool_]:
        """Which are outside the circle beyond their error."""
        return np.asarray(self.value > 2 * self.noise)


class _Crossing(NamedTuple):
    speed: float
    error: float
    rising: bool
    multiplier: complex


class Crossings:
    """Crossings of the circle between rising samples of a range, its ends among them.

    Where ``sharp``, multipliers rest on the circle, as without damping: a region then begins where
    one is outside beyond its error.
    """

    def __init__(self, matrices: MatricesOverSpeed, speed: Array, sharp: bool = False) -> None:
        self._matrices, self._sharp = matrices, sharp
        self._speed, self._levels = speed, self.levels(speed)

    def levels(self, speed: Array) -> Levels:
        """Return the log moduli at speeds of shape ``(k,)``."""
        m = 2 * self._matrices.system.size
        parts: list[tuple[Array, ...]] = []
        for start in range(0, len(speed), TOGETHER):
            matrices, error = self._matrices(speed[start : start + TOGETHER])
            values, vectors = (part.astype(complex) for part in np.linalg.eig(matrices))
            size = np.maximum(np.abs(values), 1e-300)
            # Entries err each by itself: of 864 ends of damped regions all are covered, by 2.3 at
            # least and 50 to 76 in the middle.  What rests on the circle shows the worst of them.
            shift = perturbation_size(matrices, error if self._sharp else error / m)
            noise = np.minimum(conditions(vectors) * shift[:, None] / size, 1.0)
            order = np.argsort(-size, axis=-1, kind="stable")
            columns = (np.log(size), noise, values)
            parts.append((*(np.take_along_axis(c, order, axis=-1) for c in columns), shift))
        return Levels(*(np.concatenate(c) for c in zip(*parts, strict=True)))

    def regions(self) -> Regions:
        """Return between which speeds multipliers of a kind are outside the circle, no labels."""
        found = self._crossings()
        for _ in range(6):
            # Between crossings the number outside must be what they make it.
            ends = np.unique([self._speed[0], *(c.speed for c in found), self._speed[-1]])
            fresh = np.setdiff1d(0.5 * (ends[1:] + ends[:-1]), self._speed)
            if not len(fresh):
                break
            before = len(found)
            speed = np.concatenate([self._speed, fresh])
            order = np.argsort(speed, kind="stable")
            both = zip(self._levels, self.levels(fresh), strict=True)
            self._levels = Levels(*(np.concatenate(parts)[order] for parts in both))
            self._speed = speed[order]
            found = self._crossings()
            if len(found) == before:
                break
        return self._between(found)

    def _crossings(self) -> list[_Crossing]:
        """Return all crossings between neighbouring samples, by rising speed."""
        out, levels = self._levels.outside, self._levels
        row, rank = np.nonzero(out[1:] != out[:-1])
        if not len(row):
            return []
        # What is not outside beyond its error counts as inside.
        value = np.where(out, levels.value, np.minimum(levels.value, -1e-3 * levels.noise))
        if self._sharp:
            value = np.where(out, levels.value, -levels.noise)

        def level(which: Index, at: Array) -> tuple[Array, Array]:
            found = self.levels(at)
            rows = np.arange(len(at))
            own, noise = found.value[rows, rank[which]], found.noise[rows, rank[which]]
            # On the circle the modulus rests at 1 within its error.
            return (own - 2 * noise, np.zeros_like(noise)) if self._sharp else (own, noise)

        first, second = self._speed[row], self._speed[row + 1]
        values = value[row, rank], value[row + 1, rank]
        root, width, slope = bracketed_roots(level, first, second, values)
        last = self.levels(root)
        error = width + 4 * _EPS * root
        with np.errstate(divide="ignore", invalid="ignore"):
            if self._sharp:
                # The square of the growth starts in proportion to the distance.
                beyond = np.where(out[row, rank], row, row + 1)
                rise = levels.value[beyond, rank] ** 2 / np.abs(self._speed[beyond] - root)
                error = error + 16 * last.size / rise
            else:
                error = error + last.noise[np.arange(len(root)), rank] / np.abs(slope)
        error = np.where(np.isfinite(error), error, second - first)
        return self._sorted(row, rank, root, error, last)

    def _sorted(
        self, row: Index, rank: Index, root: Array, error: Array, last: Levels
    ) -> list[_Crossing]:
        """Return crossings by rising speed, one for two conjugates."""
        out = self._levels.outside
        apart = np.abs(last.value)
        if self._sharp:
            # Those that stay rest on the circle too: the one that leaves is where it soon will be.
            after = self._levels.multiplier[np.where(out[row, rank], row, row + 1), rank]
            apart = np.abs(np.angle(last.multiplier * after.conj()[:, None]))
        nearest = np.argmin(apart, axis=-1)
        found: list[_Crossing] = []
        halves: dict[tuple[int, bool], int] = {}
        for i in np.lexsort((rank, row)):
            rising = bool(out[row[i] + 1, rank[i]])
            turn = self._crossed(int(row[i]), rising, complex(last.multiplier[i, nearest[i]]))
            if turn.imag != 0.0:
                # One of two conjugates is enough.
                key = int(row[i]), rising
                halves[key] = halves.get(key, 0) + 1
                if halves[key] % 2 == 0:
                    continue
            found.append(_Crossing(float(root[i]), float(error[i]), rising, turn))
        return sorted(found, key=lambda c: c.speed)

    def _crossed(self, row: int, rising: bool, turn: complex) -> complex:
        """Return the multiplier that crosses, of the kind that a crossing adds to those outside."""
        # Where two nearly meet at the crossing, rounding decides whether they are complex there.
        more, fewer = (row + 1, row) if rising else (row, row + 1)
        added = Counter(_kind(t) for t in _kinds(self._levels, more))
        added.subtract(_kind(t) for t in _kinds(self._levels, fewer))
        kinds = [kind for kind, number in added.items() if number > 0]
        if len(kinds) == 1 and kinds[0] != 2:
            return complex(kinds[0])
        if len(kinds) == 1 and turn.imag == 0.0:
            turn = next(t for t in _kinds(self._levels, more) if _kind(t) == 2)
        return complex(turn.real, abs(turn.imag))

    def _between(self, found: list[_Crossing]) -> Regions:
        """Join crossings outwards with the next ones of their kind inwards."""
        begun = [_Crossing(np.nan, 0.0, True, turn) for turn in _kinds(self._levels, 0)]
        rows: list[tuple[float, float, float, float, float]] = []
        turns: list[complex] = []

        def add(first: _Crossing, last: _Crossing) -> None:
            kind = _kind(first.multiplier)
            begin = first.speed if np.isfinite(first.speed) else self._seen(last.speed, kind, -1)
            end = last.speed if np.isfinite(last.speed) else self._seen(begin, kind, 1)
            rows.append((first.speed, last.speed, max(first.error, last.error), begin, end))
            turns.append(first.multiplier / abs(first.multiplier))

        for last in found:
            if last.rising:
                begun.append(last)
                continue
            kind = _kind(last.multiplier)
            same = [i for i, other in enumerate(begun) if _kind(other.multiplier) == kind]
            add(begun.pop(same[-1]) if same else last._replace(speed=np.nan), last)
        for first in begun:
            add(first, first._replace(speed=np.nan))
        numbers = np.array(rows).reshape(-1, 5).T
        return Regions.unlabelled(numbers[:2], numbers[2], numbers[3:], np.array(turns))

    def _seen(self, start: float, kind: int, step: int) -> float:
        """Return the last sample from a speed on at which a kind is outside the circle."""
        if not np.isfinite(start):
            # Without any crossing it is outside all over the range.
            return float(self._speed[0])
        side: Literal["left", "right"] = "left" if step > 0 else "right"
        i = int(np.searchsorted(self._speed, start, side)) - (step < 0)
        seen = start
        while 0 <= i < len(self._speed) and kind in map(_kind, _kinds(self._levels, i)):
            seen = float(self._speed[i])
            i += step
        return seen


def _kind(turn: complex) -> int:
    """Return 1, -1 or 2: real positive, real negative, complex."""
    return 2 if turn.imag != 0.0 else (1 if turn.real > 0 else -1)


def _kinds(levels: Levels, row: int) -> list[complex]:
    """Return the multipliers outside the circle at one sample, one of each conjugate pair."""
    values = levels.multiplier[row][levels.outside[row]]
    return [complex(value) for value in values if value.imag >= 0.0]


def damped_regions(
    matrices: MatricesOverSpeed, undamped: Regions, span: tuple[float, float]
) -> Regions:
    """Return the unstable regions of a damped system.

    Narrow ones are looked for where the ``undamped`` ones are, which lend their labels.
    """
    begin, end = np.maximum(undamped.begin, span[0]), np.minimum(undamped.end, span[1])
    seen = end - begin > 4 * undamped.error
    undamped, begin, end = undamped.take(seen), begin[seen], end[seen]
    phase = np.angle(undamped.multiplier)
    middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
    ends = np.unique(np.concatenate([span, begin, end]))
    highest = _highest(matrices, phase, middle, half)
    around = (middle[:, None] + half[:, None] * _PLACES).ravel()
    more = np.concatenate([highest, around, 0.5 * (ends[1:] + ends[:-1])])
    found = Crossings(matrices, phase_grid(matrices, span, more)).regions()
    return named_after(found.take(~(found.upper - found.lower <= 0.0)), undamped)


def named_after(found: Regions, undamped: Regions) -> Regions:
    """Give each the label of the undamped region it is most like, none twice; 0 where none is."""
    from scipy.optimize import linear_sum_assignment

    begin, end = found.begin[:, None], found.end[:, None]
    lows, highs = undamped.begin, undamped.end
    size = (end - begin) + (highs - lows) + 1e-12 * end
    cost = np.abs((end + begin) - (highs + lows)) / size
    folded = undamped.multiplier.real + 1j * np.abs(undamped.multiplier.imag)
    cost = cost + 2 * np.abs(np.angle(found.multiplier[:, None] / folded))
    # Of two that lie alike the one of like width, then that of the lower, stronger harmonic; never
    # one of another kind of multiplier.
    ratio = np.log((end - begin + 1e-15 * end) / (highs - lows + 1e-15 * highs))
    cost = cost + 0.2 * np.abs(ratio) + 0.05 * undamped.harmonic
    real = (found.multiplier.imag == 0.0)[:, None]
    cost = cost + 100.0 * (real != (undamped.kind == "principal"))
    row, column = linear_sum_assignment(cost)
    like = cost[row, column] < 20.0
    source = len(lows) + np.arange(len(begin))
    source[row[like]] = column[like]
    both = joined(undamped, found).take(source)
    named = {name: getattr(both, name) for name in ("modes", "harmonic", "detuning", "kind")}
    return found._replace(**named)


def _highest(matrices: MatricesOverSpeed, phase: Array, middle: Array, half: Array) -> Array:
    """Return where the multipliers near given phases grow most about the undamped regions."""
    if not len(middle):
        return middle
    rows, count = np.arange(len(middle)), len(_PLACES)
    speed = np.maximum(middle[:, None] + half[:, None] * _PLACES, 1e-3 * middle[:, None])

    def growth(at: Array, which: Index) -> Array:
        # The largest log modulus of the multipliers near a phase.
        values = np.linalg.eigvals(matrices(at)[0])
        away = np.abs(np.angle(values * np.exp(-1j * phase[which])[:, None]))
        with np.errstate(divide="ignore"):
            logarithm = np.log(np.abs(values))
        # Those that the undamped pair has become, whatever else grows at another argument.
        second = np.sort(away, axis=-1)[:, 1:2]
        # Arguments [rad] that count as that of the pair in any case.
        near = away <= np.maximum(second, 0.1)
        return np.asarray(np.max(np.where(near, logarithm, -np.inf), axis=-1))

    value = growth(speed.ravel(), np.repeat(rows, count)).reshape(-1, count)
    near = np.add.outer([-1, 0, 1], np.clip(np.argmax(value, axis=1), 1, count - 2))
    around = speed[rows, near], value[rows, near]
    return refined_maxima(growth, rows, *around, steps=4, rtol=0.0)[0]


def mended(
    matrices: MatricesOverSpeed,
    regions: Regions,
    usable: NDArray[np.bool_],
    span: tuple[float, float],
    near: Array,
) -> Regions:
    """Return combination regions that agree with the multipliers off the circle.

    Where not ``usable`` a pair meets at +-1: its region is kept for its label only.
    """
    ends = np.unique(np.concatenate([span, near[np.isfinite(near)]]))
    ends = ends[(ends >= span[0]) & (ends <= span[1])]
    speed = phase_grid(matrices, span, 0.5 * (ends[1:] + ends[:-1]))
    found = Crossings(matrices, speed, sharp=True).regions()
    wide = ~(found.upper - found.lower <= 4 * found.error)
    truth = found.take(wide & (found.multiplier.imag != 0.0))
    # Those whose ends agree within their errors, or that both lack.
    slack = truth.error[:, None] + regions.error
    alike = np.broadcast_to(usable, slack.shape)
    for a, b in ((truth.lower, regions.lower), (truth.upper, regions.upper)):
        gap = np.abs(a[:, None] - b)
        alike = alike & ((gap <= slack) | (np.isnan(a)[:, None] & np.isnan(b)))
    own, new = np.zeros(len(usable), dtype=bool), list[int]()
    for row, fitting in enumerate(alike):
        same = np.flatnonzero(fitting & ~own)[:1]
        own[same] = True
        if not len(same):
            new.append(row)
    if not new:
        return regions.take(usable)
    fresh = truth.take(np.array(new))
    over = (regions.begin < fresh.end[:, None]) & (regions.end > fresh.begin[:, None])
    kept = usable & (own | ~np.any(over, axis=0))
    return joined(regions.take(kept), _named(matrices, named_after(fresh, regions.take(~kept))))


def _named(matrices: MatricesOverSpeed, regions: Regions) -> Regions:
    """Label regions by the modes with the crank held where those suit better, or nothing else."""
    middle, turn = regions.middle, regions.multiplier
    held, phase = held_modes(matrices, middle), np.angle(turn)
    shares = pair_shares(matrices, held, middle, turn)
    modes, harmonic, off = meeting_labels(held, phase, shares)
    total = np.sum(np.take_along_axis(held.turns, regions.modes - 1, axis=1), axis=1)
    wrong = (2 * off < np.abs(total - regions.harmonic)) & (regions.kind == "sum")
    better = wrong | (regions.modes[:, 0] == 0)
    return regions._replace(
        modes=np.where(better[:, None], modes, regions.modes),
        harmonic=np.where(better, harmonic, regions.harmonic),
        detuning=np.where(better, off, regions.detuning),
        kind=np.where(better, "sum", regions.kind),
    )


# Growth, over its error, from which a verdict tells.
_TELLING = 20.0
# Share of the way to the next end at which an end is looked at.
_BESIDE = 0.01


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
    low, high = begin - 2 * regions.error, end + 2 * regions.error
    covered = np.any((speeds[:, None] >= low) & (speeds[:, None] <= high), axis=1)
    # Outside the circle by more than its error explains.
    grows = np.any(np.abs(found.multipliers) > 1.0 + 4 * found.error, axis=-1)
    # Deep inside a region something grows.
    wrong = np.sum(~covered & grows) + np.sum(_within(regions, speeds) & found.stable)
    untrue = _narrow(system, regions, parameters) + _counts(system, regions, span, parameters)
    return {"samples": Check(float(wrong), 0.0), "verdicts": Check(float(untrue), 0.0)}


def _narrow(system: LinearPeriodic, regions: Regions, parameters: Mapping[str, float]) -> int:
    """Return how many regions do not grow in the middle as much as their width promises."""
    with np.errstate(invalid="ignore"):
        whole = regions.take(regions.upper - regions.lower > 4 * regions.error)
    if not len(whole.error):
        return 0
    inside = floquet_multipliers(system, 0.5 * (whole.lower + whole.upper), **parameters)
    expected = _expected_growth(whole)
    told = expected > _TELLING * np.max(inside.error, axis=-1)
    least = 0.0 if _damped(inside) else 0.1 * expected
    return int(np.sum(told & (np.max(inside.exponents.real, axis=-1) <= least)))


def _expected_growth(regions: Regions) -> Array:
    """Return the growth in a period at the middle of regions, n pi b / (2 w) at a width b."""
    width = regions.end - regions.begin
    return 0.5 * np.pi * np.maximum(regions.harmonic, 1) * width / regions.end


def _counts(
    system: LinearPeriodic,
    regions: Regions,
    span: tuple[float, float],
    parameters: Mapping[str, float],
) -> int:
    """Return at how many places between ends not as many multipliers grow as regions cover."""
    # The places are beside each end and in the middle between each two.  A principal region stands
    # for one multiplier, any other for two, which holds too where four meet off the circle.
    wide = regions.take(regions.end - regions.begin > 4 * regions.error)
    begin, end = wide.begin, wide.end
    ends = np.concatenate([span, begin, end])
    slack = np.concatenate([np.zeros(2), wide.error, wide.error])
    order = np.argsort(ends, kind="stable")
    ends, slack = ends[order], slack[order]
    gap = np.diff(ends)
    spread = 4 * (slack[1:] + slack[:-1] + 16 * np.finfo(float).eps * ends[1:])
    shares = (_BESIDE, 0.5, 1.0 - _BESIDE)
    inner = [(ends[:-1] + p * gap)[min(p, 1.0 - p) * gap > spread] for p in shares]
    speeds = np.unique(np.concatenate(inner))
    if not len(speeds):
        return 0
    found = floquet_multipliers(system, speeds, **parameters)
    modulus, blur = np.abs(found.multipliers), np.max(found.error, axis=-1)
    covers = (speeds[:, None] > begin) & (speeds[:, None] < end)
    expected = covers.astype(int) @ np.where(wide.kind == "principal", 1, 2)
    fewest = np.sum(modulus > 1.0 + 4 * found.error, axis=-1)
    most = np.sum(modulus > 1.0 - 4 * found.error, axis=-1)
    if not _damped(found):
        # All that is not off the circle lies on it: only what should grow by more is missed.
        with np.errstate(divide="ignore", invalid="ignore"):
            part = (speeds[:, None] - begin) / (end - begin)
            rate = _expected_growth(wide) * 2 * np.sqrt(np.maximum(part * (1 - part), 0.0))
        least = np.min(np.where(covers, rate, np.inf), axis=1, initial=np.inf)
        most = np.where(least > _TELLING * blur, fewest, np.maximum(fewest, expected))
    no_begin = np.isnan(regions.lower) & (regions.begin > span[0])
    if np.any(no_begin | (np.isnan(regions.upper) & (regions.end < span[1]))):
        # Kinds that go over into each other are seen from sample to sample only.
        fewest, most, expected = (np.minimum(n, 1) for n in (fewest, most, expected))
    return int(np.sum((fewest > expected) | (most < expected)))


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
