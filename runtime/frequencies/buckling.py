"""The crank speed at which the axial forces of the motion itself buckle a held mechanism."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.families import LinearPeriodic
from ..floquet.first_order import even_angles
from .eigenproblem import held_arrays, require_system

Array = NDArray[np.float64]

_ANGLES = 256
_WITHIN, _PASSES = 9, 16


@dataclass(frozen=True)
class Buckling:
    """Least crank speed at which ``K + Kg`` is singular at some crank angle.

    Attributes
    ----------
    speed : float
        Crank speed [rad/s]; inf where no speed buckles the mechanism.
    angle : float
        Crank angle [rad].
    """

    speed: float
    angle: float


def buckling_speed(system: LinearPeriodic, **parameters: float) -> Buckling:
    """Return the least crank speed at which the axial forces buckle the held mechanism.

    Beyond it a link that is pressed has, over a part of the turn, no natural frequency: frozen
    analyses end there.  The moving mechanism need not be unstable, as it passes that part quickly.

    Parameters
    ----------
    system : LinearPeriodic
        Its geometric stiffness is to grow with the square of the speed, constant loads aside.
    **parameters : float
        Parameter values that replace the system's own.

    Returns
    -------
    Buckling
        The speed is exact to round-off at its angle, which is the worst one to 1e-6 of the period.

    Raises
    ------
    BadInput
        If a parameter is unknown, or mass or stiffness is not positive definite at rest.
    """
    require_system(system)
    if not system.has("Kg"):
        return Buckling(np.inf, 0.0)
    theta = even_angles(system.period, _ANGLES)
    for _ in range(_PASSES):
        softening = _softening(system, theta, parameters)
        best = int(np.argmax(softening))
        step = float(theta[1] - theta[0])
        theta = theta[best] + step * np.linspace(-1.0, 1.0, _WITHIN)
    worst = float(softening[best])
    found = float(theta[_WITHIN // 2]) % system.period
    return Buckling(1.0 / np.sqrt(worst) if worst > 0.0 else np.inf, found)


def _softening(system: LinearPeriodic, theta: Array, parameters: dict[str, float]) -> Array:
    """Return, at each angle, the largest eigenvalue of -(what a unit speed adds) over K."""
    _, resting = held_arrays(system, theta, parameters, 0.0)
    added = held_arrays(system, theta, parameters, 1.0)[1] - resting
    half = np.linalg.inv(np.linalg.cholesky(resting))
    reduced = -half @ added @ np.swapaxes(half, -1, -2)
    return np.asarray(np.linalg.eigvalsh(0.5 * (reduced + np.swapaxes(reduced, -1, -2)))[:, -1])
