"""Functions of numbers within bounds: polynomials of second order, and what they leave out.

A Taylor model holds an array of functions of n numbers x, each from -1 to 1: the coefficients of
``1, x_i, x_i^2, x_i x_j``, and a proved bound of the remainder, round-off included (Makino and Berz
1999).  Models go where code expects NumPy's arrays: through operators, the functions named in
``_FUNCTIONS``, and comparisons that come out the same for all x.  Where no bound can be had, of a
root of what may vanish for one, the remainder is no number.

Sums and products of floats are taken to be right to half a unit of the last place, sines and other
functions to four units, as NumPy states.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache, reduce
from operator import add, gt, lt, mul, neg, sub, truediv
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .twofold import product_and_rest, sum_and_rest

Array = NDArray[np.float64]
# Bounds of the round-off of an operation and of a function over the sizes of the terms, that of
# the bounds themselves among it; what underflow may cost.
_ROUNDING, _OF_FUNCTIONS, _TINY = 2.0**-49, 2.0**-47, 1e-300


class UndecidedError(ArithmeticError):
    """A comparison comes out differently within the bounds, or too close to tell."""


@lru_cache(maxsize=16)
def _pairs(n: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    found = np.array(list(itertools.combinations(range(n), 2)), dtype=int).reshape(-1, 2)
    return found[:, 0], found[:, 1]


def features(points: Array) -> Array:
    """Return 1, coordinates, their squares and products, of points ``(..., n)``, on a last axis."""
    return np.concatenate(
        [np.ones_like(points[..., :1]), points, _squares(points, points)], axis=-1
    )


def _squares(a: Array, b: Array) -> Array:
    """Return ``a_i b_i``, then ``a_i b_j`` where i < j."""
    first, second = _pairs(a.shape[-1])
    return np.concatenate([a * b, a[..., first] * b[..., second]], axis=-1)


def stacked(models: Sequence[TaylorModel], shape: tuple[int, ...] = ()) -> TaylorModel:
    """Return models, each broadcast to a shape, along a first axis."""
    features = models[0].coefficients.shape[-1]
    values = [np.broadcast_to(one.coefficients, (*shape, features)) for one in models]
    rests = [np.broadcast_to(one.rest, shape) for one in models]
    return TaylorModel(np.stack(values), np.stack(rests), models[0].n)


class TaylorModel:
    """An array of functions of n numbers.

    Attributes
    ----------
    coefficients : ndarray, shape (..., 1 + 2 n + n (n - 1) / 2)
        Of 1, the numbers, their squares, and their products.
    rest : ndarray, shape (...)
        Bound of what these leave out.
    n : int
        Count of numbers.
    """

    __slots__ = ("coefficients", "n", "rest")

    def __init__(self, coefficients: Array, rest: Any, n: int) -> None:
        self.coefficients, self.n = coefficients, n
        self.rest: Array = np.broadcast_to(rest, coefficients.shape[:-1])

    @classmethod
    def numbers(cls, middle: Array, half: Array) -> list[TaylorModel]:
        """Return the numbers themselves, each within a half-width of its middle, ``(n,)``."""
        n = len(middle)
        rows = np.zeros((n, len(features(middle))))
        rows[:, 0], rows[:, 1 : n + 1] = middle, np.diag(half)
        return [cls(row, 0.0, n) for row in rows]

    def lifted(self, values: Any) -> TaylorModel:
        """Return values as functions of the same numbers, which they do not depend on."""
        if isinstance(values, TaylorModel):
            return values
        array = np.asarray(values, dtype=float)
        coefficients = np.zeros((*array.shape, self.coefficients.shape[-1]))
        coefficients[..., 0] = array
        return TaylorModel(coefficients, 0.0, self.n)

    @property
    def real(self) -> TaylorModel:
        """The model itself: its values are real."""
        return self

    @property
    def middle(self) -> Array:
        """Values where all numbers are in the middle."""
        return self.coefficients[..., 0]

    @property
    def slope(self) -> Array:
        """Coefficients of the numbers, ``(..., n)``."""
        return self.coefficients[..., 1 : self.n + 1]

    def _sizes(self) -> tuple[Array, Array, Array]:
        """Return bounds of what is constant, of first, and of second order."""
        size, n = np.abs(self.coefficients), self.n
        return size[..., 0], size[..., 1 : n + 1].sum(axis=-1), size[..., n + 1 :].sum(axis=-1)

    def reach(self) -> Array:
        """Return bounds of how far values are from those in the middle."""
        _, linear, second = self._sizes()
        return np.asarray((linear + second + self.rest) * (1.0 + _ROUNDING))

    def largest(self) -> Array:
        """Return bounds of absolute values."""
        return np.asarray((np.abs(self.middle) + self.reach()) * (1.0 + _ROUNDING))

    def sum(self, axis: int) -> TaylorModel:
        """Return sums along an axis, counted from the first."""
        off = self.rest.shape[axis] * _ROUNDING * np.sum(np.abs(self.coefficients), axis=(axis, -1))
        total = np.sum(self.rest, axis=axis) * (1.0 + 1e-12) + off
        return TaylorModel(np.sum(self.coefficients, axis=axis), total, self.n)

    def bounds(self) -> tuple[Array, Array]:
        """Return bounds for all numbers: exact in each, the products of two at their worst."""
        n, slope = self.n, np.abs(self.slope)
        curve, products = np.split(self.coefficients[..., n + 1 :], [n], axis=-1)

        def top(curve: Array) -> Array:
            inside = 2.0 * np.abs(curve) > slope
            peak = np.square(slope) / (4.0 * np.where(inside, np.abs(curve), 1.0))
            return np.asarray(
                np.sum(np.where(inside & (curve < 0.0), peak, slope + curve), axis=-1)
            )

        beyond = np.sum(np.abs(products), axis=-1) + self.rest
        beyond = beyond + _ROUNDING * np.sum(np.abs(self.coefficients), axis=-1)
        return self.middle - top(-curve) - beyond, self.middle + top(curve) + beyond

    def __getitem__(self, place: Any) -> TaylorModel:
        place = place if isinstance(place, tuple) else (place,)
        inner = place if any(one is ... for one in place) else (*place, ...)
        return TaylorModel(self.coefficients[(*inner, slice(None))], self.rest[place], self.n)

    def __neg__(self) -> TaylorModel:
        return TaylorModel(-self.coefficients, self.rest, self.n)

    def __add__(self, other: Any) -> TaylorModel:
        also = self.lifted(other)
        total = self.coefficients + also.coefficients
        # Of what is in the middle the round-off is known: an angle plus zero has none.
        _, off = sum_and_rest(self.middle, also.middle)
        off = np.abs(off) + _ROUNDING * np.sum(np.abs(total[..., 1:]), axis=-1)
        return TaylorModel(total, (self.rest + also.rest) * (1.0 + _ROUNDING) + off, self.n)

    def __mul__(self, other: Any) -> TaylorModel:
        also, n = self.lifted(other), self.n
        (a, a1, a2), (b, b1, b2) = self._sizes(), also._sizes()
        product = self.middle[..., None] * also.coefficients
        product[..., 1:] += also.middle[..., None] * self.coefficients[..., 1:]
        squares = _squares(self.slope, also.slope) + _squares(also.slope, self.slope)
        squares[..., :n] *= 0.5
        product[..., n + 1 :] += squares
        rest = a1 * b2 + a2 * (b1 + b2)
        rest += self.rest * (b + b1 + b2 + also.rest) + (a + a1 + a2) * also.rest
        off = _ROUNDING * (a + a1 + a2) * (b + b1 + b2) + _TINY
        return TaylorModel(product, rest * (1.0 + _ROUNDING) + off, n)

    def __sub__(self, other: Any) -> TaylorModel:
        return self.__add__(-other)

    def __truediv__(self, other: Any) -> TaylorModel:
        if isinstance(other, TaylorModel):
            return self * _inverse(other)
        quotient, size = self.coefficients / other, np.abs(other)
        whole, off = product_and_rest(quotient[..., 0], other)
        off = np.abs((whole - self.middle) + off) / size
        off = off + _ROUNDING * np.sum(np.abs(quotient[..., 1:]), axis=-1)
        return TaylorModel(quotient, (self.rest / size) * (1.0 + _ROUNDING) + off, self.n)

    def __pow__(self, power: float) -> TaylorModel:
        if power == 0.5:
            return _root(self)
        if power != int(power) or power == 0:
            raise TypeError(f"power {power} of a Taylor model")
        product: TaylorModel = reduce(mul, [self] * abs(int(power)))
        return product if power > 0 else _inverse(product)

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> TaylorModel:
        return self.__neg__().__add__(other)

    def __rtruediv__(self, other: Any) -> TaylorModel:
        return self.lifted(other) * _inverse(self)

    def __gt__(self, other: Any) -> NDArray[np.bool_]:
        low, high = (self - other).bounds()
        if not np.all((low > 0.0) | (high < 0.0)):
            raise UndecidedError("comparison of numbers within their bounds")
        return np.asarray(low > 0.0)

    def __lt__(self, other: Any) -> NDArray[np.bool_]:
        return np.asarray(~(self > other))

    def __abs__(self) -> TaylorModel:
        return self * np.where(self > 0.0, 1.0, -1.0)

    def __array_ufunc__(self, ufunc: Any, method: str, *given: Any, **more: Any) -> Any:
        function = _FUNCTIONS.get(ufunc)
        if function is None or method != "__call__" or more:
            return NotImplemented
        return function(*map(self.lifted, given))


def _composed(x: TaylorModel, value: Any, first: Any, second: Any, third: Any) -> TaylorModel:
    """Return a function of a model by its value, derivative, and half the second, in the middle.

    A sixth of the third one is at most ``third`` in all that the model reaches.
    """
    n, (_, linear, others) = x.n, x._sizes()
    coefficients = np.asarray(first)[..., None] * x.coefficients
    coefficients[..., 0] = value
    squares = _squares(x.slope, x.slope)
    squares[..., n:] *= 2.0
    coefficients[..., n + 1 :] += np.asarray(second)[..., None] * squares
    others = others + x.rest
    reach, first, second = linear + others, np.abs(first), np.abs(second)
    rest = first * x.rest + second * others * (linear + reach) + third * reach**3
    off = _OF_FUNCTIONS * (np.abs(value) + first * reach + second * reach**2) + _TINY
    return TaylorModel(coefficients, rest * (1.0 + _OF_FUNCTIONS) + off, n)


def _least(x: TaylorModel) -> Array:
    """Return a bound below the values of a model over all numbers; no number unless positive."""
    size = np.abs(x.middle)
    least = size - x.reach() - _ROUNDING * size
    return np.where(least > 0.0, least, np.nan)


def _inverse(x: TaylorModel) -> TaylorModel:
    one = 1.0 / x.middle
    return _composed(x, one, -(one**2), one**3, _least(x) ** -4)


def _root(x: TaylorModel) -> TaylorModel:
    root = np.sqrt(x.middle)
    half = 0.5 / root
    return _composed(x, root, half, -0.5 * half / (2.0 * x.middle), _least(x) ** -2.5 / 16.0)


def _wave(x: TaylorModel, value: Array, slope: Array) -> TaylorModel:
    """Return a sine or cosine by its value and derivative in the middle."""
    return _composed(x, value, slope, -0.5 * value, 1.0 / 6.0)


def _tangent(x: TaylorModel) -> TaylorModel:
    tangent = np.tan(x.middle)
    slope, reach = 1.0 + tangent**2, x.reach()
    beside = np.tan(np.minimum(reach, 0.7))
    left = np.where(reach < 0.7, 1.0 - np.abs(tangent) * beside, -1.0)
    largest = ((np.abs(tangent) + beside) / np.where(left > 0.0, left, np.nan)) ** 2
    third = np.where(reach > 0.0, (1.0 + largest) * (1.0 + 3.0 * largest) / 3.0, 0.0)
    return _composed(x, tangent, slope, tangent * slope, third * (1.0 + _OF_FUNCTIONS))


def _angle(y: TaylorModel, x: TaylorModel) -> TaylorModel:
    """Return the angle of a vector, which may not reach the half line to the left."""
    turned = (x.middle * y - y.middle * x) / (x.middle * x + y.middle * y)
    tangent = turned.middle
    inverse = 1.0 / (1.0 + tangent**2)
    beside = _composed(turned, np.arctan(tangent), inverse, -tangent * inverse**2, 1.0 / 3.0)
    (low, high), (left, _) = y.bounds(), x.bounds()
    cut = (left <= 0.0) & (low <= 0.0) & (high >= 0.0)
    middle = y.lifted(np.arctan2(y.middle, x.middle))
    off = _OF_FUNCTIONS * np.abs(middle.middle)
    return middle + TaylorModel(beside.coefficients, np.where(cut, np.nan, beside.rest + off), y.n)


_FUNCTIONS: Mapping[Any, Callable[..., Any]] = {
    np.add: add,
    np.subtract: sub,
    np.multiply: mul,
    np.divide: truediv,
    np.negative: neg,
    np.greater: gt,
    np.less: lt,
    np.square: lambda x: x * x,
    np.sqrt: _root,
    np.sin: lambda x: _wave(x, np.sin(x.middle), np.cos(x.middle)),
    np.cos: lambda x: _wave(x, np.cos(x.middle), -np.sin(x.middle)),
    np.tan: _tangent,
    np.arctan2: _angle,
}
