"""Benchmark of the stress-against-speed curve of a four-bar linkage with all links flexible."""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from math import ceil, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.results import Check
from ..reduction import StressCurve, stress_curve
from ..scenes import load_scene
from .curve_rivals import SecondOrder, StressMaxima, collocated, marched, newmark_march
from .records import Benchmark, Contender, Row, compare, missing, one_thread

Array = NDArray[np.float64]

_SCENE = "aannaque_1996_table_4_1"
_SPEEDS = (5.0, 70.0)
_STATIONS = 7
_WANTED = 1e-4
_MEGABYTES = 500.0
# Angles of the collocation that is the reference, and those offered to the contender.
_FINE = 129
_OFFERED = (25, 33, 41, 49, 57, 65, 73, 81, 89, 97, 113)
_FEWEST_STEPS, _MOST_STEPS = 256, 16384
_OURS = "elastolink"
_PROBLEM = "1000 speeds"


def benchmark_stress_curve(samples: int = 5, rounds: int = 3, speeds: int = 1000) -> Benchmark:
    """Time the largest stress of each link of Aannaque's four-bar at 5 to 70 rad/s.

    Three elements a link (27 freedoms), 2 % modal damping, seven stations a link, stresses from
    the shape functions; one row also by equilibrium.  Ours tells at each speed whether the motion
    is stable, which the rivals do not; one row leaves it out.

    Parameters
    ----------
    samples : int
        Speeds at which the rivals run, spread evenly; scaled to all.
    rounds : int
        How often each contender runs, in turn.
    speeds : int
        Speeds of the curve.

    Returns
    -------
    Benchmark
        ``error``: the largest relative error of our maxima at the sampled speeds, against a
        collocation at 129 angles.  Its checks: that error, and the memory of a process that makes
        the curve [MB].

    Raises
    ------
    BadInput
        If a number is too small.

    Notes
    -----
    The rivals get their arrays at their angles beforehand, and the settings at which each just
    reaches 1e-4 at each speed: collocation the number of angles; Newmark's method (constant average
    acceleration, compiled, effective stiffnesses inverted once for all cycles) steps and cycles
    from rest.  Its last row has the error that ours has: by its order two, not run.
    """
    if min(samples, rounds) < 1 or speeds < samples:
        raise bad(
            "benchmark_stress_curve",
            f"samples={samples}, rounds={rounds}, speeds={speeds}",
            "1 or more, and no more samples than speeds",
            "take larger numbers",
        )
    return one_thread(_measure, samples, rounds, speeds)


@dataclass(frozen=True)
class _Curve:
    """The problem, its sampled speeds and the reference there."""

    system: LinearPeriodic
    speeds: Array
    picked: NDArray[np.intp]
    truth: Array
    maxima: StressMaxima

    @classmethod
    def of(cls, count: int, samples: int) -> _Curve:
        system = _system()
        speeds = np.linspace(*_SPEEDS, count)
        picked = ((np.arange(samples) + 0.5) * count / samples).astype(int)
        fine, maxima = SecondOrder(system, _FINE), StressMaxima(system, _STATIONS)
        truth = np.array([maxima(collocated(fine, float(w))) for w in speeds[picked]])
        return cls(system, speeds, picked, truth, maxima)

    def ours(
        self, method: str = "shape", workers: int = 1, *, stability: bool = True
    ) -> StressCurve:
        """Return our curve."""
        run = partial(
            stress_curve,
            self.system,
            self.speeds,
            stations=_STATIONS,
            method=method,
            stability=stability,
        )
        if workers == 1:
            return run()
        with ThreadPoolExecutor(workers) as pool:
            return run(executor=pool)

    def error(self, found: StressCurve) -> float:
        """Return our largest relative error at the sampled speeds."""
        return float(np.max(np.abs(found.maximum[self.picked] / self.truth - 1.0)))

    def peer_error(self, motions: list[Array]) -> float:
        """Return the largest relative error of motions at the sampled speeds."""
        each = [self.off(k, q) for k, q in enumerate(motions)]
        return float(np.max(each))

    def off(self, place: int, motion: Array) -> float:
        """Return the largest relative error of a motion at one of the sampled speeds."""
        return float(np.max(np.abs(self.maxima(motion) / self.truth[place] - 1.0)))

    def at(self, place: int) -> float:
        """Return one of the sampled speeds."""
        return float(self.speeds[self.picked[place]])


def _system() -> LinearPeriodic:
    """Return the linkage."""
    system = load_scene(_SCENE).system()
    if not isinstance(system, LinearPeriodic):
        raise bad(_SCENE, type(system).__name__, "a linear periodic system", "repair the scene")
    return system


def _measure(samples: int, rounds: int, count: int) -> Benchmark:
    curve = _Curve.of(count, samples)
    mine = curve.error(curve.ours())
    share = samples / count
    memory = _memory(count)
    contenders = [
        Contender(_OURS, curve.ours, curve.error, note=f"peak memory {memory:.0f} MB"),
        Contender(f"{_OURS}, two threads", partial(curve.ours, workers=2), curve.error),
        Contender(f"{_OURS}, without stability", partial(curve.ours, stability=False), curve.error),
        # Another recovery: other stresses, which the reference does not have.
        Contender(f"{_OURS}, by equilibrium", partial(curve.ours, "equilibrium"), _unknown),
        _collocation(curve, share),
    ]
    marching = _marching(curve, share)
    contenders += [marching] if marching else []
    rows = [
        _with_processor_time(row, contender, rounds)
        for row, contender in zip(compare(_PROBLEM, contenders, rounds), contenders, strict=True)
    ]
    if marching:
        rows.append(_to_our_error(rows[-1], mine))
    else:
        rows.append(missing(_PROBLEM, "Newmark, compiled", "numba is not installed"))
    return Benchmark(
        method="interleaved timing",
        error=mine,
        error_norm="largest stress of each link, relative, at the sampled speeds",
        checks={
            "error": Check(mine, _WANTED),
            "peak memory [MB]": Check(memory, _MEGABYTES),
        },
        title=f"Largest stress of each link at {count} speeds, 5 to 70 rad/s",
        rows=tuple(rows),
    )


def _with_processor_time(row: Row, contender: Contender, rounds: int) -> Row:
    """Tell the processor time of the whole, which others disturb less."""
    least = contender.processor_time(rounds)
    return replace(row, note=f"{least / contender.share:.3g} s of processor time; {row.note}")


def _unknown(found: StressCurve) -> float:
    return float("nan")


def _collocation(curve: _Curve, share: float) -> Contender:
    """Return collocation with as few angles as reach the wanted error, here and with the next."""
    offered = {count: SecondOrder(curve.system, count) for count in _OFFERED}
    chosen = []
    for place in range(len(curve.picked)):
        met = [
            curve.off(place, collocated(p, curve.at(place))) <= _WANTED for p in offered.values()
        ]
        lasting = [k for k in range(len(met) - 1) if met[k] and met[k + 1]]
        chosen.append(_OFFERED[lasting[0] if lasting else -1])
    jobs = [partial(collocated, offered[n], curve.at(k)) for k, n in enumerate(chosen)]
    note = f"{min(chosen)} to {max(chosen)} angles"
    return Contender("dense collocation", partial(_each, jobs), curve.peer_error, share, note)


def _marching(curve: _Curve, share: float) -> Contender | None:
    """Return Newmark's march with as few steps and cycles as reach the wanted error."""
    march = newmark_march()
    if march is None:
        return None
    problems: dict[int, SecondOrder] = {}
    jobs, told = [], []
    for place in range(len(curve.picked)):
        steps, cycles = _settings(curve, place, problems, march)
        jobs.append(partial(marched, problems[steps], curve.at(place), cycles, march))
        told.append(f"{steps} x {cycles}")
    note = "steps x cycles: " + ", ".join(told)
    return Contender("Newmark, compiled", partial(_each, jobs), curve.peer_error, share, note)


def _settings(
    curve: _Curve, place: int, problems: dict[int, SecondOrder], march: Callable[..., Any]
) -> tuple[int, int]:
    """Return the steps and cycles at which a march from rest reaches the wanted error."""
    speed = curve.at(place)
    ratio, slowest = 0.02, 160.0
    settled = ceil(14.0 / (ratio * slowest * 2.0 * pi / speed)) + 1
    steps = _FEWEST_STEPS
    while True:
        problem = problems.setdefault(steps, SecondOrder(curve.system, steps))
        off = curve.off(place, marched(problem, speed, settled, march))
        if off <= _WANTED or 5 * steps // 4 > _MOST_STEPS:
            break
        # Order two tells where the next try may succeed; not more than three times as far.
        factor = min(max(np.sqrt(off / _WANTED), 1.1), 3.0)
        steps = min(64 * ceil(factor * steps / 64), _MOST_STEPS)
    # The cycle from which on it stays there, not one at which the error happens to pass through 0.
    fewest = settled
    while fewest > 1 and curve.off(place, marched(problem, speed, fewest - 1, march)) <= _WANTED:
        fewest -= 1
    for other in [n for n in problems if n > 2048 and n != steps]:
        del problems[other]
    return steps, fewest


def _each(jobs: Sequence[Callable[[], Array]]) -> list[Array]:
    return [job() for job in jobs]


def _to_our_error(row: Row, error: float) -> Row:
    """Return what the march would take to our error: steps by its order, the cycles the same."""
    factor = float(np.sqrt(max(row.error / error, 1.0)))
    return replace(
        row,
        contender="Newmark, to our error",
        milliseconds=row.milliseconds * factor,
        error=min(row.error, error),
        ratio=row.ratio * factor,
        note=f"the row above times {factor:.2f}, by its order; not run",
    )


def _memory(count: int) -> float:
    """Return the peak memory [MB] of a fresh process that makes the curve; NaN where unknown."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(max_workers=1, mp_context=context) as pool:
        return pool.submit(_peak_of_curve, count).result()


def _peak_of_curve(count: int) -> float:
    stress_curve(_system(), np.linspace(*_SPEEDS, count))
    if sys.platform == "win32":
        return float("nan")
    import resource

    used = float(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    return used / (2.0**20 if sys.platform == "darwin" else 2.0**10)
