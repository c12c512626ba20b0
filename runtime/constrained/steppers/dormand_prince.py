"""Dormand and Prince's method of order 8(5,3), in whatever coordinates a chart gives."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Protocol

import numpy as np

from ..equations import Array, NoConvergence, State
from .protocol import Control, Step, StoppedEarly, first_step

ORDER = 8
_STAGES = 12
_SAFETY, _LEAST, _MOST = 0.9, 0.2, 6.0
_PARTS = 64

Rate = Callable[[float, Array], Array]


class Chart(Protocol):
    """Coordinates ``y`` in which the motion is an ordinary differential equation."""

    def begin(self, state: State) -> tuple[Array, Array]:
        """Return y and its rate at the start of a step; may choose other coordinates there."""

    def rate(self, t: float, y: Array) -> Array:
        """Return dy/dt at a stage."""

    def full(self, t: float, y: Array) -> tuple[Array, Array]:
        """Return a prediction of all coordinates and velocities."""

    def finish(self, t: float, y: Array) -> State:
        """Return the state on the constraints at the end of a step."""

    def inner(self, state: State) -> tuple[Array, Array]:
        """Return y and its rate at the end of a step, in the coordinates of its start."""

    def scale(self, y: Array, ahead: Array) -> Array:
        """Return the sizes that the tolerance is relative to."""


@dataclass(frozen=True)
class _Tableau:
    rows: tuple[Array, ...]
    weights: Array
    nodes: Array
    third: Array
    fifth: Array
    extra: tuple[Array, ...]
    dense: Array


@cache
def _tableau() -> _Tableau:
    """Return the coefficients as SciPy has them."""
    from scipy.integrate import DOP853

    extra = np.asarray(DOP853.A_EXTRA)
    return _Tableau(
        rows=tuple(np.asarray(DOP853.A[i, :i]) for i in range(_STAGES)),
        weights=np.asarray(DOP853.B),
        nodes=np.concatenate([np.asarray(DOP853.C), [1.0], np.asarray(DOP853.C_EXTRA)]),
        third=np.asarray(DOP853.E3)[:_STAGES],
        fifth=np.asarray(DOP853.E5)[:_STAGES],
        extra=tuple(row[: _STAGES + 1 + i] for i, row in enumerate(extra)),
        dense=np.asarray(DOP853.D),
    )


def march(chart: Chart, start: State, end: float, control: Control) -> Iterator[Step]:
    """March in the coordinates of a chart.

    Parameters
    ----------
    chart : Chart
        Coordinates.
    start : State
        Meets the constraints.
    end : float
        Time to reach [s].
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
    state = start
    grid = _grid(start.t, end, control)
    if grid is not None:
        for t in grid[1:]:
            for step in _forced(chart, state, float(t), control):
                yield step
                state = step.after
        return
    h = first_step(start, control, ORDER)
    while state.t < end:
        t = state.t + h
        if t >= end - 1e-12 * h:
            t = end
        length = t - state.t
        if not length > 4e-16 * max(abs(state.t), abs(end)):
            raise StoppedEarly(
                "the step became too short: the constraints lose their rank, or the motion diverges"
            )
        factor, taken = _attempt(chart, state, t, length, control, forced=False)
        if taken is not None:
            yield taken
            state = taken.after
        h = min(length * factor, control.longest)


def _forced(chart: Chart, state: State, end: float, control: Control) -> Iterator[Step]:
    """Take one step of given length; on a grid, which a second run follows, in parts if need be."""
    parts = 1
    while state.t < end:
        t = end if parts == 1 else state.t + (end - state.t) / parts
        _, taken = _attempt(chart, state, t, t - state.t, control, forced=True)
        if taken is not None:
            yield taken
            state = taken.after
            parts = max(1, parts - 1)
        elif control.grid is None or parts >= _PARTS:
            raise StoppedEarly("a fixed step has no solution: shorten it")
        else:
            parts *= 2


def _grid(begin: float, end: float, control: Control) -> Array | None:
    """Return the ends of fixed steps, or None where a tolerance chooses them."""
    if control.grid is not None or control.step is None:
        return control.grid
    return np.linspace(begin, end, max(1, round((end - begin) / control.step)) + 1)


def _attempt(
    chart: Chart, state: State, t: float, h: float, control: Control, *, forced: bool
) -> tuple[float, Step | None]:
    """Return the factor of the next step's length, and this step where it is accepted."""
    try:
        y, rate = chart.begin(state)
        slopes, ahead = _stages(chart.rate, state.t, y, rate, h)
        size = _error(slopes, chart.scale(y, ahead), h, control.rtol)
        if not size < 1.0 and not forced:
            short = _SAFETY * size ** (-1.0 / ORDER) if np.isfinite(size) else 0.0
            return max(_LEAST, short), None
        after = chart.finish(t, ahead)
        last, last_rate = chart.inner(after)
    except NoConvergence:
        return _LEAST, None
    factor = min(_MOST, _SAFETY * size ** (-1.0 / ORDER)) if size > 0 else _MOST
    slopes[_STAGES] = last_rate
    between = _Between(chart.rate, chart.full, state.t, h, y, last, slopes)
    return factor, Step(state, after, between)


def _stages(rate: Rate, t: float, y: Array, start: Array, h: float) -> tuple[Array, Array]:
    """Return the slopes of the stages, with room for those of the interpolant, and the end."""
    tableau = _tableau()
    slopes = np.empty((_STAGES + 4, len(y)))
    slopes[0] = start
    for i in range(1, _STAGES):
        inner = y + h * (tableau.rows[i] @ slopes[:i])
        slopes[i] = rate(t + tableau.nodes[i] * h, inner)
    return slopes, y + h * (tableau.weights @ slopes[:_STAGES])


def _error(slopes: Array, scale: Array, h: float, rtol: float) -> float:
    """Return the error of a step over its tolerance (Hairer, Norsett and Wanner, II.10)."""
    tableau = _tableau()
    if not len(scale):
        return 0.0
    five = (tableau.fifth @ slopes[:_STAGES]) / (rtol * scale)
    three = (tableau.third @ slopes[:_STAGES]) / (rtol * scale)
    above, below = float(five @ five), float(three @ three)
    if above == 0.0 and below == 0.0:
        return 0.0
    return h * above / float(np.sqrt((above + 0.01 * below) * len(scale)))


class _Between:
    """The interpolant of order 7 in the chart; its three more stages are made on first use."""

    def __init__(
        self,
        rate: Rate,
        full: Callable[[float, Array], tuple[Array, Array]],
        t: float,
        h: float,
        y: Array,
        last: Array,
        slopes: Array,
    ) -> None:
        self._rate, self._full = rate, full
        self._t, self._h = t, h
        self._y, self._last, self._slopes = y, last, slopes
        self._made: Array | None = None

    def _coefficients(self) -> Array:
        tableau, slopes, h, y = _tableau(), self._slopes, self._h, self._y
        for i, row in enumerate(tableau.extra):
            place = _STAGES + 1 + i
            inner = y + h * (row @ slopes[: len(row)])
            slopes[place] = self._rate(self._t + tableau.nodes[place] * h, inner)
        change = self._last - y
        found = np.empty((3 + len(tableau.dense), len(y)))
        found[0] = change
        found[1] = h * slopes[0] - change
        found[2] = 2 * change - h * (slopes[_STAGES] + slopes[0])
        found[3:] = h * (tableau.dense @ slopes)
        return found

    def __call__(self, t: float) -> tuple[Array, Array]:
        """Return predicted coordinates and velocities at a time inside the step."""
        if self._made is None:
            self._made = self._coefficients()
        x = (t - self._t) / self._h
        y = np.zeros_like(self._y)
        for i, row in enumerate(self._made[::-1]):
            y = (y + row) * (x if i % 2 == 0 else 1.0 - x)
        return self._full(t, self._y + y)
