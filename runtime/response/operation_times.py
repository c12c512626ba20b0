"""Run times of the algorithms for the steady state, step by step the same, in one run."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np
from numpy.typing import ArrayLike

from ..core.families import LinearPeriodic
from ..integrators.newmark import newmark_rule
from ..periodic.first_order import canonical_form
from .closed_form import printed_closing
from .stepped import period_maps, ring_closing
from .transition import transition_closing


def run_times(
    system: LinearPeriodic,
    speed: float,
    *,
    intervals: int = 720,
    cycles: int = 31,
    repeats: int = 3,
    **parameters: ArrayLike,
) -> dict[str, float]:
    """Return the time [s] that each algorithm takes with Newmark's steps, the least of some runs.

    Parameters
    ----------
    system : LinearPeriodic
        The system, forced.
    speed : float
        Crank speed [rad/s].
    intervals, cycles : int
        Steps in a revolution, and revolutions marched.
    repeats : int
        Runs of each.
    **parameters : array_like
        Parameter values that replace the system's own.

    Returns
    -------
    dict
        ``steps``: the maps and loads of all intervals, which the others take as they are; then
        ``time_marching``, ``transition_matrix``, ``closed_form`` and ``cyclic``.

    Raises
    ------
    BadInput
        As :func:`~.steady_state.steady_state`.
    """
    form = canonical_form(system, speed, parameters, forcing=True)
    rule = newmark_rule()
    maps, loads = period_maps(form, rule, intervals)

    def marching() -> None:
        state = np.zeros(loads.shape[1])
        for _ in range(cycles):
            for matrix, load in zip(maps, loads, strict=True):
                state = matrix @ state + load

    runs: dict[str, Callable[[], object]] = {
        "steps": lambda: period_maps(form, rule, intervals),
        "time_marching": marching,
        "transition_matrix": lambda: transition_closing(maps, loads),
        "closed_form": lambda: printed_closing(maps, loads),
        "cyclic": lambda: ring_closing(maps, loads),
    }
    found = {}
    with np.errstate(over="ignore", invalid="ignore"):
        for name, run in runs.items():
            times = []
            for _ in range(max(1, repeats)):
                begin = perf_counter()
                run()
                times.append(perf_counter() - begin)
            found[name] = min(times)
    return found
