"""Problems, methods at their settings, and how they are measured: in turn, one thread each."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.errors import BadInput
from ...core.progress import bar

Array = NDArray[np.float64]
Work = Callable[[], Any]

# A method is not asked for more digits where a run took longer [s].
_LONGEST = 2.0
# A run that may be broken off is, after this [s].
PATIENCE = 20.0
# Runs longer than this [s] are timed once.
_ONCE = 1.0
# Runs shorter than this [s] are repeated in a round until they have taken as long.
_SHORT = 2e-3


class TooLongError(Exception):
    """A run took longer than ``PATIENCE``."""


def patient(slope: Callable[[float, Array], Array]) -> Callable[[float, Array], Array]:
    """Return a slope that raises TooLongError once ``PATIENCE`` has passed since now."""
    end = time.perf_counter() + PATIENCE

    def limited(place: float, state: Array) -> Array:
        if time.perf_counter() > end:
            raise TooLongError
        return slope(place, state)

    return limited


@dataclass(frozen=True)
class Method:
    """One way to solve a problem, with its settings from loose to tight.

    Attributes
    ----------
    name : str
        As in the table.
    prepare : callable
        From a setting to the work that is timed; compilation belongs here.
    settings : tuple of float
        Tolerances, or steps a revolution.
    ours : bool
        Whether it is this toolkit's.
    share : float
        Part of the whole problem that the work does.
    """

    name: str
    prepare: Callable[[float], Work]
    settings: tuple[float, ...]
    ours: bool = False
    share: float = 1.0


@dataclass(frozen=True)
class Problem:
    """What is solved, its reference, and who solves it.

    Attributes
    ----------
    name : str
        System and task, ``hill-monodromy``.
    title : str
        What it is.
    error : callable
        From what a method returns to its error.
    digits : float
        Error of the reference itself.
    methods : tuple of Method
        The contenders.
    absent : tuple of str
        Peers that are not installed, or do not serve, each with the reason.
    """

    name: str
    title: str
    error: Callable[[Any], float]
    digits: float
    methods: tuple[Method, ...]
    absent: tuple[str, ...] = ()


@dataclass(frozen=True)
class Point:
    """One method at one setting.

    Attributes
    ----------
    problem, method : str
        Names.
    ours : bool
        Whether it is this toolkit's.
    setting : float
        Tolerance, or steps a revolution.
    milliseconds : float
        Median over the rounds, of the whole problem.
    error : float
        Against the reference, at least that of the reference.
    preparation : float
        Seconds of what was made once beforehand: compilation, tables.
    """

    problem: str
    method: str
    ours: bool
    setting: float
    milliseconds: float
    error: float
    preparation: float = 0.0


@dataclass
class _Run:
    """A prepared work, its error, and its times."""

    method: Method
    setting: float
    work: Work
    error: float
    repeats: int
    preparation: float
    times: list[float] = field(default_factory=list)


def measured(
    problem: Problem, rounds: int, *, progress: bool = False
) -> tuple[list[Point], list[str]]:
    """Return every method at every setting that it reached, timed in turn; and who is left out."""
    runs: list[_Run] = []
    left_out = list(problem.absent)
    for method in _shown(problem, progress):
        found, reason = _prepared(problem, method)
        runs += found
        if not found:
            left_out.append(f"{method.name}: {reason}")
    for _ in range(rounds):
        for run in runs:
            if not run.times or run.times[0] < _ONCE:
                run.times.append(_timed(run.work, run.repeats))
    points = [
        Point(
            problem.name,
            run.method.name,
            run.method.ours,
            run.setting,
            1e3 * float(np.median(run.times)) / run.method.share,
            max(run.error, problem.digits),
            run.preparation,
        )
        for run in runs
    ]
    return points, left_out


def _shown(problem: Problem, progress: bool) -> Iterator[Method]:
    """Yield the methods, told of on a progress bar."""
    with bar(progress, len(problem.methods), unit=f" methods of {problem.name}") as tick:
        for done, method in enumerate(problem.methods, 1):
            yield method
            if tick is not None:
                tick(done)


def _prepared(problem: Problem, method: Method) -> tuple[list[_Run], str]:
    """Return the runs of a method, until one takes too long; and why there is no other."""
    runs: list[_Run] = []
    reason = "no setting gave a finite result"
    for setting in method.settings:
        begin = time.perf_counter()
        try:
            work = method.prepare(setting)
            error = problem.error(work())
        except TooLongError:
            reason = f"broken off after {PATIENCE:g} s"
            break
        except BadInput as refused:
            reason = str(refused)
            break
        first = time.perf_counter() - begin
        single = _timed(work, 1)
        if np.isfinite(error):
            repeats = max(1, int(_SHORT / single))
            known = [single] if single >= _ONCE else []
            preparation = max(0.0, first - single)
            runs.append(_Run(method, setting, work, error, repeats, preparation, known))
        if single > _LONGEST:
            break
    return runs, reason


def _timed(work: Work, repeats: int) -> float:
    begin = time.perf_counter()
    for _ in range(repeats):
        work()
    return (time.perf_counter() - begin) / repeats


def fastest(points: Sequence[Point], level: float, *, ours: bool) -> Point | None:
    """Return the fastest point whose error is within a level; None where there is none."""
    good = [p for p in points if p.ours == ours and p.error <= level]
    return min(good, key=lambda p: p.milliseconds, default=None)
