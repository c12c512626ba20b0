"""Slow modes of a stiff system, which move with it, and the flexibility of its fast ones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.errors import BadInput
from ..core.trigonometric import even_angles
from ..periodic.first_order import CanonicalForm
from ..simulation.second_order import keep
from .speed_parts import SpeedParts

Array = NDArray[np.float64]

# Ratio of neighbouring frequencies at all angles that lets the modes below be followed together.
_GAP = 1.05
# Lowest fast frequency over that of the highest harmonic kept.
_APART = 1.1
# Asymmetry of a matrix that has natural modes.
_SKEW = 1e-9


@dataclass(frozen=True)
class SlowModes:
    """Slow modes at even angles.

    Attributes
    ----------
    shapes, slopes, bends : ndarray
        Phi and its first two derivatives by the angle, ``(nt, n, m)``.
    flexibility : ndarray
        Of the fast modes, ``(nt, n, n)``.
    highest : ndarray
        Highest frequency of each slow mode [rad/s], ``(m,)``.
    """

    shapes: Array
    slopes: Array
    bends: Array
    flexibility: Array
    highest: Array

    def thinned(self, every: int) -> SlowModes:
        """Return the modes at every so many of the angles."""
        parts = (self.shapes, self.slopes, self.bends, self.flexibility)
        shapes, slopes, bends, flexibility = (np.ascontiguousarray(p[::every]) for p in parts)
        return SlowModes(shapes, slopes, bends, flexibility, self.highest)


def _held(form: CanonicalForm, parts: SpeedParts, count: int) -> tuple[Array, ...]:
    """Return M, squared frequencies and shapes of unit modal mass at even angles.

    Of M and K, and of Kg where it does not depend on the speed; empty where a matrix is not
    symmetric or not positive definite.  Kept with the system.
    """
    from ..periodic.moving_basis import natural_modes

    key = ("held modes", *parts.key)
    known = form.system.kept.get(key)
    if known is None:
        known = ()
        n = form.system.size
        shape = (count, n, n)
        mass, stiff = (
            np.broadcast_to(parts.arrays.get(name, np.zeros((1, n, n))), shape)
            for name in ((2, 0), (0, -2))
        )
        skew = [float(np.max(np.abs(a - np.swapaxes(a, -1, -2)))) for a in (mass, stiff)]
        if all(s <= _SKEW * np.max(np.abs(a)) for s, a in zip(skew, (mass, stiff), strict=True)):
            try:
                known = (mass, *natural_modes(mass, stiff))
            except np.linalg.LinAlgError:
                # A mechanism that buckles, or is free to move: there are no modes to steer by.
                known = ()
        keep(form.system, key, known)
    return known


def slow_modes(
    form: CanonicalForm, parts: SpeedParts, count: int, highest: float
) -> SlowModes | None:
    """Return as few slow modes as keep the fast ones well above a frequency.

    Parameters
    ----------
    form : CanonicalForm
        Its first member is taken.
    parts : SpeedParts
        Of its equation at the same angles.
    count : int
        Number of even angles.
    highest : float
        The frequency [rad/s].

    Returns
    -------
    SlowModes or None
        None where there is no such number of modes, or there are no modes.
    """
    held = _held(form, parts, count)
    if not held:
        return None
    mass, squares, shapes = held
    lowest = np.sqrt(np.min(squares, axis=0))
    ratio = np.sqrt(np.min(squares[:, 1:] / squares[:, :-1], axis=0))
    for m in np.flatnonzero((ratio >= _GAP) & (lowest[1:] >= _APART * highest)) + 1:
        key = ("slow basis", int(m), *parts.key)
        known = form.system.kept.get(key)
        if known is None:
            known = _basis(form.system.period, int(m), mass, squares, shapes)
            keep(form.system, key, known)
        if known:
            shapes, slopes, bends, flexibility = known
            highest_kept = np.sqrt(np.max(squares[:, :m], axis=0))
            return SlowModes(shapes, slopes, bends, flexibility, highest_kept)
    return None


def _basis(period: float, m: int, mass: Array, squares: Array, shapes: Array) -> tuple[Array, ...]:
    """Return Phi, its two derivatives and the flexibility of the others; empty if mirrored."""
    from ..core.trigonometric import differentiated
    from ..periodic.moving_basis import StillModes, carried_basis

    still = StillModes(even_angles(period, len(mass)), squares, shapes, mass)
    try:
        basis = carried_basis(period, m, still)
    except BadInput:
        # Another number of modes does not.
        return ()
    fast = shapes[:, :, m:]
    flexibility = (fast / squares[:, None, m:]) @ np.swapaxes(fast, -1, -2)
    return basis.values, basis.slopes, differentiated(basis.slopes, period), flexibility
