"""Angles, and values of a function of the crank angle."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import bad

Array = NDArray[np.float64]
_Values = TypeVar("_Values")


class Remembered(Generic[_Values]):
    """A function of angles ``(nt,)`` that keeps its last values, for all who ask at the same."""

    def __init__(self, function: Callable[[Array], _Values]) -> None:
        self._function = function
        self._last: tuple[Array, _Values] | None = None

    def __call__(self, theta: Array) -> _Values:
        """Return the values at angles, the last ones where these are the same."""
        last = self._last
        if last is None or not np.array_equal(last[0], theta):
            last = self._last = (np.array(theta), self._function(theta))
        return last[1]


def irregular_angles(count: int) -> Array:
    """Return angles of a turn by the golden section, ``(count,)``: none of regular samples."""
    places = (0.6180339887498949 * np.arange(1, count + 1)) % 1.0
    return np.asarray(2.0 * np.pi * places, dtype=np.float64)


def finite_angles(theta: ArrayLike) -> Array:
    """Return angles as an array of any shape; refuse any that is not finite."""
    angles = np.asarray(theta, dtype=float)
    if not np.all(np.isfinite(angles)):
        raise bad("theta", "an angle that is not finite", "finite angles", "correct the input")
    return angles


def values_at(f: Callable[[Array], ArrayLike], theta: Array, name: str) -> Array:
    """Return the values of a function ``name`` of the angle, one for each angle, ``(nt,)``.

    It may return one for all; what is not one finite value for each angle is refused.
    """
    values = np.array(f(theta), dtype=float)
    if values.shape == ():
        values = np.full(theta.shape, float(values))
    if values.shape != theta.shape:
        raise bad(
            f"function {name!r}",
            f"values of shape {values.shape} for angles of shape {theta.shape}",
            "one value per angle",
            "vectorise the function",
        )
    if not np.all(np.isfinite(values)):
        raise bad(
            f"function {name!r}",
            f"a value that is not finite at theta = {theta[~np.isfinite(values)][0]:.6g} rad",
            "finite values over the whole turn",
            "check the geometry",
        )
    return values
