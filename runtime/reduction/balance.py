"""Harmonic balance of a condensed system as a polynomial in the crank speed.

``sum_k w^k P_k x = sum_k w^k F_k``, x the Fourier series of the reduced coordinates: the matrices
are assembled once for all speeds.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import comb

import numpy as np
from numpy.typing import NDArray

from .condensed import Condensed
from ..core.trigonometric import Array


@dataclass(frozen=True)
class Balance:
    """The balanced equation.

    The unknowns stand harmonic by harmonic (mean, cosine 1, sine 1, ...), for each the reduced
    coordinates; in an orthonormal basis, so that a smaller number of harmonics is a leading part.

    Attributes
    ----------
    powers : tuple of int
        Powers k of the speed.
    matrices : ndarray
        P_k, shape ``(len(powers), d, d)``, d = m (2 harmonics + 1).
    loads : mapping of int to ndarray
        F_k ``(d,)`` by power of the speed.
    harmonics, modes : int
        Their numbers.
    wave : float
        2 pi over the period.
    """

    powers: tuple[int, ...]
    matrices: Array
    loads: Mapping[int, Array]
    harmonics: int
    modes: int
    wave: float

    @property
    def size(self) -> int:
        """Number d of unknowns."""
        return self.modes * (2 * self.harmonics + 1)

    def taylor(self, speed: float, orders: int = 1) -> Array:
        """Return the Taylor coefficients of ``sum_k w^k P_k`` at a speed, ``(orders, d, d)``."""
        factors = np.array([_taylor(self.powers, speed, order) for order in range(orders)])
        flat = self.matrices.reshape(len(self.powers), -1)
        return np.asarray(factors @ flat).reshape(orders, self.size, self.size)

    def load(self, speed: float, order: int = 0) -> Array:
        """Return a Taylor coefficient of ``sum_k w^k F_k`` at a speed, ``(d,)``."""
        factors = _taylor(tuple(self.loads), speed, order)
        return np.asarray(np.stack(list(self.loads.values()), axis=1) @ factors)

    def truncated(self, harmonics: int) -> Balance:
        """Return the balance of fewer harmonics."""
        size = self.modes * (2 * harmonics + 1)
        return replace(
            self,
            matrices=np.ascontiguousarray(self.matrices[:, :size, :size]),
            loads={k: v[:size] for k, v in self.loads.items()},
            harmonics=harmonics,
        )

    def derivatives(self, x: Array, order: int) -> Array:
        """Return the Fourier series ``(d, ...)`` of the derivative of some order."""
        shape = x.shape
        series = x.reshape(-1, self.modes, *shape[1:])
        numbers = self.wave * np.arange(1, len(series) // 2 + 1)
        numbers = numbers.reshape(-1, *(1,) * (series.ndim - 1))
        for _ in range(order):
            turned = np.zeros_like(series)
            turned[1::2] = numbers * series[2::2]
            turned[2::2] = -numbers * series[1::2]
            series = turned
        return series.reshape(shape)


def _taylor(powers: tuple[int, ...], speed: float, order: int) -> Array:
    """Return what each power of the speed gives to a Taylor coefficient."""
    return np.array([comb(k, order) * speed ** (k - order) if k >= order else 0.0 for k in powers])


def balance(condensed: Condensed, harmonics: int) -> Balance:
    """Return the balanced equation of a condensed system.

    Parameters
    ----------
    condensed : Condensed
        On at least four times as many angles as harmonics.
    harmonics : int
        Their number.
    """
    wave = 2.0 * np.pi / condensed.period
    matrices: dict[int, Array] = {}
    for (power, order), samples in condensed.operator.items():
        block = _products(samples, harmonics)
        for _ in range(order):
            block = _after_derivative(block, wave)
        matrices[power] = matrices[power] + block if power in matrices else block
    modes = condensed.basis.shape[-1]
    size = modes * (2 * harmonics + 1)
    powers = tuple(sorted(matrices))
    whole = np.empty((len(powers), size, size))
    for k, power in enumerate(powers):
        whole[k] = matrices[power].transpose(0, 2, 1, 3).reshape(size, size)
    loads = {
        power: series(samples, harmonics).reshape(-1)
        for power, samples in sorted(condensed.load.items())
    }
    return Balance(powers, whole, loads, harmonics, modes, wave)


def series(samples: Array, harmonics: int) -> Array:
    """Return coefficients ``(2 harmonics + 1, ...)`` in the orthonormal basis, of even samples.

    The basis: 1, then sqrt(2) cos and sqrt(2) sin of each harmonic in turn.
    """
    spectrum = np.fft.rfft(samples, axis=0)[: harmonics + 1] / len(samples)
    out = np.empty((2 * harmonics + 1, *samples.shape[1:]))
    out[0] = spectrum[0].real
    out[1::2] = np.sqrt(2.0) * spectrum[1:].real
    out[2::2] = -np.sqrt(2.0) * spectrum[1:].imag
    return out


def samples_table(theta: Array, harmonics: int, wave: float) -> Array:
    """Return the orthonormal basis at angles, ``(nt, 2 harmonics + 1)``."""
    phase = wave * theta[:, None] * np.arange(1, harmonics + 1)
    out = np.empty((len(theta), 2 * harmonics + 1))
    out[:, 0] = 1.0
    out[:, 1::2] = np.sqrt(2.0) * np.cos(phase)
    out[:, 2::2] = np.sqrt(2.0) * np.sin(phase)
    return out


def _products(samples: Array, harmonics: int) -> Array:
    """Return what multiplication by a periodic matrix is to series, ``(h, h, m, m)``."""
    spectrum = np.fft.rfft(samples, axis=0) / len(samples)
    wanted = 2 * harmonics + 1
    padded = np.zeros((wanted, *samples.shape[1:]), dtype=complex)
    known = min(wanted, len(spectrum))
    padded[:known] = spectrum[:known]
    even, odd = padded.real, -padded.imag
    number: NDArray[np.int64] = np.arange(harmonics + 1)
    apart, together = number[:, None] - number, number[:, None] + number
    sign = np.sign(apart)[..., None, None]
    even_apart, even_together = even[np.abs(apart)], even[together]
    odd_apart, odd_together = odd[np.abs(apart)] * sign, odd[together]
    out = np.empty((wanted, wanted, *samples.shape[1:]))
    out[1::2, 1::2] = (even_apart + even_together)[1:, 1:]
    out[2::2, 2::2] = (even_apart - even_together)[1:, 1:]
    out[1::2, 2::2] = (odd_together - odd_apart)[1:, 1:]
    out[2::2, 1::2] = (odd_together + odd_apart)[1:, 1:]
    half = np.sqrt(0.5)
    out[0, 1::2] = half * (even_apart + even_together)[0, 1:]
    out[1::2, 0] = half * (even_apart + even_together)[1:, 0]
    out[0, 2::2] = half * (odd_together - odd_apart)[0, 1:]
    out[2::2, 0] = half * (odd_together + odd_apart)[1:, 0]
    out[0, 0] = even[0]
    return out


def _after_derivative(block: Array, wave: float) -> Array:
    """Return a block that acts on the derivative as one that acts on the series."""
    out = np.zeros_like(block)
    count = (block.shape[1] - 1) // 2
    numbers = (wave * np.arange(1, count + 1))[:, None, None]
    # The derivative's cosine coefficient is n times the sine's, its sine's -n times the cosine's.
    out[:, 2::2] = numbers * block[:, 1::2]
    out[:, 1::2] = -numbers * block[:, 2::2]
    return out
