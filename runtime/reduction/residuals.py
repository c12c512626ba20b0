"""Motions of a condensed system put into the full equation, and what that leaves answered."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..beams.recovery_forms import LinearForm
from .balance import Balance, series
from .condensed import Condensed
from .stress_rows import peaks
from ..core.trigonometric import Array, differentiated

_FORCES = ("f", "h", "p")


class FullEquation:
    """The full equation at one speed, times its square, on the angles of a condensed system."""

    def __init__(self, condensed: Condensed, speed: float) -> None:
        self.condensed, self.speed = condensed, speed
        arrays = condensed.arrays
        self.at = {
            name: sum((speed**p * v for p, v in powers.items()), start=np.zeros(()))
            for name, powers in arrays.items()
        }

    def rest(self, q: Array) -> Array:
        """Return forces less what a motion ``(nt, n)`` needs, ``(nt, n)``."""
        period, at = self.condensed.period, self.at
        slope = differentiated(q, period)
        momentum = _times(at["M"], slope)
        needs = _times(at["K"], q)
        if "A" in at:
            momentum = momentum + _times(at["A"], q)
            needs = needs - _times(np.swapaxes(at["A"], -1, -2), slope)
        for name, sign, values in (
            ("B", -1.0, q),
            ("Kg", 1.0, q),
            ("C", 1.0, slope),
            ("D", 1.0, q),
        ):
            if name in at:
                needs = needs + sign * _times(at[name], values)
        needs = needs + differentiated(momentum, period)
        return np.asarray(sum((at[name] for name in _FORCES if name in at), start=-needs))


def _times(matrices: Array, vectors: Array) -> Array:
    return np.asarray((matrices @ vectors[..., None])[..., 0])


def motion_of(
    condensed: Condensed, balance: Balance, x: Array, speed: float, table: Array
) -> Array:
    """Return q ``(nt, n)`` of a series of reduced coordinates, the forces' own part left out."""
    total = np.zeros(condensed.basis.shape[:2])
    at: dict[int, Array] = {}
    for (e, j), values in condensed.motion.items():
        if j not in at:
            at[j] = table @ balance.derivatives(x, j).reshape(-1, balance.modes)
        total = total + speed**e * _times(values, at[j])
    return total


def corrected_motion(
    condensed: Condensed, balance: Balance, x: Array, speed: float, table: Array
) -> tuple[Array, Array]:
    """Return a motion as condensed and the same corrected by the full equation, ``(nt, n)`` each.

    What it leaves of the equation is answered by the modes left out, then by the modes kept, then
    by those left out again.
    """
    forced = sum(speed**e * v[..., 0] for (e, _), v in condensed.forced.items())
    first = motion_of(condensed, balance, x, speed, table) + forced
    full = FullEquation(condensed, speed)
    across = np.swapaxes(condensed.basis, -1, -2)
    better = first + _times(condensed.flexibility, full.rest(first))
    pushed = series(_times(across, full.rest(better)), balance.harmonics).reshape(-1)
    change = np.linalg.solve(balance.taylor(speed)[0], pushed)
    better = better + motion_of(condensed, balance, change, speed, table)
    return first, better + _times(condensed.flexibility, full.rest(better))


def stresses_of(form: LinearForm, q: Array, speed: float, period: float) -> Array:
    """Return the rows of a form of recovery in a motion on even angles, ``(nt, rows)``."""
    slope = differentiated(q, period)
    return np.asarray(form.values(speed, q, slope, differentiated(slope, period)))


def corrected_peaks(
    form: LinearForm,
    condensed: Condensed,
    balance: Balance,
    x: Array,
    speed: float,
    *,
    table: Array,
    link: NDArray[np.int64],
) -> tuple[Array, Array]:
    """Return the largest stress of each link of a motion as condensed, and corrected.

    Parameters
    ----------
    form : LinearForm
        Stresses as a form of the motion.
    condensed, balance : Condensed, Balance
        The reduced system.
    x : ndarray, shape (d,)
        Series of its coordinates.
    speed : float
        Speed [rad/s].
    table : ndarray
        The Fourier basis at the angles.
    link : ndarray of int
        Link of each row of the form.
    """
    links = int(np.max(link)) + 1
    both = [
        stresses_of(form, q, speed, condensed.period)
        for q in corrected_motion(condensed, balance, x, speed, table)
    ]
    found = peaks(np.stack(both, axis=-1), link, links, condensed.period).size
    return found[:, 0], found[:, 1]
