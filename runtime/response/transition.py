"""Steady states by the transition matrix, algorithm 1, (6.15)-(6.19): ``transition_matrix``."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .request import Found, Request
from .stepped import stepped

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


def by_transition_matrix(request: Request) -> Found:
    """Return periodic motions by two marches through one period."""
    return stepped(request, "transition matrix (algorithm 1)", transition_closing)


def transition_closing(maps: Array, loads: Array) -> tuple[Array, float, float]:
    """Return the states of a period closed by its transition matrix.

    The period is marched through from the unit matrix and from rest at once, which gives R and
    y_c(T); ``y_s(0) = (I - R)^-1 y_c(T)`` (6.18); and once more from there.
    """
    m = loads.shape[1]
    whole = np.concatenate([np.eye(m), np.zeros((m, 1))], axis=1)
    with np.errstate(over="ignore", invalid="ignore"):
        for matrix, load in zip(maps, loads, strict=True):
            whole = matrix @ whole
            whole[:, -1] += load
    transition, response = whole[:, :-1], whole[:, -1]
    nothing = np.full_like(loads, np.nan)
    if not np.all(np.isfinite(whole)):
        return nothing, np.inf, np.inf
    closed = np.eye(m) - transition
    spread = np.linalg.svd(closed, compute_uv=False)
    if not spread[-1] > _EPS * spread[0]:
        return nothing, np.inf, np.inf
    state = np.linalg.solve(closed, response)
    sensitivity = float((1.0 + np.linalg.norm(transition, 2)) / spread[-1])
    nodes = np.empty_like(loads)
    for k, (matrix, load) in enumerate(zip(maps, loads, strict=True)):
        nodes[k] = state
        state = matrix @ state + load
    # How far the motion misses its own start, of which growth within the period makes the most.
    size = float(np.max(np.abs(nodes))) or 1.0
    missed = float(np.max(np.abs(state - nodes[0]))) / size
    floor = _EPS * np.sqrt(len(maps)) * sensitivity
    return nodes, sensitivity, min(floor + 4 * missed, 1.0)
