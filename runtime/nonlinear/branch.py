"""Branches of periodic motions: steps along them, special points, and the branches that cross."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import takewhile

import numpy as np

from .orbit import EPS, FAILURES, STAGES, Direction, Lost, Measure, Orbit, Solver, changed
from .segments import Motion

# First correction that a step aims at, relative; factors by which a step changes at once; its
# first, its least and its largest length.
_AIM = 1e-4
_LONGER, _SHORTER = 2.0, 0.3
_PAST = 2  # motions before the last one that a step is extrapolated from
_FIRST, _LEAST, _LARGEST = 0.02, 1e-7, 0.5
# Parts of the range that a step may change the parameter by, and between two points of a curve.
_REACH, _WIDEST = 1.0 / 20.0, 1.0 / 60.0
# Relative amplitude at which a crossing branch is entered.
_ENTERED = 0.02
# Steps of a special point over those of the motions about it, the part of a step that it may lie
# beyond it by, and to which it is located; last correction after which a test is what it is.
_FINER, _BEYOND, _LOCATED, _FRESH = 1.4, 1e-3, 1e-12, 1e-13
_ROUNDING = 64 * EPS  # of a test, over the size of the matrix
# Part of a test's value to which the parabola through three has to fall for a pair to be sought.
_DIP = 0.3


@dataclass(frozen=True)
class Special:
    """A point of a branch at which motions meet, or lose their stability."""

    kind: str  # "fold", "doubling", "branch point" or "torus"
    orbit: Orbit
    measure: Measure
    value_error: float


def torus(orbit: Orbit) -> float:
    """Return what vanishes where a pair of complex multipliers passes the unit circle."""
    pairs = np.abs(orbit.multipliers[orbit.multipliers.imag > 1e-9])
    return float(np.log(pairs[np.argmin(np.abs(np.log(pairs)))])) if pairs.size else np.nan


# What vanishes at a special point of a kind: the parameter's part of the tangent; the determinant
# that is zero where a multiplier is -1; that of the bordered equations where branches cross.
TESTS: dict[str, Callable[[Orbit], float]] = {
    "fold": lambda orbit: orbit.tangent.value / orbit.tangent.span,
    "doubling": lambda orbit: float(np.linalg.det(orbit.matrix + np.eye(len(orbit.matrix)))),
    "branch point": lambda orbit: orbit.border,
    "torus": torus,
}


@dataclass(frozen=True)
class Branch:
    """One branch, point by point, special points among them."""

    points: tuple[tuple[Orbit, Measure], ...]
    special: tuple[Special, ...]
    ended: str  # why

    @property
    def turns(self) -> int:
        """Revolutions of the drive after which the motions repeat."""
        return self.points[0][0].motion.turns

    def joined(self, ahead: Branch) -> Branch:
        """Return one branch of two that begin at one point: this one backwards, then the other."""
        back = tuple((orbit.turned(), measure) for orbit, measure in reversed(self.points))
        special = (*reversed(self.special), *ahead.special)
        ended = dict.fromkeys((self.ended, ahead.ended))
        return Branch((*back, *ahead.points[1:]), special, "; ".join(ended))


LEFT, CLOSED, JOINED = "it leaves the range", "it closes", "it joins a motion of fewer turns"


@dataclass(frozen=True)
class Limits:
    """Where branches end."""

    low: float  # of the parameter
    high: float
    largest: float  # of the deflection over the length, where the system watches it
    points: int


def followed(solver: Solver, begun: tuple[Orbit, Measure], limits: Limits) -> Branch:
    """Follow a branch from a motion along its tangent, locating special points on the way.

    It ends where it leaves the range or cannot be followed, where it comes back to its beginning,
    and where a motion of several turns becomes one of fewer.
    """
    points: list[tuple[Orbit, Measure]] = [begun]
    special: list[Special] = []
    ended, before = f"it has {limits.points} points", None
    for orbit, measure, reason in _steps(solver, *begun, limits):
        if orbit is None or measure is None:
            ended = reason
            break
        last = points[-1][0]
        found = [*special_points(solver, last, orbit)]
        if before is not None and not found:
            found = [*hidden_pairs(solver, before, last, orbit)]
        special += found
        rows = [*points[len(points) - 1 :], *((point.orbit, point.measure) for point in found)]
        if found:
            # A hidden pair may lie before the last motion: all stand in the order of the branch.
            along = [orbit.tangent.dot(_change(orbit, row[0])) for row in rows]
            points[-1:] = [rows[i] for i in np.argsort(along, kind="stable")]
        points.append((orbit, measure))
        before = last
    return Branch(tuple(points), tuple(special), ended)


def _change(orbit: Orbit, other: Orbit) -> Direction:
    """Return what leads from a motion to another."""
    x, v, _ = other.motion.at(orbit.motion.step * np.arange(len(orbit.motion.x)))
    states = np.concatenate([x, v], axis=1) - orbit.motion.states
    return replace(orbit.tangent, states=states, value=other.value - orbit.value)


def _steps(
    solver: Solver, orbit: Orbit, measure: Measure, limits: Limits
) -> Iterator[tuple[Orbit | None, Measure | None, str]]:
    """Yield the motions along a branch, and at last why it ends."""
    step, first, away = _FIRST, orbit, False
    past: list[Orbit] = []
    watch = solver.problem.system.watch
    for _ in range(limits.points):
        points: list[tuple[Orbit, Measure]] = []
        while not points:
            if step < _LEAST:
                yield None, None, "it cannot be followed"
                return
            try:
                points, size = _ahead(solver, orbit, step, past)
            except FAILURES:
                step *= _SHORTER
        inside = [*takewhile(lambda at: limits.low <= at[0].value <= limits.high, points)]
        if len(inside) < len(points):
            beyond = points[len(inside)]
            points = [*inside, _at_end(solver, orbit, beyond[0], limits) or beyond]
        for point, measure in points:
            if _fewer_turns(orbit.motion, point.motion):
                yield None, None, JOINED
                return
            yield point, measure, ""
            if watch is not None and float(np.max(watch(point.motion.x))) > limits.largest:
                yield None, None, f"the deflection passes {limits.largest:g} of the length"
                return
        if len(inside) < len(points):
            yield None, None, LEFT
            return
        ahead = points[-1][0]
        passed = abs(first.value - ahead.value) <= 2.0 * step * solver.span and _passed(
            ahead, orbit, first
        )
        if away and passed:
            yield None, None, CLOSED
            return
        away = away or not passed
        order = 2 * (1 + len(past))
        grown = float(np.clip((_AIM / max(size, 1e-12)) ** (1 / order), _SHORTER, _LONGER))
        reach = _REACH * solver.span / max(abs(ahead.tangent.value), 1e-12)
        past, orbit = [orbit, *past][:_PAST], ahead
        step = min(step * grown, _LARGEST, reach)


def _ahead(
    solver: Solver, orbit: Orbit, step: float, past: list[Orbit]
) -> tuple[list[tuple[Orbit, Measure]], float]:
    """Return the motions of a step, as dense as a curve through them wants, with their errors."""
    # And the largest first correction.  They are corrected side by side, as arrays of more states
    # cost less a state.
    past = [other.resampled(len(orbit.motion.x)) for other in past]
    value, guess = orbit.ahead(step, past)
    # Before a fold, where the parameter slows down, as many as its present rate wants.
    wide = max(abs(value - orbit.value), step * abs(orbit.tangent.value))
    count = max(round(wide / (_WIDEST * solver.span)), 1)
    guesses = [orbit.ahead(step * j / count, past) for j in range(1, count)]
    orbits, size = solver.all_corrected(
        [(*each, orbit.tangent) for each in (*guesses, (value, guess))]
    )
    if orbits[-1].tangent.dot(orbit.tangent) < 0.5:
        raise Lost("the branch turns within a step")
    pairs = zip(orbits, solver.all_measured(orbits), strict=True)
    return [solver.refined(orbit, measure=measure) for orbit, measure in pairs], size


def _at_end(
    solver: Solver, orbit: Orbit, beyond: Orbit, limits: Limits
) -> tuple[Orbit, Measure] | None:
    """Return the motion at the end of the range that a step leaves, None where it is not found."""
    value = limits.low if beyond.value < limits.low else limits.high
    across = solver.along_parameter(beyond.motion, beyond.value - orbit.value)
    with suppress(*FAILURES):
        found, measure = solver.fine(value, beyond.motion, across)
        return found if found.tangent.dot(orbit.tangent) > 0.0 else found.turned(), measure
    return None


def _passed(ahead: Orbit, orbit: Orbit, first: Orbit) -> bool:
    """Return True where the first motion of a branch lies on the step between two motions."""
    change, step = _change(ahead, first), ahead.tangent.dot(_change(ahead, orbit))
    along, square = ahead.tangent.dot(change), change.dot(change)
    same_way = ahead.tangent.dot(first.tangent) > 0.0
    return step <= along <= 0.0 and square - along * along <= (0.1 * step) ** 2 and same_way


def _fewer_turns(before: Motion, after: Motion) -> bool:
    """Return True where the halves of a motion have become equal between two points."""
    if before.turns % 2:
        return False
    half = np.pi * before.turns
    angles = half * np.arange(64) / 64
    first, last = (motion.at(angles)[0] - motion.at(angles + half)[0] for motion in (before, after))
    return bool(np.sum(first * last) <= 0.0)


def special_points(solver: Solver, before: Orbit, after: Orbit) -> Iterator[Special]:
    """Yield the special points between two motions, located."""
    for kind, test in TESTS.items():
        values = test(before), test(after)
        # A value that is zero to the last digit belongs to one of the two steps that meet there.
        if not min(values) < 0.0 <= max(values):
            continue
        if kind == "torus" and not _leaves(solver, before, after):
            continue
        with suppress(*FAILURES):
            yield _located(solver, kind, _Between(solver, before, after))


def _leaves(solver: Solver, *orbits: Orbit) -> bool:
    """Return False where pairs become real, or lie on the unit circle by their errors."""
    # So they do along the whole branch of a system without damping.
    pairs = {int(np.sum(orbit.multipliers.imag > 0)) for orbit in orbits}
    return len(pairs) == 1 and any(
        abs(torus(orbit)) > np.max(solver.measure(orbit).multiplier_errors) for orbit in orbits
    )


def hidden_pairs(solver: Solver, before: Orbit, here: Orbit, after: Orbit) -> Iterator[Special]:
    """Yield two special points between three motions whose test has the same sign at each.

    That is sought where the parabola through the three values all but comes to zero.
    """
    from scipy.optimize import minimize_scalar

    for kind in ("doubling", "branch point"):
        test = TESTS[kind]
        values = np.array([test(orbit) for orbit in (before, here, after)])
        sign = np.sign(values[1])
        first, middle, last = sign * values
        bend = first - 2.0 * middle + last
        if not (min(first, middle, last) > 0.0 and middle <= min(first, last) and bend > 0.0):
            continue
        if middle - (last - first) ** 2 / (8.0 * bend) > _DIP * middle:
            continue
        between = _Between(solver, *((before, here) if first < last else (here, after)))
        with suppress(*FAILURES):
            lowest = minimize_scalar(
                lambda part, between=between, test=test, sign=sign: sign * test(between(part)),
                bounds=(0.0, 1.0),
                method="bounded",
                options={"maxiter": 16},
            )
            if lowest.fun < 0.0:
                yield _located(solver, kind, between, 0.0, lowest.x)
                yield _located(solver, kind, between, lowest.x, 1.0)


class _Between:
    """The motions of a branch between two of them, on more steps than these."""

    def __init__(self, solver: Solver, before: Orbit, after: Orbit) -> None:
        self.solver = solver
        steps = int(np.ceil(_FINER * len(after.motion.x)))
        ends, _ = solver.all_corrected(
            [(o.value, o.motion.resampled(steps, STAGES), o.tangent) for o in (before, after)]
        )
        self._found = list(zip((0.0, 1.0), ends, strict=True))
        chord = _change(ends[1], ends[0]).times(-1.0)
        self._length = float(np.sqrt(chord.dot(chord)))
        self._chord = chord.unit()

    def __call__(self, part: float) -> Orbit:
        """Return the motion at a part of the way on the line between both."""
        places = [place for place, _ in self._found]
        k = int(np.searchsorted(places, part))
        if k < len(places) and places[k] == part:
            return self._found[k][1]
        upper = min(max(k, 1), len(places) - 1)
        (_, before), (end, after) = self._found[upper - 1 : upper + 1]
        value, guess = after.ahead((part - end) * self._length, (before,))
        # Across the line at its own part of it, whatever the guess is.
        first = self._found[0][1]
        off = replace(
            self._chord, states=guess.states - first.motion.states, value=value - first.value
        )
        along = part * self._length - self._chord.dot(off)
        chord = self._chord.times(along)
        orbit, _ = self.solver.corrected(
            value + chord.value, guess.moved(chord.states, 0.0 * guess.a), self._chord
        )
        if orbit.last > _FRESH:
            orbit, _ = self.solver.corrected(orbit.value, orbit.motion, self._chord)
        orbit = orbit if orbit.tangent.dot(self._chord) >= 0 else orbit.turned()
        self._found.insert(k, (part, orbit))
        return orbit


def _located(
    solver: Solver, kind: str, between: _Between, low: float = 0.0, high: float = 1.0
) -> Special:
    """Return the special point between two motions at which a test has different signs."""
    from scipy.optimize import brentq

    test = TESTS[kind]
    rounding = 4 * EPS
    if test(between(low)) * test(between(high)) > 0.0:
        # On more steps it lies just beyond.
        low, high = low - _BEYOND, high + _BEYOND
        if test(between(low)) * test(between(high)) > 0.0:
            raise Lost("a test keeps its sign on more steps")
    part = brentq(lambda p: test(between(p)), low, high, xtol=_LOCATED, rtol=rounding, maxiter=60)
    orbit = between(part)
    measure = solver.measure(orbit)
    return Special(kind, orbit, measure, value_error(solver, orbit, kind, measure))


def value_error(solver: Solver, orbit: Orbit, kind: str, measure: Measure | None = None) -> float:
    """Return the error estimate of the parameter at a special point."""
    measure = measure or solver.measure(orbit)
    if kind == "fold":
        return measure.value_error
    test, step = TESTS[kind], 1e-4
    value, guess = changed(orbit, orbit.tangent, step)
    beside, _ = solver.corrected(value, guess, orbit.tangent)
    slope = (test(beside) - test(orbit)) / step
    rough = replace(orbit, whole=np.concatenate([orbit.whole[:-1], measure.rough[None]]))
    # Not a share of it: the linearisation before the last correction is in the difference, too.
    off = abs(test(rough) - test(orbit)) + _ROUNDING * max(float(np.linalg.norm(orbit.matrix)), 1.0)
    along = off / abs(slope) if slope else np.inf
    return measure.value_error + along * abs(orbit.tangent.value)


def doubled(solver: Solver, orbit: Orbit) -> tuple[Orbit, Measure]:
    """Return a first motion of twice the turns, beside a doubling."""
    values, vectors = orbit.eigen
    vector = np.real(vectors[:, np.argmin(np.abs(values + 1.0))])
    change = orbit.whole[:-1] @ vector
    motion = orbit.motion
    a = (orbit.swept.response @ change[:, None, :, None])[..., 0]
    x, v, every = (np.concatenate([part] * 2) for part in (motion.x, motion.v, motion.a))
    twice = Motion(2 * motion.turns, x, v, every)
    states, a = np.concatenate([change, -change]), np.concatenate([a, -a])
    long = replace(orbit.tangent, states=states, value=0.0)
    length = _ENTERED / float(np.sqrt(long.dot(long)))
    for _ in range(6):
        guess = twice.moved(length * states, length * a)
        try:
            return solver.fine(orbit.value, guess, long.unit())
        except FAILURES:
            length *= _SHORTER
    raise Lost("the branch of twice the turns cannot be entered")


def crossing(solver: Solver, orbit: Orbit, sign: float) -> tuple[Orbit, Measure]:
    """Return a first motion on the branch that crosses at a branch point, to one side."""
    size = len(orbit.matrix)
    equations = np.column_stack([orbit.matrix - np.eye(size), orbit.added[-1, :, 1] * solver.span])
    vectors = np.linalg.svd(equations)[2][-2:]
    ways = []
    for vector in vectors:
        value = float(vector[-1]) * solver.span
        states = orbit.whole[:-1] @ vector[:-1] + value * orbit.added[:-1, :, 1]
        ways.append(replace(orbit.tangent, states=states, value=value))
    along = [orbit.tangent.dot(way) for way in ways]
    mixed = replace(
        ways[0],
        states=along[1] * ways[0].states - along[0] * ways[1].states,
        value=along[1] * ways[0].value - along[0] * ways[1].value,
    ).unit()
    length = sign * _ENTERED
    for _ in range(6):
        value, guess = changed(orbit, mixed, length)
        try:
            found, measure = solver.fine(value, guess, mixed.times(sign))
            return found, measure
        except FAILURES:
            length *= _SHORTER
    raise Lost("the branch that crosses cannot be entered")
