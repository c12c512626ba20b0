"""Exact pieces of members, so that frequencies at which nodes stand still are no poles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .frames import DynamicStiffness
from .members import phases

Array = NDArray[np.float64]

# Shares of the length, fewer pieces first.
_SHARES: tuple[tuple[float, ...], ...] = (
    (1.0,),
    *((share, 1.0 - share) for share in (0.5, 0.546, 0.578, 0.607, 0.523, 0.637, 0.664)),
    (0.371, 0.335, 0.294),
    (0.412, 0.327, 0.261),
    (0.345, 0.345, 0.31),
    (0.283, 0.262, 0.239, 0.216),
)
_FAR_ENOUGH = 0.6
_WIDEST, _CHANGE = 0.02, 0.3


def divided_for(
    problem: DynamicStiffness, low: float, high: float | None = None
) -> DynamicStiffness:
    """Return a structure whose pieces have no pole near some frequencies [rad/s].

    One piece for a member wherever that will do; otherwise unequal ones (the fictitious joint of
    Aannaque 5.4.1).
    """
    ends = np.array([low, low if high is None else high])
    chosen: dict[str, tuple[float, ...]] = {}
    length, *_ = problem.assembly.data
    z, b = phases(ends, *problem.assembly.data)
    for beam in problem.structure.beams:
        own = [k for k, p in enumerate(problem.assembly.pieces) if p.beam.name == beam.name]
        whole_z = z[:, own[0]] * beam.length / length[own[0]]
        whole_b = b[:, own[0]] * beam.length / length[own[0]]
        scores = []
        offered = [shares for shares in _SHARES if len(shares) >= len(own)]
        for shares in offered:
            scores.append(_distance(np.outer(whole_z, shares), np.outer(whole_b, shares)))
            if scores[-1] > _FAR_ENOUGH:
                break
        best = offered[int(np.argmax(scores))]
        if len(best) > 1:
            chosen[beam.name] = best
    whole = len(problem.assembly.pieces) == len(problem.structure.beams)
    return problem if whole and not chosen else problem.divided(chosen)


def narrow_enough(problem: DynamicStiffness, omega: float) -> float:
    """Return the relative width within which no phase of a whole member changes much."""
    z, b = phases(omega, *problem.assembly.data)
    return float(min(_WIDEST, _CHANGE / max(np.max(z) / 2.0, np.max(b))))


def _distance(z: Array, b: Array) -> float:
    """Return how far the nearest pole is, over a quarter of the distance between poles."""
    bending = np.abs(np.cos(z) - 1.0 / np.cosh(np.minimum(z, 700.0)))
    bending = np.where(z < 3.0, 1.0, bending)
    axial = np.where(b < 1.5, 1.0, np.abs(np.sin(b)))
    return float(min(bending.min(), axial.min()))
