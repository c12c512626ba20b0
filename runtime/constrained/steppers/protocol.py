"""What the integrators of constrained systems have in common: control, steps, weights."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..equations import Array, Equations, State

# Stages of the implicit methods where none are asked for.
STAGES = 5


@dataclass(frozen=True)
class Control:
    """How an integrator chooses its steps.

    Attributes
    ----------
    rtol : float
        Relative tolerance of the error of one step.
    q_scale, qd_scale : ndarray, shape (n,)
        Sizes of the coordinates and velocities below which the tolerance is absolute.
    step : float or None
        Fixed step [s] instead of a tolerance.
    longest : float
        Longest step [s].
    refine : float
        Factor by which fixed steps are shortened, for a second run that tells the error.
    stages : int or None
        Stages of an implicit method; None for its own choice.
    grid : ndarray or None
        Ends of the steps [s] of an explicit method, instead of a tolerance.
    """

    rtol: float
    q_scale: Array
    qd_scale: Array
    step: float | None = None
    longest: float = np.inf
    refine: float = 1.0
    stages: int | None = None
    grid: Array | None = None


@dataclass(frozen=True)
class Step:
    """One accepted step.

    Attributes
    ----------
    before, after : State
        Its ends.
    between : callable
        ``between(t)`` predicts ``(q, qd)`` at a time inside, not yet on the constraints.
    """

    before: State
    after: State
    between: Callable[[float], tuple[Array, Array]]


class StoppedEarly(ArithmeticError):  # noqa: N818 - reads as what it is
    """An integrator cannot go on; the message says why."""


Stepper = Callable[[Equations, State, Array, Control], Iterator[Step]]


def natural_scales(state: State, columns: Array) -> tuple[Array, Array]:
    """Return sizes of coordinates and velocities from the largest ones, by inertia.

    Parameters
    ----------
    state : State
        At the start.
    columns : ndarray, shape (n,)
        Units of the coordinates, from their inertia.

    Returns
    -------
    q_scale, qd_scale : ndarray, shape (n,)
        A hundredth of the size that a coordinate of the largest energy has.
    """
    place = max(float(np.max(np.abs(state.q / columns))), 1e-300)
    speed = float(np.max(np.abs(state.qd / columns)))
    push = float(np.max(np.abs(state.qdd / columns)))
    # A motion that starts from rest gets speeds of the order sqrt(acceleration x length).
    speed = max(speed, float(np.sqrt(place) * np.sqrt(push)), 1e-300)
    return 0.01 * place * columns, 0.01 * speed * columns


def first_step(state: State, control: Control, order: int) -> float:
    """Return a length for the first step, from the sizes of the state and its rates [s]."""
    # The floors are a hundredth of a full size by inertia, which is the measure here.
    place = float(np.max(np.abs(state.q) / control.q_scale)) + 1.0
    pace = float(np.max(np.abs(state.qd) / control.q_scale)) / place
    push = float(np.max(np.abs(state.qdd) / control.qd_scale))
    speed = float(np.max(np.abs(state.qd) / control.qd_scale)) + 1.0
    rate = max(pace, push / speed, 1e-300)
    return float(min(0.5 * control.rtol ** (1.0 / (order + 1)) / rate, control.longest))
