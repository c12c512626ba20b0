"""Explicit steps of order 8 in independent coordinates, chosen by rank-revealing QR."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..equations import Array, Equations, NoConvergence, State
from .dormand_prince import march
from .protocol import Control, Step

_MOST = 12
_EPS = float(np.finfo(float).eps)
# The dependent columns are chosen anew when their condition has grown by this factor.
_WORSE = 3.0


def coordinate_partitioning(
    equations: Equations, start: State, times: Array, control: Control
) -> Iterator[Step]:
    """March in independent coordinates with steps of order 8.

    The dependent coordinates are those that pivoted QR of the Jacobian takes first; at every stage
    they and their velocities are solved for to round-off (Wehage and Haug 1982).  They are chosen
    anew, at the start of a step, when the condition of their columns has grown threefold.

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
    yield from march(Partition(equations, control), start, float(times[-1]), control)


class Partition:
    """Independent coordinates and their velocities.

    Parameters
    ----------
    equations : Equations
        The system.
    control : Control
        Gives the sizes that tolerances are relative to.

    Attributes
    ----------
    choices : int
        How often the coordinates were chosen.
    """

    def __init__(self, equations: Equations, control: Control) -> None:
        self._equations, self._control = equations, control
        self._dependent: NDArray[np.intp] | None = None
        self._independent: NDArray[np.intp] = np.arange(0)
        self._condition = np.inf
        self._base: State | None = None
        self.choices = 0

    def begin(self, state: State) -> tuple[Array, Array]:
        """Return the independent coordinates, chosen anew where the old choice has become poor."""
        jacobian = self._scaled(self._equations.system.violation(state.q, state.t)["jacobian"])
        if self._dependent is None or self._measure(jacobian) > _WORSE * self._condition:
            self._choose(jacobian)
        self._base = state
        return self.inner(state)

    def inner(self, state: State) -> tuple[Array, Array]:
        """Return independent coordinates and velocities, and their rates."""
        i = self._independent
        return (
            np.concatenate([state.q[i], state.qd[i]]),
            np.concatenate([state.qd[i], state.qdd[i]]),
        )

    def rate(self, t: float, y: Array) -> Array:
        """Return the rates of the independent coordinates and velocities."""
        q, qd = self.full(t, y)
        i = self._independent
        qdd, _ = self._equations.acceleration(t, q, qd)
        return np.concatenate([qd[i], qdd[i]])

    def full(self, t: float, y: Array) -> tuple[Array, Array]:
        """Return all coordinates and velocities, the dependent ones solved to round-off."""
        free = len(self._independent)
        q = self._positions(t, y[:free])
        qd = np.zeros_like(q)
        qd[self._independent] = y[free:]
        if self._equations.k and self._dependent is not None:
            a = self._equations.terms(t, q, qd)
            jacobian, rows = a["jacobian"], self._equations.rows
            defect = rows * (a["velocity_rhs"][:, 0] - jacobian @ qd)
            qd[self._dependent] = self._solve(self._scaled(jacobian), defect)
        return q, qd

    def finish(self, t: float, y: Array) -> State:
        """Return the state at the end of a step."""
        return self._equations.at(t, *self.full(t, y))

    def scale(self, y: Array, ahead: Array) -> Array:
        """Return the sizes of the independent coordinates and velocities."""
        i, control = self._independent, self._control
        floor = np.concatenate([control.q_scale[i], control.qd_scale[i]])
        found: Array = floor + np.maximum(np.abs(y), np.abs(ahead))
        return found

    def _scaled(self, jacobian: Array) -> Array:
        found: Array = self._equations.rows[:, None] * jacobian * self._equations.columns
        return found

    def _measure(self, scaled: Array) -> float:
        """Return the size of the whole over the least singular value of the dependent columns."""
        if not len(scaled):
            return 1.0
        values = np.linalg.svd(scaled[:, self._dependent], compute_uv=False)
        return float(np.linalg.norm(scaled) / values[-1]) if values[-1] > 0 else np.inf

    def _choose(self, scaled: Array) -> None:
        from scipy.linalg import qr

        k, n = scaled.shape
        order: NDArray[np.intp] = np.arange(n)
        if k:
            order = np.asarray(qr(scaled, mode="r", pivoting=True)[1], dtype=np.intp)
        self._dependent = np.sort(order[:k])
        self._independent = np.sort(order[k:])
        self._condition = self._measure(scaled)
        self.choices += 1

    def _solve(self, scaled: Array, right: Array) -> Array:
        """Return the dependent part of a solution with the scaled Jacobian."""
        try:
            found = np.linalg.solve(scaled[:, self._dependent], right)
        except np.linalg.LinAlgError as singular:
            raise NoConvergence("the dependent coordinates are not determined") from singular
        change: Array = found * self._equations.columns[self._dependent]
        return change

    def _positions(self, t: float, free: Array) -> Array:
        """Return all coordinates from the independent ones."""
        base, equations = self._base, self._equations
        if base is None or not equations.k:
            return free.copy()
        ahead = t - base.t
        q = base.q + ahead * (base.qd + 0.5 * ahead * base.qdd)
        q[self._independent] = free
        # The way, and not the distance, which is short about a turning point.
        way = np.abs(ahead * base.qd) + ahead * ahead * np.abs(base.qdd)
        moved = float(np.max(way / equations.columns))
        last = np.inf
        size = float(np.max(np.abs(q / equations.columns))) + _EPS
        for count in range(_MOST):
            a = equations.system.violation(q, t)
            change = self._solve(
                self._scaled(a["jacobian"]), -equations.rows * a["constraints"][:, 0]
            )
            q[self._dependent] += change
            now = float(np.max(np.abs(change / equations.columns[self._dependent])))
            if not np.isfinite(now) or (count == 0 and now > 0.1 * moved + 1e-9 * size):
                break  # too far from the prediction: another branch may be nearer
            if now <= 1e-9 * size:
                return q
            if now > 0.5 * last:
                break
            last = now
        raise NoConvergence("the dependent coordinates are out of reach")
