"""Explicit steps of order 8 with projection onto the constraints."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .equations import SMALL, Array, Equations, NoConvergence, State, Step, StoppedEarly, Tolerance

# Where SciPy ends.
_TIGHTEST = 3e-14
# Some five minutes of steps of the rod.
_MOST_STEPS = 200_000


def projection(
    equations: Equations, start: State, end: float, tolerance: Tolerance
) -> Iterator[Step]:
    """March with Dormand and Prince's steps of order 8, each end projected by the masses.

    The accelerations are those of the index-1 form, one small solve for each of the 12 stages.
    Positions and velocities are projected after each step (Hairer and Wanner, section VII.2), so
    that the constraints hold to round-off however long the motion is.  Parameters, steps and
    errors as of :func:`.collocation.collocation`.
    """
    from scipy.integrate import DOP853, DenseOutput

    n = equations.n

    def rate(t: float, y: Array) -> Array:
        try:
            return np.concatenate([y[n:], equations.accelerations(t, y[:n], y[n:])[0]])
        except NoConvergence:  # the step is refused and becomes shorter
            return np.full_like(y, np.nan)

    solver = DOP853(
        rate,
        start.t,
        np.concatenate([start.x, start.v]),
        end,
        rtol=max(tolerance.rtol, _TIGHTEST),
        atol=tolerance.rtol * np.repeat([tolerance.place, SMALL * tolerance.speed], n),
        max_step=tolerance.longest,
    )
    state = start
    for _ in range(_MOST_STEPS):
        solver.step()
        if solver.status == "failed":
            raise StoppedEarly(
                "the step became too short: the constraints lose their rank, or the motion diverges"
            )
        between = solver.dense_output()
        after = equations.state(float(solver.t), solver.y[:n], solver.y[n:])
        solver.y, solver.f = np.concatenate([after.x, after.v]), np.concatenate([after.v, after.a])

        def at(t: Array, between: DenseOutput = between) -> tuple[Array, Array]:
            x, v = np.split(between(t).T, 2, axis=1)
            return x, v

        reach = np.maximum(np.abs(state.x), np.abs(after.x))
        yield Step(state, after, at, reach, np.empty(0))
        if solver.status == "finished":
            return
        state = after
    raise StoppedEarly(f"{_MOST_STEPS} steps were not enough: shorten the span")
