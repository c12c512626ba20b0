"""Functions of the crank angle: values remembered or refused, trigonometric series."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import bad

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
_Values = TypeVar("_Values")

_EPS = float(np.finfo(float).eps)
GOLDEN = (float(np.sqrt(5.0)) - 1.0) / 2.0
# Angles over the period by the golden section, which no wave shares.
BETWEEN = np.arange(1.0, 14.0) * GOLDEN % 1.0
# Angles evaluated at a time.
_TOGETHER = 4096


class Remembered(Generic[_Values]):
    """A function of angles ``(nt,)`` that keeps its last values, for all who ask at the same."""

    def __init__(self, function: Callable[[Array], _Values]) -> None:
        self._function = function
        self._last: tuple[Array, _Values] | None = None

    def __call__(self, theta: Array) -> _Values:
        """Return the values at angles, the last ones where these are the same."""
        last = self._last
        if last is None or not _same(last[0], theta):
            last = self._last = (np.array(theta), self._function(theta))
        return last[1]


def _same(one: Array, two: Array) -> bool:
    """Return whether angles are the same; of objects, whether they are the same ones."""
    if one.dtype != two.dtype or one.dtype != object:
        return one.dtype == two.dtype and np.array_equal(one, two)
    return one.shape == two.shape and all(a is b for a, b in zip(one.flat, two.flat, strict=True))


def irregular_angles(count: int) -> Array:
    """Return angles of a turn by the golden section, ``(count,)``: none of regular samples."""
    places = (GOLDEN * np.arange(1, count + 1)) % 1.0
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
        found = f"values of shape {values.shape} for angles of shape {theta.shape}"
        raise bad(f"function {name!r}", found, "one value per angle", "vectorise the function")
    if not np.all(np.isfinite(values)):
        angle = theta[~np.isfinite(values)][0]
        found = f"a value that is not finite at theta = {angle:.6g} rad"
        expected = "finite values over the whole turn"
        raise bad(f"function {name!r}", found, expected, "check the geometry")
    return values


@dataclass(frozen=True)
class PeriodicArray:
    """An array-valued periodic function, ``Re sum_k c_k exp(2 pi i k theta / period)``.

    Its coefficients ``(harmonics + 1, *shape)`` beyond the mean count twice already.
    """

    coefficients: ComplexArray
    period: float

    def __call__(self, theta: Array) -> Array:
        """Evaluate at angles ``(nt,)`` [rad]; returns ``(nt, *shape)``."""
        return self._sum(np.asarray(theta, dtype=float), self.coefficients)

    def derivative(self, theta: Array) -> Array:
        """Evaluate the derivative by the angle at angles ``(nt,)``; returns ``(nt, *shape)``."""
        waves = 1j * np.arange(len(self.coefficients)) * (2.0 * np.pi / self.period)
        turned = self.coefficients.reshape(len(waves), -1) * waves[:, None]
        return self._sum(np.asarray(theta, dtype=float), turned.reshape(self.coefficients.shape))

    def _sum(self, theta: Array, coefficients: ComplexArray) -> Array:
        shape, count = coefficients.shape[1:], len(coefficients)
        flat = coefficients.reshape(count, -1)
        rows = np.concatenate([flat.real, -flat.imag[1:]])
        out = np.empty((len(theta), flat.shape[1]))
        waves = np.arange(count) * (2.0 * np.pi / self.period)
        for begin in range(0, len(theta), _TOGETHER):
            phase = theta[begin : begin + _TOGETHER, None] * waves
            table = np.concatenate([np.cos(phase), np.sin(phase[:, 1:])], axis=1)
            out[begin : begin + _TOGETHER] = table @ rows
        return out.reshape(len(theta), *shape)


def even_angles(period: float, count: int) -> Array:
    """Return angles that divide a period evenly, from 0, shape ``(count,)`` [rad]."""
    return np.asarray(period * np.arange(float(count)) / count)


def interpolated(values: Array, period: float, noise: float = 0.0) -> PeriodicArray:
    """Return the series through samples ``(nt, ...)`` at even angles, from 0.

    The last harmonics up to ``noise`` times the largest, at least round-off, are left out.
    """
    amplitude = np.fft.rfft(values, axis=0) / len(values)
    amplitude[1:] *= 2.0
    if len(values) % 2 == 0:
        # The highest one cannot tell cosine from sine: its derivative would be one-sided.
        amplitude = amplitude[:-1]
    size = np.max(np.abs(amplitude.reshape(len(amplitude), -1)), axis=1, initial=0.0)
    seen = np.flatnonzero(size > max(_EPS, noise) * np.max(size, initial=0.0))
    return PeriodicArray(amplitude[: (seen[-1] if len(seen) else 0) + 1], period)


def differentiated(values: Array, period: float) -> Array:
    """Return the derivative by the angle of periodic samples ``(nt, ...)``, spectrally."""
    count = len(values)
    waves = 1j * np.arange(count // 2 + 1) * (2.0 * np.pi / period)
    if count % 2 == 0:
        waves[-1] = 0.0
    half = np.fft.rfft(values, axis=0)
    half *= waves.reshape(-1, *(1,) * (values.ndim - 1))
    return np.asarray(np.fft.irfft(half, n=count, axis=0))


def tail(values: Array) -> float:
    """Return the largest of the upper quarter of the harmonics over the largest of all."""
    amplitude = np.abs(np.fft.rfft(values.reshape(len(values), -1), axis=0))
    largest = float(np.max(amplitude, initial=0.0))
    upper = amplitude[-max(1, len(amplitude) // 4) :]
    return float(np.max(upper, initial=0.0)) / largest if largest else 0.0


def resampled(values: Array, count: int) -> Array:
    """Return periodic samples ``(nt, ...)`` at another number of even angles."""
    given = len(values)
    if given == count:
        return values
    spectrum = np.fft.rfft(values, axis=0)
    if given % 2 == 0 and count > given:
        spectrum[-1] *= 0.5
    kept = np.zeros((count // 2 + 1, *values.shape[1:]), dtype=complex)
    most = min(len(kept), len(spectrum))
    kept[:most] = spectrum[:most]
    return np.asarray(np.fft.irfft(kept, n=count, axis=0) * (count / given))
