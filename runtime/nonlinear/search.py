"""Periodic motions beside the known ones: starts of many kinds, known motions deflated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import Array, Nonlinear
from ..core.inputs import is_finite, require_whole
from ..core.progress import bar
from ..core.results import Result, provenance
from .march import Marcher, end
from .orbit import FAILURES, FIRST_STEPS, STAGES, Solver, taken
from .response import checked_problem, extremes, first_motion, same_motion
from .segments import Motion, Problem, chained, evaluated, sweep

# Amplitudes of the starts in the first coordinate that suits, over its largest trial; phases.
_AMPLITUDES, _PHASES = (0.1, 0.2, 0.35, 0.5), 6
# Starts of random harmonics, and how many of these a turn: one in fifty reaches an unstable motion
# of large amplitude that all other starts have missed.
_RANDOM, _HARMONICS = 192, 4
# Marched starts, revolutions of each at the most, and how near a state has to come back.
_MARCHED, _SETTLING, _NEAR = 12, 120, 1e-2
# Their relative error, and steps of a revolution: one that takes more is lost.
_ROUGHLY, _MARCHED_STEPS = 1e-4, 96
# Corrections of a start, relative correction of what is worth to be settled, starts together.
_ITERATIONS, _ARRIVED, _AT_ONCE = 40, 1e-6, 24


@dataclass(frozen=True, kw_only=True)
class CoexistingMotions(Result):
    """Periodic motions of a system at one value of a parameter, and what was searched for them.

    Attributes
    ----------
    motions : tuple of Motion
        The motions; to :func:`response_curve` they go as ``starts``.
    turns : ndarray of int, shape (m,)
    lowest, highest : ndarray, shape (m,)
        Extremes of the deflection.
    multiplier : ndarray, shape (m,)
        Modulus of the largest Floquet multiplier, over the period.
    value : float
        The parameter.
    searched : mapping of str to int
        Starts of each kind that were tried.  There may be other motions.
    """

    motions: tuple[Motion, ...]
    turns: NDArray[np.int64]
    lowest: Array
    highest: Array
    multiplier: Array
    value: float
    searched: Mapping[str, int]
    unit: str = ""

    arrays_along: ClassVar = {"motion": "turns lowest highest multiplier error stable"}
    exported: ClassVar[tuple[str, ...]] = ("stable",)

    def _own_units(self) -> dict[str, str]:
        return dict.fromkeys(("lowest", "highest"), self.unit)

    @property
    def stable(self) -> NDArray[np.bool_]:
        """True where no multiplier lies outside the unit circle."""
        return np.asarray(self.multiplier <= 1.0 + 1e-8)


def coexisting_motions(
    system: Nonlinear,
    parameter: str,
    value: float,
    *,
    speed: float | None = None,
    turns: int = 1,
    largest: float = 0.5,
    seed: int = 0,
    rtol: float = 1e-8,
    progress: bool = False,
) -> CoexistingMotions:
    """Search for periodic motions at one value of a parameter.

    Newton's iteration from many starts, motions that are known deflated (a step towards one of
    them is turned away): from rest; from harmonics of each mode at frozen frequencies, as large as
    a softened resonance would have them; from motions that were marched from random states; and
    from sums of random harmonics.

    Parameters
    ----------
    system : Nonlinear
    parameter : str
        ``"speed"``, or a name of ``system.parameters``.
    value : float
        Its value [SI].
    speed : float, optional
        Speed of the drive [rad/s] where something else is given.
    turns : int
        Largest number of revolutions after which the motions repeat.
    largest : float
        Largest amplitude of a start, in the unit of the coordinates.
    seed : int
        Of the random starts.
    rtol : float
        Wanted error of the motions, relative.
    progress : bool
        Whether to show a bar.

    Returns
    -------
    CoexistingMotions

    Raises
    ------
    BadInput
        If an argument is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> changes = {"model.formulation": "inextensible", "coupler.damping_ratio": 0.03}
    >>> rig = el.load_scene("smith_1972_101104_thirtysecond_inch", changes).system()
    >>> found = el.nonlinear.coexisting_motions(rig, "speed", 37.0)
    >>> print(found.stable, (1000.0 * (found.highest - found.lowest)).round(1))
    [ True False  True] [30.8 54.9 61.7]
    """
    if not is_finite(value):
        raise bad("value", repr(value), "a finite number", "correct it")
    around = (value - 0.01 * abs(value) - 1e-300, value)
    problem, _, _ = checked_problem(system, parameter, around, speed)
    require_whole("turns", turns, 1, 64)
    if not (is_finite(largest) and largest > 0):
        raise bad("largest", repr(largest), "a positive amplitude", "try 0.5")
    solver = Solver(problem, max(abs(value), 1e-6), rtol)
    starts = _starts(solver, value, turns, largest, np.random.default_rng(seed))
    counts = {kind: len(motions) for kind, motions in starts.items()}
    # A motion that is so much larger than the largest start is given up.
    bound = 50.0 * largest
    found: list[Motion] = []
    with bar(progress, len(starts) + 1, unit="kind of start") as tick:
        for number, motions in enumerate(starts.values()):
            for motion in _together(solver, value, motions, bound):
                _keep(solver, found, motion)
            tick(number + 1)
        counts["known ones, deflated"] = len(found) + 1
        for start in [first_motion(problem), *found]:
            near = start.moved(0.1 * largest * np.ones_like(start.states), 0.0 * start.a)
            for motion in _together(solver, value, [near], bound, found):
                _keep(solver, found, motion)
    return _result(solver, value, found, counts)


def _keep(solver: Solver, found: list[Motion], motion: Motion) -> None:
    """Add a motion to the known ones unless it is one of them."""
    short = _shortest(motion)
    if not any(same_motion(solver, known, short) for known in found):
        found.append(short)


@np.errstate(all="ignore")
def _together(
    solver: Solver,
    value: float,
    starts: Sequence[Motion],
    bound: float,
    known: Sequence[Motion] = (),
) -> list[Motion]:
    """Return the periodic motions that starts of as many turns come to, all of them at once."""
    # Known ones are deflated.
    arrived: list[Motion] = []
    queues: dict[tuple[int, ...], list[Motion]] = {}
    for start in starts:
        queues.setdefault((start.turns, *start.a.shape), []).append(start)
    for queue in queues.values():
        for first in range(0, len(queue), _AT_ONCE):
            arrived += _newton(solver, value, queue[first : first + _AT_ONCE], bound, known)
    settled = []
    for motion in arrived:
        with suppress(*FAILURES):
            settled.append(solver.settled(value, motion))
    return settled


def _newton(
    solver: Solver, value: float, starts: list[Motion], bound: float, known: Sequence[Motion]
) -> list[Motion]:
    """Return what Newton's iteration makes of starts of one shape, damped each by itself."""
    arrived: list[Motion] = []
    size = 2 * solver.problem.system.size
    for _ in range(_ITERATIONS):
        if not starts:
            break
        motion = Motion.together(starts)
        runs, m = motion.runs, len(motion.x) // motion.runs
        try:
            swept = sweep(solver.problem, value, motion)
        except FAILURES:
            if len(starts) == 1:
                break
            # One that cannot be evaluated must not stop the others.
            half = len(starts) // 2
            return arrived + [
                found
                for part in (starts[:half], starts[half:])
                for found in _newton(solver, value, part, bound, known)
            ]
        maps, loads = (
            part.reshape(runs, m, size, -1).swapaxes(0, 1) for part in (swept.maps, swept.loads)
        )
        whole, added = chained(maps, loads)
        first = _solved(np.eye(size) - whole[-1], added[-1])
        change = (whole[:-1] @ first + added[:-1])[..., 0].swapaxes(0, 1)
        going: list[Motion] = []
        for here, run, step in zip(starts, swept.runs(runs), change, strict=True):
            scale = solver.scale(here)
            factor = _turned_away(here, step, scale, known)
            large = abs(factor) * float(np.max(np.abs(step) / scale))
            if not np.isfinite(large) or float(np.max(np.abs(here.x))) > bound:
                continue
            ahead = taken(here, run, step, 0.0, factor * min(1.0, 0.5 / max(large, 1e-300)))
            (arrived if large <= _ARRIVED else going).append(ahead)
        starts = going
    return arrived


def _solved(matrices: Array, right: Array) -> Array:
    """Return the solutions of equations, NaN where they have none."""
    try:
        return np.asarray(np.linalg.solve(matrices, right))
    except np.linalg.LinAlgError:
        if len(matrices) == 1:
            return np.full_like(right, np.nan)
        each = zip(matrices[:, None], right[:, None], strict=True)
        return np.concatenate([_solved(*one) for one in each])


def _starts(
    solver: Solver, value: float, turns: int, largest: float, random: np.random.Generator
) -> dict[str, list[Motion]]:
    """Return the starts by kind."""
    problem = solver.problem
    starts = {"rest": [first_motion(problem)]}
    for mode, frequency in enumerate(_frequencies(problem, value)):
        for k in range(1, turns + 1):
            # A softened mode answers below its frequency, a hardened one above.
            near = round(float(frequency) * k)
            for order in sorted({max(near - 1, 1), max(near, 1), near + 1}):
                if k > 1 and np.gcd(order, k) > 1:
                    continue
                for amplitude in _AMPLITUDES:
                    for phase in 2.0 * np.pi * np.arange(_PHASES) / _PHASES:
                        harmonics = np.zeros((problem.system.size, order), dtype=complex)
                        harmonics[mode, -1] = amplitude * largest * np.exp(1j * phase)
                        wave = _wave(problem, harmonics, k)
                        starts.setdefault(f"mode {mode + 1}", []).append(wave)
    marcher = Marcher(problem, _ROUGHLY, _MARCHED_STEPS)
    speed, _ = problem.at(value)
    if problem.name == "speed":
        for _ in range(_MARCHED):
            state = largest * random.normal(size=(1, 2 * problem.system.size))
            marched = _marched(marcher, speed, state, turns)
            if marched is not None:
                starts.setdefault("marched", []).append(marched)
    for k in range(1, turns + 1):
        real, imaginary = random.normal(size=(2, _RANDOM, problem.system.size, _HARMONICS * k))
        harmonics = (real + 1j * imaginary) / np.arange(1, _HARMONICS * k + 1)
        sizes = np.linalg.norm(harmonics, axis=(1, 2)) / (largest * random.uniform(size=_RANDOM))
        waves = (_wave(problem, each, k) for each in harmonics / sizes[:, None, None])
        starts.setdefault("random", []).extend(waves)
    return starts


def _frequencies(problem: Problem, value: float) -> Array:
    """Return natural frequencies about rest over the drive's speed, coefficients averaged."""
    rest = first_motion(problem)
    found = evaluated(problem, value, rest.angles, (*rest.stages(), rest.a))
    mass, stiffness = (np.mean(part, axis=(0, 1)) for part in (found.mass, found.stiffness))
    squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real
    return np.sort(np.sqrt(np.maximum(squares, 0.0)))


def _wave(problem: Problem, harmonics: Array, turns: int) -> Motion:
    """Return the motion with such harmonics ``(n, h)``, the first of so many turns."""
    rest = first_motion(problem, turns)
    rates = 1j * np.arange(1, harmonics.shape[1] + 1) / turns
    begins = rest.step * np.arange(len(rest.x))
    x, v, a = (
        np.real((rates**k * np.exp(np.multiply.outer(angles, rates))) @ harmonics.T)
        for k, angles in enumerate((begins, begins, rest.angles))
    )
    return Motion(turns, x, v, a)


def _marched(marcher: Marcher, speed: float, state: Array, turns: int) -> Motion | None:
    """Return the last revolutions of a motion from a state, or None where it is lost."""
    # It ends where a state all but comes back after some turns.
    last: list[Motion] = []
    states = [state]
    try:
        for _ in range(_SETTLING):
            before = last[-1] if last else None
            last = [*last, marcher.revolution(speed, states[-1], before)][-turns:]
            states.append(end(last[-1]))
            size = np.abs(states[-1]) + marcher.problem.system.small
            gaps = [np.max(np.abs(states[-1] - one) / size) for one in states[-2 : -turns - 2 : -1]]
            near = [k for k, gap in enumerate(gaps, 1) if gap < _NEAR]
            if near and len(last) >= near[0]:
                last = last[-near[0] :]
                break
    except FAILURES:
        return None
    steps = max(len(motion.x) for motion in last)
    whole = Motion.together([motion.resampled(steps, STAGES) for motion in last])
    return replace(whole, turns=len(last), runs=1)


def _turned_away(motion: Motion, change: Array, scale: Array, known: Sequence[Motion]) -> float:
    """Return what a step of Newton's is multiplied by where the known motions are deflated."""
    # With m the product of 1 + 1 / |y - y_i|^2 over them it is 1 / (1 - m' . step / m).
    slope = 0.0
    for other in known:
        for shift in range(other.turns):
            # Where the steps of the motion begin, some turns later.
            angles = motion.step * np.arange(len(motion.x)) + 2.0 * np.pi * shift
            x, v, _ = other.at(np.mod(angles, other.span))
            apart = motion.states - np.concatenate([x, v], axis=1)
            square = float(np.mean(np.sum((apart / scale) ** 2, axis=1))) + 1e-300
            along = float(np.mean(np.sum(apart * change / scale**2, axis=1)))
            slope -= 2.0 * along / (square * (1.0 + square))
    return 1.0 / (1.0 - slope) if slope != 1.0 else 1.0


def _shortest(motion: Motion) -> Motion:
    """Return a motion over as few turns as it repeats after."""
    for turns in range(1, motion.turns):
        if motion.turns % turns:
            continue
        angles = motion.span * np.arange(64) / 64
        later = motion.at(np.mod(angles + 2.0 * np.pi * turns, motion.span))[0]
        here = motion.at(angles)[0]
        if float(np.max(np.abs(later - here))) <= 1e-6 * float(np.max(np.abs(here)) + 1e-300):
            steps = max(len(motion.x) * turns // motion.turns, FIRST_STEPS)
            return motion.resampled(steps, STAGES, turns)
    return motion


def _result(
    solver: Solver, value: float, found: list[Motion], counts: dict[str, int]
) -> CoexistingMotions:
    rows: list[tuple[float, ...]] = []
    kept: list[Motion] = []
    for motion in found:
        try:
            orbit, measure = solver.fine(value, motion, solver.along_parameter(motion))
        except FAILURES:
            continue
        if any(same_motion(solver, known, orbit.motion) for known in kept):
            continue
        ends = extremes(solver.problem, orbit)
        rows.append((orbit.motion.turns, *ends, abs(orbit.multipliers[0]), measure.error))
        kept.append(orbit.motion)
    table = np.array(rows, dtype=float).reshape(-1, 5)
    order = np.argsort(table[:, 2] - table[:, 1], kind="stable")
    table = table[order]
    return CoexistingMotions(
        method="Newton from many starts, known motions deflated",
        error=table[:, 4],
        error_norm="of each motion, relative to its largest coordinate and rate",
        provenance=provenance(solver.problem.system.provenance),
        motions=tuple(kept[i] for i in order),
        turns=table[:, 0].astype(int),
        lowest=table[:, 1],
        highest=table[:, 2],
        multiplier=table[:, 3],
        value=float(value),
        searched=counts,
        unit=solver.problem.system.unit,
    )
