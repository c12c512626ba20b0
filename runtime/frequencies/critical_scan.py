"""A quick look at how far a structure of beams bends over many speeds, on its slow modes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..core.errors import BadInput
from ..core.families import LinearPeriodic

Array = NDArray[np.float64]

# Error up to which the motions are sought: maxima are looked for, not told.
_RTOL = 1e-4
_SHARE = 0.1


def scanned_deflections(system: LinearPeriodic, speeds: Array) -> Array | None:
    """Return the largest r.m.s. deflection over the length at rising speeds, ``(ns,)``.

    By the motions of :func:`elastolink.stress_curve`: on moving modes, all others answering
    quasi-statically, rational in the speed between some tens of speeds.

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
    from ..reduction.balance import samples_table
    from ..reduction.ranges import grid_of, ranges_of
    from ..reduction.residuals import motion_of
    from ..reduction.sweeping import motions

    if system.structure is None or system.relative_deflection is None:
        return None
    try:
        grid = grid_of(system, None)
        pieces = ranges_of(system, grid, speeds, _RTOL)
    except BadInput:
        # No subspace is smooth: the slow way finds what there is.
        return None
    rows = system.relative_deflection(grid.still.theta)
    out = np.empty(len(speeds))
    for piece in pieces:
        balance = piece.whole.truncated(piece.harmonics)
        own = speeds[piece.part]
        series = motions(balance, own, _SHARE * _RTOL).series
        table = samples_table(grid.still.theta, balance.harmonics, balance.wave)
        forced = piece.condensed.forced
        values = np.empty(len(own))
        for k, speed in enumerate(own.tolist()):
            q = motion_of(piece.condensed, balance, series[:, k], speed, table)
            q = q + sum(speed**e * v[..., 0] for (e, _), v in forced.items())
            bent = (rows @ q[..., None])[..., 0]
            values[k] = np.sqrt(np.max(np.mean(bent**2, axis=0)))
        out[piece.part] = values
    return out
