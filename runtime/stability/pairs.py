"""Meetings of two multipliers on the unit circle, and the edges of the regions that they open.

Multipliers are sampled over the speed and told apart by their Krein signatures; where two of
opposite signature meet, r and s,

    g = 2 - r/s - s/r = -(r - s)^2 / (r s)

is real: positive where both are on the circle, negative where they have left it, and smooth in the
speed, while their moduli start with a square root.  Near a narrow tongue it is a parabola.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.maxima import bracketed_roots
from ..periodic.equation import equation_of
from ..periodic.multipliers import conditions, eigenvalues
from ..periodic.over_speed import MatricesOverSpeed
from ..periodic.signatures import form_matrix, signatures_of
from .labels import Regions

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Index = NDArray[np.intp]

_EPS = float(np.finfo(float).eps)
_MOST_SAMPLES = 40_000
TOGETHER = 256
# How far a sum of phases may lie from a whole turn where the multipliers are taken for locked.
_LOCKED = 1e-4
_TURN_ROUND = 2.0 * np.pi
# Sign of the form, over the unit vector, from which it tells the two multipliers apart.
_TELLING = 1e-5


class Events(NamedTuple):
    """Meetings of multipliers, each between two sampled speeds, ``(k,)`` or ``(k, 2)``.

    The pair is apart at ``low`` and ``high``, NaN where the range ends first or one of the two is
    then at +-1 and off the circle.  ``inside`` is a sampled speed where it was found off the circle
    or not told apart, ``reach`` the first and the last such; ``plus`` and ``minus`` are the
    arguments of the multipliers of positive and of negative signature at low and high.
    """

    low: Array
    high: Array
    inside: Array
    reach: Array
    plus: Array
    minus: Array


class Samples(NamedTuple):
    """Arguments of the multipliers of positive signature over the rising speed, ``(ns, n)``.

    They are followed from sample to sample, up to a whole number of turns; ``open`` is true where
    the multiplier is off the circle or its signature open.
    """

    speed: Array
    phase: Array
    open: Flags


def phase_grid(matrices: MatricesOverSpeed, span: tuple[float, float], more: Array) -> Array:
    """Return speeds from one to the next of which no mode turns far, and ``more`` within, rising.

    The first and the last are the ends.  A range that needs more than 40 000 of them is refused.
    """
    low, high = span
    system = matrices.system
    ends = equation_of(matrices.known, np.array([low, high]), matrices.parameters)
    # From one sample to the next the fastest mode turns by 0.3 rad.
    fastest = float(np.max(ends.rate() * ends.speed))
    count = int(np.ceil(fastest * system.period * (1 / low - 1 / high) / 0.3)) + 2
    if count > _MOST_SAMPLES:
        found = f"a lowest speed of {low:.4g} rad/s, which needs {count} samples"
        fix = "raise the lowest speed or leave out the highest modes"
        raise bad("speed_range", found, f"at most {_MOST_SAMPLES}", fix)
    # Phases grow with the inverse speed.
    even = 1.0 / np.linspace(1 / low, 1 / high, max(count, 8))
    even[[0, -1]] = low, high
    return np.asarray(np.unique(np.concatenate([even, more[(more > low) & (more < high)]])))


def sampled_phases(matrices: MatricesOverSpeed, span: tuple[float, float], more: Array) -> Samples:
    """Return the phases of a conservative system over a range of speeds, and at ``more`` of them.

    A range in which the growth in a turn overflows is refused.
    """
    speed = phase_grid(matrices, span, more)
    phases, flags = [], []
    for start in range(0, len(speed), TOGETHER):
        scaled, error = matrices(speed[start : start + TOGETHER])
        if not np.all(np.isfinite(scaled)):
            found = "growth beyond double precision within a turn"
            raise bad("speed_range", found, "speeds of moderate growth", "raise the lowest speed")
        values, own, vectors = eigenvalues(scaled, perturbation_size(scaled, error))
        # Signatures take for one what lies within ten errors.
        signatures = signatures_of(vectors, values, 0.1 * own)
        for angles, signs in zip(np.angle(values), signatures, strict=True):
            angle, undecided = _positive(angles, signs)
            phases.append(angle)
            flags.append(undecided)
    return Samples(speed, *_followed(np.array(phases), np.array(flags)))


def _positive(angle: Array, signs: NDArray[np.int8]) -> tuple[Array, Flags]:
    """Return the n arguments of positive signature, rising, and which of them are open."""
    # Multipliers whose signature is open come in groups of like argument, half of them positive.
    decided = angle[signs == 1]
    rest = np.sort(np.mod(angle[signs == 0], _TURN_ROUND))[::2]
    both = np.mod(np.concatenate([decided, rest]), _TURN_ROUND)
    undecided = np.concatenate([np.zeros(len(decided), bool), np.ones(len(rest), bool)])
    order = np.argsort(both, kind="stable")
    return both[order], undecided[order]


def _followed(phases: Array, flags: Flags) -> tuple[Array, Flags]:
    """Order the phases so that each follows its own, which keeps the order round the circle."""
    place = np.arange(phases.shape[1])
    lifted, ordered = np.array(phases), np.array(flags)
    rotations = (place + place[:, None]) % len(place)
    for t in range(1, len(phases)):
        steps = phases[t][rotations] - lifted[t - 1]
        steps = steps - _TURN_ROUND * np.round(steps / _TURN_ROUND)
        best = int(np.argmin(np.sum(np.abs(steps), axis=1)))
        lifted[t] = lifted[t - 1] + steps[best]
        ordered[t] = flags[t][rotations[best]]
        # Positions on the circle rotate with what was matched.
        phases[t] = phases[t][rotations[best]]
    return lifted, ordered


def meetings(samples: Samples, principal: bool = False) -> Events:
    """Return where sums of the phases of two modes pass a whole number of turns.

    With ``principal`` a mode meets itself instead: its two multipliers, at +1 or -1.

    A multiplier of positive signature at phase a meets one of negative signature at -b, the
    conjugate of b, where a + b is a whole number of turns.  Meetings while one of the two is off
    the circle at +-1 are none: it is not there to be met.
    """
    n = samples.phase.shape[1]
    rows: list[tuple[float, ...]] = []
    real = samples.open & (np.abs(_wrapped(2 * samples.phase)) < _LOCKED)
    # What is missing has the number -1.
    speed = np.append(samples.speed, np.nan)
    for k in range(n):
        for other in (k,) if principal else range(k + 1, n):
            total = samples.phase[:, k] + samples.phase[:, other]
            locked = samples.open[:, k] & samples.open[:, other]
            locked &= np.abs(_wrapped(total)) < _LOCKED
            hidden = np.zeros_like(locked) if principal else real[:, k] | real[:, other]
            for first, last, run in _passages(total / _TURN_ROUND, locked & ~hidden, hidden):
                inside = run[len(run) // 2] if run else -1
                low, high, middle = speed[[first, last, inside]]
                reach = speed[[run[0], run[-1]] if run else [first, last]]
                kept = [i for i in (first, last) if i >= 0] or [inside]
                at = [kept[0], kept[-1]]
                plus, minus = samples.phase[at, k], -samples.phase[at, other]
                rows.append((low, high, middle, *reach, *plus, *minus))
    table = np.array(rows, dtype=float).reshape(-1, 9)
    reach, plus, minus = (table[:, i : i + 2] for i in (3, 5, 7))
    return Events(table[:, 0], table[:, 1], table[:, 2], reach, plus, minus)


def _passages(turns: Array, locked: Flags, hidden: Flags) -> Iterator[tuple[int, int, list[int]]]:
    """Yield samples before, after and those inside each passage of a whole number of turns."""
    before, run = -1, list[int]()
    for t in range(len(turns)):
        if locked[t]:
            run.append(t)
            continue
        after = -1 if hidden[t] else t
        if run:
            yield before, after, run
        elif min(before, after) >= 0 and np.floor(turns[t]) != np.floor(turns[before]):
            yield before, t, []
        before, run = after, []
    if run:
        yield before, -1, run


class Pair(NamedTuple):
    """Two multipliers at each of k places, all arrays of shape ``(k,)``.

    ``gap`` is g, negative off the circle, ``noise`` its absolute error, ``ahead`` the angle by
    which the positive one leads the negative one [rad], 0 off the circle; ``plus`` and ``minus``
    are their arguments [rad]; within ``blur`` the two are not told apart.
    """

    gap: Array
    noise: Array
    ahead: Array
    plus: Array
    minus: Array
    blur: Array


def pairs_at(matrices: MatricesOverSpeed, speed: Array, plus: Array, minus: Array) -> Pair:
    """Return the pairs of multipliers nearest to expected arguments, one at each speed."""
    if not len(speed):
        return Pair(*(np.zeros(0),) * 6)
    scaled, error = matrices(speed)
    m = scaled.shape[-1]
    values, vectors = np.linalg.eig(scaled)
    values, vectors = values.astype(complex), vectors.astype(complex)
    form = np.real(np.diagonal(form_matrix(vectors), axis1=-2, axis2=-1))
    angle = np.angle(values)
    first = np.abs(_wrapped(angle - plus[:, None])) + 9.0 * (form < -_TELLING)
    second = np.abs(_wrapped(angle - minus[:, None])) + 9.0 * (form > _TELLING)
    cost = first[:, :, None] + second[:, None, :]
    # Off the circle the two have the same argument and inverse moduli.
    cost += np.abs(np.log(np.abs(values[:, :, None] * values[:, None, :])))
    cost[:, np.arange(m), np.arange(m)] = np.inf
    best = np.argmin(cost.reshape(len(cost), -1), axis=-1)
    rows = np.arange(len(best))
    i, j = best // m, best % m
    r, s = values[rows, i], values[rows, j]
    gap = np.real(-((r - s) ** 2) / (r * s))
    shift = perturbation_size(scaled, error)
    with np.errstate(invalid="ignore", over="ignore"):
        own = conditions(vectors)
        both = own[rows, i] + own[rows, j]
        sway = np.abs(r - s) * both
    size = np.linalg.norm(scaled, axis=(-2, -1))
    sway = np.where(np.isfinite(sway), np.minimum(sway, 4 * size), 4 * size)
    ahead = np.where(gap > 0.0, _wrapped(np.angle(r) - np.angle(s)), 0.0)
    noise = 2 * shift * sway + 4 * shift**2
    return Pair(gap, noise, ahead, np.angle(r), np.angle(s), shift * both)


def perturbation_size(matrices: Array, error: Array) -> Array:
    """Return how large the error of matrices is in the Frobenius norm, shape ``(nb,)``.

    ``error`` is the largest error of an entry over the largest entry.
    """
    m = matrices.shape[-1]
    size = m * error * np.max(np.abs(matrices), axis=(-2, -1))
    return np.asarray(size + 4 * m * _EPS * np.linalg.norm(matrices, axis=(-2, -1)))


def _wrapped(angle: Array) -> Array:
    return np.asarray(np.mod(angle + np.pi, 2 * np.pi) - np.pi)


def refined_edges(matrices: MatricesOverSpeed, events: Events) -> tuple[Regions, Array, Array]:
    """Return the tongues in which pairs meet, without labels, their middles, and least widths.

    Ends are equal where the tongue is too narrow to be told from none, that is below this width,
    and NaN where the range ended first; the middle is then that of where the pair was seen.  A
    parabola through three values of g leads to its least value; where that is negative beyond its
    error, both zeros are bracketed and solved for.
    """
    search = _Search(matrices, events)
    search.run()
    k = len(events.low)
    ends, errors = np.full((2, k), np.nan), np.zeros((2, k))
    phase = np.array(search.phase)
    for side, outer in enumerate((events.low, events.high)):
        known = np.flatnonzero(search.found & np.isfinite(outer))
        ends[side, known], errors[side, known], phase[known] = search.edge(known, side)
    closed = ~search.found
    ends[:, closed] = search.bottom[closed]
    errors[:, closed] = 0.5 * search.least[closed]
    reach = np.where(np.isfinite(ends), ends, events.reach.T)
    centre, seen = 0.5 * (ends[0] + ends[1]), np.mean(events.reach, axis=1)
    middle = np.where(np.isfinite(centre), centre, seen)
    turn = np.exp(1j * np.abs(phase))
    found = Regions.unlabelled(ends, np.max(errors, axis=0), reach, turn)
    return found, middle, search.least


class _Search:
    """The state of a search for the least gap of each pair."""

    def __init__(self, matrices: MatricesOverSpeed, events: Events) -> None:
        self.matrices = matrices
        k = len(events.low)
        self.x = np.stack([events.low, events.high])
        self.angles = np.stack([events.plus.T, events.minus.T])
        self.g = np.full((2, k), np.nan)
        self.old = np.full((2, k), np.nan)
        self.bottom = np.array(events.inside)
        self.depth = np.full(k, np.nan)
        self.least = np.zeros(k)
        self.phase = np.zeros(k)
        self.found = np.zeros(k, dtype=bool)
        self.sides = np.zeros((2, k))
        self.slope = np.full(k, np.nan)

    def run(self) -> None:
        """Find for each pair a speed off the circle, or the least gap."""
        blur = np.zeros(len(self.bottom))
        for side in (0, 1):
            index = np.flatnonzero(np.isfinite(self.x[side]))
            pair = self._at(index, self.x[side, index])
            self.g[side, index], self.sides[side, index] = pair.gap, np.sign(pair.ahead)
            blur[index] = np.maximum(blur[index], pair.blur)
            self._keep(side, index, pair)
        with np.errstate(invalid="ignore", divide="ignore"):
            reach = np.sqrt(np.maximum(self.g[0], 0)) + np.sqrt(np.maximum(self.g[1], 0))
            self.slope = reach / (self.x[1] - self.x[0])
            least = 4 * blur / self.slope
        self.least = np.where(np.isfinite(least), least, 0.0)
        begun = np.flatnonzero(np.isfinite(self.bottom))
        self._try(begun, self.bottom[begun])
        active = np.flatnonzero(~self.found & np.all(np.isfinite(self.x), axis=0))
        for _ in range(40):
            if not len(active):
                break
            ended = self._try(active, self._next(active))
            active = active[~ended]

    def _at(self, index: Index, speed: Array) -> Pair:
        """Evaluate pairs where interpolation between the brackets expects them."""
        low, high = self.x[:, index]
        both = np.isfinite(low) & np.isfinite(high) & (high > low)
        with np.errstate(invalid="ignore", divide="ignore"):
            part = np.where(both, (speed - low) / (high - low), np.where(np.isfinite(low), 0, 1))
        plus, minus = ((1 - part) * a[0, index] + part * a[1, index] for a in self.angles)
        return pairs_at(self.matrices, speed, plus, minus)

    def _keep(self, side: int, index: Index, pair: Pair) -> None:
        """Remember the arguments at a bracket's end, on the turn of the expected ones."""
        for which, found in enumerate((pair.plus, pair.minus)):
            usual = self.angles[which, side, index]
            self.angles[which, side, index] = usual + _wrapped(found - usual)

    def _next(self, index: Index) -> Array:
        """Return where a parabola has its least value, or else where the phases should cross."""
        (low, high), (g_low, g_high) = self.x[:, index], self.g[:, index]
        x3, g3 = self.old[:, index]
        with np.errstate(invalid="ignore", divide="ignore"):
            left, right = np.sqrt(np.maximum(g_low, 0)), np.sqrt(np.maximum(g_high, 0))
            crossing = low + (high - low) * left / (left + right)
            d1, d2 = (g_high - g_low) / (high - low), (g3 - g_low) / (x3 - low)
            curve = (d2 - d1) / (x3 - high)
            vertex = 0.5 * (low + high) - 0.5 * d1 / curve
            usable = np.isfinite(vertex) & (curve > 0)
            usable &= (vertex > low) & (vertex < high)
            place = np.where(usable, vertex, crossing)
        margin = 1e-3 * (high - low)
        place = np.where(np.isfinite(place), place, 0.5 * (low + high))
        return np.asarray(np.clip(place, low + margin, high - margin))

    def _try(self, index: Index, speed: Array) -> Flags:
        """Evaluate new places, move the brackets, and tell which pairs need no more."""
        pair = self._at(index, speed)
        with np.errstate(invalid="ignore", divide="ignore"):
            width = 2 * np.sqrt(pair.noise + np.maximum(-pair.gap, 0)) / self.slope[index]
        off = pair.gap < -pair.noise
        self.found[index] = off
        self.bottom[index], self.phase[index] = speed, pair.plus
        self.depth[index] = pair.gap
        rounding = 8 * _EPS * speed
        on_low = np.sign(pair.ahead) == self.sides[0, index]
        for side, moves in ((0, on_low & ~off), (1, ~on_low & ~off)):
            rows = np.flatnonzero(moves & np.isfinite(self.x[side, index]))
            own = index[rows]
            self.old[0, own], self.old[1, own] = self.x[side, own], self.g[side, own]
            self.x[side, own], self.g[side, own] = speed[rows], pair.gap[rows]
            self._keep(side, own, Pair(*(values[rows] for values in pair)))
        closed = (pair.gap <= pair.noise) | (self.x[1, index] - self.x[0, index] <= rounding)
        closed &= ~off
        if np.any(closed):
            own = index[closed]
            self.least[own] = np.maximum(width[closed], self.least[own]) + rounding[closed]
        return np.asarray(off | closed)

    def edge(self, index: Index, side: int) -> tuple[Array, Array, Array]:
        """Return one edge of open tongues, its error, and the argument there."""
        outer, inner = self.x[side, index], self.bottom[index]

        def gap(rows: Index, speed: Array) -> tuple[Array, Array]:
            pair = self._at(index[rows], speed)
            return pair.gap, pair.noise

        values = self.g[side, index], self.depth[index]
        roots, width, slope = bracketed_roots(gap, outer, inner, values)
        last = self._at(index, roots)
        with np.errstate(divide="ignore", invalid="ignore"):
            error = last.noise / np.abs(slope)
        error = np.where(np.isfinite(error), error, np.abs(outer - inner))
        middle = 0.5 * np.angle(np.exp(2j * last.plus) * np.exp(1j * (last.minus - last.plus)))
        turn = np.exp(1j * middle)
        turn = np.where(np.real(turn * np.exp(-1j * last.plus)) < 0, -turn, turn)
        return roots, error + width + 16 * _EPS * roots, np.angle(turn)
