"""How fast a term of a system varies: the Fourier amplitudes of its entries."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..errors import bad

if TYPE_CHECKING:
    from .linear_periodic import Term

Array = NDArray[np.float64]

# Even angles: first and most of them.
_FIRST, _MOST = 256, 4096
# Amplitudes of the upper half, over the largest, that are round-off.
_NOISE = 1e-13
# What the series may differ by from the term, over its size, at angles between.
_ALIKE = 1e-10
# Angles by the golden section, which no wave shares.
_BETWEEN = np.arange(1, 14) * ((np.sqrt(5.0) - 1.0) / 2.0) % 1.0


def term_spectrum(term: Term, expected: tuple[int, ...], period: float) -> Array:
    """Return the largest Fourier amplitude of an entry of a term, per harmonic.

    ``expected`` is the shape of its value at an angle.  Of a constant term there is one; else one
    more than half the angles it took: they are doubled until the upper half is round-off and the
    series meets the term between them.  Values that are not finite, or of a wrong shape for many
    angles, are refused.
    """
    if term.constant:
        value = _checked(term, expected, np.zeros(1))
        largest: Array = np.max(np.abs(value), axis=1)
        return largest
    count = _FIRST
    while True:
        theta = np.linspace(0.0, period, count, endpoint=False, dtype=np.float64)
        table = np.fft.rfft(_checked(term, expected, theta), axis=0) / count
        amplitude: Array = np.max(np.abs(table), axis=1)
        faded = np.max(amplitude[len(amplitude) // 2 :]) <= _NOISE * np.max(amplitude)
        if count == _MOST or (faded and _meets(term, expected, period, table)):
            return amplitude
        count *= 2


def _meets(
    term: Term, expected: tuple[int, ...], period: float, table: NDArray[np.complex128]
) -> bool:
    """Return whether the series gives the term between the samples: no wave was mistaken."""
    values = _checked(term, expected, period * _BETWEEN)
    waves = np.exp(2j * np.pi * _BETWEEN[:, None] * np.arange(len(table)))
    series = 2.0 * (waves @ table).real - table[0].real
    return bool(np.max(np.abs(series - values)) <= _ALIKE * np.max(np.abs(values)))


def _checked(term: Term, expected: tuple[int, ...], theta: Array) -> Array:
    """Return the values as rows; refuse what is not finite, or of a wrong shape."""
    values = np.asarray(term(theta), dtype=float)
    where = f"term {term.array} ({term.scale})"
    if values.shape != (len(theta), *expected):
        raise bad(
            where,
            f"shape {values.shape} for {len(theta)} angles",
            f"{(len(theta), *expected)}",
            "make the function return one array per angle",
        )
    flat = values.reshape(len(values), -1)
    finite = np.all(np.isfinite(flat), axis=1)
    if not np.all(finite):
        raise bad(
            where,
            f"a value that is not finite at crank angle {theta[int(np.argmin(finite))]:.6g}",
            "finite numbers at every angle",
            "check the function, its domain and the geometry",
        )
    return flat
