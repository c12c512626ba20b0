"""Reduced inertia and load as Fourier series: what an integrator asks for thousands of times."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..linkages.linkage import Array

_TURN = 2.0 * np.pi
_FEWEST, _MOST = 64, 1024
# A series ends in round-off, and meets its function off the samples, or is not used.
_TAIL, _OFF = 1e-14, 1e-12
_PROBES = np.array([0.37, 1.91, 4.05, 5.83, 7.77])


@dataclass(frozen=True)
class ReducedTable:
    """Fourier series of J, J'/2 and, where it depends on the angle alone, the load torque.

    Attributes
    ----------
    orders : ndarray, shape (k,)
        ``i`` times the harmonics.
    rows : ndarray, shape (3, k)
        Complex coefficients; the function is the real part of their sum with the waves.
    loaded : bool
        Whether the third row is the load torque; else it is zero.
    """

    orders: NDArray[np.complex128]
    rows: NDArray[np.complex128]
    loaded: bool

    def __call__(self, theta: float) -> list[float]:
        """Return J, J'/2 [kg m^2] and the load torque [N m] at a crank angle [rad]."""
        found: list[float] = (self.rows @ np.exp(self.orders * theta)).real.tolist()
        return found


def reduced_table(
    inertia: Callable[[Array], Array], load: Callable[[Array], Array] | None
) -> ReducedTable | None:
    """Return the table of a machine; None where the inertia wants too many harmonics.

    Parameters
    ----------
    inertia : callable
        Reduced inertia over crank angles, of period 2 pi.
    load : callable or None
        Load torque, where it depends on the angle alone; left out where it does not repeat.
    """
    first = _series(inertia)
    if first is None:
        return None
    second = None if load is None else _series(load)
    size = max(first.size, 0 if second is None else second.size)
    orders = 1j * np.arange(size)
    rows = np.zeros((3, size), dtype=complex)
    rows[0, : first.size] = first
    rows[1] = orders / 2.0 * rows[0]
    if second is not None:
        rows[2, : second.size] = second
    return ReducedTable(orders, rows, second is not None)


def _series(function: Callable[[Array], Array]) -> Any:
    """Return the harmonics of a function down to round-off; None where there are too many."""
    count = _FEWEST
    while count <= _MOST:
        values = np.asarray(function(_TURN * np.arange(count) / count))
        harmonics = np.fft.rfft(values) * (2.0 / count)
        harmonics[0] /= 2.0
        sizes, largest = np.abs(harmonics), float(np.max(np.abs(values)))
        if largest == 0.0:
            return harmonics[:1]
        if float(np.max(sizes[-max(1, sizes.size // 4) :])) <= _TAIL * largest:
            kept = int(np.max(np.nonzero(sizes > 1e-17 * largest)[0], initial=0)) + 1
            harmonics = harmonics[: min(kept, 3 * sizes.size // 4)]
            waves = np.exp(1j * np.outer(_PROBES, np.arange(harmonics.size)))
            gap = np.max(np.abs((waves @ harmonics).real - function(_PROBES)))
            return harmonics if gap <= _OFF * largest else None
        count *= 2
    return None
