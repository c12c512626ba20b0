"""Natural frequencies and shapes of a system with its crank held at angles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..floquet.first_order import numbers

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
# Round-offs of a sum's terms that its error is told as.
_ROUNDED = 2.0


@dataclass(frozen=True)
class HeldModes:
    """Natural frequencies and shapes at crank angles.

    Attributes
    ----------
    frequency : ndarray
        Natural frequencies [rad/s], rising, shape ``(nt, n)``.
    shape : ndarray
        Shapes, columns of unit modal mass, ``(nt, n, n)``.
    mass : ndarray
        M, ``(nt, n, n)``.
    error : ndarray
        Round-off of the frequencies [rad/s], ``(nt, n)``.
    """

    frequency: Array
    shape: Array
    mass: Array
    error: Array


def held_arrays(
    system: LinearPeriodic, theta: Array, parameters: Mapping[str, float], speed: float
) -> tuple[Array, Array]:
    """Return M and K + Kg at crank angles, Kg with the axial forces of a crank speed."""
    mass = system.array("M", theta, **parameters)
    stiffness = system.array("K", theta, **parameters)
    if system.has("Kg"):
        stiffness = stiffness + system.array("Kg", theta, speed, **parameters)
    return mass, stiffness


def held_frequencies(
    system: LinearPeriodic, theta: Array, parameters: Mapping[str, float], speed: float = 0.0
) -> tuple[Array, Array]:
    """Return natural frequencies [rad/s] at crank angles and their round-off, ``(nt, n)`` each.

    Raises
    ------
    BadInput
        As :func:`held_modes`.
    """
    held = held_modes(system, theta, parameters, speed)
    return held.frequency, held.error


def held_modes(
    system: LinearPeriodic, theta: Array, parameters: Mapping[str, float], speed: float = 0.0
) -> HeldModes:
    """Return natural frequencies and shapes at crank angles ``(nt,)`` [rad].

    Raises
    ------
    BadInput
        If mass or stiffness is not positive definite at some angle.
    """
    mass, stiffness = held_arrays(system, theta, parameters, speed)
    half = _inverse_factor(mass, stiffness, theta)
    flexibility = half @ mass @ np.swapaxes(half, -1, -2)
    # Of the inverse problem the lowest frequencies are the largest eigenvalues, the accurate ones.
    _, vectors = np.linalg.eigh((flexibility + np.swapaxes(flexibility, -1, -2)) / 2)
    shape = np.swapaxes(half, -1, -2) @ vectors[:, :, ::-1]
    square, error = _quotients(mass, stiffness, shape)
    shape = shape / np.sqrt(np.einsum("tik,tij,tjk->tk", shape, mass, shape))[:, None, :]
    order = np.argsort(square, axis=1, kind="stable")
    frequency, error = np.sqrt(square), 0.5 * error / np.sqrt(square)
    return HeldModes(
        np.take_along_axis(frequency, order, axis=1),
        np.take_along_axis(shape, order[:, None, :], axis=2),
        mass,
        np.take_along_axis(error, order, axis=1),
    )


def _quotients(mass: Array, stiffness: Array, shape: Array) -> tuple[Array, Array]:
    """Return the squares of the frequencies as Rayleigh's quotients, and their round-off.

    What the shapes are wrong by enters squared; what is left is the round-off of the sums.
    """
    size = np.abs(shape)
    kinetic = np.sum(shape * (mass @ shape), axis=1)
    square = np.sum(shape * (stiffness @ shape), axis=1) / kinetic
    summed = np.sum(size * (np.abs(stiffness) @ size), axis=1)
    summed += square * np.sum(size * (np.abs(mass) @ size), axis=1)
    return square, _ROUNDED * _EPS * summed / kinetic


def _inverse_factor(mass: Array, stiffness: Array, theta: Array) -> Array:
    """Return the inverse of Cholesky's factor of K; both matrices must have one."""
    factor: NDArray[np.floating[Any]] = mass
    for name, matrix in (("mass M", mass), ("stiffness K + Kg", stiffness)):
        try:
            factor = np.linalg.cholesky(matrix)
        except np.linalg.LinAlgError:
            symmetric = (matrix + np.swapaxes(matrix, -1, -2)) / 2
            lowest = np.min(np.linalg.eigvalsh(symmetric), axis=-1)
            where = float(theta[int(np.argmin(lowest))])
            raise bad(
                name,
                f"smallest eigenvalue {float(np.min(lowest)):.3g} at crank angle {where:.6g}",
                "a positive definite matrix at every angle",
                "check the parameters; a rigid or buckled motion has no natural frequency",
            ) from None
    return np.asarray(np.linalg.inv(factor))


def require_system(system: object) -> None:
    """Refuse what is no linear periodic system.

    Raises
    ------
    BadInput
        If it is none.
    """
    if not isinstance(system, LinearPeriodic):
        found, fix = type(system).__name__, "take one from linkage_system or a scene"
        raise bad("system", found, "a LinearPeriodic", fix)


def crank_angles(system: LinearPeriodic, theta: ArrayLike | None) -> Array:
    """Return checked crank angles; 361 over a period by default.

    Raises
    ------
    BadInput
        If they are no row of finite numbers.
    """
    if theta is None:
        return np.linspace(0.0, system.period, 361)
    angles = np.atleast_1d(numbers("theta", theta))
    if angles.ndim != 1 or not angles.size or not np.all(np.isfinite(angles)):
        raise bad("theta", theta, "finite crank angles [rad], one row", "correct them")
    return angles


def assurance(first: Array, second: Array, mass: Array, *, squared: bool = True) -> Array:
    """Return the mass-weighted assurance of shapes (columns), or its root with a sign.

    ``(u^T M v)^2 / (u^T M u  v^T M v)``: 1 of the same shape, 0 of shapes without a common part.
    """
    product = np.swapaxes(first, -1, -2) @ mass @ second
    one = np.einsum("...ik,...ij,...jk->...k", first, mass, first)
    other = np.einsum("...ik,...ij,...jk->...k", second, mass, second)
    root: Array = product / np.sqrt(one[..., :, None] * other[..., None, :])
    return root**2 if squared else root
