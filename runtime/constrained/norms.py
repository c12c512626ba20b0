"""How well a motion meets its constraints: positions, velocities and accelerations."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..core.families import Constrained
from ..core.families.multipliers import scaling

Array = NDArray[np.float64]


def constraint_norms(
    system: Constrained, t: Array, q: Array, qd: Array, qdd: Array
) -> tuple[Array, Array, Array]:
    """Return the scaled defects of the constraints at the three levels.

    A row of ``Phi``, ``Phi_q qd - rhs`` and ``Phi_q qdd - gamma`` is divided by the length of the
    row of ``Phi_q S`` (S measures the coordinates by their inertia) and by the size of the scaled
    coordinates, velocities and accelerations over the motion: 1e-16 is round-off whatever the
    units.

    Parameters
    ----------
    system : Constrained
        The system.
    t : ndarray, shape (nt,)
        Times [s].
    q, qd, qdd : ndarray, shape (nt, n)
        Coordinates and their derivatives.

    Returns
    -------
    position, velocity, acceleration : ndarray, shape (nt,)
        Largest scaled defect of a row at each time.
    """
    if not system.constraints:
        zero = np.zeros(len(t))
        return zero, zero.copy(), zero.copy()
    a = system.dynamics(q, qd, t)
    phi = system.violation(q, t)["constraints"][..., 0]
    jacobian = a["jacobian"]
    columns, rows = scaling(a["mass"], jacobian)
    defects = (
        phi,
        (jacobian @ qd[..., None] - a["velocity_rhs"])[..., 0],
        (jacobian @ qdd[..., None] - a["gamma"])[..., 0],
    )
    place, speed, push = (
        float(np.max(np.abs(vector / columns), initial=0.0)) for vector in (q, qd, qdd)
    )
    # What cancels in the accelerations is of the size of the centripetal ones.
    sizes = (place, speed, max(push, speed * (speed / place if place > 0 else 0.0)))
    found = [
        np.max(np.abs(rows * defect), axis=-1) / (size if size > 0 else 1.0)
        for defect, size in zip(defects, sizes, strict=True)
    ]
    return found[0], found[1], found[2]
