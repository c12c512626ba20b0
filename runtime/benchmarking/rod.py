"""Benchmark of a stability chart of the flexible rod over crank speed and crank ratio."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..charts import StabilityChart, stability_chart
from ..charts.invariants import characteristic
from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.results import Check
from ..systems.rod import OverhangBasis, PolynomialBasis, rod_system
from .records import Benchmark, Contender, Row, compare, missing, one_thread
from .rod_reference import (
    Entries,
    Reals,
    invariants_in_long_doubles,
    monodromy_in_long_doubles,
    solve_once,
)

Array = NDArray[np.float64]

_SPEEDS, _RATIOS = (500.0, 4000.0), (0.01, 0.2)
_WANTED = 1e-8
_TOLERANCE = 1e-11
# Points on one line for peers that take a batch, one at a time, and with solve_ivp.
_BATCH, _SINGLE, _FEW = 16, 4, 2
# States from which heyoka compiles in its compact mode.
_COMPACT = 6
_OURS = "elastolink"
_HEYOKA, _HEYOKA_ONE = "heyoka, batch, Fourier entries", "heyoka, one point at a time"
_SCIPY = "solve_ivp (DOP853)"
_PAPER = "Beale & Scott's estimate"
_PAPER_MINUTES = 300.0
PROBLEMS = ("3 polynomial modes", "4 overhang modes")


def benchmark_rod(
    points: tuple[int, int] = (400, 250),
    rounds: int = 5,
    problems: tuple[str, ...] | None = None,
) -> Benchmark:
    """Time a stability chart of the flexible rod, 500 to 4000 rad/s and crank ratios 0.01 to 0.2.

    Parameters
    ----------
    points : tuple of int
        Points along the speed and along the crank ratio, 16 each at the least.
    rounds : int
        How often each contender runs, in turn.
    problems : tuple of str, optional
        Some of ``"3 polynomial modes"``, ``"4 overhang modes"``; both by default.

    Returns
    -------
    Benchmark
        ``error`` is the largest deviation of our invariants from the reference, over the larger
        of 1 and their size, on three lines of the chart; heyoka is named and left out where it is
        not installed.

    Raises
    ------
    BadInput
        If a number is too small or a problem is unknown.

    Notes
    -----
    The remark tells microseconds of processor time for each point, the least of all rounds.  The
    peers solve y' = L y for the whole matrix over a turn at points of the middle line, L as a
    Fourier series less what is below 1e-13; its making, and heyoka's compilation, are not timed.
    The reference is a Taylor series in extended precision.  Beale & Scott estimated 300 minutes for
    a point with two modes, on an Apollo 4000.
    """
    if min(points) < 16 or rounds < 1:
        raise bad(
            "benchmark_rod",
            f"points={points}, rounds={rounds}",
            "16 points along each axis, 1 round",
            "take larger numbers",
        )
    unknown = sorted(set(problems or ()) - set(PROBLEMS))
    if unknown:
        raise bad("benchmark_rod", unknown, f"some of {PROBLEMS}", "correct the name")
    return one_thread(_measure, points, rounds, problems or PROBLEMS)


def rod_of(problem: str) -> LinearPeriodic:
    """Return the very flexible rod of Beale & Scott with the modes of a problem."""
    basis = PolynomialBasis(3) if problem == PROBLEMS[0] else OverhangBasis(4)
    return rod_system(
        basis,
        crank_ratio=0.1,
        frame=0.59997,
        length=1.0,
        bending_stiffness=0.7e11 * 0.5208e-6,
        mass_per_length=7.15,
    )


def _measure(points: tuple[int, int], rounds: int, problems: tuple[str, ...]) -> Benchmark:
    rows: list[Row] = []
    checks = {}
    worst = 0.0
    for problem in problems:
        chart = _Chart(problem, points)
        mine = chart.error(chart.ours())
        worst = max(worst, mine)
        checks[f"error of the invariants, {problem}"] = Check(mine, _WANTED)
        checks[f"error of the largest modulus, {problem}"] = Check(chart.growth_error(), _WANTED)
        note = f"figure {chart.found.error:.1e}, growth within {chart.growth_error():.0e}"
        contenders = [Contender(_OURS, chart.ours, chart.error, note=note)]
        peers, left_out = chart.heyoka()
        contenders += [*peers, chart.scipy()]
        measured = compare(problem, contenders, rounds)
        told = [
            _per_point(row, contender, rounds, chart.total)
            for row, contender in zip(measured, contenders, strict=True)
        ]
        rows += [*told, *left_out, _paper(problem, chart.total, measured[0].milliseconds)]
    return Benchmark(
        method="interleaved timing",
        error=worst,
        error_norm="invariants, relative where beyond 1, against extended precision",
        checks=checks,
        title=f"Stability chart of the flexible rod, {points[0]} speeds x {points[1]} crank ratios",
        rows=tuple(rows),
    )


def _per_point(row: Row, contender: Contender, rounds: int, total: int) -> Row:
    """Tell the processor time of a point, which others disturb less."""
    least = contender.processor_time(rounds)
    each = f"{1e6 * least / (contender.share * total):.3g} us a point"
    return replace(row, note=f"{each}; {row.note}")


def _paper(problem: str, total: int, ours: float) -> Row:
    """Return what the paper estimated, which nobody measured here."""
    whole = _PAPER_MINUTES * 6e4 * total
    note = "300 minutes a point, two modes; estimated in 1991 for an Apollo 4000, not run"
    return Row(problem, _PAPER, whole, float("nan"), whole / ours, note=note)


class _Chart:
    """One chart, and the points at which contenders are compared."""

    def __init__(self, problem: str, points: tuple[int, int]) -> None:
        self.problem, self.system = problem, rod_of(problem)
        self.speeds = np.linspace(*_SPEEDS, points[0])
        self.ratios = np.linspace(*_RATIOS, points[1])
        self.total = points[0] * points[1]
        self.columns = np.linspace(0, points[0] - 1, _BATCH).round().astype(int)
        self.lines = np.array([0, points[1] // 2, points[1] - 1])
        self.entries = [self._entries(int(i)) for i in self.lines]
        speeds = self.speeds[self.columns]
        matrices = np.stack([monodromy_in_long_doubles(e, speeds) for e in self.entries])
        self.matrices = matrices.astype(float)
        self.truth = invariants_in_long_doubles(matrices)
        self.found = self.ours()

    def _entries(self, line: int) -> Entries:
        return Entries.of(self.system.with_geometry(crank_ratio=float(self.ratios[line])))

    def ours(self) -> StabilityChart:
        return stability_chart(self.system, ("speed", self.speeds), ("crank_ratio", self.ratios))

    def error(self, chart: StabilityChart) -> float:
        """Return the largest error of the invariants on the three lines."""
        found = chart.invariants[np.ix_(self.lines, self.columns)]
        return _relative(found, self.truth)

    def growth_error(self) -> float:
        """Return the largest error of the largest modulus, away from double roots."""
        exact = np.max(np.abs(np.linalg.eigvals(self.matrices)), axis=-1)
        place = np.ix_(self.lines, self.columns)
        gap = np.abs(self.found.largest[place] - exact)
        clear = exact > 1.0 + 1e-3
        return float(np.max(gap[clear], initial=0.0))

    def peer_error(self, matrices: Array) -> float:
        found = characteristic(matrices, reduced=True)
        return _relative(found, self.truth[1, self._picked(len(found))])

    def _picked(self, count: int) -> NDArray[np.intp]:
        return np.linspace(0, _BATCH - 1, count).round().astype(int)

    def heyoka(self) -> tuple[list[Contender], list[Row]]:
        """Return heyoka's contenders, or rows that say that it is not installed."""
        entries, out, left_out = self.entries[1], [], []
        for name, count, batch in ((_HEYOKA, _BATCH, 0), (_HEYOKA_ONE, _SINGLE, 1)):
            run = heyoka_loop(entries, batch)
            if run is None:
                left_out.append(missing(self.problem, name, "not installed"))
                continue
            speeds = self.speeds[self.columns[self._picked(count)]]
            work: Callable[[], Array] = partial(run, speeds)
            share = count / self.total
            out.append(Contender(name, work, self.peer_error, share, f"tol {_TOLERANCE:g}"))
        return out, left_out

    def scipy(self) -> Contender:
        """Return solve_ivp on two points."""
        speeds = self.speeds[self.columns[self._picked(_FEW)]]

        def run() -> Array:
            return np.stack([solve_once(self.entries[1], float(w), _TOLERANCE) for w in speeds])

        return Contender(_SCIPY, run, self.peer_error, _FEW / self.total, f"rtol {_TOLERANCE:g}")


def _relative(found: Array, truth: Reals) -> float:
    size = np.maximum(1.0, np.max(np.abs(truth), axis=-1))
    gap: Reals = np.abs(found.astype(np.longdouble) - truth)
    return float(np.max(np.max(gap, axis=-1) / size))


def heyoka_loop(
    entries: Entries, batch: int = 0, *, compact: bool | None = None
) -> Callable[[Array], Array] | None:
    """Return heyoka's loop over speeds, compiled for one crank ratio, or None without heyoka.

    Parameters
    ----------
    entries : Entries
        The Fourier series of L.
    batch : int
        Speeds in a batch, by default as many as heyoka recommends; 1 for none.
    compact : bool, optional
        Whether to compile in heyoka's compact mode; by default for more than six states, which
        take minutes otherwise.
    """
    try:
        import heyoka as hy
    except ImportError:
        return None
    m = entries.size
    state = [[hy.make_vars(f"y{i}_{j}") for j in range(m)] for i in range(m)]
    waves = [
        (hy.cos(float(k) * hy.time), hy.sin(float(k) * hy.time)) for k in range(entries.a.shape[1])
    ]
    table = [[_entry(hy, waves, entries, i, k) for k in range(m)] for i in range(m)]
    system = [
        (
            state[i][j],
            hy.sum([e * y[j] for e, y in zip(table[i], state, strict=True) if e is not None]),
        )
        for i in range(m)
        for j in range(m)
    ]
    small = m > _COMPACT if compact is None else compact
    count = batch or int(hy.recommended_simd_size())
    start = np.eye(m).ravel()
    options = {"tol": _TOLERANCE, "fast_math": True, "compact_mode": small}
    if count == 1:
        single = hy.taylor_adaptive(system, start.copy(), pars=[0.0], **options)
    else:
        initial = np.repeat(start[:, None], count, axis=1)
        many = hy.taylor_adaptive_batch(
            system, initial.copy(), pars=np.zeros((1, count)), **options
        )

    def one_by_one(speeds: Array) -> Array:
        out = np.empty((len(speeds), m * m))
        for i, speed in enumerate(speeds):
            single.time = 0.0
            single.state[:] = start
            single.pars[0] = speed**-2.0
            single.propagate_until(2.0 * pi)
            out[i] = single.state
        return out.reshape(-1, m, m)

    def together(speeds: Array) -> Array:
        out = np.empty((len(speeds), m * m))
        for first in range(0, len(speeds), count):
            part = slice(first, first + count)
            here = len(speeds[part])
            many.set_time(0.0)
            many.state[:] = initial
            many.pars[0, :] = speeds[first] ** -2.0
            many.pars[0, :here] = speeds[part] ** -2.0
            many.propagate_until(2.0 * pi)
            out[part] = many.state[:, :here].T
        return out.reshape(-1, m, m)

    return one_by_one if count == 1 else together


def _entry(hy: Any, waves: list[tuple[Any, Any]], entries: Entries, i: int, k: int) -> Any:
    """Return an entry of L as an expression, None where it vanishes; the parameter is 1/w^2."""
    terms = []
    for part, factor in ((0, None), (1, hy.par[0])):
        a, b = entries.series(part, i, k)
        own = [hy.expression(float(a[0]))] if a[0] else []
        for (cos, sin), am, bm in zip(waves[1:], a[1:].tolist(), b[1:].tolist(), strict=False):
            own += [am * cos] if am else []
            own += [bm * sin] if bm else []
        if own:
            total = hy.sum(own)
            terms.append(total if factor is None else factor * total)
    return hy.sum(terms) if terms else None
