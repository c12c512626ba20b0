"""Forces of a four-bar linkage as a NumPy user would write them: rivals, and a reference."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Values: TypeAlias = NDArray[np.floating[Any]]

# Rows of what every function here returns.
NAMES = ("x12", "y12", "x23", "y23", "x34", "y34", "x41", "y41", "T", "X", "Y", "M")
# The best of 2048 to 16384, like our own.
_BLOCK = 8192


@dataclass(frozen=True)
class Data:
    """Open four-bar linkage with straight links at constant speed.

    Attributes
    ----------
    lengths : ndarray, shape (4,)
        Frame, crank, coupler, follower [m].
    moments : ndarray, shape (3,)
        First moments of crank, coupler and follower about their first joints [kg m].
    inertias : ndarray, shape (3,)
        About the same joints [kg m^2].
    masses : ndarray, shape (3,)
        Of the same links [kg].
    speed : float
        Of the crank [rad/s].
    """

    lengths: Values
    moments: Values
    inertias: Values
    masses: Values
    speed: Any

    def inputs(self) -> Values:
        """Return every number on which the forces depend, in one array."""
        groups = (self.lengths, self.moments, self.inertias, self.masses, np.array([self.speed]))
        return np.concatenate(groups)

    @classmethod
    def of(cls, inputs: Values) -> Data:
        """Return the data of an array made by :meth:`inputs`."""
        return cls(inputs[:4], inputs[4:7], inputs[7:10], inputs[10:13], inputs[13])


def motion_by_hand(theta: Values, data: Data) -> tuple[Values, ...]:
    """Return cosines, sines and accelerations of the links by Smith (2.2), (2.7), (2.10)."""
    l1, l2, l3, l4 = data.lengths
    c2, s2 = np.cos(theta), np.sin(theta)
    dx, dy = l1 - l2 * c2, -l2 * s2
    square = dx * dx + dy * dy
    along = (square + (l3 * l3 - l4 * l4)) * (0.5 / l3)
    across = np.sqrt(square - along * along)
    inverse = 1 / square
    c3, s3 = (dx * along - dy * across) * inverse, (dy * along + dx * across) * inverse
    c4, s4 = (l3 * c3 - dx) * (1 / l4), (l3 * s3 - dy) * (1 / l4)
    s34 = 1 / (s3 * c4 - c3 * s4)
    s23, s24 = s2 * c3 - c2 * s3, s2 * c4 - c2 * s4
    w3, w4 = (-l2 / l3) * s24 * s34, (-l2 / l4) * s23 * s34
    c23, c24, c34 = c2 * c3 + s2 * s3, c2 * c4 + s2 * s4, c3 * c4 + s3 * s4
    n3, n4 = l3 * w3 * w3, l4 * w4 * w4
    a3 = (l2 * c24 + n3 * c34 - n4) * s34 * (-1 / l3)
    a4 = (l2 * c23 - n4 * c34 + n3) * s34 * (-1 / l4)
    return c2, s2, c3, s3, c4, s4, s23, s34, w3, w4, a3, a4


def forces_by_hand(theta: Values, data: Data) -> Values:
    """Return pin forces, torque, shaking force and moment by Smith (4.7)-(4.12).

    Parameters
    ----------
    theta : ndarray, shape (n,)
        Crank angles [rad].
    data : Data
        The linkage.

    Returns
    -------
    ndarray, shape (12, n)
        Rows as in :data:`NAMES`; the moment with the reaction of the drive, which (4.13) lacks.
    """
    l1, l2, l3, l4 = data.lengths
    square = data.speed * data.speed
    m2, m3, m4 = data.moments * square
    _, i3, i4 = data.inertias * square
    c2, s2, c3, s3, c4, s4, s23, s34, w3, w4, a3, a4 = motion_by_hand(theta, data)
    about_b = (i3 * a3 - (m3 * l2) * s23) * s34 * (1 / l3)
    about_d = i4 * a4 * s34 * (1 / l4)
    x34, y34 = about_b * c4 + about_d * c3, about_b * s4 + about_d * s3
    n3, n4 = w3 * w3, w4 * w4
    lumped = data.masses[1] * square * l2
    x23 = x34 - (lumped * c2 + m3 * (n3 * c3 + a3 * s3))
    y23 = y34 - (lumped * s2 + m3 * (n3 * s3 - a3 * c3))
    x12, y12 = x23 - m2 * c2, y23 - m2 * s2
    x41 = x34 + m4 * (n4 * c4 + a4 * s4)
    y41 = y34 + m4 * (n4 * s4 - a4 * c4)
    torque = l2 * (y23 * c2 - x23 * s2)
    rows = (x12, y12, x23, y23, x34, y34, x41, y41, torque)
    return np.stack([*rows, x41 - x12, y41 - y12, l1 * y41 - torque])


def forces_in_blocks(theta: Values, data: Data) -> Values:
    """Return the same, evaluated in blocks that fit the cache."""
    out = np.empty((len(NAMES), theta.size), dtype=theta.dtype)
    for start in range(0, theta.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        out[:, part] = forces_by_hand(theta[part], data)
    return out


def forces_by_solving(theta: Values, data: Data) -> Values:
    """Return the same from the nine equations (4.4)-(4.6), by batched ``numpy.linalg.solve``."""
    l1, l2, l3, l4 = data.lengths
    c2, s2, c3, s3, c4, s4, _, _, w3, w4, a3, a4 = motion_by_hand(theta, data)
    (m2, m3, m4), square = data.moments, data.speed**2
    lumped = data.masses[1] * l2
    matrix = np.zeros((theta.size, 9, 9))
    right = np.zeros((theta.size, 9))
    # Columns: x12 y12 x23 y23 x34 y34 x41 y41 T; rows: two forces and a moment for each link.
    for row, (first, second) in ((0, (0, 2)), (3, (2, 4)), (6, (4, 6))):
        for axis in (0, 1):
            matrix[:, row + axis, first + axis] = 1.0
            matrix[:, row + axis, second + axis] = -1.0
    matrix[:, 2, 2], matrix[:, 2, 3], matrix[:, 2, 8] = l2 * s2, -l2 * c2, 1.0
    matrix[:, 5, 4], matrix[:, 5, 5] = l3 * s3, -l3 * c3
    matrix[:, 8, 4], matrix[:, 8, 5] = -l4 * s4, l4 * c4
    right[:, 0], right[:, 1] = -m2 * c2, -m2 * s2
    right[:, 3] = -lumped * c2 - m3 * (w3 * w3 * c3 + a3 * s3)
    right[:, 4] = -lumped * s2 - m3 * (w3 * w3 * s3 - a3 * c3)
    right[:, 5] = data.inertias[1] * a3 - m3 * l2 * (s2 * c3 - c2 * s3)
    right[:, 6] = -m4 * (w4 * w4 * c4 + a4 * s4)
    right[:, 7] = -m4 * (w4 * w4 * s4 - a4 * c4)
    right[:, 8] = data.inertias[2] * a4
    found = np.linalg.solve(matrix, right[..., None])[..., 0].T * square
    x41, y41, torque = found[6], found[7], found[8]
    rest = np.stack([x41 - found[0], y41 - found[1], l1 * y41 - torque])
    return np.concatenate([found, rest])


def reference(theta: Values, data: Data) -> tuple[Values, Values]:
    """Return the forces in extended precision, and what a rounding of the inputs does to them.

    Returns
    -------
    value : ndarray of longdouble, shape (12, n)
        Good to about ``1e-19`` times the second array over the value.
    scale : ndarray, shape (12, n)
        ``|f| + sum_i |x_i df/dx_i|`` over the crank angle and every number of the data.
    """
    step = np.longdouble(1e-9)
    angles, inputs = theta.astype(np.longdouble), data.inputs().astype(np.longdouble)
    value = forces_by_hand(angles, Data.of(inputs))
    scale = np.abs(value)
    changed = [(angles * (1 + sign * step), inputs) for sign in (1, -1)]
    pairs = [changed]
    for i in range(inputs.size):
        change = np.ones_like(inputs)
        change[i] += step
        pairs.append([(angles, inputs * change), (angles, inputs * (2 - change))])
    for (up, more), (down, less) in pairs:
        gap = forces_by_hand(up, Data.of(more)) - forces_by_hand(down, Data.of(less))
        scale = scale + np.abs(gap) / (2 * step)
    return value, np.asarray(scale, dtype=float)
