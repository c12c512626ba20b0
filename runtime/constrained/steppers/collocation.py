"""Collocation over long windows, all nodes of a window in one evaluation."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..batches import accelerations_with_slopes, nearest_states
from ..equations import Array, Equations, NoConvergence, State
from .gauss_window import Solved, TooLong, nodes, solve_window
from .protocol import Control, Step, StoppedEarly

_SAFETY, _LEAST, _MOST = 0.9, 0.2, 3.0
# A looser tolerance makes no window cheaper.
_LOOSEST = 1e-3
# How much shorter a window becomes that has something outside of its nodes.
_OUTSIDE = 2.0
# Every so many nodes what may stop a motion is looked at.
_EACH = 3
# Sizes of speeds are the full natural ones: by energy, not a hundredth of it.
_FAST = 100.0
_UNKNOWNS, _LEAST_NODES, _MOST_NODES = 160, 8, 24
# Stages of windows of fixed length where none are asked for.
_FIXED = 8


@dataclass(frozen=True)
class Window(Step):
    """A window with what is known inside of it.

    Attributes
    ----------
    solved : Solved
        The collocation.
    missed : ndarray, shape (s, n)
        Change of its accelerations by a shorter series, carried on from the windows before.
    astray : tuple of ndarray
        Change of coordinates and velocities at the beginning, carried on alike.
    slack : tuple of ndarray
        Errors of coordinates and velocities that belong to neither: what the iteration left, and
        what happens outside of the nodes.
    """

    solved: Solved
    missed: Array
    astray: tuple[Array, Array]
    slack: tuple[Array, Array]

    def samples(self, t: Array) -> tuple[Array, Array, Array]:
        """Return predicted coordinates, velocities, and how far a shorter series is off.

        Parameters
        ----------
        t : ndarray, shape (nt,)
            Times inside [s].

        Returns
        -------
        q, qd, gap : ndarray, shape (nt, n)
            The gap is that of the coordinates.
        """
        solved = self.solved
        h, x = solved.h, (t - self.before.t) / solved.h
        twice, once = solved.points.at(x)
        q, qd = solved.along(x, twice, once)
        place, speed = self.astray
        series = solved.points.series @ self.missed * solved.columns
        gap: Array = np.abs(place + h * x[:, None] * speed + h * h * (twice @ series))
        return q, qd, gap + self.slack[0]

    def largest(self) -> Array:
        """Return the largest sizes of the coordinates at the nodes, ``(n,)``."""
        solved, before = self.solved, self.before
        q = before.q + solved.h * solved.points.c[:, None] * before.qd
        q = q + solved.h**2 * solved.columns * (solved.points.twice @ solved.slope)
        found: Array = np.max(np.abs(q), axis=0)
        return found

    def pieces(self, equations: Equations) -> list[Step]:
        """Return the window in parts between some of its nodes.

        Raises
        ------
        NoConvergence
            If a node does not reach the constraints.
        """
        solved = self.solved
        x = solved.points.c[_EACH - 1 : -1 : _EACH]
        q, qd = solved.along(x, *solved.points.at(x))
        inner = nearest_states(equations, self.before.t + solved.h * x, q, qd)
        states = [self.before, *inner, self.after]
        return [Step(a, b, self.between) for a, b in pairwise(states)]


def collocation(
    equations: Equations, start: State, times: Array, control: Control
) -> Iterator[Window]:
    """March in long windows of Gauss collocation, each end projected onto the constraints.

    A window has many nodes and spans what would be tens of explicit steps; its nodes are
    evaluated in one call of the emitted functions, whose cost hardly depends on their number.
    The windows are as long as the end of the Legendre series of the accelerations allows.

    Beside the motion goes that of a series shorter by two terms, linearised inside the windows and
    projected at their ends: its distance is the error figure.

    Parameters
    ----------
    equations : Equations
        The system.
    start : State
        Meets the constraints.
    times : ndarray, shape (nt,)
        The last is where to end [s]; windows pass over the others.
    control : Control
        Tolerance, or fixed length of the windows.

    Yields
    ------
    Window
        The accepted windows.

    Raises
    ------
    StoppedEarly
        If the window becomes too short.
    """
    end = float(times[-1])
    number = control.stages or (_stages(equations.n) if control.step is None else _FIXED)
    points, forced = nodes(number), control.step is not None
    h = _first(equations, start, end, control, number)
    state: State = start
    guess: Array | None = None
    side: tuple[Array, Array] | None = (np.zeros(equations.n), np.zeros(equations.n))
    while state.t < end:
        t = state.t + h
        if t >= end - 1e-12 * h or (not forced and t > end - 0.1 * h):
            t = end
        length = t - state.t
        if not length > 4e-16 * max(abs(state.t), abs(end)):
            raise StoppedEarly(
                "the step became too short: the constraints lose their rank, or the motion diverges"
            )
        if guess is None:
            guess = np.tile(state.qdd / equations.columns, (number, 1))
        rtol = min(control.rtol, _LOOSEST) if not forced else 1e-14
        try:
            solved = solve_window(
                equations,
                state,
                length,
                points,
                guess,
                (control.q_scale, _FAST * control.qd_scale),
                rtol,
                forced=forced,
            )
            after = equations.state(t, *solved.end())
            outside = solved.unseen(after.qdd)
            if not forced and solved.units.of(*outside) > rtol:
                raise TooLong(_OUTSIDE**number, solved.slope)
        except (TooLong, NoConvergence) as reason:
            if forced:
                raise StoppedEarly("a fixed step has no solution: shorten it") from reason
            size = reason.size if isinstance(reason, TooLong) else 1e3**number
            h = length * max(_LEAST, _SAFETY * size ** (-1.0 / number))
            guess = (
                points.shortened(reason.slope, h / length) if isinstance(reason, TooLong) else None
            )
            continue
        taken = _window(state, after, solved, outside, side)
        yield taken
        side = _carried(equations, taken)
        state, guess = after, None
        if not forced:
            size = max(solved.size, 1e-300)
            h = min(length * min(_MOST, _SAFETY * size ** (-1.0 / number)), control.longest)


def _stages(size: int) -> int:
    """Return how many nodes serve a number of coordinates best.

    An evaluation costs nearly the same for few nodes and many, the solution of a window their
    third power.
    """
    return int(np.clip(_UNKNOWNS // max(size, 1), _LEAST_NODES, _MOST_NODES))


def _first(equations: Equations, start: State, end: float, control: Control, number: int) -> float:
    """Return the length of the first window, from the fastest motion that the state allows."""
    span = end - start.t
    if control.step is not None:
        return span / max(1, round(span / control.step))
    n, columns = equations.n, equations.columns
    place, speed = start.q / columns, start.qd / columns
    found = accelerations_with_slopes(
        equations, np.array([start.t]), place[None], speed[None], span
    )
    matrix = np.eye(2 * n, k=n)
    matrix[n:, :n], matrix[n:, n:] = found.by_place[0], found.by_speed[0]
    rate = float(np.max(np.abs(np.linalg.eigvals(matrix)), initial=0.0))
    # Term k of the Legendre series of exp(i z x) is about (e z / 2 k)^k.
    reach = 1.5 * 4.0 * number / np.e * min(control.rtol, _LOOSEST) ** (1.0 / number)
    return min(reach / rate if rate > 0.0 else span, span, control.longest)


def _window(
    before: State,
    after: State,
    solved: Solved,
    outside: tuple[Array, Array],
    side: tuple[Array, Array] | None,
) -> Window:
    def between(t: float) -> tuple[Array, Array]:
        x = np.array([(t - before.t) / solved.h])
        q, qd = solved.along(x, *solved.points.at(x))
        return q[0], qd[0]

    units, columns = solved.units, solved.columns
    slack = (
        columns * (outside[0] + solved.left * units.place),
        columns * (outside[1] + solved.left * units.speed),
    )
    if side is None:
        unknown = np.full_like(before.q, np.inf)
        return Window(before, after, between, solved, solved.slope, (unknown, unknown), slack)
    return Window(before, after, between, solved, solved.missed(*side), side, slack)


def _carried(equations: Equations, taken: Window) -> tuple[Array, Array] | None:
    """Return the distance of the motion of the shorter series at the end of a window."""
    solved, (place, speed), after = taken.solved, taken.astray, taken.after
    if not np.isfinite(place).all():
        return None
    h, points = solved.h, solved.points
    rise = solved.columns * (points.back @ taken.missed)
    place = place + h * (speed + h * rise)
    speed = speed + h * solved.columns * (points.b @ taken.missed)
    q = after.q + place + np.copysign(taken.slack[0], place)
    qd = after.qd + speed + np.copysign(taken.slack[1], speed)
    try:
        q, qd = equations.nearest(after.t, q, qd)
    except NoConvergence:
        return None
    return q - after.q, qd - after.qd
