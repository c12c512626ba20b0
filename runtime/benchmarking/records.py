"""What a benchmark returns, and how its contenders are timed: in turn, one thread each."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..core.periodic_function import PeriodicFunction
from ..core.results import Result

Array = NDArray[np.float64]
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
_SHORT = 0.1
Measured = TypeVar("Measured")
_PINNED = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")


@dataclass(frozen=True)
class Row:
    """One contender on one problem.

    Attributes
    ----------
    problem, contender : str
        What was solved, and by what.
    milliseconds : float
        Median time of the whole problem; a sample scaled up where ``sampled`` is true.
    error : float
        Largest deviation from the reference at the compared points.
    ratio : float
        Median over the rounds of its time divided by ours.
    sampled : bool
        True where only part of the problem was run.
    note : str
        Settings, or why the contender was left out.
    """

    problem: str
    contender: str
    milliseconds: float
    error: float
    ratio: float
    sampled: bool = False
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class Benchmark(Result):
    """A table of contenders.

    Attributes
    ----------
    rows : tuple of Row
        Ours first within each problem.
    title : str
        What was measured.
    """

    title: str
    rows: tuple[Row, ...]

    def table(self) -> str:
        """Return the table as text, one line per contender."""
        head = ("problem", "contender", "ms", "times ours", "error", "remark")
        lines = [
            (
                row.problem,
                row.contender,
                _number(row.milliseconds) + ("*" if row.sampled else ""),
                _number(row.ratio),
                "-" if np.isnan(row.error) else f"{row.error:.1e}",
                row.note,
            )
            for row in self.rows
        ]
        text = [self.title, *padded(head, lines)]
        text.append("* a sample, scaled to the whole; medians of interleaved rounds, one thread")
        return "\n".join(text)

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings, ready for JSON."""
        out = super().to_dict()
        out["rows"] = [
            {
                key: None if isinstance(value, float) and np.isnan(value) else value
                for key, value in vars(row).items()
            }
            for row in self.rows
        ]
        return out


@dataclass(frozen=True)
class Contender:
    """Something to time.

    Attributes
    ----------
    name : str
        As in the table.
    run : callable
        Does the work (or a sample of it) and returns what is compared with the reference.
    share : float
        The part of the whole problem that ``run`` does.
    error : callable
        From what ``run`` returns to the largest deviation from the reference.
    note : str
        Settings.
    """

    name: str
    run: Callable[[], Any]
    error: Callable[[Any], float]
    share: float = 1.0
    note: str = ""

    def processor_time(self, rounds: int) -> float:
        """Return the least processor time of some runs [s], of what ``run`` does."""
        least = float("inf")
        for _ in range(rounds):
            begin = time.process_time()
            self.run()
            least = min(least, time.process_time() - begin)
        return least


def compare(problem: str, contenders: Sequence[Contender], rounds: int) -> list[Row]:
    """Time the contenders in turn, ``rounds`` times; the first is ours.

    Before each timed run a short one is repeated untimed, so that none suffers from what the one
    before it left in the caches.
    """
    times = np.empty((rounds, len(contenders)))
    errors, short = [], []
    for contender in contenders:
        begin = time.perf_counter()
        errors.append(contender.error(contender.run()))
        short.append(time.perf_counter() - begin < _SHORT)
    for i in range(rounds):
        for j, contender in enumerate(contenders):
            if short[j]:
                contender.run()
            begin = time.perf_counter()
            contender.run()
            times[i, j] = (time.perf_counter() - begin) / contender.share
    ratios = np.median(times / times[:, :1], axis=0)
    middle = 1e3 * np.median(times, axis=0)
    return [
        Row(
            problem=problem,
            contender=contender.name,
            milliseconds=float(middle[j]),
            error=errors[j],
            ratio=float(ratios[j]),
            sampled=contender.share < 1.0,
            note=contender.note,
        )
        for j, contender in enumerate(contenders)
    ]


def padded(head: Sequence[str], lines: Sequence[Sequence[str]]) -> list[str]:
    """Return the lines of a table of cells, each column as wide as its widest."""
    every = (head, *lines)
    widths = [max(len(line[i]) for line in every) for i in range(len(head))]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in every
    ]


def missing(problem: str, name: str, why: str) -> Row:
    """Return the row of a contender that could not run."""
    return Row(problem, name, float("nan"), float("nan"), float("nan"), note=why)


def one_thread(work: Callable[..., Measured], *arguments: Any) -> Measured:
    """Call ``work`` with numerical libraries on one thread, in a new process where needed.

    The libraries read their number of threads when they load, so an environment that does not
    pin it already needs a fresh interpreter.
    """
    if all(os.environ.get(name) == "1" for name in _PINNED):
        return work(*arguments)
    before: Mapping[str, str | None] = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        context = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(max_workers=1, mp_context=context) as pool:
            return pool.submit(work, *arguments).result()
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def functions() -> dict[str, PeriodicFunction]:
    """Return the test functions: a general one of 24 harmonics, f3 of Smith's three linkages.

    f3 is ``-alpha4 / sin(theta3 - theta4)``, Smith (6.16).
    """
    from ..linkages import FourBar

    out = {}
    rng = np.random.default_rng(1972)
    fall = 0.7 ** np.arange(25)
    a, b = rng.uniform(-1.0, 1.0, 25) * fall, rng.uniform(-1.0, 1.0, 25) * fall
    b[0] = 0.0
    out["24 harmonics"] = PeriodicFunction(a, b)
    for name, lengths in (
        ("f3 (5,1,5,2)", (5, 1, 5, 2)),
        ("f3 (10,1,10,4)", (10, 1, 10, 4)),
        ("f3 (2,1,2,2)", (2, 1, 2, 2)),
    ):
        frame, crank, coupler, follower = (float(length) for length in lengths)
        linkage = FourBar(frame, crank, coupler, follower)
        out[name] = PeriodicFunction.from_callable(_end_load(linkage.motion), name=name)
    return out


def _end_load(motion: Callable[[Array], Any]) -> Callable[[Array], Array]:
    def f3(theta: Array) -> Array:
        found = motion(theta)
        return np.asarray(-found.alpha4 / np.sin(found.theta3 - found.theta4))

    return f3


def _number(value: float) -> str:
    if np.isnan(value):
        return "-"
    return f"{value:.3g}" if value < 1e4 else f"{value:.2e}"
