"""What a moving basis of the rod's deflection is, and what the rods' functions refuse.

The deflection from the line of the block is ``v = L sum_i q_i(t) e_i(eta; xi)``, eta = x/L from 0
to 1 and xi = x1/L the block's place, with ``e_i(0) = e_i(xi) = 0``.  The equations want integrals
of the shapes over the rod, functions of xi alone; the angle enters through xi(theta).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from reprlib import repr as short
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import Problem, bad, refuse
from ...core.inputs import is_finite, numbers

Array = NDArray[np.float64]

# Names of the integrals: those with one row and column per shape, and those with one entry.
MATRIX_ARRAYS = ("overlap", "drift", "drift_drift", "bending", "bending_drift", "tension")
VECTOR_ARRAYS = ("moment", "mean")
# Closer to the pin the integrals of some shapes leave the range of a double.
_NEAREST = 1e-12


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
        """Return the shapes or a derivative by eta, ``(nt, nx, n)``.

        At places eta on the rod, 0 to 1, ``(nx,)``, for places xi of the block, ``(nt,)``.
        """

    def array(self, name: str, place: Array) -> Array:
        """Return the integrals of one name at places xi; ``(nt, n, n)`` or ``(nt, n)``."""


def require_array(name: str) -> None:
    """Refuse the name of an array that no basis has."""
    known = (*MATRIX_ARRAYS, *VECTOR_ARRAYS)
    if name not in known:
        raise bad("array", name, f"one of {', '.join(known)}", "see MovingBasis")


def require_places(place: ArrayLike, alone: bool = False) -> Array:
    """Return the block's places as a vector, refused where the block is not on the rod.

    With ``alone`` a number makes a vector of one.
    """
    expected = f"a vector of places x1/L in 0 < x1/L <= 1, not nearer to the pin than {_NEAREST:g}"
    fix = "keep the block on the rod: a longer rod, or a shorter crank"
    return _between("place", place, _NEAREST, expected, fix, alone)


def require_points(x: ArrayLike, where: str = "x", alone: bool = False) -> Array:
    """Return points of the rod as a vector, refused where they are not on it.

    With ``alone`` a number makes a vector of one.
    """
    return _between(where, x, 0.0, "a vector of places x/L from 0 to 1", "stay on the rod", alone)


def _between(
    where: str, values: ArrayLike, least: float, expected: str, fix: str, alone: bool
) -> Array:
    given = numbers(where, values)
    given = np.atleast_1d(given) if alone else given
    if given.ndim != 1 or not np.all((given >= least) & (given <= 1.0)):
        shape = f"shape {given.shape}"
        if given.size and np.all(np.isfinite(given)):
            shape += f", values from {np.min(given):.6g} to {np.max(given):.6g}"
        raise bad(where, shape, expected, fix)
    return given


def require_numbers(
    values: Mapping[str, object], *, zero: Collection[str] = (), signed: Collection[str] = ()
) -> None:
    """Refuse what is not a finite number above 0, all such at once.

    Those of ``zero`` may be 0; those of ``signed`` may have either sign, but not be 0.
    """
    problems = []
    for name, value in values.items():
        allowed = "other than 0" if name in signed else "from 0" if name in zero else "above 0"
        number: Any = value if is_finite(value) else np.nan
        usable = {"other than 0": abs(number) > 0, "from 0": number >= 0, "above 0": number > 0}
        if not usable[allowed]:
            problems.append(Problem(name, short(value), f"a finite number {allowed}", "correct it"))
    refuse(problems)


def require_drop(drop: object, known: tuple[str, ...]) -> tuple[str, ...]:
    """Return the terms to leave out, sorted and once each, refused where one is unknown."""
    whole = isinstance(drop, Collection) and not isinstance(drop, str | bytes)
    if not whole or any(name not in known for name in drop):  # type: ignore[attr-defined]
        raise bad("drop", repr(drop), f"some of {known}", "correct it")
    return tuple(name for name in sorted(known) if name in drop)  # type: ignore[operator]
