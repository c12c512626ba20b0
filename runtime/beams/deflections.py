"""Deflections of the beams over their length: how far a motion is from the linear range."""

from __future__ import annotations

import numpy as np

from .assembly import AngleArrays, Array
from .placed_shapes import placed_shapes


def relative_deflection(arrays: AngleArrays, theta: Array) -> Array:
    """Return what turns coordinates into deflections across the beams over their lengths.

    Parameters
    ----------
    arrays : AngleArrays
        Of the structure.
    theta : ndarray
        Crank angles ``(nt,)`` [rad].

    Returns
    -------
    ndarray
        Shape ``(nt, k, n)``: displacement across each element from its place on the rigid beam, at
        its middle and its end, over the beam's length.
    """
    motion = arrays.motion(theta)
    found = []
    for placed, own in arrays.local:
        _, across = placed_shapes(placed, np.array([0.5, 1.0]))
        c, s = motion.products[placed.beam.name][:, 1:3].T
        local = np.zeros((len(theta), 2, len(own.mass)))
        for x, y in ((0, 1), (3, 4)):
            local[:, :, x] = -s[:, None] * across[:, y]
            local[:, :, y] = c[:, None] * across[:, y]
        others = [i for i in range(len(own.mass)) if i not in (0, 1, 3, 4)]
        local[:, :, others] = across[:, others]
        full = np.zeros((len(theta), 2, arrays.count))
        full[:, :, placed.indices] = local / placed.beam.length
        found.append(full[:, :, arrays.free])
    return np.concatenate(found, axis=1)
