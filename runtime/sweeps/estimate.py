"""What a sweep will cost, told before it is begun."""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.workers import check_workers
from .sweeping import planned


@dataclass(frozen=True)
class SweepEstimate:
    """Time and memory of a sweep, from working out one of its pieces."""

    points: int
    pieces: int
    seconds: float  # of the whole sweep, each worker having a core of its own
    piece_seconds: float  # of the piece that was timed
    bytes: int  # of the outputs, in memory or in the store
    piece_bytes: int  # most memory that a worker held beside its subject during that piece
    workers: int

    def __str__(self) -> str:
        """Return it as one line."""
        return (
            f"{self.points} points in {self.pieces} pieces: about {self.seconds:.3g} s with "
            f"{self.workers} worker{'s' * (self.workers > 1)}, {self.bytes / 1e6:.3g} MB of "
            f"outputs, {self.piece_bytes / 1e6:.3g} MB for each worker"
        )


def estimate_sweep(
    what: str | Callable[..., Any],
    subject: object,
    values: Mapping[str, ArrayLike],
    *,
    options: Mapping[str, object] | None = None,
    outputs: tuple[str, ...] | None = None,
    chunk: int | None = None,
    workers: int = 1,
) -> SweepEstimate:
    """Return what :func:`sweep` of the same arguments would cost, from doing its middle piece.

    The piece is done twice: once for the memory, and again for the time.  Where some points are
    far dearer than others, low speeds for one, the time is no better than to a small factor.
    """
    check_workers(workers)
    plan = planned(what, subject, values, options, outputs, chunk)
    middle = plan.grid.pieces // 2
    already = tracemalloc.is_tracing()
    if not already:
        tracemalloc.start()
    try:
        before = tracemalloc.get_traced_memory()[0]
        tracemalloc.reset_peak()
        piece = plan.piece(middle)
        peak = tracemalloc.get_traced_memory()[1] - before
    finally:
        if not already:
            tracemalloc.stop()
    begin = time.perf_counter()
    plan.piece(middle)
    seconds = time.perf_counter() - begin
    run = plan.grid.run(middle)
    share = plan.grid.points / (run.stop - run.start)
    held = sum(int(np.asarray(array).nbytes) for array in piece.arrays.values())
    at_once = min(workers, plan.grid.pieces)
    return SweepEstimate(
        points=plan.grid.points,
        pieces=plan.grid.pieces,
        seconds=seconds * share / at_once,
        piece_seconds=seconds,
        bytes=round(held * share),
        piece_bytes=int(peak),
        workers=workers,
    )
