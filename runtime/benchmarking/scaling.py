"""Throughput of sweeps against the number of workers."""

from __future__ import annotations

import os
import time
import warnings
from collections.abc import Callable
from concurrent.futures import Executor
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np

from ..core.errors import LinearRangeWarning, bad
from ..sweeps import process_pool, sweep
from ..sweeps.workers import check_workers
from .records import Benchmark, Row

# Throughput over that of one worker that two cores are to give.
_WANTED = 1.7
# What a worker is given beforehand, so that its start and its imports are not timed.
_SLEEP = 0.2


def benchmark_scaling(workers: int = 2, *, rounds: int = 3, scale: float = 1.0) -> Benchmark:
    """Measure sweeps by one process and by several, in turns, and compare their bytes.

    Parameters
    ----------
    workers : int
        How many processes; no more than there are free cores gives anything.
    rounds : int
        How often each is measured; the ratio is the median of the rounds.
    scale : float
        Factor on the size of the sweeps, which take some seconds each.

    Returns
    -------
    Benchmark
        Rows of one and of several workers for each sweep; ``ratio`` is the time over that of one
        worker.  Its checks: ``throughput``, 1.7 over the least factor gained, of two workers, and
        ``same bytes``, how many sweeps differ.

    Raises
    ------
    BadInput
        If a number is unusable.
    """
    check_workers(workers)
    if workers < 2 or rounds < 1 or not 0.0 < scale <= 100.0:
        raise bad(
            "benchmark_scaling",
            f"workers={workers}, rounds={rounds}, scale={scale}",
            "workers >= 2, rounds >= 1, scale from 0 to 100",
            "correct them",
        )
    rows: list[Row] = []
    gains: list[float] = []
    differing = 0
    with process_pool(1) as single, process_pool(workers) as several:
        for pool, count in ((single, 1), (several, workers)):
            _wake(pool, count)
        for name, work in _sweeps(scale).items():
            times = np.empty((rounds, 2))
            found: list[Any] = [None, None]
            for i in range(rounds + 1):
                for j, pool in enumerate((single, several)):
                    begin = time.perf_counter()
                    with warnings.catch_warnings():
                        # How far the coupler bends at a resonance is of no interest here.
                        warnings.simplefilter("ignore", LinearRangeWarning)
                        found[j] = work(executor=pool)
                    # The first round makes what each worker keeps.
                    times[max(i - 1, 0), j] = time.perf_counter() - begin
            gains.append(float(np.median(times[:, 0] / times[:, 1])))
            differing += not _alike(*found)
            rows += _rows(name, times, workers)
    checks = {"same bytes": (float(differing), 0.0)}
    if workers == 2:
        checks["throughput"] = (_WANTED / min(gains), 1.0)
    return _benchmark(rows, checks, workers)


def _benchmark(rows: list[Row], checks: dict[str, tuple[float, float]], workers: int) -> Benchmark:
    from ..core.results import Check

    return Benchmark(
        method="interleaved timing of process pools",
        error=checks["same bytes"][0],
        error_norm="sweeps whose bytes differ between the pools",
        checks={name: Check(*pair) for name, pair in checks.items()},
        title=f"Sweeps by 1 and by {workers} processes, {os.cpu_count()} cores",
        rows=tuple(rows),
    )


def _rows(name: str, times: Any, workers: int) -> list[Row]:
    ratio = float(np.median(times[:, 1] / times[:, 0]))
    middle = 1e3 * np.median(times, axis=0)
    gain = f"{float(np.median(times[:, 0] / times[:, 1])):.2f} times the throughput"
    return [
        Row(name, "1 worker", float(middle[0]), 0.0, 1.0),
        Row(name, f"{workers} workers", float(middle[1]), 0.0, ratio, note=gain),
    ]


def _sweeps(scale: float) -> dict[str, Callable[..., Any]]:
    """Return the sweeps by name, each to be called with an executor."""
    from ..scenes import load_scene

    rod = load_scene("beale_1992_flexible_rod", {"model.modes": 2}).linear_system()
    coupler = load_scene("smith_1972_5152_sixteenth_inch").linear_system()
    speeds = max(32, round(4000 * scale))
    ratios = max(8, round(128 * scale))
    motions = max(64, round(2048 * scale))
    return {
        "multipliers of the flexible rod": partial(
            sweep,
            "floquet_multipliers",
            rod,
            {"speed": np.linspace(500.0, 4000.0, speeds)},
            chunk=max(4, speeds // 32),
        ),
        "chart of the flexible rod": partial(
            sweep,
            "stability_chart",
            rod,
            {
                "crank_ratio": np.linspace(0.01, 0.2, ratios),
                "speed": np.linspace(500.0, 4000.0, 200),
            },
            chunk=200 * max(2, ratios // 32),
        ),
        "steady states of the coupler": partial(
            sweep,
            "steady_state",
            coupler,
            {"speed": np.linspace(30.0, 33.0, motions)},
            chunk=max(4, motions // 32),
        ),
    }


def _wake(pool: Executor, count: int) -> None:
    """Let each process of a pool start and load what it needs."""
    for future in [pool.submit(_load) for _ in range(count)]:
        future.result()


def _load() -> None:
    for name in ("charts.chart", "response.steady_state"):
        import_module(f"..{name}", __package__)
    # Long enough for the others to take their own.
    time.sleep(_SLEEP)


def _alike(one: Any, other: Any) -> bool:
    names = sorted(one.outputs)
    return names == sorted(other.outputs) and all(
        one[name].tobytes() == other[name].tobytes() for name in names
    )
