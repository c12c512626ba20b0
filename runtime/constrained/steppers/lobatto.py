"""The symmetric pair Lobatto IIIA and IIIB on constrained systems, RATTLE with more stages."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from ...core.errors import bad
from ..equations import Array, Equations, NoConvergence, State
from .lobatto_tableau import LobattoPair, lobatto_pair
from .protocol import STAGES, Control, Step, StoppedEarly, first_step

_MOST = 30
_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Stages:
    """The inside of a step.

    Attributes
    ----------
    t : ndarray, shape (s,)
        Times [s].
    q, qd, qdd : ndarray, shape (s, n)
        Stage values.
    multipliers : ndarray, shape (s, k)
        Of the stages, which meet the positions' constraints alone.
    h : float
        Length of the step [s].
    pair : LobattoPair
        Coefficients.
    end : tuple of ndarray
        Coordinates and velocities at the end of the step.
    """

    t: Array
    q: Array
    qd: Array
    qdd: Array
    multipliers: Array
    h: float
    pair: LobattoPair
    end: tuple[Array, Array]


def lobatto(
    equations: Equations,
    start: State,
    times: Array,
    control: Control,
) -> Iterator[Step]:
    """March with equal symmetric steps of order ``2 stages - 2`` that end on the given times.

    Positions are those of Lobatto IIIA, velocities of IIIB; the multipliers of the stages make
    the positions meet the constraints at every stage and the velocities at the end (Jay 1996;
    with two stages this is RATTLE).  Energy does not drift in conservative systems.

    Parameters
    ----------
    equations : Equations
        The system.
    start : State
        Meets the constraints.
    times : ndarray, shape (nt,)
        Given times [s].
    control : Control
        Its stages; the step is the fixed one, or else one step is compared with two of half its
        length at the start, until their gap is within the tolerance.

    Yields
    ------
    Step
        The steps.

    Raises
    ------
    StoppedEarly
        If a step has no solution.
    """
    pair = lobatto_pair(control.stages or STAGES)
    longest = control.step or _pilot(equations, start, float(times[-1]), control, pair)
    state = start
    guess: Stages | None = None
    for begin, end in pairwise(times):
        number = max(1, int(np.ceil((end - begin) / longest * (1.0 - 1e-9))))
        number = int(np.ceil(number * control.refine))
        for i in range(1, number + 1):
            t = float(begin + (end - begin) * (i / number)) if i < number else float(end)
            try:
                inside = solve_stages(equations, state, t - state.t, pair, guess)
                after = equations.at(t, *inside.end)
            except NoConvergence as reason:
                raise StoppedEarly(f"a step has no solution ({reason}): shorten it") from reason
            yield Step(state, after, _between(inside))
            state, guess = after, inside


def _pilot(
    equations: Equations, start: State, end: float, control: Control, pair: LobattoPair
) -> float:
    """Return a step whose gap to two halves is within the tolerance at the start."""
    h = min(40.0 * first_step(start, control, pair.order), end - start.t)
    for _ in range(60):
        try:
            whole = solve_stages(equations, start, h, pair).end
            half = solve_stages(equations, start, 0.5 * h, pair).end
            middle = equations.at(start.t + 0.5 * h, *half)
            twice = solve_stages(equations, middle, 0.5 * h, pair).end
        except NoConvergence:
            h *= 0.5
            continue
        scales = (control.q_scale + np.abs(start.q), control.qd_scale + np.abs(start.qd))
        size = max(
            float(np.max(np.abs(a - b) / scale)) / control.rtol
            for a, b, scale in zip(whole, twice, scales, strict=True)
        )
        if size <= 1.0:
            return h
        h *= max(0.2, min(0.9, 0.9 * size ** (-1.0 / (pair.order + 1))))
    raise bad("rtol", control.rtol, "a tolerance that a step can meet", "raise it, or give step")


def _between(inside: Stages) -> Callable[[float], tuple[Array, Array]]:
    """Return the polynomials through the stages."""

    def between(t: float) -> tuple[Array, Array]:
        weights = _lagrange(inside.pair.c, (t - inside.t[0]) / inside.h)
        return weights @ inside.q, weights @ inside.qd

    return between


def _lagrange(nodes: Array, x: float) -> Array:
    """Return the weights that interpolate from the nodes to x."""
    weights = np.ones(len(nodes))
    for i, node in enumerate(nodes):
        others = np.delete(nodes, i)
        weights[i] = np.prod((x - others) / (node - others))
    return weights


def solve_stages(
    equations: Equations,
    state: State,
    h: float,
    pair: LobattoPair,
    previous: Stages | None = None,
) -> Stages:
    """Return the stages of one step.

    Newton's iteration, with the Jacobian of the whole step where the system has variations, else
    with the forces taken as constant, which converges for short steps.

    Parameters
    ----------
    equations : Equations
        The system.
    state : State
        At the start of the step.
    h : float
        Length [s].
    pair : LobattoPair
        Coefficients.
    previous : Stages, optional
        Those of the step before, to begin from their continuation.

    Raises
    ------
    NoConvergence
        If the iteration does not converge.
    """
    guesses = [_flat(state, pair)]
    if previous is not None and previous.h >= 0.2 * h:
        guesses.insert(0, _continued(previous, h, pair))
    for guess in guesses[:-1]:
        try:
            return _newton(equations, state, h, pair, guess)
        except NoConvergence:
            continue
    return _newton(equations, state, h, pair, guesses[-1])


def _newton(
    equations: Equations, state: State, h: float, pair: LobattoPair, guess: tuple[Array, Array]
) -> Stages:
    s, n, k = len(pair.c), equations.n, equations.k
    twice = pair.first @ pair.second
    t = state.t + h * pair.c
    qdd, lam = guess
    drift = state.q + h * pair.c[:, None] * state.qd
    inverse: Array | None = None
    last = np.inf
    weight, slopes = equations.columns, equations.system.variations
    unit = max(float(np.max(np.abs(state.qdd / weight))), _EPS)
    # Rounding of the positions, over h^2, is all that their constraints say of accelerations.
    noise = _EPS * float(np.max(np.abs(state.q / weight))) / (h * h)
    for _ in range(_MOST):
        q = drift + h * h * (twice @ qdd)
        qd = state.qd + h * (pair.second @ qdd)
        try:
            residual, parts = _residual(equations, t, q, qd, qdd, lam, state.qd, h, pair)
            if inverse is None:
                found = None if slopes is None else slopes(q, qd, qdd, lam, t)
                matrix = stage_matrix(equations, parts, found, h, pair)
                inverse = np.asarray(np.linalg.inv(matrix), dtype=float)
        except np.linalg.LinAlgError as singular:
            raise NoConvergence("the matrix of the stages is singular") from singular
        change = inverse @ residual
        qdd = qdd - change[: s * n].reshape(s, n) * weight
        lam = lam - change[s * n :].reshape(s, k) * equations.rows
        size = float(np.max(np.abs(change[: s * n])))
        unit = max(unit, float(np.max(np.abs(qdd / weight))))
        if not np.isfinite(size) or size > 1e6 * unit:
            break
        small = size <= 1e-9 * unit + 1e3 * noise
        if size <= 4 * _EPS * unit + noise or (small and size >= 0.25 * last):
            q = drift + h * h * (twice @ qdd)
            qd = state.qd + h * (pair.second @ qdd)
            end = q[-1], state.qd + h * (pair.b @ qdd)
            return Stages(t, q, qd, qdd, lam, h, pair, end)
        if size >= 0.1 * last and not small:
            inverse = None
        last = size
    raise NoConvergence("the stages do not converge")


def _flat(state: State, pair: LobattoPair) -> tuple[Array, Array]:
    """Return the accelerations and multipliers of the start for all stages."""
    s = len(pair.c)
    return np.tile(state.qdd, (s, 1)), np.tile(state.multipliers, (s, 1))


def _continued(previous: Stages, h: float, pair: LobattoPair) -> tuple[Array, Array]:
    """Return accelerations and multipliers by the polynomials of the step before."""
    # A beginning need not be exact, and steps of nearly one length share their weights.
    ahead = _ahead(len(pair.c), round(h / previous.h, 6))
    return ahead @ previous.qdd, ahead @ previous.multipliers


@lru_cache(maxsize=64)
def _ahead(stages: int, ratio: float) -> Array:
    """Return the weights that continue stage values over a next step, ``ratio`` times as long."""
    nodes = lobatto_pair(stages).c
    return np.array([_lagrange(nodes, 1.0 + c * ratio) for c in nodes])


def _residual(
    equations: Equations,
    t: Array,
    q: Array,
    qd: Array,
    qdd: Array,
    lam: Array,
    start: Array,
    h: float,
    pair: LobattoPair,
) -> tuple[Array, dict[str, Array]]:
    """Return the scaled defects of motion, positions and last velocities, and the arrays."""
    system, n = equations.system, equations.n
    equations.evaluations += len(t)
    # Far from a solution numbers may overflow; that is found below.
    with np.errstate(over="ignore", invalid="ignore"):
        a = dict(system.dynamics(q, qd, t))
        phi = system.violation(q, t)["constraints"][..., 0]
        jacobian = a["jacobian"]
        forces = (a["forces"] - a["rest"])[..., 0]
        motion = (a["mass"] @ qdd[..., None])[..., 0] - forces
        motion -= (np.swapaxes(jacobian, -1, -2) @ lam[..., None])[..., 0]
        velocity = start + h * (pair.b @ qdd)
        rate = jacobian[-1] @ velocity - a["velocity_rhs"][-1, :, 0]
        held = np.concatenate([phi[1:] / (h * h), rate[None] / h])
        scaled = (motion * equations.columns).ravel(), (held * equations.rows).ravel()
    if not np.isfinite(scaled[0]).all() or not np.isfinite(scaled[1]).all():
        raise NoConvergence(f"the equations of {n} coordinates are not finite")
    return np.concatenate(scaled), a


def stage_matrix(
    equations: Equations,
    a: Mapping[str, Array],
    variations: Mapping[str, Array] | None,
    h: float,
    pair: LobattoPair,
) -> Array:
    """Return the Jacobian of a step's residual by its accelerations and multipliers, scaled.

    The change of the last Jacobian with the positions is left out here, as Newton's iteration
    does without it.

    Parameters
    ----------
    equations : Equations
        Gives the scaling.
    a : mapping
        Arrays of the dynamics at the stages.
    variations : mapping or None
        Damping and stiffness at the stages.
    h : float
        Length of the step [s].
    pair : LobattoPair
        Coefficients.

    Returns
    -------
    ndarray, shape (s (n + k), s (n + k))
        Motion at the stages, then positions at all stages but the first and velocities at the
        end; accelerations of the stages, then multipliers.
    """
    s, n, k = len(pair.c), equations.n, equations.k
    unit = equations.columns[:, None] * equations.columns
    jacobian = a["jacobian"] * equations.rows[:, None] * equations.columns
    matrix = np.zeros((s * (n + k), s * (n + k)))
    blocks = np.zeros((s, n, s, n))
    every = np.arange(s)
    twice = pair.first @ pair.second
    if variations is not None:
        blocks += h * pair.second[:, None, :, None] * (variations["damping"] * unit)[:, :, None]
        blocks += h * h * twice[:, None, :, None] * (variations["stiffness"] * unit)[:, :, None]
    blocks[every, :, every, :] += a["mass"] * unit
    matrix[: s * n, : s * n] = blocks.reshape(s * n, s * n)
    side = np.zeros((s, n, s, k))
    side[every, :, every, :] = -np.swapaxes(jacobian, -1, -2)
    matrix[: s * n, s * n :] = side.reshape(s * n, s * k)
    below = np.empty((s, k, s, n))
    below[:-1] = twice[1:, None, :, None] * jacobian[1:, :, None, :]
    below[-1] = pair.b[None, :, None] * jacobian[-1][:, None, :]
    matrix[s * n :, : s * n] = below.reshape(s * k, s * n)
    return matrix
