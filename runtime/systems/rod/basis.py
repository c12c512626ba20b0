"""What a moving basis of the rod's deflection is: shapes that depend on the block's place.

The deflection from the line of the block is ``v = L sum_i q_i(t) e_i(eta; xi)``, eta = x/L from 0
to 1 and xi = x1/L the block's place, with ``e_i(0) = e_i(xi) = 0``.  The equations want integrals
of the shapes over the rod, functions of xi alone; the angle enters through xi(theta).
"""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Names of the integrals: those with one row and column per shape, and those with one entry.
MATRIX_ARRAYS = ("overlap", "drift", "drift_drift", "bending", "bending_drift", "tension")
VECTOR_ARRAYS = ("moment", "mean")


@runtime_checkable
class MovingBasis(Protocol):
    """Shapes ``e_i(eta; xi)`` of a rod from its pin (eta = 0) to its tip, held at the block xi.

    With ' = d/d eta and all integrals from eta = 0 to 1, the arrays are

    ================= ==============================================
    ``overlap``       ``int e_i e_j``
    ``drift``         ``int e_i de_j/dxi``
    ``drift_drift``   ``int de_i/dxi de_j/dxi``
    ``bending``       ``int e_i'' e_j''``
    ``bending_drift`` ``int e_i'' de_j''/dxi``
    ``tension``       ``int (1 - eta^2)/2 e_i' e_j'``
    ``moment``        ``int eta e_i``
    ``mean``          ``int e_i``
    ================= ==============================================

    All are free of dimension.
    """

    @property
    def size(self) -> int:
        """Number n of shapes."""

    @property
    def labels(self) -> tuple[str, ...]:
        """One name per shape."""

    def shapes(self, x: Array, place: Array, derivative: int = 0) -> Array:
        """Return the shapes or a derivative by eta.

        Parameters
        ----------
        x : ndarray
            Places eta on the rod, from 0 to 1, shape ``(nx,)``.
        place : ndarray
            Places xi of the block, shape ``(nt,)``.
        derivative : int
            Which derivative by eta.

        Returns
        -------
        ndarray
            Shape ``(nt, nx, n)``.
        """

    def array(self, name: str, place: Array) -> Array:
        """Return the integrals of one name at places xi ``(nt,)``; ``(nt, n, n)`` or ``(nt, n)``.

        Raises
        ------
        BadInput
            If there is no array of that name.
        """
