"""What an integrator asks of a constrained system at one state, in scaled variables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.families import Constrained
from ..core.families.multipliers import kkt_matrix, scaling

Array = NDArray[np.float64]

# Newton iterations on the constraints before a state counts as out of reach.
_MOST = 25
_EPS = float(np.finfo(float).eps)


class NoConvergence(ArithmeticError):  # noqa: N818 - reads as what it is
    """A stage has no solution near its predictor, or one that is not finite."""


@dataclass(frozen=True)
class State:
    """A state that meets the constraints at all three levels.

    Attributes
    ----------
    t : float
        Time [s].
    q, qd, qdd : ndarray, shape (n,)
        Coordinates and their time derivatives.
    multipliers : ndarray, shape (k,)
        Multipliers.
    """

    t: float
    q: Array
    qd: Array
    qdd: Array
    multipliers: Array


class Equations:
    """A constrained system with one scaling for a whole motion.

    Coordinates are measured by their inertia and constraint rows by their length, in powers of
    two, so that one small matrix of entries near 1 serves accelerations and projections.

    Parameters
    ----------
    system : Constrained
        The system; its parameters are single numbers.
    q, qd : ndarray, shape (n,)
        Where the scaling is taken.
    t : float
        Time there [s].
    """

    def __init__(self, system: Constrained, q: Array, qd: Array, t: float) -> None:
        self.system = system
        self.n, self.k = system.size, system.constraints
        a = system.dynamics(q, qd, t)
        self.columns, self.rows = scaling(a["mass"], a["jacobian"])
        self.scale = np.concatenate([self.columns, self.rows])
        self.outer = self.scale[:, None] * self.scale
        self.evaluations = 0

    def terms(self, t: float, q: Array, qd: Array) -> Mapping[str, Array]:
        """Return the arrays of the dynamics at a state."""
        self.evaluations += 1
        return self.system.dynamics(q, qd, t)

    def matrix(self, a: Mapping[str, Array]) -> Array:
        """Return the scaled matrix of accelerations and multipliers."""
        n = self.n
        jacobian = a["jacobian"]
        matrix = np.zeros((n + self.k, n + self.k))
        matrix[:n, :n] = a["mass"]
        matrix[:n, n:] = -jacobian.T
        matrix[n:, :n] = jacobian
        matrix *= self.outer
        return matrix

    def solve(self, matrix: Array, right: Array) -> Array:
        """Solve with a scaled matrix.

        Raises
        ------
        NoConvergence
            If the matrix is singular or the answer not finite.
        """
        try:
            found: Array = self.scale * np.linalg.solve(matrix, self.scale * right)
        except np.linalg.LinAlgError as singular:
            raise NoConvergence("the constraints' Jacobian lost its rank") from singular
        if not np.isfinite(found).all():
            raise NoConvergence("the accelerations are not finite")
        return found

    def acceleration(self, t: float, q: Array, qd: Array) -> tuple[Array, Array]:
        """Return accelerations and multipliers at a state.

        Raises
        ------
        NoConvergence
            If they do not exist.
        """
        a = self.terms(t, q, qd)
        right = np.concatenate([a["forces"][:, 0] - a["rest"][:, 0], a["gamma"][:, 0]])
        found = self.solve(self.matrix(a), right)
        return found[: self.n], found[self.n :]

    def accelerations(self, t: Array, q: Array, qd: Array) -> tuple[Array, Array]:
        """Return accelerations ``(s, n)`` and multipliers ``(s, k)`` at several states at once.

        Raises
        ------
        NoConvergence
            If they do not exist.
        """
        self.evaluations += len(t)
        a = self.system.dynamics(q, qd, t)
        matrix = self.outer * kkt_matrix(a["mass"], a["jacobian"])
        right = np.concatenate([a["forces"] - a["rest"], a["gamma"]], axis=-2)[..., 0]
        try:
            found = np.linalg.solve(matrix, (self.scale * right)[..., None])[..., 0]
        except np.linalg.LinAlgError as singular:
            raise NoConvergence("the constraints' Jacobian lost its rank") from singular
        if not np.isfinite(found).all():
            raise NoConvergence("the accelerations are not finite")
        found *= self.scale
        return found[:, : self.n], found[:, self.n :]

    def positions(self, t: float, q: Array, mass: Array) -> Array:
        """Return the positions nearest to ``q``, in the metric of ``mass``, on the constraints.

        Newton's iteration ends where its correction no longer falls and is of round-off size.

        Raises
        ------
        NoConvergence
            If it does not get there.
        """
        if not self.k:
            return q
        right = np.zeros(self.n + self.k)
        last = np.inf
        for _ in range(_MOST):
            a = self.system.violation(q, t)
            right[self.n :] = -a["constraints"][:, 0]
            matrix = self.matrix({"mass": mass, "jacobian": a["jacobian"]})
            change = self.solve(matrix, right)[: self.n]
            q = q + change
            size = float(np.max(np.abs(change / self.columns)))
            scale = float(np.max(np.abs(q / self.columns))) + _EPS
            # Newton squares the defect: a correction of this size leaves none.
            if size <= 1e-9 * scale or (size >= 0.5 * last and size <= 1e-12 * scale):
                return q
            if not size < 2.0 * last:
                break
            last = size
        raise NoConvergence("the positions do not reach the constraints")

    def nearest(self, t: float, q: Array, qd: Array) -> tuple[Array, Array]:
        """Return the coordinates and velocities nearest to predicted ones, by the masses.

        Raises
        ------
        NoConvergence
            If the constraints are out of reach.
        """
        if not self.k:
            return q, qd
        predicted = self.terms(t, q, qd)
        q = self.positions(t, q, predicted["mass"])
        a = self.terms(t, q, qd)
        matrix = self.matrix(a)
        right = np.zeros(self.n + self.k)
        right[self.n :] = a["velocity_rhs"][:, 0] - a["jacobian"] @ qd
        return q, qd + self.solve(matrix, right)[: self.n]

    def state(self, t: float, q: Array, qd: Array) -> State:
        """Return the state nearest to a predicted one, in the metric of the masses.

        Raises
        ------
        NoConvergence
            If the constraints are out of reach.
        """
        return self.at(t, *self.nearest(t, q, qd))

    def at(self, t: float, q: Array, qd: Array) -> State:
        """Return the state of positions and velocities that meet the constraints."""
        qdd, multipliers = self.acceleration(t, q, qd)
        return State(t, q, qd, qdd, multipliers)
