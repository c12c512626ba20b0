"""The determinant of the dynamic stiffness over the frequency (Aannaque Fig. 5.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..beams._checks import require_kind
from ..core.errors import bad
from ..core.families import Transcendental
from ..floquet.first_order import numbers

Array = NDArray[np.float64]


def log_determinant(problem: Transcendental, omega: ArrayLike) -> tuple[Array, Array]:
    """Return the determinant of D without overflow.

    Zeros are frequencies at which the nodes move, poles those of the members with held ends; a
    frequency at which all nodes stand still is a pole for whole members and a zero for divided
    ones.

    Parameters
    ----------
    problem : Transcendental
        Any.
    omega : array_like, shape (...)
        Frequencies [rad/s].

    Returns
    -------
    logarithm : ndarray, shape (...)
        ``log10 |det D|``.
    sign : ndarray, shape (...)
        Sign of the determinant.

    Raises
    ------
    BadInput
        If a frequency is not positive, or there is none.
    """
    require_kind("problem", problem, Transcendental, "make one with dynamic_stiffness")
    rates = numbers("omega", omega)
    if not rates.size or not np.all((rates > 0.0) & np.isfinite(rates)):
        raise bad("omega", repr(omega), "positive frequencies [rad/s]", "leave out the others")
    sign, logarithm = np.linalg.slogdet(problem.stiffness(rates))
    return np.asarray(logarithm / np.log(10.0)), np.asarray(sign)
