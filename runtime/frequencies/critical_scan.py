"""How far a structure of beams bends over many speeds, on its lowest modes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..core.errors import BadInput
from ..core.families import LinearPeriodic

Array = NDArray[np.float64]

# Error of the transition matrices: maxima are looked for, not reported.
_RTOL = 1e-6
# Angles of a revolution.
_ANGLES = 64


def scanned_deflections(system: LinearPeriodic, speeds: Array) -> Array | None:
    """Return the largest r.m.s. deflection over the length at rising speeds, ``(ns,)``.

    Parameters
    ----------
    system : LinearPeriodic
        Damped, with deflections that are known.
    speeds : ndarray, shape (ns,)
        Rising speeds [rad/s].

    Returns
    -------
    ndarray or None
        None where the system has no slow modes apart from fast ones.
    """
    from ..periodic.swept_motions import Truncations, speed_ranges

    if system.structure is None or system.relative_deflection is None:
        return None
    try:
        truncations = Truncations(system)
        modes = truncations.usable(0, _ANGLES)[-1]
    except (BadInput, IndexError):
        # No subspace is smooth: the slow way finds what there is.
        return None
    out = np.empty(len(speeds))
    for piece in speed_ranges(speeds):
        span = float(speeds[piece][0]), float(speeds[piece][-1])
        moving = truncations.motions(modes, _ANGLES, span, _RTOL)
        rows = system.relative_deflection(moving.truncated.theta)
        for part, q, _ in moving.blocks(speeds[piece]):
            bent = rows @ np.moveaxis(q, 0, -1)
            out[piece][part] = np.sqrt(np.max(np.mean(bent**2, axis=0), axis=0))
    return out
