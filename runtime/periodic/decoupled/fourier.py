"""Periodic arrays between their even samples, by their Fourier series."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Harmonics below this part of the largest are round-off.
_KEEP = 4 * float(np.finfo(float).eps)
_REMEMBERED = 4


@dataclass(frozen=True)
class PeriodicSeries:
    """A periodic array: theta ``(nt,)`` [rad] to ``(nt, *shape)``.  Make it with :meth:`of`.

    Attributes
    ----------
    rows : ndarray
        Coefficients of 1, of the cosines and of the sines, shape ``(2 reach + 1, size)``.
    period : float
        Period [rad].
    shape : tuple of int
        Of one array.
    """

    rows: Array
    period: float
    shape: tuple[int, ...]
    _memory: dict[bytes, Array] = field(default_factory=dict, compare=False, repr=False)

    @classmethod
    def of(cls, samples: Array, period: float) -> PeriodicSeries:
        """Return the series through even samples ``(nt, *shape)``."""
        count = len(samples)
        spectrum = np.fft.rfft(samples.reshape(count, -1), axis=0) / count
        size = np.max(np.abs(spectrum), axis=1)
        kept = np.flatnonzero(size > _KEEP * float(np.max(size)))
        reach = min(int(kept[-1]) if len(kept) else 0, count // 2 - 1)
        used = spectrum[: reach + 1]
        rows = np.concatenate([used[:1].real, 2 * used[1:].real, -2 * used[1:].imag])
        return cls(rows, period, samples.shape[1:])

    @property
    def reach(self) -> int:
        """Highest harmonic."""
        return len(self.rows) // 2

    def __call__(self, theta: Array) -> Array:
        """Return the array at angles; those of the last few calls are remembered."""
        key = theta.tobytes()
        found = self._memory.get(key)
        if found is None:
            phase = 2 * np.pi / self.period * np.outer(theta, np.arange(1, self.reach + 1))
            waves = np.concatenate([np.ones((len(theta), 1)), np.cos(phase), np.sin(phase)], axis=1)
            found = (waves @ self.rows).reshape(len(theta), *self.shape)
            while len(self._memory) >= _REMEMBERED:
                self._memory.pop(next(iter(self._memory)), None)
            self._memory[key] = found
        return found


@dataclass(frozen=True)
class Part:
    """One array of a series of several, times a factor: theta ``(nt,)`` to ``(nt, m, m)``."""

    series: PeriodicSeries
    number: int
    factor: float

    def __call__(self, theta: Array) -> Array:
        """Return the array at angles."""
        value: Array = self.factor * self.series(np.asarray(theta, dtype=float))[:, self.number]
        return value
