"""Work against error of the integrators on one monodromy matrix, for benchmarks."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .protocol import Array, OneStep


@dataclass(frozen=True)
class Work:
    """One method with one number of steps.

    Attributes
    ----------
    method : str
        Its name.
    steps : int
        Steps over the stretch.
    error : float
        Largest entry of the error over the largest of the matrix, worst of the batch; inf where a
        step was refused or overflowed.
    seconds : float
        Shortest processor time of the repeats.
    """

    method: str
    steps: int
    error: float
    seconds: float


def flow(method: OneStep, form: Any, steps: int, stretch: float = 1.0) -> Array:
    """Return the matrices over a stretch of the period, in scaled variables, ``(nb, m, m)``.

    Parameters
    ----------
    method : OneStep
        The method.
    form : CanonicalForm
        The systems.
    steps : int
        Number of steps.
    stretch : float
        Part of the period, from its start.
    """
    step = stretch * float(form.system.period) / steps
    together = max(1, 100_000 // (form.size**2 * max(1, len(form.speed))))
    total = np.eye(form.size)
    for left in range(0, steps, together):
        theta = step * np.arange(left, min(left + together, steps), dtype=float)
        maps = method.maps(form.generator, theta, step)
        while maps.shape[1] > 1:
            even = maps.shape[1] - maps.shape[1] % 2
            pairs = maps[:, 1:even:2] @ maps[:, 0:even:2]
            maps = np.concatenate([pairs, maps[:, even:]], axis=1)
        total = maps[:, 0] @ total
    return total


def work_against_error(
    form: Any,
    methods: Iterable[OneStep],
    steps: Sequence[int],
    exact: Array,
    stretch: float = 1.0,
    repeats: int = 3,
) -> tuple[Work, ...]:
    """Time every method with every number of steps against a reference.

    Parameters
    ----------
    form : CanonicalForm
        The systems; a batch is solved together.
    methods : iterable of OneStep
        The methods.
    steps : sequence of int
        Numbers of steps.
    exact : ndarray
        The matrices over the stretch, as :func:`flow` gives them for many steps, ``(nb, m, m)``.
    stretch : float
        Part of the period: a short one spares a stiff system its whole revolution.
    repeats : int
        Runs of each, of which the shortest counts.
    """
    from ..core.errors import BadInput

    size = np.max(np.abs(exact), axis=(-2, -1))
    rows = []
    for method in methods:
        for count in steps:
            taken, error = float("inf"), float("inf")
            for _ in range(repeats):
                begun = time.process_time()
                try:
                    with np.errstate(over="ignore", invalid="ignore"):
                        found = flow(method, form, count, stretch)
                except BadInput:
                    break
                taken = min(taken, time.process_time() - begun)
                gap = np.max(np.abs(found - exact), axis=(-2, -1)) / size
                error = float(np.max(np.where(np.isfinite(gap), gap, np.inf)))
            rows.append(Work(method.name, count, error, taken))
    return tuple(rows)


def fastest(rows: Iterable[Work], error: float) -> tuple[Work, ...]:
    """Return the cheapest run of each method that keeps an error level, the fastest first."""
    best: dict[str, Work] = {}
    for row in rows:
        held = best.get(row.method)
        if row.error <= error and (held is None or row.seconds < held.seconds):
            best[row.method] = row
    return tuple(sorted(best.values(), key=lambda row: row.seconds))
