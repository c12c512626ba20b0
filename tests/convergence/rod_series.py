"""Terms of a linear periodic system as Fourier series: the same to round-off, quick to sample."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from elastolink.runtime.core.families import LinearPeriodic

# Where neighbouring frequencies nearly meet, modes turn into each other within a small angle.
_MOST = 4096


def tabulated(system: LinearPeriodic) -> LinearPeriodic:
    """Return the system with each term's trigonometric interpolant at even angles."""
    terms = tuple(
        term if term.constant else replace(term, function=_series(term, system.period))
        for term in system.terms
    )
    return replace(system, terms=terms)


def _series(term, period):
    count = 128
    while True:
        values = term(np.linspace(0.0, period, count, endpoint=False))
        half = np.fft.rfft(values, axis=0) / count
        size = np.max(np.abs(half.reshape(len(half), -1)), axis=1)
        if not size.any():
            return np.zeros(values.shape[1:])
        if np.max(size[len(half) * 3 // 4 :]) < 1e-12 * size.max() or count == _MOST:
            break
        count *= 2
    # What is left out, and what the samples cannot tell apart, is near round-off.
    assert np.max(size[len(half) * 3 // 4 :]) < 1e-9 * size.max()
    kept = int(np.flatnonzero(size > 1e-15 * size.max())[-1]) + 1
    half = half[:kept]
    half[1:] *= 2.0
    rate = 2 * np.pi / period * np.arange(kept)

    def function(theta):
        phase = np.multiply.outer(np.asarray(theta), rate)
        return np.tensordot(np.cos(phase), half.real, 1) - np.tensordot(np.sin(phase), half.imag, 1)

    return function
