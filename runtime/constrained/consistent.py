"""Initial values that meet the constraints: positions, velocities, accelerations, multipliers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import Problem, RedundantConstraints, bad
from ..core.families import Constrained
from ..core.families.multipliers import check_rank, kkt_matrix, scaling
from ..core.results import Check, Result, provenance
from .equations import Array
from .norms import constraint_norms

_MOST = 60
_EPS = float(np.finfo(float).eps)
# Constraints count as met where their scaled defect is of this size.
MET = 1e-12


@dataclass(frozen=True, kw_only=True)
class ConsistentState(Result):
    """A state that meets the constraints at all three levels.

    Attributes
    ----------
    q, qd, qdd : ndarray, shape (*batch, n)
        Coordinates, velocities and accelerations.
    multipliers : ndarray, shape (*batch, k)
        Multipliers.
    t : ndarray, shape batch
        Time [s].
    moved : ndarray, shape (*batch, n)
        How far the positions were moved.
    position_norm, velocity_norm, acceleration_norm : ndarray, shape batch
        Scaled defects of the constraints (see :func:`.norms.constraint_norms`).
    iterations : int
        Newton iterations.
    labels : tuple of str
        Names of the coordinates.
    """

    q: Array
    qd: Array
    qdd: Array
    multipliers: Array
    t: Array
    moved: Array
    position_norm: Array
    velocity_norm: Array
    acceleration_norm: Array
    iterations: int
    labels: tuple[str, ...]


def consistent_state(
    system: Constrained,
    q: ArrayLike,
    qd: ArrayLike,
    t: ArrayLike = 0.0,
    *,
    hold: Iterable[str | int] = (),
) -> ConsistentState:
    """Return the nearest state that meets the constraints.

    Positions: Newton's iteration on ``Phi(q, t) = 0``, each correction the smallest in the metric
    of the masses, damped where a full one does not lower the defect.  Velocities: the smallest
    change with ``Phi_q qd = velocity_rhs``.  Accelerations and multipliers: the equations of
    motion with ``Phi_q qdd = gamma``.

    Parameters
    ----------
    system : Constrained
        The system.
    q, qd : array_like, shape (*batch, n)
        Coordinates and velocities near which to look; they broadcast.
    t : array_like, shape batch
        Time [s].
    hold : iterable of str or int
        Coordinates, by label or place, that keep their given position and velocity.

    Returns
    -------
    ConsistentState
        Its ``error`` is the largest scaled defect that is left.

    Raises
    ------
    BadInput
        If an input is not finite or of the wrong shape, a held coordinate is unknown, too many are
        held, or the iteration does not converge: no state near the given one meets the
        constraints.
    RedundantConstraints
        If the constraints repeat or contradict each other there.
    """
    q0, qd0, time = _given(system, q, qd, t)
    held = _held(system, hold)
    found, count = _positions(system, q0, time, held)
    a = system.dynamics(found, qd0, time)
    columns, rows = scaling(a["mass"], a["jacobian"])
    check_rank(_free(a["jacobian"], held), columns, rows)
    defect = a["velocity_rhs"][..., 0] - (a["jacobian"] @ qd0[..., None])[..., 0]
    rates = qd0 + _least_change(a["mass"], a["jacobian"], defect, columns, rows, held)
    qdd, multipliers = system.accelerations(found, rates, time)
    norms = _norms(system, time, found, rates, qdd)
    worst = max(float(np.max(norm, initial=0.0)) for norm in norms)
    return ConsistentState(
        method="Newton's iteration, smallest change in the metric of the masses",
        error=worst,
        error_norm="largest scaled defect of a constraint, at position, velocity or acceleration",
        checks={"constraints": Check(worst, MET)},
        provenance=provenance(system.provenance),
        q=found,
        qd=rates,
        qdd=qdd,
        multipliers=multipliers,
        t=time,
        moved=found - q0,
        position_norm=norms[0],
        velocity_norm=norms[1],
        acceleration_norm=norms[2],
        iterations=count,
        labels=system.labels,
    )


def _given(
    system: Constrained, q: ArrayLike, qd: ArrayLike, t: ArrayLike
) -> tuple[Array, Array, Array]:
    """Return checked positions, velocities and times of one batch."""
    arrays = {}
    for name, value in (("q", q), ("qd", qd), ("t", t)):
        try:
            arrays[name] = np.asarray(value, dtype=float)
        except (TypeError, ValueError) as wrong:
            raise bad(name, repr(value), "numbers", "correct it") from wrong
        if not np.isfinite(arrays[name]).all():
            raise bad(name, "a number that is not finite", "finite numbers", "correct it")
    n = system.size
    for name in ("q", "qd"):
        if arrays[name].ndim == 0 or arrays[name].shape[-1] != n:
            fix = f"one for each of {', '.join(system.labels) or n}"
            raise bad(name, f"shape {arrays[name].shape}", f"shape (..., {n})", fix)
    try:
        batch = np.broadcast_shapes(
            arrays["q"].shape[:-1], arrays["qd"].shape[:-1], arrays["t"].shape
        )
    except ValueError as wrong:
        shapes = [arrays[name].shape for name in arrays]
        raise bad(
            "q, qd, t", f"shapes {shapes}", "shapes that broadcast", "correct them"
        ) from wrong
    return (
        np.broadcast_to(arrays["q"], (*batch, n)).copy(),
        np.broadcast_to(arrays["qd"], (*batch, n)).copy(),
        np.broadcast_to(arrays["t"], batch).copy(),
    )


def _held(system: Constrained, hold: Iterable[str | int]) -> Array:
    """Return 1.0 for the coordinates that may move and 0.0 for those that are held."""
    free = np.ones(system.size)
    for item in hold:
        place = system.labels.index(item) if item in system.labels else item
        if isinstance(place, str) or not 0 <= place < system.size:
            known = f"one of {list(system.labels)} or its place"
            raise bad("hold", repr(item), known, "correct the name")
        free[place] = 0.0
    number, most = system.size - int(free.sum()), max(system.size - system.constraints, 0)
    if number > most:
        found = f"{number} coordinates"
        raise bad("hold", found, f"at most {most}, the degrees of freedom", "hold fewer")
    return free


def _free(jacobian: Array, held: Array) -> Array:
    return jacobian * held


def _least_change(
    mass: Array, jacobian: Array, defect: Array, columns: Array, rows: Array, held: Array
) -> Array:
    """Return the smallest change of the free coordinates with ``jacobian @ change = defect``."""
    n, k = mass.shape[-1], jacobian.shape[-2]
    if k == 0:
        return np.zeros(mass.shape[:-1])
    metric = mass * held * held[:, None]
    diagonal = np.arange(n)
    metric[..., diagonal, diagonal] += (1.0 - held) / columns**2
    scale = np.concatenate([columns, rows], axis=-1)
    matrix = scale[..., :, None] * kkt_matrix(metric, _free(jacobian, held)) * scale[..., None, :]
    right = scale * np.concatenate([np.zeros_like(columns), defect], axis=-1)
    try:
        solved = np.linalg.solve(matrix, right[..., None])[..., 0] * scale
    except np.linalg.LinAlgError:
        return np.full(mass.shape[:-1], np.nan)
    change: Array = solved[..., :n]
    return change


def _positions(system: Constrained, q: Array, t: Array, held: Array) -> tuple[Array, int]:
    """Return positions on the constraints and the number of iterations."""
    if not system.constraints:
        return q, 0
    mass = system.dynamics(q, np.zeros_like(q), t)["mass"]
    a = system.violation(q, t)
    if not all(np.isfinite(value).all() for value in (mass, *a.values())):
        raise bad("q", "constraints that are not finite", "a state that they allow", "correct it")
    columns, rows = scaling(mass, a["jacobian"])
    check_rank(a["jacobian"], columns, rows)
    _check_rows(system, q, t, columns, a["jacobian"])
    floor = 4 * _EPS * np.sqrt(system.size)
    previous = np.full(t.shape, np.inf)
    for count in range(1, _MOST + 1):
        change = _least_change(mass, a["jacobian"], -a["constraints"][..., 0], columns, rows, held)
        size = np.max(np.abs(change / columns), axis=-1)
        scale = np.max(np.abs(q / columns), axis=-1) + np.max(np.abs(change / columns), axis=-1)
        if not np.isfinite(change).all():
            break
        if np.all((size <= floor * scale) | ((size <= 1e-10 * scale) & (size >= 0.5 * previous))):
            return q, count
        q, a = _damped(system, q, t, change, a, rows)
        previous = size
        if not all(np.isfinite(value).all() for value in a.values()):
            break
        columns, rows = scaling(mass, a["jacobian"])
    check_rank(_free(a["jacobian"], held), columns, rows)
    raise bad(
        "q",
        "no state nearby that meets the constraints",
        "a position that the linkage can take",
        "start nearer to one, hold other coordinates, or check the dimensions",
    )


def _check_rows(system: Constrained, q: Array, t: Array, columns: Array, jacobian: Array) -> None:
    """Refuse a row of the Jacobian that vanishes, against its size a little aside."""
    place = np.max(np.abs(q / columns), axis=-1, keepdims=True)
    # Incommensurate parts of a thousandth, so that no symmetry can hide the row.
    parts = 1e-3 * np.cos(1.0 + np.sqrt(2.0) * np.arange(system.size))
    aside = q + np.where(place > 0, place, 1.0) * columns * parts
    here = np.linalg.norm(jacobian * columns[..., None, :], axis=-1)
    there = system.violation(aside, t)["jacobian"] * columns[..., None, :]
    if np.any(here <= 1e-9 * np.linalg.norm(there, axis=-1)):
        raise RedundantConstraints(
            Problem(
                "constraints",
                "one without a direction",
                "rows of the Jacobian that do not vanish",
                "leave the position where the linkage can branch",
            )
        )


def _damped(
    system: Constrained, q: Array, t: Array, change: Array, a: object, rows: Array
) -> tuple[Array, dict[str, Array]]:
    """Return positions after a correction, halved where it would raise the defect."""
    before = np.max(np.abs(rows * np.asarray(a["constraints"])[..., 0]), axis=-1)  # type: ignore[index]
    factor = np.ones(t.shape)
    for _ in range(12):
        trial = q + factor[..., None] * change
        found = dict(system.violation(trial, t))
        after = np.max(np.abs(rows * found["constraints"][..., 0]), axis=-1)
        worse = (after > before) & (after > 1e-9)
        if not worse.any():
            break
        factor = np.where(worse, 0.5 * factor, factor)
    return trial, found


def _norms(
    system: Constrained, t: Array, q: Array, qd: Array, qdd: Array
) -> tuple[Array, Array, Array]:
    n = system.size
    flat = [array.reshape(-1, n) for array in (q, qd, qdd)]
    parts = constraint_norms(system, t.reshape(-1), *flat)
    return tuple(part.reshape(t.shape) for part in parts)  # type: ignore[return-value]
