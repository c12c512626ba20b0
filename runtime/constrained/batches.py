"""Many states of a constrained system in one evaluation: accelerations, slopes, projection."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.families.multipliers import kkt_matrix
from .equations import Array, Equations, NoConvergence, State

_EPS = float(np.finfo(float).eps)
_MOST = 25
# Differences of the emitted functions are taken over this part of the size of a state.
_APART = 1e-6


@dataclass(frozen=True)
class Slopes:
    """Accelerations at several states and how they vary, over the units of the coordinates.

    Attributes
    ----------
    accelerations : ndarray, shape (s, n)
        Accelerations.
    by_place, by_speed : ndarray, shape (s, n, n)
        Their derivatives by coordinates and velocities.
    """

    accelerations: Array
    by_place: Array
    by_speed: Array


def accelerations_with_slopes(
    equations: Equations, t: Array, place: Array, speed: Array, span: float
) -> Slopes:
    """Return accelerations and their derivatives, by differences, in one evaluation.

    The equations are varied with accelerations and multipliers held, so that one matrix for each
    state serves all differences: ``K d(qdd, lam) = -d(residual)``.

    Parameters
    ----------
    equations : Equations
        The system.
    t : ndarray, shape (s,)
        Times [s].
    place, speed : ndarray, shape (s, n)
        Coordinates and velocities over their units.
    span : float
        Time over which speeds and accelerations count as changes [s].

    Raises
    ------
    NoConvergence
        If the accelerations do not exist.
    """
    n, s = equations.n, len(t)
    equations.evaluations += (2 * n + 1) * s
    fast = float(np.max(np.abs(speed), initial=0.0))
    wide = max(float(np.max(np.abs(place), initial=0.0)), fast * span)
    wide = wide if wide > 0.0 else 1.0
    fast = fast if fast > 0.0 else wide / span
    steps = _APART * np.array([wide, fast])
    # Powers of two, so that the differences are exactly what they are divided by.
    steps = np.asarray(np.exp2(np.round(np.log2(steps))), dtype=np.float64)
    places = np.broadcast_to(place, (2 * n + 1, s, n)).copy()
    speeds = np.broadcast_to(speed, (2 * n + 1, s, n)).copy()
    each = np.arange(n)
    places[1 + each, :, each] += steps[0]
    speeds[1 + n + each, :, each] += steps[1]
    columns = equations.columns
    moments = np.broadcast_to(t, (2 * n + 1, s))
    a = equations.system.dynamics(places * columns, speeds * columns, moments)
    push = (a["rest"] - a["forces"])[..., 0]
    jacobian, gamma = a["jacobian"], a["gamma"][..., 0]
    matrix = equations.outer * kkt_matrix(a["mass"][0], jacobian[0])
    scale = equations.scale
    right = -scale * np.concatenate([push[0], -gamma[0]], axis=-1)
    solved = _solved(matrix, right[..., None])[..., 0]
    if not np.isfinite(solved).all():
        raise NoConvergence("the accelerations are not finite")
    qdd, lam = solved[:, :n] * scale[:n], solved[:, n:] * scale[n:]
    motion = (a["mass"] @ qdd[..., None])[..., 0] + push
    motion -= (np.swapaxes(jacobian, -1, -2) @ lam[..., None])[..., 0]
    held = (jacobian @ qdd[..., None])[..., 0] - gamma
    defect = scale * np.concatenate([motion, held], axis=-1)
    varied = np.moveaxis(defect[1:] - defect[0], 0, -1)
    found = -_solved(matrix, varied)[:, :n]
    if not np.isfinite(found).all():
        raise NoConvergence("the slopes of the accelerations are not finite")
    slopes = found.reshape(s, n, 2, n) / steps[:, None]
    return Slopes(solved[:, :n], slopes[:, :, 0], slopes[:, :, 1])


def _solved(matrix: Array, right: Array) -> Array:
    try:
        found = np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError as singular:
        raise NoConvergence("the constraints' Jacobian lost its rank") from singular
    return np.asarray(found, dtype=np.float64)


def nearest_states(equations: Equations, t: Array, q: Array, qd: Array) -> list[State]:
    """Return the states nearest to predicted ones, in the metric of the masses, all at once.

    Parameters
    ----------
    equations : Equations
        The system.
    t : ndarray, shape (m,)
        Times [s].
    q, qd : ndarray, shape (m, n)
        Predicted coordinates and velocities.

    Raises
    ------
    NoConvergence
        If the constraints are out of reach.
    """
    if not len(t):
        return []
    system = equations.system
    if equations.k:
        equations.evaluations += 2 * len(t)
        mass = system.dynamics(q, qd, t)["mass"]
        q = _positions(equations, t, q, mass)
        a = system.dynamics(q, qd, t)
        defect = (a["velocity_rhs"] - a["jacobian"] @ qd[..., None])[..., 0]
        matrix = equations.outer * kkt_matrix(a["mass"], a["jacobian"])
        qd = qd + _change(equations, matrix, defect)
    qdd, lam = equations.accelerations(t, q, qd)
    return [State(float(t[i]), q[i], qd[i], qdd[i], lam[i]) for i in range(len(t))]


def _change(equations: Equations, matrix: Array, defect: Array) -> Array:
    """Return the least changes that the constraints' defects ask for."""
    n, scale = equations.n, equations.scale
    right = np.zeros((len(defect), len(scale)))
    right[:, n:] = scale[n:] * defect
    found: Array = scale[:n] * _solved(matrix, right[..., None])[:, :n, 0]
    if not np.isfinite(found).all():
        raise NoConvergence("the constraints are out of reach")
    return found


def _positions(equations: Equations, t: Array, q: Array, mass: Array) -> Array:
    """Return positions on the constraints; see :meth:`Equations.positions`."""
    last = np.full(len(t), np.inf)
    for _ in range(_MOST):
        a = equations.system.violation(q, t)
        matrix = equations.outer * kkt_matrix(mass, a["jacobian"])
        change = _change(equations, matrix, -a["constraints"][..., 0])
        q = q + change
        size = np.max(np.abs(change / equations.columns), axis=-1)
        scale = np.max(np.abs(q / equations.columns), axis=-1) + _EPS
        there = (size <= 1e-9 * scale) | ((size >= 0.5 * last) & (size <= 1e-12 * scale))
        if there.all():
            return q
        if not np.all(there | (size < 2.0 * last)):
            break
        last = size
    raise NoConvergence("the positions do not reach the constraints")
