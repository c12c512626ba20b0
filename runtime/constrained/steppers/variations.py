"""A motion together with its variations: the exact derivative of the symmetric steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import bad
from ...core.families import Constrained
from ..equations import Array, Equations, NoConvergence, State
from .lobatto import Stages, solve_stages, stage_matrix
from .lobatto_tableau import LobattoPair, lobatto_pair
from .protocol import STAGES, StoppedEarly


@dataclass(frozen=True)
class VariedMotion:
    """A motion over equal steps and what becomes of small changes of its start.

    Attributes
    ----------
    t : ndarray, shape (steps + 1,)
        Ends of the steps [s].
    q, qd, qdd : ndarray, shape (steps + 1, n)
        States.
    multipliers : ndarray, shape (steps + 1, k)
        Multipliers.
    columns : ndarray, shape (2n, m)
        Changes ``(dq, dqd)`` at the end.
    evaluations : int
        Evaluations of the equations of motion.
    """

    t: Array
    q: Array
    qd: Array
    qdd: Array
    multipliers: Array
    columns: Array
    evaluations: int


def motion_with_variations(
    system: Constrained,
    q: ArrayLike,
    qd: ArrayLike,
    span: tuple[float, float],
    columns: ArrayLike | None = None,
    *,
    steps: int,
    stages: int = STAGES,
) -> VariedMotion:
    """Integrate a state and the derivatives of the end by the start.

    The steps are those of :func:`.lobatto.lobatto`, order ``2 stages - 2``; the columns are the
    derivative of these very steps, so that Newton's iteration on the end of a motion converges
    quadratically.  A column that leaves the constraints is carried on as by the equations of
    motion with ``Phi_q qdd = gamma``: its defects of position and velocity stay and grow linearly.

    Parameters
    ----------
    system : Constrained
        With variations; its parameters are single numbers.
    q, qd : array_like, shape (n,)
        A state that meets the constraints (:func:`.consistent.consistent_state`).
    span : pair of float
        First and last time [s].
    columns : array_like, shape (2n, m), optional
        Changes ``(dq, dqd)`` of the start; by default all, the unit matrix.
    steps : int
        Number of equal steps.
    stages : int
        Stages of a step, at least 2.

    Returns
    -------
    VariedMotion
        States at the ends of the steps, and the columns at the end.

    Raises
    ------
    BadInput
        If the system has no variations or an argument is unusable.
    StoppedEarly
        If a step has no solution.
    """
    if system.variations is None:
        raise bad("system", "no variations", "a module emitted with them", "regenerate it with")
    q, qd = np.array(q, dtype=float), np.array(qd, dtype=float)
    n = system.size
    begin, end = float(span[0]), float(span[1])
    if q.shape != (n,) or qd.shape != (n,) or not np.isfinite([*q, *qd, begin, end]).all():
        raise bad("q, qd, span", "other", f"{n} finite numbers each, two times", "correct them")
    if not 1 <= steps <= 10**7 or stages < 2:
        raise bad("steps, stages", (steps, stages), "at least 1 and 2", "correct them")
    moved = np.eye(2 * n) if columns is None else np.array(columns, dtype=float)
    if moved.ndim != 2 or len(moved) != 2 * n:
        raise bad("columns", f"shape {moved.shape}", f"shape ({2 * n}, m)", "correct it")
    return _march(system, q, qd, np.linspace(begin, end, steps + 1), moved, lobatto_pair(stages))


def _march(
    system: Constrained, q: Array, qd: Array, t: Array, columns: Array, pair: LobattoPair
) -> VariedMotion:
    equations = Equations(system, q, qd, float(t[0]))
    rate = jacobian_rate(system, q, qd, float(t[0]))
    states, inside = [equations.at(float(t[0]), q, qd)], None
    for end in t[1:]:
        before = states[-1]
        try:
            inside = solve_stages(equations, before, float(end) - before.t, pair, inside)
            after = equations.at(float(end), *inside.end)
            next_rate = jacobian_rate(system, after.q, after.qd, after.t)
            columns = _carried(equations, before, inside, columns, (rate, next_rate))
        except (NoConvergence, np.linalg.LinAlgError) as reason:
            raise StoppedEarly(
                f"a step at t = {before.t:.6g} has no solution ({reason}): take more steps"
            ) from reason
        states.append(after)
        rate = next_rate
    return VariedMotion(
        t,
        np.array([state.q for state in states]),
        np.array([state.qd for state in states]),
        np.array([state.qdd for state in states]),
        np.array([state.multipliers for state in states]),
        columns,
        equations.evaluations,
    )


def jacobian_rate(system: Constrained, q: Array, qd: Array, t: float) -> Array:
    """Return the rate of the constraints' Jacobian along a motion, ``(k, n)``.

    It is ``d(Phi_q qd - velocity_rhs)/dq = -1/2 d(gamma)/d(qd)``.  gamma is of second degree in
    the velocities, so that central differences give it without truncation, whatever the step.

    Parameters
    ----------
    system : Constrained
        The system.
    q, qd : ndarray, shape (n,)
        State.
    t : float
        Time [s].
    """
    n = system.size
    if not system.constraints:
        return np.zeros((0, n))
    mass = np.abs(np.diagonal(system.dynamics(q, qd, t)["mass"]))
    unit = 1.0 / np.sqrt(np.where(mass > 0, mass, 1.0))
    speed = float(np.max(np.abs(qd / unit)))
    change = np.diag(unit * (speed if speed > 0 else 1.0))
    places = np.broadcast_to(q, (n, n))
    moment = np.full(n, t)
    ahead = system.dynamics(places, qd + change, moment)["gamma"][..., 0]
    behind = system.dynamics(places, qd - change, moment)["gamma"][..., 0]
    found: Array = -0.25 * ((ahead - behind) / np.diagonal(change)[:, None]).T
    return found


def tangent_basis(system: Constrained, q: Array, qd: Array, t: float = 0.0) -> Array:
    """Return changes ``(dq, dqd)`` that keep the constraints, ``(2n, 2(n - k))``.

    They span the null space of ``[[Phi_q, 0], [d(Phi_q)/dt, Phi_q]]`` and are orthonormal in
    coordinates measured by their inertia, the velocities measured by the fastest one.

    Parameters
    ----------
    system : Constrained
        The system.
    q, qd : ndarray, shape (n,)
        A state that meets the constraints.
    t : float
        Time [s].
    """
    n, k = system.size, system.constraints
    equations = Equations(system, q, qd, t)
    jacobian = system.violation(q, t)["jacobian"]
    rate = jacobian_rate(system, q, qd, t)
    place = float(np.max(np.abs(q / equations.columns)))
    speed = float(np.max(np.abs(qd / equations.columns)))
    pace = speed / place if speed > 0 and place > 0 else 1.0
    units = np.concatenate([equations.columns, equations.columns * pace])
    rows = np.concatenate([equations.rows, equations.rows / pace])
    whole = np.block([[jacobian, np.zeros((k, n))], [rate, jacobian]])
    _, _, right = np.linalg.svd(rows[:, None] * whole * units)
    basis: Array = units[:, None] * right[2 * k :].T
    return basis


def _carried(
    equations: Equations,
    before: State,
    inside: Stages,
    columns: Array,
    rates: tuple[Array, Array],
) -> Array:
    """Return columns at the end of a step from those at its start."""
    system, pair, h = equations.system, inside.pair, inside.h
    s, n, k, m = len(pair.c), equations.n, equations.k, columns.shape[1]
    dq, dv = columns[:n], columns[n:]
    a = dict(system.dynamics(inside.q, inside.qd, inside.t))
    found = system.variations(inside.q, inside.qd, inside.qdd, inside.multipliers, inside.t)  # type: ignore[misc]
    matrix = stage_matrix(equations, a, found, h, pair)
    twice = pair.first @ pair.second
    held = equations.rows[:, None]
    moved = h * twice[-1][None, :, None] * (held * rates[1] * equations.columns)[:, None, :]
    matrix[s * (n + k) - k :, : s * n] += moved.reshape(k, s * n)
    start = a["jacobian"][0]
    defect, growth = start @ dq, start @ dv + rates[0] @ dq
    ahead = dq + h * pair.c[:, None, None] * dv
    motion = equations.columns[:, None] * (found["damping"] @ dv + found["stiffness"] @ ahead)
    place = a["jacobian"] @ ahead - defect - h * pair.c[:, None, None] * growth
    speed = a["jacobian"][-1] @ dv + rates[1] @ ahead[-1] - growth
    below = np.concatenate([place[1:] / (h * h), speed[None] / h])
    right = np.concatenate([motion.reshape(s * n, m), (held * below).reshape(s * k, m)])
    change = -np.linalg.solve(matrix, right)[: s * n].reshape(s, n, m) * equations.columns[:, None]
    end = np.tensordot(twice[-1], change, 1), np.tensordot(pair.b, change, 1)
    return np.concatenate([ahead[-1] + h * h * end[0], dv + h * end[1]])
