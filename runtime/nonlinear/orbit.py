"""Periodic motions: Newton's iteration at one value of a parameter, and across a direction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from ..core.families import Array
from ..core.files import NOT_SAVED
from .segments import Motion, NotFinite, Problem, Sweep, chained, sweep

EPS = float(np.finfo(float).eps)
# Newton has arrived where its correction, relative to the motion, is below the first: its square
# is round-off; or where it no longer falls below the second.  Below the third errors fall by their
# squares, the fourth being a margin of what is left then.
_LAST, _SMALL, _SQUARED, _MORE = 3e-10, 1e-8, 1e-4, 4.0
_ITERATIONS, _MOST_ITERATIONS = 10, 40
# Corrections after which the derivative by the parameter is kept, and beyond which a guess is
# refused, relative.
_NEAR, _FAR = 1e-5, 0.3
# Stages of the motion beside which errors are measured, less than those of the motion, and the
# share of the difference that is taken for the error, where steps meet and within them: 99 % of the
# multipliers, motions and peaks of random systems are covered, half of them by no more than 100
# times the error (tests/error_estimates/test_response_errors.py).
_FEWER, SHARE, _INNER_SHARE = 1, 2.0, 1.0
_NEAR_TOP = 0.4  # distance from the middle of all deflections over their range: near an extreme
# Of multipliers: the least part of what the difference of two matrices may amount to that counts;
# of the last correction, before which steps are linearised, a factor (they are off by at most 4
# times it); and their errors that are allowed, over that of the motion.
_LEAST_PART, _STALE, _MULTIPLIERS = 0.02, 10.0, 10.0
STAGES, FIRST_STEPS, MOST_STEPS = 12, 5, 384


class Lost(ArithmeticError):  # noqa: N818 - reads as what it is
    """There is no periodic motion near a guess, or it cannot be followed."""


FAILURES = (Lost, NotFinite, np.linalg.LinAlgError)


@dataclass(frozen=True)
class Direction:
    """A change of a motion and of the parameter, with the sizes that changes are relative to."""

    states: Array  # (m, 2n): changes of the states (x, v) at the beginnings of the steps
    value: float  # change of the parameter
    scale: Array  # (2n,): sizes of coordinates and rates
    span: float  # size of the parameter

    def dot(self, other: Direction) -> float:
        """Return the inner product, in the sizes of this one."""
        row, last = self.weights
        states = other.resampled(len(row)).states
        return float(np.sum(row * states) + last * other.value)

    @cached_property
    def weights(self) -> tuple[Array, float]:
        """The inner product with this direction as a row: ``(m, 2n)`` and a number."""
        return self.states / self.scale**2 / len(self.states), self.value / self.span**2

    def times(self, factor: float) -> Direction:
        """Return a multiple."""
        return replace(self, states=factor * self.states, value=factor * self.value)

    def unit(self) -> Direction:
        """Return the direction with length 1."""
        return self.times(1.0 / float(np.sqrt(self.dot(self))))

    def resampled(self, steps: int) -> Direction:
        """Return the direction at the beginnings of so many steps."""
        m = len(self.states)
        if steps == m:
            return self
        old, new = np.arange(m + 1) / m, np.arange(steps) / steps
        closed = np.concatenate([self.states, self.states[:1]])
        columns = [np.interp(new, old, column) for column in closed.T]
        return replace(self, states=np.stack(columns, axis=-1))


@dataclass(frozen=True)
class Orbit:
    """A periodic motion at one value of the parameter, and what the motions next to it are like."""

    value: float
    motion: Motion
    swept: Sweep = field(metadata=NOT_SAVED)  # its steps, linearised
    # whole, added: (m + 1, 2n, 2n), (m + 1, 2n, 2): states at all ends by the first one, by what
    # is wrong and by the parameter
    whole: Array
    added: Array
    tangent: Direction  # along the branch, of unit length
    slope: Array  # (m, s, n): change of the accelerations along it
    # Determinant of the equations bordered by the tangent, rows of unit length: its sign changes
    # at a branch point.
    border: float
    last: float = 0.0  # the last correction, before which the steps were linearised, relative

    @property
    def matrix(self) -> Array:
        """The monodromy matrix of ``(x, dx/dtheta)``, shape ``(2n, 2n)``."""
        return np.asarray(self.whole[-1])

    @cached_property
    def eigen(self) -> tuple[Array, Array]:
        """Eigenvalues of the monodromy matrix, the largest first, and its vectors as columns."""
        values, vectors = np.linalg.eig(self.matrix)
        order = np.argsort(-np.abs(values), kind="stable")
        return values[order].astype(complex), vectors[:, order]

    @property
    def multipliers(self) -> Array:
        """Floquet multipliers, the largest first."""
        return self.eigen[0]

    def turned(self) -> Orbit:
        """Return the motion with its tangent the other way."""
        return replace(
            self, tangent=self.tangent.times(-1.0), slope=-self.slope, border=-self.border
        )

    def resampled(self, steps: int) -> Orbit:
        """Return motion and tangent on other steps, all that `ahead` needs."""
        motion, n = self.motion, self.motion.x.shape[1]
        if steps == len(motion.x):
            return self
        way = replace(
            motion, x=self.tangent.states[:, :n], v=self.tangent.states[:, n:], a=self.slope
        ).resampled(steps, STAGES)
        tangent = replace(self.tangent, states=way.states)
        return replace(self, motion=motion.resampled(steps, STAGES), tangent=tangent, slope=way.a)

    def ahead(self, step: float, past: Sequence[Orbit] = ()) -> tuple[float, Motion]:
        """Return value and motion a step along the branch, by Hermite's interpolation.

        ``past``: the motions before, the last one first, of as many steps.
        """
        here, places, factors = self.tangent, [0.0], [1.0]
        orbits = [self, *past]
        ways = [replace(o.tangent, scale=here.scale, span=here.span) for o in orbits]
        for k, (orbit, other) in enumerate(pairwise(orbits)):
            states = orbit.motion.states - other.motion.states
            chord = replace(here, states=states, value=orbit.value - other.value)
            factors.append(1.0 / float(np.sqrt(ways[k + 1].dot(ways[k + 1]))))
            cosine = ways[k].dot(ways[k + 1]) * factors[k] * factors[k + 1]
            # As long as an arc of a circle between the tangents.
            half = 0.5 * float(np.arccos(np.clip(cosine, -1.0, 1.0)))
            arc = float(np.sqrt(chord.dot(chord))) / float(np.sinc(half / np.pi))
            places.append(places[-1] - arc)
        states, value, a = 0.0 * here.states, 0.0, 0.0 * self.slope
        weights = zip(orbits, factors, *_hermite(places, step), strict=True)
        for orbit, factor, by_place, by_tangent in weights:
            slope, motion = by_tangent * factor, orbit.motion
            states += by_place * (motion.states - self.motion.states) + slope * orbit.tangent.states
            value += by_place * (orbit.value - self.value) + slope * orbit.tangent.value
            a += by_place * (motion.a - self.motion.a) + slope * orbit.slope
        return self.value + value, self.motion.moved(states, a)


def _hermite(places: Sequence[float], at: float) -> tuple[list[float], list[float]]:
    """Return the weights of values and of derivatives at places, in the polynomial through them."""
    by_place, by_slope = [], []
    for i, place in enumerate(places):
        others = [other for j, other in enumerate(places) if j != i]
        square = math.prod((at - other) / (place - other) for other in others) ** 2
        inverse = sum(1.0 / (place - other) for other in others)
        by_place.append((1.0 - 2.0 * (at - place) * inverse) * square)
        by_slope.append((at - place) * square)
    return by_place, by_slope


@dataclass(frozen=True)
class Measure:
    """How far a motion is from the true one, by a motion on fewer stages."""

    error: float  # distance from the branch where the steps meet, relative to the motion
    peak_error: float  # of the extremes of what is shown, absolute
    value_error: float  # the parameter's part of it
    multiplier_errors: Array  # (2n,)
    rough: Array  # (2n, 2n): monodromy matrix of the other motion


def sizes_of(coordinates: Array, rates: Array, least: float = 0.0) -> Array:
    """Return the sizes of coordinates and rates ``(m, n)``, ``(2n,)``: the largest of each kind."""
    largest = [max(float(np.max(np.abs(part))), least) for part in (coordinates, rates)]
    return np.repeat(largest, coordinates.shape[1])


def remaining(size: float, before: float, last: float = _LAST) -> float:
    """Return what a correction leaves, infinite where another one is wanted.

    ``before``: the correction before, infinite for the first one; ``last``: what may be left.
    """
    if size <= _LAST:
        return 0.0  # but for round-off
    if size <= _SMALL and size >= 0.5 * before:
        return size  # it falls no more
    left = _MORE * size * (size / before) ** 2 if size <= _SQUARED else np.inf
    return left if 0.0 < left <= last else np.inf


def share(difference: Any, level: float) -> Any:
    """Return the error of what differs so much from what fewer stages give.

    A difference within a level of rounding, or of a linearisation before the last correction, is
    no larger than the error.
    """
    return SHARE * difference + np.minimum(5.0 * difference, level)


@dataclass(frozen=True)
class Solver:
    """Newton's iteration for the periodic motions of a problem."""

    problem: Problem
    span: float  # range of the parameter, by which its changes are measured
    rtol: float = 1e-8  # wanted error of the motions, relative

    def scale(self, motion: Motion) -> Array:
        """Return the sizes of coordinates and rates, ``(2n,)``: the largest of each kind."""
        return sizes_of(motion.x, motion.v, self.problem.system.small)

    def settled(self, value: float, motion: Motion) -> Motion:
        """Return the periodic motion near a guess at a value, by damped steps of Newton.

        Raises `Lost` where there is none.
        """
        before = np.inf
        for _ in range(_MOST_ITERATIONS):
            swept = sweep(self.problem, value, motion)
            change = closed(swept)
            scale = self.scale(motion)
            size = float(np.max(np.abs(change) / scale))
            if not np.isfinite(size):
                break
            part = 1.0 if size <= 1.0 or np.all(scale == self.problem.system.small) else 1.0 / size
            motion = taken(motion, swept, change, 0.0, part)
            if np.isfinite(remaining(size, before)):
                return motion
            before = size
        raise Lost("no periodic motion was found near the guess")

    def corrected(self, value: float, motion: Motion, direction: Direction) -> tuple[Orbit, float]:
        """Return the motion nearest to a guess across a direction, and the first correction.

        Raises `Lost` where there is none near.
        """
        orbits, first = self.all_corrected([(value, motion, direction)])
        return orbits[0], first

    def all_corrected(
        self, guesses: Sequence[tuple[float, Motion, Direction]]
    ) -> tuple[list[Orbit], float]:
        """Return the motions nearest to guesses of as many steps, and the largest first correction.

        They are corrected side by side.  Raises `Lost` where there is none near one of them.
        """
        values = np.array([value for value, _, _ in guesses])
        motions = [motion for _, motion, _ in guesses]
        directions = [direction.resampled(len(motion.x)) for _, motion, direction in guesses]
        before, first = np.inf, 0.0
        by_parameter: bool | Array = True
        for _ in range(_ITERATIONS):
            together = Motion.together(motions)
            swept = sweep(self.problem, values, together, by_parameter=by_parameter)
            runs = swept.runs(len(motions))
            chains = [chained(run.maps, run.loads) for run in runs]
            sizes = []
            for i, (run, chain) in enumerate(zip(runs, chains, strict=True)):
                change, moved = _bordered(*chain, directions[i])
                own = float(np.max(np.abs(change) / self.scale(motions[i])))
                sizes.append(max(own, abs(moved) / self.span))
                motions[i] = taken(motions[i], run, change, moved)
                values[i] += moved
            size = max(sizes)
            first = first or size
            if not size < _FAR:
                raise Lost("a correction is too large")
            # The derivative by the parameter is kept where the motions have all but settled.
            by_parameter = swept.by_parameter if size <= _NEAR else True
            if size <= _LAST or (size <= _SMALL and size >= 0.5 * before):
                found = zip(values.tolist(), motions, runs, chains, directions, sizes, strict=True)
                return [self._orbit(*parts) for parts in found], first
            before = size
        raise Lost(f"not there after {_ITERATIONS} corrections")

    def _orbit(
        self,
        value: float,
        motion: Motion,
        swept: Sweep,
        chain: tuple[Array, Array],
        direction: Direction,
        last: float,
    ) -> Orbit:
        """Return the motion with its tangent, in the sense of a direction."""
        whole, added = chain
        measured = replace(direction, scale=self.scale(motion), span=self.span)
        change, moved = _bordered(whole, added, measured, along=1.0)
        tangent = replace(measured, states=change, value=moved).unit()
        slope = (swept.response @ tangent.states[:, None, :, None])[..., 0]
        slope += tangent.value * swept.stage_loads[..., 1]
        rows = _bordered_matrix(whole, added, tangent)
        border = float(np.linalg.det(rows / np.linalg.norm(rows, axis=1, keepdims=True)))
        return Orbit(value, motion, swept, whole, added, tangent, slope, border, last)

    def measure(self, orbit: Orbit) -> Measure:
        """Return how far a motion is from the true one."""
        return self.all_measured([orbit])[0]

    def all_measured(self, orbits: Sequence[Orbit]) -> list[Measure]:
        """Return how far motions of as many steps are from the true ones."""
        fewer = [orbit.motion.with_stages(orbit.motion.a.shape[1] - _FEWER) for orbit in orbits]
        values = np.array([orbit.value for orbit in orbits])
        swept = sweep(self.problem, values, Motion.together(fewer)).runs(len(orbits))
        return [self._measured(*parts) for parts in zip(orbits, fewer, swept, strict=True)]

    def _measured(self, orbit: Orbit, fewer: Motion, swept: Sweep) -> Measure:
        """Return how far a motion is from the true one, by its sweep on fewer stages."""
        motion = orbit.motion
        stages = motion.a.shape[1]
        whole, added = chained(swept.maps, swept.loads)
        # What the parameter does differs but little by fewer stages.
        added = np.concatenate([added, orbit.added[..., 1:]], axis=-1)
        change, moved = _bordered(whole, added, orbit.tangent)
        rounding, noise = self._rounding(orbit)
        size = max(float(np.linalg.norm(orbit.matrix)), 1.0)
        scale = orbit.tangent.scale
        sizes = np.max(np.abs(change) / scale, axis=0)
        away = share(max(float(np.max(sizes)), abs(moved) / self.span), noise) + rounding
        within = taken(fewer, swept, change, 0.0).at_stages(stages)
        moved_most, off = self._shown(orbit, within)
        moved_by = share(float(np.max(sizes[: motion.x.shape[1]])), noise) + rounding
        differences = _differences(orbit, np.asarray(whole[-1]))
        return Measure(
            away,
            _INNER_SHARE * off + (moved_by + 256 * EPS) * moved_most,
            share(abs(moved), noise * self.span) + rounding * max(abs(orbit.value), self.span),
            share(differences, (noise + _STALE * orbit.last) * size) + rounding * size,
            np.asarray(whole[-1]),
        )

    def _shown(self, orbit: Orbit, other: Array) -> tuple[float, float]:
        """Return how far the deflection moves if all coordinates move by their size, and does."""
        # `other`: the coordinates at the Gauss points of another motion; the deflections of both
        # are compared near the extremes.
        shown, (_, parameters) = self.problem.system.shown, self.problem.at(orbit.value)
        q = orbit.motion.stages()[0]
        step = 1e-4 * float(orbit.tangent.scale[0]) * np.eye(self.problem.system.size)[:, None]
        both = shown(orbit.motion.x + step, parameters) - shown(orbit.motion.x - step, parameters)
        most = float(np.max(np.sum(np.abs(both), axis=0))) / 2e-4
        values = shown(q, parameters)
        near = np.abs(values - 0.5 * (np.min(values) + np.max(values))) >= _NEAR_TOP * np.ptp(
            values
        )
        off = np.abs(shown(other, parameters) - values)
        return most, float(np.max(off[near]))

    def _rounding(self, orbit: Orbit) -> tuple[float, float]:
        """Return the error of a sum over the steps, and of coordinates by rounded accelerations."""
        # A link's angle is of the order of 1 while it bends by less.
        n = self.problem.system.size
        stiffness = float(np.max(np.abs(orbit.swept.response[:, :, :, :n])))
        scale = float(orbit.tangent.scale[0])
        return 48 * EPS * len(orbit.motion.x), 32 * EPS * (1.0 + stiffness / min(scale, 1.0))

    def fine(self, value: float, motion: Motion, direction: Direction) -> tuple[Orbit, Measure]:
        """Return the motion across a direction, on as many steps as its error wants."""
        orbit, _ = self.corrected(value, motion, direction)
        return self.refined(orbit, direction)

    def refined(
        self, orbit: Orbit, direction: Direction | None = None, measure: Measure | None = None
    ) -> tuple[Orbit, Measure]:
        """Return a motion on as many steps as its error wants, and that error.

        Across a direction, by default that of the branch.  ``measure``: its error, where known.
        """
        across = direction or orbit.tangent
        while True:
            measure, steps = measure or self.measure(orbit), len(orbit.motion.x)
            unsure = np.max(measure.multiplier_errors / np.maximum(np.abs(orbit.multipliers), 1.0))
            sure = measure.error <= self.rtol and unsure <= _MULTIPLIERS * self.rtol
            if sure or steps >= MOST_STEPS * orbit.motion.turns:
                return orbit, measure
            motion = orbit.motion.resampled(int(np.ceil(1.3 * steps)), STAGES)
            (orbit, _), measure = self.corrected(orbit.value, motion, across), None

    def along_parameter(self, motion: Motion, sign: float = 1.0) -> Direction:
        """Return the direction in which the parameter alone changes."""
        n = motion.x.shape[1]
        zero = np.zeros((len(motion.x), 2 * n))
        return Direction(zero, sign * self.span, self.scale(motion), self.span)


def _differences(orbit: Orbit, rough: Array) -> Array:
    """Return by how much multipliers differ from those of another matrix, ``(2n,)``."""
    # At least a part of what the difference of the matrices may amount to: that of a multiplier
    # passes zero where its signs change.
    multipliers, vectors = orbit.eigen
    rows, columns = np.abs(np.linalg.pinv(vectors)), np.abs(vectors)
    gaps = np.abs(rough - orbit.matrix)
    # Two that have all but met part by a root.
    root = np.sqrt(np.linalg.norm(gaps) * np.linalg.norm(orbit.matrix))
    most = np.minimum(np.sum(rows @ gaps * columns.T, axis=1), root)
    others, found = np.linalg.eigvals(rough).astype(complex), []
    for multiplier in multipliers:
        nearest = int(np.argmin(np.abs(others - multiplier)))
        found.append(abs(others[nearest] - multiplier))
        others = np.delete(others, nearest)
    return np.asarray(np.maximum(found, _LEAST_PART * most))


def changed(orbit: Orbit, direction: Direction, length: float) -> tuple[float, Motion]:
    """Return value and motion beside an orbit, its accelerations as linearised."""
    states, moved = length * direction.states, length * direction.value
    swept = orbit.swept
    a = (swept.response @ states[:, None, :, None])[..., 0] + moved * swept.stage_loads[..., 1]
    return orbit.value + moved, orbit.motion.moved(states, a)


def closed(swept: Sweep) -> Array:
    """Return the changes of the states ``(m, 2n)`` that close the period at one parameter.

    Raises `Lost` where there are none.
    """
    whole, added = chained(swept.maps, swept.loads)
    try:
        first = np.linalg.solve(np.eye(whole.shape[-1]) - whole[-1], added[-1, :, 0])
    except np.linalg.LinAlgError as singular:
        raise Lost("a multiplier is 1") from singular
    return np.asarray(whole[:-1] @ first + added[:-1, :, 0])


def taken(motion: Motion, swept: Sweep, change: Array, moved: float, part: float = 1.0) -> Motion:
    """Return a motion after a correction of its states."""
    a = swept.stage_loads[..., 0] + (swept.response @ change[:, None, :, None])[..., 0]
    if moved:
        a = a + moved * swept.stage_loads[..., 1]
    return motion.moved(part * change, part * a)


def _bordered_matrix(whole: Array, added: Array, direction: Direction) -> Array:
    """Return the equations of first state and parameter: the period, and across a direction."""
    row, last = direction.weights
    size = whole.shape[-1]
    matrix = np.empty((size + 1, size + 1))
    matrix[:size, :size] = whole[-1] - np.eye(size)
    matrix[:size, size] = added[-1, :, 1]
    matrix[size, :size] = np.einsum("mi,mij->j", row, whole[:-1])
    matrix[size, size] = np.sum(row * added[:-1, :, 1]) + last
    return matrix


def _bordered(
    whole: Array, added: Array, direction: Direction, along: float = 0.0
) -> tuple[Array, float]:
    """Return changes of states and parameter that close the period, by so much along."""
    # With `along` what is wrong with the motion is left aside.
    wrong = 0.0 if along else 1.0
    row, _ = direction.weights
    right = np.append(-wrong * added[-1, :, 0], along - wrong * np.sum(row * added[:-1, :, 0]))
    matrix = _bordered_matrix(whole, added, direction)
    try:
        solution = np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        # At a branch point, to the last digit: the shortest of all solutions.
        solution = np.linalg.lstsq(matrix, right)[0]
    first, moved = solution[:-1], float(solution[-1])
    change = whole[:-1] @ first + wrong * added[:-1, :, 0] + moved * added[:-1, :, 1]
    return change, moved
