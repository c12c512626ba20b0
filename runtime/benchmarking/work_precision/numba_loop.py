"""A loop by hand, compiled by numba: fixed steps of the order-8 method of Dormand and Prince."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from .equation import Array

_STAGES = 12


def _sum_series(values: Array, a: Array, b: Array, angle: float) -> None:
    """Enter the values at an angle of Fourier series, a row each."""
    cos, sin = np.cos(angle), np.sin(angle)
    for e in range(len(values)):
        values[e] = a[e, 0]
    c, s = 1.0, 0.0
    for k in range(1, a.shape[1]):
        c, s = c * cos - s * sin, s * cos + c * sin
        for e in range(len(values)):
            values[e] += a[e, k] * c + b[e, k] * s


@cache
def compiled_loop() -> Callable[..., Array] | None:
    """Return the compiled loop, or None where numba is not installed.

    It takes the rows and columns of the entries of L, their cosine and sine coefficients
    ``(entries, harmonics + 1)``, the first harmonic [1/rad], the start ``(m, columns)``, the
    angles and the steps between two of them; it returns the states ``(angles, m, columns)``.
    """
    try:
        import numba
    except ImportError:
        return None
    from scipy.integrate._ivp import dop853_coefficients as published

    stage = np.ascontiguousarray(published.A[:_STAGES, :_STAGES])
    weight = np.ascontiguousarray(published.B[:_STAGES])
    node = np.ascontiguousarray(published.C[:_STAGES])

    def loop(
        rows: Any,
        columns: Any,
        a: Array,
        b: Array,
        wave: float,
        start: Array,
        angles: Array,
        inner: int,
    ) -> Array:
        m, count = start.shape
        found = np.empty((len(angles), m, count))
        found[0] = start
        state, trial = start.copy(), np.empty_like(start)
        slopes = np.zeros((_STAGES, m, count))
        values = np.empty(len(rows))
        for k in range(1, len(angles)):
            h = (angles[k] - angles[k - 1]) / inner
            for step in range(inner):
                theta = angles[k - 1] + step * h
                for s in range(_STAGES):
                    for i in range(m):
                        for c in range(count):
                            total = 0.0
                            for earlier in range(s):
                                total += stage[s, earlier] * slopes[earlier, i, c]
                            trial[i, c] = state[i, c] + h * total
                            slopes[s, i, c] = 0.0
                    _entries(values, a, b, wave * (theta + node[s] * h))
                    for e in range(len(rows)):
                        for c in range(count):
                            slopes[s, rows[e], c] += values[e] * trial[columns[e], c]
                for i in range(m):
                    for c in range(count):
                        total = 0.0
                        for s in range(_STAGES):
                            total += weight[s] * slopes[s, i, c]
                        state[i, c] += h * total
            found[k] = state
        return found

    _entries = numba.njit(_sum_series, fastmath=True)
    compiled: Callable[..., Array] = numba.njit(loop, fastmath=True)
    return compiled
