"""Frequencies by their count alone: for any problem that can count."""

from __future__ import annotations

import numpy as np

from ..core.errors import bad
from ..core.families import Transcendental
from ..core.results import Check, provenance
from .result import FrameFrequencies

_START = 1e-3
_MOST_DOUBLINGS = 400


def bisected(
    problem: Transcendental, upto: float | None, count: int | None, rtol: float
) -> FrameFrequencies:
    """Return the frequencies of a problem by bisection on their number.

    Parameters
    ----------
    problem : Transcendental
        What counts.
    upto, count, rtol
        As :func:`wittrick_williams` takes them.

    Raises
    ------
    BadInput
        If there are not as many frequencies as asked for.
    """
    high = upto if upto is not None else _above(problem, count or 1)
    total = int(problem.count(high))
    pending = [(0.0, high, 0, total)]
    found: list[tuple[float, float]] = []
    while pending:
        low, high, first, last = pending.pop()
        if first == last:
            continue
        middle = (low + high) / 2.0
        if high - low <= rtol * high or not low < middle < high:
            found += [(middle, (high - low) / 2.0)] * (last - first)
            continue
        between = min(max(int(problem.count(middle)), first), last)
        pending.append((middle, high, between, last))
        pending.append((low, middle, first, between))
    places = np.array([place for place, _ in found])
    widths = np.array([width for _, width in found])
    chosen = slice(None) if count is None else slice(count)
    _, group, size = np.unique(places, return_inverse=True, return_counts=True)
    return FrameFrequencies(
        frequencies=places[chosen],
        multiplicity=size[group][chosen].astype(np.int64),
        modes=(),
        problem=problem,
        method="Wittrick-Williams count, bisection",
        error=widths[chosen],
        error_norm="each frequency, absolute [rad/s]",
        error_kind="bound",
        checks={"frequencies not found": Check(float(abs(len(found) - total)), 0.0)},
        provenance=provenance(problem.provenance),
    )


def _above(problem: Transcendental, count: int) -> float:
    high = _START
    for _ in range(_MOST_DOUBLINGS):
        if int(problem.count(high)) >= count:
            return high
        high *= 2.0
    raise bad("count", str(count), "fewer frequencies", "ask for fewer")
