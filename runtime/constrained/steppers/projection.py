"""Explicit steps of order 8 with projection onto the constraints."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..equations import Array, Equations, State
from .dormand_prince import march
from .protocol import Control, Step


def projection(
    equations: Equations, start: State, times: Array, control: Control
) -> Iterator[Step]:
    """March with steps of order 8, each end projected in the metric of the masses.

    The accelerations are those of the index-1 form, one small solve for each of the 12 stages.
    Positions and velocities are projected after each accepted step (Hairer and Wanner, section
    VII.2), so that the constraints hold to round-off however long the motion is.

    Parameters
    ----------
    equations : Equations
        The system.
    start : State
        Meets the constraints.
    times : ndarray, shape (nt,)
        The last is where to end [s]; steps pass over the others.
    control : Control
        Tolerance, or fixed step.

    Yields
    ------
    Step
        The accepted steps.

    Raises
    ------
    StoppedEarly
        If the step becomes too short.
    """
    yield from march(_Whole(equations, control), start, float(times[-1]), control)


def unprojected(
    equations: Equations, start: State, times: Array, control: Control
) -> Iterator[Step]:
    """March as :func:`projection` without projecting: the constraints drift.

    For comparison; the defects of the positions grow linearly in time at least.
    """
    yield from march(_Drifting(equations, control), start, float(times[-1]), control)


class _Whole:
    """All coordinates and velocities."""

    def __init__(self, equations: Equations, control: Control) -> None:
        self._equations, self._n = equations, equations.n
        self._floor = np.concatenate([control.q_scale, control.qd_scale])

    def begin(self, state: State) -> tuple[Array, Array]:
        return self.inner(state)

    def inner(self, state: State) -> tuple[Array, Array]:
        return np.concatenate([state.q, state.qd]), np.concatenate([state.qd, state.qdd])

    def rate(self, t: float, y: Array) -> Array:
        q, qd = y[: self._n], y[self._n :]
        return np.concatenate([qd, self._equations.acceleration(t, q, qd)[0]])

    def full(self, t: float, y: Array) -> tuple[Array, Array]:
        return y[: self._n], y[self._n :]

    def finish(self, t: float, y: Array) -> State:
        return self._equations.state(t, y[: self._n], y[self._n :])

    def scale(self, y: Array, ahead: Array) -> Array:
        found: Array = self._floor + np.maximum(np.abs(y), np.abs(ahead))
        return found


class _Drifting(_Whole):
    """As the whole, but the end of a step is left where it is."""

    def finish(self, t: float, y: Array) -> State:
        return self._equations.at(t, y[: self._n], y[self._n :])
