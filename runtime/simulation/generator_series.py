"""Fourier series of a generator over the crank angle, sampled once and checked."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..core.trigonometric import even_angles
from ..periodic.first_order import CanonicalForm

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_EPS = float(np.finfo(float).eps)
# Samples of a period: fewest, most, and most numbers in all of them.
_FEWEST, _MOST, _MOST_FLOATS = 64, 8192, 2**24
# Harmonic that cannot fall to round-off within as many samples where it still counts.
_TOO_HIGH = 2000
# Share of an entry's size that its highest harmonics may hold: round-off of the terms; where they
# no longer fall, that of an ill-conditioned mass; and what may be missed between the samples.
_RESOLVED, _LEVEL, _MET = 4e-15, 1e-13, 1e-13
# How far noise stands above its middle.
_ABOVE = 10.0
# An entry counts as large as this share of its row and its column at the least.
_LEAST = 1e-2
# The same of the largest rate of the system.
_SHARE = 0.1
# Powers of the angle that an expansion may take, each over its factorial.
_EXPONENTS = np.arange(29.0)
_FACTORIALS = np.concatenate([[1.0], np.cumprod(_EXPONENTS[1:])])
# Angles between the samples, by the golden section: they share no symmetry with a wave.
_TRIED = 5


@dataclass(frozen=True)
class GeneratorSeries:
    """The generator of one system as a Fourier series.

    Attributes
    ----------
    mean : ndarray
        Shape ``(m m,)``.
    waves : ndarray of complex
        Twice the coefficients of harmonics 1, 2, ..., shape ``(r, m m)``.
    period : float
        Of the coefficients [rad].
    size : int
        m.
    missed : float
        Largest difference from the generator at angles between the samples, over ``tops``.
    tops : ndarray
        Sizes that errors of the entries are weighed by, ``(m m,)``.
    """

    mean: Array
    waves: ComplexArray
    period: float
    size: int
    missed: float
    tops: Array

    def __call__(self, theta: Array) -> Array:
        """Return the generator at crank angles ``(nt,)``, shape ``(nt, m, m)``."""
        value: Array = self.mean + self._phases(theta) @ _real_rows(self.waves)
        return value.reshape(len(theta), self.size, self.size)

    def powers(self, half: float) -> int | None:
        """Return how many powers of the angle expansions about middles take; None for too many.

        Parameters
        ----------
        half : float
            Half the length of a stretch [rad].
        """
        left_out = self._shares @ (self._rates[:, None] * half) ** _EXPONENTS / _FACTORIALS
        enough = np.flatnonzero(left_out <= 0.5 * _EPS)
        return max(1, int(enough[0])) if len(enough) else None

    @cached_property
    def _rates(self) -> Array:
        rates: Array = (2 * np.pi / self.period) * np.arange(1.0, len(self.waves) + 1)
        return rates

    @cached_property
    def _shares(self) -> Array:
        """Largest share of its entry's size that each harmonic has, ``(r,)``."""
        share: Array = np.max(np.abs(self.waves) / self.tops, axis=1, initial=0.0)
        return share

    def _phases(self, theta: Array) -> Array:
        # Within one period the phases keep their digits.
        phase = (theta % self.period)[:, None] * self._rates
        return np.concatenate([np.cos(phase), np.sin(phase)], axis=1)


@dataclass(frozen=True)
class Expansion:
    """The generator about middles of stretches by powers of tau, -1 < tau < 1.

    Attributes
    ----------
    series : GeneratorSeries
        The generator.
    powers : int
        Powers kept.
    rows : ndarray
        From cosines and sines of the middles to the coefficients times half the length of a
        stretch, ``(2 r, powers m m)``.
    mean : ndarray
        What no wave adds to them, ``(powers m m,)``.
    """

    series: GeneratorSeries
    powers: int
    rows: Array
    mean: Array

    def about(self, middles: Array) -> Array:
        """Return coefficients at middles ``(k,)``, side by side: ``(k, m, powers m)``."""
        m = self.series.size
        found = self.mean + self.series._phases(middles) @ self.rows
        return found.reshape(len(middles), m, self.powers * m)


def expansion(series: GeneratorSeries, half: float, powers: int) -> Expansion:
    """Return how to expand a generator about the middles of stretches.

    Parameters
    ----------
    series : GeneratorSeries
        The generator.
    half : float
        Half the length of a stretch [rad].
    powers : int
        Powers of the angle to keep.
    """
    m, reach = series.size, len(series.waves)
    rows = np.empty((2 * reach, m, powers, m))
    mean = np.zeros((m, powers, m))
    mean[:, 0] = half * series.mean.reshape(m, m)
    waves = half * series.waves
    for power in range(powers):
        rows[:, :, power] = _real_rows(waves).reshape(2 * reach, m, m)
        waves = waves * (1j * half / (power + 1) * series._rates[:, None])
    return Expansion(series, powers, rows.reshape(2 * reach, powers * m * m), mean.ravel())


def _real_rows(waves: ComplexArray) -> Array:
    return np.concatenate([waves.real, -waves.imag])


def _weights(form: CanonicalForm, values: Array) -> Array:
    """Return the sizes that errors of entries are weighed by, ``(m m,)``.

    An entry small beside its row and its column counts as a share of them.  In what multiplies
    the motion every entry counts as a share of the largest rate, as round-off of any step does.
    """
    largest = np.max(np.abs(values), axis=0)
    row, column = np.max(largest, axis=1, keepdims=True), np.max(largest, axis=0, keepdims=True)
    tops: Array = np.maximum(largest, _LEAST * np.minimum(row, column))
    n = 2 * form.system.size
    tops[:n, :n] = np.maximum(tops[:n, :n], _SHARE * float(form.rate[0]))
    tops[tops == 0.0] = 1.0
    return tops.ravel()


def generator_series(form: CanonicalForm) -> GeneratorSeries | None:
    """Return the Fourier series of the generator of a batch of one, in the scaled state.

    Parameters
    ----------
    form : CanonicalForm
        A batch of one.

    Returns
    -------
    GeneratorSeries or None
        None where 8192 samples of a period do not resolve the generator to round-off, or would
        take more than 128 MiB.
    """
    period, size = form.system.period, form.size
    if form.reach > _TOO_HIGH:
        return None
    count = max(_FEWEST, min(4 * form.reach, _MOST))
    while count <= _MOST and count * size * size <= _MOST_FLOATS:
        values = form.generator(even_angles(period, count))[0]
        half = np.fft.rfft(values.reshape(count, size * size), axis=0) / count
        tops = _weights(form, values)
        kept = count // 3
        sizes = np.max(np.abs(half) / tops, axis=1)
        noise = float(np.median(sizes[kept:]))
        if np.max(sizes[kept:]) <= max(_RESOLVED, min(_ABOVE * noise, _LEVEL)):
            seen = np.flatnonzero(sizes[:kept] > max(0.25 * _EPS, noise))
            reach = int(seen[-1]) if len(seen) else 0
            met = max(_MET, _ABOVE * noise * float(np.sqrt(count)))
            return _checked(form, half[: reach + 1], tops, met)
        count *= 2
    return None


def _checked(
    form: CanonicalForm, half: ComplexArray, tops: Array, met: float
) -> GeneratorSeries | None:
    """Return the series, if it meets the generator at other angles."""
    period, size = form.system.period, form.size
    series = GeneratorSeries(half[0].real, 2.0 * half[1:], period, size, 0.0, tops)
    theta = period * ((0.5 + np.arange(1.0, _TRIED + 1)) * (np.sqrt(5) - 1) / 2 % 1.0)
    gap = np.max(np.abs(series(theta) - form.generator(theta)[0]), axis=0).ravel()
    missed = float(np.max(gap / tops))
    if not missed <= met:
        return None
    return GeneratorSeries(series.mean, series.waves, period, size, missed, tops)
