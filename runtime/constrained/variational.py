"""Linearisation of the index-reduced constrained equations, and the manifold's tangent space."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import Constrained
from ..core.families.multipliers import kkt_matrix

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_MOST_PROJECTIONS = 12


@dataclass(frozen=True)
class Linearised:
    """Accelerations at states and how they vary: ``dqdd = by_q dq + by_qd dqd``.

    The variation is that of the index-reduced equations: the constraints hold at acceleration
    level for every neighbour, whether or not it meets them at the levels below.

    Attributes
    ----------
    qdd, lam : ndarray, shape (*batch, n), (*batch, k)
        Accelerations and multipliers.
    by_q, by_qd : ndarray, shape (*batch, n, n)
        Derivatives of the accelerations.
    jacobian, jacobian_rate : ndarray, shape (*batch, k, n)
        Jacobian of the constraints and its rate along the motion.
    mass, damping : ndarray, shape (*batch, n, n)
        Mass matrix, and the derivative of the equations by the velocities.
    velocity_defect, acceleration_defect : ndarray, shape (*batch, k)
        ``Phi_q qd + Phi_t``, and what is left of the constraints at acceleration level.
    forced : bool
        True where generalised forces outside the Lagrangian act somewhere.
    """

    qdd: Array
    lam: Array
    by_q: Array
    by_qd: Array
    jacobian: Array
    jacobian_rate: Array
    mass: Array
    damping: Array
    velocity_defect: Array
    acceleration_defect: Array
    forced: bool


def linearised(system: Constrained, q: Array, qd: Array, t: Array) -> Linearised:
    """Solve for accelerations and multipliers, and for their derivatives by the state.

    With J = Phi_q, the variation of a motion obeys (emitted from the same Lagrangian)::

        M dqdd + D dqd + K dq = J^T dlam,      J dqdd + 2 Jd dqd + Jdd dq = 0.

    Parameters
    ----------
    system : Constrained
        With variations.
    q, qd : ndarray, shape (*batch, n)
        States.
    t : ndarray, shape batch
        Times [s].
    """
    n, k = system.size, system.constraints
    a = system.dynamics(q, qd, t)
    mass, jacobian = a["mass"], a["jacobian"]
    matrix = kkt_matrix(mass, jacobian)
    right = np.concatenate([a["forces"] - a["rest"], a["gamma"]], axis=-2)
    solved = np.linalg.solve(matrix, right)[..., 0]
    qdd, lam = solved[..., :n], solved[..., n:]
    varied = variations_of(system)(q, qd, qdd, lam, t)
    rates = np.zeros((*mass.shape[:-2], n + k, 2 * n))
    rates[..., :n, :n] = -varied["stiffness"]
    rates[..., :n, n:] = -varied["damping"]
    rates[..., n:, :n] = -varied["jacobian_acceleration"]
    rates[..., n:, n:] = -2.0 * varied["jacobian_rate"]
    slopes: Array = np.asarray(np.linalg.solve(matrix, rates), dtype=np.float64)
    return Linearised(
        qdd,
        lam,
        slopes[..., :n, :n],
        slopes[..., :n, n:],
        jacobian,
        varied["jacobian_rate"],
        mass,
        varied["damping"],
        (jacobian @ qd[..., None] - a["velocity_rhs"])[..., 0],
        (jacobian @ qdd[..., None] - a["gamma"])[..., 0],
        bool(np.any(a["forces"])),
    )


def variations_of(system: Constrained) -> Callable[..., dict[str, Array]]:
    """Return the variational equations of a system.

    Raises
    ------
    BadInput
        If it has none.
    """
    if system.variations is None:
        raise bad(
            "system",
            "no variational equations",
            "a constrained system with variations",
            "emit the model with the output 'variations'",
        )
    found: Callable[..., dict[str, Array]] = system.variations  # type: ignore[assignment]
    return found


@dataclass(frozen=True)
class Scale:
    """Units in which coordinates of different kinds compare: state ``(size q, size qd / rate)``.

    Attributes
    ----------
    size : ndarray, shape (n,)
        Square roots of the masses over their largest; 1 where there is none.
    rate : float
        Of motions, which makes velocities comparable with coordinates [rad/s].
    """

    size: Array
    rate: float

    def state(self, q: Array, qd: Array) -> Array:
        """Return scaled states, shape ``(*batch, 2n)``."""
        return np.concatenate([q * self.size, qd * (self.size / self.rate)], axis=-1)

    def physical(self, state: Array) -> tuple[Array, Array]:
        """Return coordinates and velocities of scaled states (or of differences of them)."""
        n = len(self.size)
        return state[..., :n] / self.size, state[..., n:] * (self.rate / self.size)

    @property
    def whole(self) -> Array:
        """The factors of a whole state, shape ``(2n,)``."""
        return np.concatenate([self.size, self.size / self.rate])


def scale_of(mass: Array, rate: float) -> Scale:
    """Return the scale that goes with mass matrices of shape ``(*batch, n, n)``."""
    n = mass.shape[-1]
    largest = np.max(np.abs(np.diagonal(mass, axis1=-2, axis2=-1)).reshape(-1, n), axis=0)
    top = np.max(largest, initial=0.0)
    size = np.sqrt(np.where(largest > 0.0, largest, top) / top) if top > 0 else np.ones(n)
    return Scale(size, rate)


@dataclass(frozen=True)
class Tangent:
    """The manifold of the constraints, at states: what leaves it and what stays.

    Attributes
    ----------
    normals : ndarray, shape (*batch, 2k, 2n)
        Derivatives of ``Phi`` and of ``dPhi/dt / rate`` by the scaled state.
    along : ndarray, shape (*batch, 2n, 2n - 2k)
        Orthonormal basis of the tangent space.
    across : ndarray, shape (*batch, 2n, 2k)
        Orthonormal basis of its complement.
    """

    normals: Array
    along: Array
    across: Array


def tangent(found: Linearised, scale: Scale) -> Tangent:
    """Return the tangent space of the constraint manifold at linearised states."""
    k, n = found.jacobian.shape[-2:]
    lead = found.jacobian.shape[:-2]
    normals = np.zeros((*lead, 2 * k, 2 * n))
    normals[..., :k, :n] = normals[..., k:, n:] = found.jacobian / scale.size
    normals[..., k:, :n] = found.jacobian_rate / (scale.size * scale.rate)
    if k == 0:
        whole = np.broadcast_to(np.eye(2 * n), (*lead, 2 * n, 2 * n))
        return Tangent(normals, whole, whole[..., :0])
    basis = np.linalg.qr(np.swapaxes(normals, -1, -2), mode="complete")[0]
    return Tangent(normals, basis[..., 2 * k :], basis[..., : 2 * k])


def onto_manifold(
    system: Constrained, q: Array, qd: Array, t: Array, scale: Scale
) -> tuple[Array, Array]:
    """Return the states moved to the constraints at both levels, by least scaled distance.

    Parameters and shapes as in :func:`linearised`.  A state that does not get there in a few
    Newton steps is returned as far as it came; the constraint norms tell.
    """
    if system.constraints == 0:
        return q, qd
    q = np.array(q)
    before = np.inf
    for _ in range(_MOST_PROJECTIONS):
        a = system.violation(q, t)
        change = _least(a["jacobian"], a["constraints"][..., 0], scale)
        q -= change
        moved = float(np.max(np.abs(change * scale.size), initial=0.0))
        if not moved < before or moved <= 4 * _EPS * float(np.max(np.abs(q * scale.size))):
            break
        before = moved
    a = system.dynamics(q, qd, t)
    defect = (a["jacobian"] @ qd[..., None] - a["velocity_rhs"])[..., 0]
    return q, qd - _least(a["jacobian"], defect, scale)


def _least(jacobian: Array, defect: Array, scale: Scale) -> Array:
    """Return the smallest scaled change whose product with the Jacobian is the defect."""
    weighted = jacobian / scale.size**2
    gram = jacobian @ np.swapaxes(weighted, -1, -2)
    force = np.linalg.solve(gram, defect[..., None])
    change: Array = (np.swapaxes(weighted, -1, -2) @ force)[..., 0]
    return change
