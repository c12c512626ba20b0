"""Arrays of twice the digits: sums ``high + low`` of two floats, about 32 digits.

An emitted function takes them in place of its arguments and returns what it would without
round-off; the difference to what it returns for floats is its error.  Sums and products are those
of Dekker (1971): what a float operation leaves out is a float itself.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]

# pi/2 as a sum of three floats, exact to 2^-160.
_QUARTER = (1.5707963267948966, 6.123233995736766e-17, -1.4973849048591833e-33)


def sum_and_rest(a: Any, b: Any) -> tuple[Any, Any]:
    """Return the float next to a sum, and what it leaves out."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def product_and_rest(a: Any, b: Any) -> tuple[Any, Any]:
    """Return the float next to a product, and what it leaves out."""
    total = a * b
    (a1, a2), (b1, b2) = _halves(a), _halves(b)
    return total, ((a1 * b1 - total) + a1 * b2 + a2 * b1) + a2 * b2


def _halves(a: Any) -> tuple[Any, Any]:
    # Halves of 26 bits.
    high = (2.0**27 + 1.0) * a
    high = high - (high - a)
    return high, a - high


class Twofold:
    """An array of numbers of twice the digits; operations broadcast, with floats too."""

    # NumPy's arrays leave operations with these to them.
    __array_ufunc__ = None

    __slots__ = ("high", "low")

    def __init__(self, high: Any, low: Any = 0.0) -> None:
        self.high, self.low = high, low

    def __array_namespace__(self, *, api_version: str | None = None) -> Any:
        return _Functions

    def __neg__(self) -> Twofold:
        return Twofold(-self.high, -self.low)

    def __add__(self, other: Any) -> Twofold:
        other = _twofold(other)
        (high, rest), (low, least) = (
            sum_and_rest(self.high, other.high),
            sum_and_rest(self.low, other.low),
        )
        high, rest = sum_and_rest(high, rest + low)
        return Twofold(*sum_and_rest(high, rest + least))

    def __sub__(self, other: Any) -> Twofold:
        return self + (-_twofold(other))

    def __mul__(self, other: Any) -> Twofold:
        other = _twofold(other)
        high, low = product_and_rest(self.high, other.high)
        return Twofold(*sum_and_rest(high, low + (self.high * other.low + self.low * other.high)))

    def __truediv__(self, other: Any) -> Twofold:
        other = _twofold(other)
        first = self.high / other.high
        rest = self - other * first
        second = rest.high / other.high
        third = (rest - other * second).high / other.high
        return Twofold(*sum_and_rest(first, second)).__add__(third)

    def __pow__(self, power: int) -> Twofold:
        value = self
        for _ in range(power - 1):
            value = value * self
        return value

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> Twofold:
        return self.__neg__().__add__(other)

    def __rtruediv__(self, other: Any) -> Twofold:
        return _twofold(other) / self

    def gap(self, values: Array) -> Array:
        """Return how far floats are off."""
        rest = self - values
        return np.asarray(np.abs(rest.high + rest.low))


def _twofold(value: Any) -> Twofold:
    return value if isinstance(value, Twofold) else Twofold(value)


class _Functions:
    """The functions of emitted modules to twice the digits."""

    @staticmethod
    def sin(angle: Twofold) -> Twofold:
        return _turned(angle)[1]

    @staticmethod
    def cos(angle: Twofold) -> Twofold:
        return _turned(angle)[0]

    @staticmethod
    def sqrt(square: Twofold) -> Twofold:
        root = np.sqrt(square.high)
        # Newton's step doubles the digits; the root of zero has all of them.
        rest = (square - Twofold(root) * root).high
        return Twofold(*sum_and_rest(root, rest / (2.0 * np.where(root == 0.0, 1.0, root))))

    @staticmethod
    def atan2(y: Any, x: Any) -> Twofold:
        y, x = _twofold(y), _twofold(x)
        angle = np.arctan2(y.high, x.high)
        cosine, sine = _turned(Twofold(angle))
        # The angle that is left is as small as a round-off: it is its own tangent.
        rest = (y * cosine - x * sine) / (x * cosine + y * sine)
        return Twofold(angle).__add__(rest)


def _turned(angle: Twofold) -> tuple[Twofold, Twofold]:
    """Return cosine and sine, by Taylor's series in what exceeds whole quarters of a turn."""
    quarters = np.round(angle.high / _QUARTER[0])
    rest = angle
    for part in _QUARTER:
        rest = rest - Twofold(quarters) * part
    square = rest * rest
    cosine = sine = Twofold(1.0)
    # Up to pi/4 the next term is below 1e-34.
    for k in range(27, 2, -2):
        sine = 1.0 - square * sine / float((k - 1) * k)
        cosine = 1.0 - square * cosine / float(k * (k + 1))
    sine, cosine = rest * sine, 1.0 - 0.5 * square * cosine
    whole = quarters % 4.0
    across = whole % 2.0 == 1.0
    return (
        _chosen(across, sine, cosine) * np.where((whole == 1.0) | (whole == 2.0), -1.0, 1.0),
        _chosen(across, cosine, sine) * np.where(whole >= 2.0, -1.0, 1.0),
    )


def _chosen(where: NDArray[np.bool_], one: Twofold, other: Twofold) -> Twofold:
    high = np.where(where, one.high, other.high)
    return Twofold(high, np.where(where, one.low, other.low))
