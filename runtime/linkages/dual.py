"""Numbers that carry their derivatives: any emitted function differentiated to the last digit.

An emitted function takes its array namespace from its first argument.  Given dual numbers
``f + df`` it works out values and derivatives together by the rules of differentiation: no step,
no difference, no cancellation beyond that of the function itself.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class Dual:
    """A value and its derivatives.

    Parameters
    ----------
    value : array_like, shape (...)
        The value.
    slope : ndarray, shape (..., n)
        Its derivatives by n parameters; the shapes but for the last axis broadcast.
    """

    __slots__ = ("slope", "value")
    # NumPy's numbers and arrays leave operations with a dual number to it.
    __array_ufunc__ = None

    def __init__(self, value: ArrayLike, slope: Array) -> None:
        self.value: Array = np.asarray(value, dtype=float)
        self.slope = slope

    def __array_namespace__(self, api_version: str | None = None) -> Any:
        """Return the functions of dual numbers that emitted functions use."""
        return _Functions

    def _times(self, value: Array, factor: Array) -> Dual:
        return Dual(value, factor[..., np.newaxis] * self.slope)

    def __neg__(self) -> Dual:
        """Return the opposite."""
        return Dual(-self.value, -self.slope)

    def __add__(self, other: Any) -> Dual:
        """Return the sum."""
        if isinstance(other, Dual):
            return Dual(self.value + other.value, self.slope + other.slope)
        return Dual(self.value + other, self.slope)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Dual:
        """Return the difference."""
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> Dual:
        """Return the difference, this being subtracted."""
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> Dual:
        """Return the product."""
        if isinstance(other, Dual):
            mine = self.value[..., np.newaxis] * other.slope
            return Dual(self.value * other.value, mine + other.value[..., np.newaxis] * self.slope)
        factor = np.asarray(other, dtype=float)
        return self._times(self.value * factor, factor)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Dual:
        """Return the quotient."""
        if isinstance(other, Dual):
            value = self.value / other.value
            slope = self.slope - value[..., np.newaxis] * other.slope
            return Dual(value, slope / other.value[..., np.newaxis])
        divisor = np.asarray(other, dtype=float)
        return Dual(self.value / divisor, self.slope / divisor[..., np.newaxis])

    def __rtruediv__(self, other: Any) -> Dual:
        """Return the quotient, this being the divisor."""
        value = np.asarray(other, dtype=float) / self.value
        return self._times(value, -value / self.value)

    def __pow__(self, power: float) -> Dual:
        """Return the power; the exponent is a plain number."""
        return self._times(self.value**power, power * self.value ** (power - 1))


class _Functions:
    """The functions of an array namespace, for dual and for plain numbers."""

    @staticmethod
    def sin(angle: Any) -> Any:
        if not isinstance(angle, Dual):
            return np.sin(angle)
        return angle._times(np.sin(angle.value), np.cos(angle.value))

    @staticmethod
    def cos(angle: Any) -> Any:
        if not isinstance(angle, Dual):
            return np.cos(angle)
        return angle._times(np.cos(angle.value), -np.sin(angle.value))

    @staticmethod
    def tan(angle: Any) -> Any:
        if not isinstance(angle, Dual):
            return np.tan(angle)
        tangent = np.tan(angle.value)
        return angle._times(tangent, 1.0 + tangent * tangent)

    @staticmethod
    def sqrt(square: Any) -> Any:
        if not isinstance(square, Dual):
            return np.sqrt(square)
        root = np.sqrt(square.value)
        return square._times(root, 0.5 / root)

    @staticmethod
    def atan2(y: Any, x: Any) -> Any:
        if not (isinstance(y, Dual) or isinstance(x, Dual)):
            return np.arctan2(y, x)
        height, width = (part.value if isinstance(part, Dual) else part for part in (y, x))
        square = np.asarray(height * height + width * width)
        slope: Any = 0.0
        if isinstance(y, Dual):
            slope = slope + np.asarray(width / square)[..., np.newaxis] * y.slope
        if isinstance(x, Dual):
            slope = slope - np.asarray(height / square)[..., np.newaxis] * x.slope
        return Dual(np.arctan2(height, width), slope)


def seeded(values: dict[str, Any], names: tuple[str, ...]) -> dict[str, Dual]:
    """Return numbers as dual ones, the named ones being what is differentiated by.

    Parameters
    ----------
    values : dict of str to array_like
        All numbers.
    names : tuple of str
        Which of them count, in the order of the slopes' last axis.
    """
    still = np.zeros(len(names))
    slopes = dict(zip(names, np.eye(len(names)), strict=True))
    return {name: Dual(value, slopes.get(name, still)) for name, value in values.items()}


def split(number: Any, shape: tuple[int, ...], count: int) -> tuple[Array, Array]:
    """Return value and derivatives of a number in full shape, the derivatives' axis first.

    Parameters
    ----------
    number : Dual or array_like
        What an emitted function returned; a plain number depends on no parameter.
    shape : tuple of int
        Shape of the value.
    count : int
        Number of parameters.
    """
    value = number.value if isinstance(number, Dual) else np.asarray(number, dtype=float)
    slope = number.slope if isinstance(number, Dual) else np.zeros(count)
    full = np.broadcast_to(slope, (*shape, count))
    return np.array(np.broadcast_to(value, shape)), np.array(np.moveaxis(full, -1, 0))
