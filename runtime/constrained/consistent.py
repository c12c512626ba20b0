"""Initial values that meet the constraints: positions, velocities, accelerations, multipliers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import Problem, RedundantConstraints, bad
from ..core.families import Constrained
from ..core.families.multipliers import check_rank, scaling
from ..core.inputs import numbers, require_kind
from ..core.results import Check, Result, provenance
from .equations import Array, Equations, NoConvergence, constraint_norms


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
        Scaled defects of the constraints (see :func:`.equations.constraint_norms`).
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
    require_kind("system", system, Constrained, "take the .system() of a scene with constraints")
    q0, qd0, time = _given(system, q, qd, t)
    free = _free(system, hold)
    place, speed, count = q0, qd0, 0
    if system.constraints:
        mass = _checked_mass(system, q0, time)
        equations = Equations(system, q0, np.zeros_like(q0), time)
        columns = equations.columns
        try:
            x, count = equations.positions(time, q0 / columns, mass, free)
        except NoConvergence as reason:
            raise bad(
                "q",
                "no state nearby that meets the constraints",
                "a position that the linkage can take",
                "start nearer to one, hold other coordinates, or check the dimensions",
            ) from reason
        place = x * columns
        at = system.dynamics(place, qd0, time)
        check_rank(at["jacobian"] * free, *scaling(at["mass"], at["jacobian"]))
        speed = qd0 + columns * equations.velocity_change(at, qd0 / columns, free)
    qdd, multipliers = system.accelerations(place, speed, time)
    flat = [values.reshape(-1, system.size) for values in (place, speed, qdd)]
    made = constraint_norms(system, time.reshape(-1), *flat)
    norms: dict[str, Any] = {name: norm.reshape(time.shape) for name, norm in made.items()}
    worst = max(float(np.max(norm, initial=0.0)) for norm in norms.values())
    # Constraints count as met where their scaled defect is of this size.
    return ConsistentState(
        method="Newton's iteration, smallest change in the metric of the masses",
        error=worst,
        error_norm="largest scaled defect of a constraint, at position, velocity or acceleration",
        checks={"constraints": Check(worst, 1e-12)},
        provenance=provenance(system.provenance),
        q=place,
        qd=speed,
        qdd=qdd,
        multipliers=multipliers,
        t=time,
        moved=place - q0,
        iterations=count,
        labels=system.labels,
        **norms,
    )


def _given(
    system: Constrained, q: ArrayLike, qd: ArrayLike, t: ArrayLike
) -> tuple[Array, Array, Array]:
    """Return checked positions, velocities and times of one batch."""
    arrays = {name: numbers(name, value) for name, value in (("q", q), ("qd", qd), ("t", t))}
    n = system.size
    for name, array in arrays.items():
        if not np.isfinite(array).all():
            raise bad(name, "a number that is not finite", "finite numbers", "correct it")
        if name != "t" and array.shape[-1:] != (n,):
            fix = f"one for each of {', '.join(system.labels)}"
            raise bad(name, f"shape {array.shape}", f"shape (..., {n})", fix)
    shapes = [arrays["q"].shape[:-1], arrays["qd"].shape[:-1], arrays["t"].shape]
    try:
        batch = np.broadcast_shapes(*shapes)
    except ValueError as wrong:
        raise bad(
            "q, qd, t", f"shapes {shapes}", "shapes that broadcast", "correct them"
        ) from wrong
    places, speeds = (np.broadcast_to(arrays[name], (*batch, n)).copy() for name in ("q", "qd"))
    return places, speeds, np.broadcast_to(arrays["t"], batch).copy()


def _free(system: Constrained, hold: Iterable[str | int]) -> Array:
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
        raise bad(
            "hold",
            f"{number} coordinates",
            f"at most {most}, the degrees of freedom",
            "hold fewer",
        )
    return free


def _checked_mass(system: Constrained, q: Array, t: Array) -> Array:
    """Return the masses; refuse constraints that depend on each other or have no direction."""
    mass = system.dynamics(q, np.zeros_like(q), t)["mass"]
    at = system.violation(q, t)
    if not all(np.isfinite(value).all() for value in (mass, *at.values())):
        raise bad("q", "constraints that are not finite", "a state that they allow", "correct it")
    columns, rows = scaling(mass, at["jacobian"])
    check_rank(at["jacobian"], columns, rows)
    # A vanishing row is short against its size a little aside, by incommensurate parts, so that no
    # symmetry can hide it.
    place = np.max(np.abs(q / columns), axis=-1, keepdims=True)
    # A row of the Jacobian vanishes where it is this much shorter than a little aside.
    parts = 1e-3 * np.cos(1.0 + np.sqrt(2.0) * np.arange(system.size))
    aside = q + np.where(place > 0, place, 1.0) * columns * parts
    here, there = (
        np.linalg.norm(jacobian * columns[..., None, :], axis=-1)
        for jacobian in (at["jacobian"], system.violation(aside, t)["jacobian"])
    )
    if np.any(here <= 1e-9 * there):
        raise RedundantConstraints(
            Problem(
                "constraints",
                "one without a direction",
                "rows of the Jacobian that do not vanish",
                "leave the position where the linkage can branch",
            )
        )
    return mass
