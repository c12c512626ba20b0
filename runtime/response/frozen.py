"""Natural frequencies with the crank held at an angle, and their mean over the cycle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import bad
from ..families import LinearPeriodic
from ..floquet.first_order import even_angles, numbers
from ..results import Check, Result, provenance

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
# Most angles over which a mean is taken.
_MOST = 4096


@dataclass(frozen=True, kw_only=True)
class FrozenFrequencies(Result):
    """Natural frequencies of a linear periodic system with its crank held.

    Attributes
    ----------
    theta : ndarray
        Crank angles [rad], shape ``(nt,)``.
    frequency : ndarray
        Natural frequencies [rad/s] of M and K + Kg there, rising, shape ``(nt, n)``.
    mean : ndarray
        Their means over the period, each rank by itself, shape ``(n,)`` [rad/s].
    error : ndarray
        Absolute error of ``frequency`` [rad/s], shape ``(nt, n)``: round-off of the eigenvalue
        problem; that of the basis is not in it.
    """

    theta: Array
    frequency: Array
    mean: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "theta": ("angle",),
        "frequency": ("angle", "mode"),
        "error": ("angle", "mode"),
        "mean": ("mode",),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the first natural frequency over the crank angle and return the axes."""
        from ..plotting import axes_or_new

        ax = axes_or_new(ax)
        ax.plot(np.degrees(self.theta), self.frequency[:, 0])
        ax.axhline(self.mean[0], color="0.6", linewidth=0.8)
        ax.set_xlabel("crank angle [deg]")
        ax.set_ylabel("first natural frequency [rad/s]")
        return ax


def frozen_frequencies(
    system: LinearPeriodic, theta: ArrayLike | None = None, **parameters: float
) -> FrozenFrequencies:
    """Return the natural frequencies of a system with its crank held at angles.

    Neither the crank's speed nor damping plays a part: ``(K + Kg) q = omega^2 M q`` at each angle
    (Beale & Scott's Fig. 11).

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    theta : array_like, optional
        Crank angles [rad], shape ``(nt,)``; 361 over a period by default.
    **parameters : float
        Parameter values that replace the system's own.

    Returns
    -------
    FrozenFrequencies
        Its check: ``mean``, the change of the means, over them, by half as many angles.

    Raises
    ------
    BadInput
        If an angle is not finite, a parameter is unknown, or a stiffness is not positive definite
        or a mass is not at some angle.
    """
    if theta is None:
        angles = np.linspace(0.0, system.period, 361)
    else:
        angles = np.atleast_1d(numbers("theta", theta))
    if angles.ndim != 1 or not angles.size or not np.all(np.isfinite(angles)):
        raise bad("theta", theta, "finite crank angles [rad], one row", "correct them")
    frequency, error = _frequencies(system, angles, parameters)
    mean, change = _mean(system, parameters)
    return FrozenFrequencies(
        method="generalised eigenvalue problem of K + Kg and M",
        error=error,
        error_norm="absolute, of each frequency [rad/s], round-off alone",
        checks={"mean": Check(change, 1e-9)},
        provenance=provenance(system.changed_provenance(**parameters)),
        theta=angles,
        frequency=frequency,
        mean=mean,
    )


def _mean(system: LinearPeriodic, parameters: Mapping[str, float]) -> tuple[Array, float]:
    """Return the means over the period and the last change relative to them."""
    count, before = 64, None
    while True:
        # A rank's frequency is analytic where it does not meet its neighbour: the trapezoidal rule
        # on the circle converges geometrically.
        found = _frequencies(system, even_angles(system.period, count), parameters)[0].mean(axis=0)
        change = np.inf if before is None else float(np.max(np.abs(found - before) / found))
        if change <= 1e-12 or 2 * count > _MOST:
            return found, change
        count, before = 2 * count, found


def _frequencies(
    system: LinearPeriodic, theta: Array, parameters: Mapping[str, float]
) -> tuple[Array, Array]:
    mass = system.array("M", theta, **parameters)
    stiffness = system.array("K", theta, **parameters) + system.array("Kg", theta, **parameters)
    for name, matrix in (("mass M", mass), ("stiffness K + Kg", stiffness)):
        lowest = np.min(np.linalg.eigvalsh((matrix + np.swapaxes(matrix, -1, -2)) / 2), axis=-1)
        if not np.all(lowest > 0):
            where = float(theta[int(np.argmin(lowest))])
            raise bad(
                name,
                f"smallest eigenvalue {float(np.min(lowest)):.3g} at crank angle {where:.6g}",
                "a positive definite matrix at every angle",
                "check the parameters; a rigid or buckled motion has no natural frequency",
            )
    half = np.linalg.inv(np.linalg.cholesky(stiffness))
    # Of the inverse problem the lowest frequencies are the largest eigenvalues, the accurate ones.
    flexibility = half @ mass @ np.swapaxes(half, -1, -2)
    squares = np.linalg.eigvalsh((flexibility + np.swapaxes(flexibility, -1, -2)) / 2)[:, ::-1]
    frequency: Array = 1.0 / np.sqrt(squares)
    condition = np.linalg.cond(stiffness)[:, None]
    spread = squares[:, :1] / squares
    error = frequency * _EPS * system.size * (condition + spread)
    return frequency, error
