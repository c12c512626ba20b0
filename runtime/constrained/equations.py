"""The equations of a constrained system in scaled coordinates, at one state or at many."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.families import Constrained
from ..core.families.multipliers import kkt_matrix, scaling

Array = NDArray[np.float64]

EPS = float(np.finfo(float).eps)
# Part of the largest scaled coordinate below which the tolerance of one is absolute.
SMALL = 0.01
# Newton squares the defect: a correction of this relative size leaves none ...
_LAST = 1e-9


LEVELS = ("position", "velocity", "acceleration")


class NoConvergence(ArithmeticError):  # noqa: N818 - reads as what it is
    """The equations have no solution near a state, or one that is not finite."""


@dataclass(frozen=True)
class State:
    """A state that meets the constraints at all three levels, scaled."""

    t: float  # time [s]
    # x, v, a: (n,): coordinates and their time derivatives
    x: Array
    v: Array
    a: Array


@dataclass(frozen=True)
class Linearised:
    """Accelerations at states, and how they vary: ``da = by_x dx + by_v dv``; scaled.

    The constraints hold at acceleration level for every neighbour, whether or not it meets them at
    the levels below.
    """

    a: Array  # (*batch, n): accelerations
    multipliers: Array  # (*batch, k): multipliers
    # by_x, by_v: (*batch, n, n): derivatives of the accelerations by coordinates and
    # velocities
    by_x: Array
    by_v: Array
    # terms, variations: arrays of the dynamics and of their variation, not scaled; the latter empty
    # where the system has none
    terms: Mapping[str, Array]
    variations: Mapping[str, Array]


class Equations:
    """A constrained system in coordinates of unit inertia, with constraint rows of unit length.

    The coordinates are ``q = columns x`` and the constraints ``rows Phi``, by powers of two, so
    that scaling is exact and one matrix of entries near 1 serves accelerations and projections.
    Masses and rows are measured at the given states, at their largest; ``evaluations`` counts the
    states at which the dynamics were evaluated.
    """

    def __init__(self, system: Constrained, q: Array, qd: Array, t: float | Array) -> None:
        self.system, self.n, self.k = system, system.size, system.constraints
        at = system.dynamics(q, qd, t)
        columns, rows = scaling(at["mass"], at["jacobian"])
        lead = tuple(range(columns.ndim - 1))
        self.columns: Array = np.min(columns, axis=lead)
        self.rows: Array = np.min(rows, axis=lead)
        self._scale = np.concatenate([self.columns, self.rows])
        self._outer = self._scale[:, None] * self._scale
        self.evaluations = 0

    def terms(self, t: float | Array, x: Array, v: Array) -> Mapping[str, Array]:
        """Return the arrays of the dynamics, not scaled."""
        self.evaluations += x.size // self.n
        return self.system.dynamics(x * self.columns, v * self.columns, t)

    def accelerations(self, t: float | Array, x: Array, v: Array) -> tuple[Array, Array]:
        """Return accelerations and multipliers."""
        return self._accelerations(self.terms(t, x, v))[1:]

    def _accelerations(self, at: Mapping[str, Array]) -> tuple[Array, Array, Array]:
        """Return the scaled matrix, accelerations and multipliers."""
        matrix = self._outer * kkt_matrix(at["mass"], at["jacobian"])
        right = np.concatenate([at["forces"] - at["rest"], at["gamma"]], axis=-2)
        both = solved(matrix, self._scale[:, None] * right)[..., 0]
        return matrix, both[..., : self.n], both[..., self.n :]

    def linearised(self, t: Array, x: Array, v: Array) -> Linearised:
        """Return accelerations and their derivatives by the state.

        With ``J = Phi_q`` the variation of a motion obeys, as emitted from the Lagrangian::

            M dqdd + D dqd + K dq = J^T dlam,      J dqdd + 2 Jd dqd + Jdd dq = 0.

        Where the system has no variational equations, differences stand for them.
        """
        n, columns, rows = self.n, self.columns, self.rows
        at = self.terms(t, x, v)
        matrix, a, multipliers = self._accelerations(at)
        varied: Mapping[str, Array] = {}
        if self.system.variations is None:
            right = self._differences(t, x, v, at, (a, multipliers))
        else:
            right = np.empty((*matrix.shape[:-1], 2 * n))
            states = (x * columns, v * columns, a * columns, multipliers * rows)
            varied = self.system.variations(*states, t)
            right[..., :n, :n] = varied["stiffness"]
            right[..., :n, n:] = varied["damping"]
            right[..., n:, :n] = varied["jacobian_acceleration"]
            right[..., n:, n:] = 2.0 * varied["jacobian_rate"]
            right *= self._scale[:, None] * np.concatenate([columns, columns])
        slopes = -solved(matrix, right)
        return Linearised(a, multipliers, slopes[..., :n, :n], slopes[..., :n, n:], at, varied)

    def _differences(
        self, t: Array, x: Array, v: Array, at: Mapping[str, Array], held: tuple[Array, Array]
    ) -> Array:
        """Return how the equations vary with accelerations and multipliers held."""
        n = self.n
        wide = float(np.max(np.abs(x), initial=0.0)) or 1.0
        fast = float(np.max(np.abs(v), initial=0.0)) or wide
        # Relative differences of the equations where their derivatives were not emitted: about the
        # square root of the rounding, where rounding and second derivatives do equal harm.
        steps = 2.0**-20 * np.exp2(np.round(np.log2([wide, fast])))
        lead = (2 * n, *(1,) * (x.ndim - 1), n)
        change = np.eye(2 * n)
        places = x + steps[0] * change[:, :n].reshape(lead)
        speeds = v + steps[1] * change[:, n:].reshape(lead)
        away = self.terms(np.broadcast_to(t, places.shape[:-1]), places, speeds)
        defect = self._defect(away, *held) - self._defect(at, *held)
        return np.asarray(np.moveaxis(defect, 0, -1) / np.repeat(steps, n))

    def _defect(self, at: Mapping[str, Array], a: Array, multipliers: Array) -> Array:
        """Return what accelerations and multipliers leave of the equations, scaled."""
        qdd, force = (a * self.columns)[..., None], (multipliers * self.rows)[..., None]
        jacobian = at["jacobian"]
        motion = at["mass"] @ qdd + at["rest"] - at["forces"]
        motion = motion - np.swapaxes(jacobian, -1, -2) @ force
        held = jacobian @ qdd - at["gamma"]
        defect: Array = self._scale * np.concatenate([motion, held], axis=-2)[..., 0]
        return defect

    def nearest(self, t: float | Array, x: Array, v: Array) -> tuple[Array, Array]:
        """Return coordinates and velocities on the constraints, nearest by the masses."""
        if not self.k:
            return x, v
        x, _ = self.positions(t, x, self.terms(t, x, v)["mass"])
        return x, v + self.velocity_change(self.terms(t, x, v), v)

    def positions(
        self, t: float | Array, x: Array, mass: Array, free: Array | None = None
    ) -> tuple[Array, int]:
        """Return the nearest positions on the constraints, and the number of corrections.

        Newton's iteration in the metric of the masses (not scaled), damped where a correction would
        raise the defect.  ``free (n,)`` is 1 for coordinates that may move, 0 for those held.
        """
        at = self.system.violation(x * self.columns, t)
        last = np.inf
        # Newton corrections of positions, and halvings of one that would raise the defect.
        for count in range(60):
            change = self._least_change(mass, at["jacobian"], -at["constraints"][..., 0], free)
            size = np.max(np.abs(change), axis=-1)
            small = size / (np.max(np.abs(x + change), axis=-1) + EPS)
            # A correction below 1e-12 that no longer falls is round-off.
            if np.all((small <= _LAST) | ((small <= 1e-12) & (size >= 0.5 * last))):
                return x + change, count + 1
            x, at = self._damped(t, x, change, at)
            last = size
        raise NoConvergence("the positions do not reach the constraints")

    def velocity_change(
        self, at: Mapping[str, Array], v: Array, free: Array | None = None
    ) -> Array:
        """Return the least change of velocities that meets the constraints' rates."""
        defect = at["velocity_rhs"] - at["jacobian"] @ (v * self.columns)[..., None]
        return self._least_change(at["mass"], at["jacobian"], defect[..., 0], free)

    def _damped(
        self, t: float | Array, x: Array, change: Array, at: Mapping[str, Array]
    ) -> tuple[Array, Mapping[str, Array]]:
        """Return positions after a correction, halved where it would raise the defect."""
        before = np.max(np.abs(self.rows * at["constraints"][..., 0]), axis=-1)
        factor = np.ones(np.shape(before))
        for _ in range(12):
            trial = x + factor[..., None] * change
            at = self.system.violation(trial * self.columns, t)
            after = np.max(np.abs(self.rows * at["constraints"][..., 0]), axis=-1)
            worse = (after > before) & (after > _LAST)
            if not np.any(worse):
                break
            factor = np.where(worse, 0.5 * factor, factor)
        return trial, at

    def _least_change(
        self, mass: Array, jacobian: Array, defect: Array, free: Array | None
    ) -> Array:
        """Return the least change, by the masses, whose product with the Jacobian is the defect."""
        n, matrix = self.n, kkt_matrix(mass, jacobian)
        if free is not None:
            matrix[..., :n] *= free
            matrix[..., :n, :] *= free[:, None]
            each = np.arange(n)
            matrix[..., each, each] += (1.0 - free) / self.columns**2
        right = np.zeros((*defect.shape[:-1], n + self.k, 1))
        right[..., n:, 0] = self.rows * defect
        return solved(self._outer * matrix, right)[..., :n, 0]

    def state(self, t: float, x: Array, v: Array) -> State:
        """Return the state on the constraints nearest to a predicted one."""
        return self.at(t, *self.nearest(t, x, v))

    def at(self, t: float, x: Array, v: Array) -> State:
        """Return the state of coordinates and velocities that meet the constraints."""
        return State(t, x, v, self.accelerations(t, x, v)[0])


def solved(matrix: Array, right: Array) -> Array:
    """Return the solution of linear equations."""
    try:
        solution = np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError as singular:
        raise NoConvergence("the constraints' Jacobian lost its rank") from singular
    if not np.isfinite(solution).all():
        raise NoConvergence("the equations of motion are not finite")
    return np.asarray(solution, dtype=np.float64)


def constraint_norms(
    system: Constrained, t: Array, q: Array, qd: Array, qdd: Array
) -> dict[str, Any]:
    """Return the largest scaled defects of the constraints by level, ``(nt,)`` each.

    ``position_norm``, ``velocity_norm`` and ``acceleration_norm``, as results have them.

    A row of ``Phi``, ``Phi_q qd - rhs`` and ``Phi_q qdd - gamma`` is divided by the length of the
    row of ``Phi_q S`` (S measures the coordinates by their inertia) and by the size of the scaled
    coordinates, velocities and accelerations over the motion: 1e-16 is round-off whatever the
    units.
    """
    at = system.dynamics(q, qd, t)
    jacobian = at["jacobian"]
    columns, rows = scaling(at["mass"], jacobian)
    defects = (
        system.violation(q, t)["constraints"],
        jacobian @ qd[..., None] - at["velocity_rhs"],
        jacobian @ qdd[..., None] - at["gamma"],
    )
    place, speed, push = (
        float(np.max(np.abs(vector / columns), initial=0.0)) for vector in (q, qd, qdd)
    )
    # What cancels in the accelerations is of the size of the centripetal ones.
    sizes = (place, speed, max(push, speed * (speed / place if place > 0 else 0.0)))
    return {
        f"{level}_norm": np.max(np.abs(rows * defect[..., 0]), axis=-1, initial=0.0) / (size or 1.0)
        for level, defect, size in zip(LEVELS, defects, sizes, strict=True)
    }
