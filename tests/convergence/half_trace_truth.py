"""Half traces to more digits than doubles hold: a Taylor series in extended precision.

Shares nothing with the solver: steps of the initial value problem, each a power series of high
order whose coefficients follow from those of f by the product rule.
"""

from __future__ import annotations

import numpy as np
from elastolink.runtime.core.periodic_function import PeriodicFunction
from numpy.typing import ArrayLike, NDArray

Real = np.longdouble
Reals = NDArray[np.longdouble]

_TURN = Real("6.283185307179586476925286766559005768394")
_ORDER = 34


def half_traces(f: PeriodicFunction, lam2: ArrayLike, mu: ArrayLike, damping: float = 0.0) -> Reals:
    """Return half traces of y'' + 2 K y' + (lam2 + mu f) y = 0 in extended precision.

    Parameters
    ----------
    f : PeriodicFunction
        Taken as exact.
    lam2, mu : array_like
        Broadcast together.
    damping : float
        K.

    Returns
    -------
    ndarray of longdouble
        On machines whose long double has 64 bits of fraction good to about 1e-17 times the
        growth of the solutions; elsewhere no better than doubles.
    """
    x, y = np.broadcast_arrays(np.asarray(lam2, dtype=float), np.asarray(mu, dtype=float))
    lam, amp = x.ravel().astype(Real) - Real(damping) ** 2, y.ravel().astype(Real)
    size = float(np.abs(lam).max() + np.abs(amp).max() * f.amplitudes.sum())
    steps = int(max(32, 4 * f.harmonics, 8 * np.sqrt(size)))
    h = _TURN / steps
    m = np.arange(f.harmonics + 1).astype(Real)
    powers = np.arange(_ORDER)
    factorials = np.cumprod(np.maximum(powers, 1).astype(Real))
    falling = np.asarray((m * h)[:, None] ** powers / factorials, dtype=Real)
    value = np.stack([np.ones_like(lam), np.zeros_like(lam)])
    slope = value[::-1].copy()
    for step in range(steps):
        series = _taylor(f, m, h * step, falling)
        value, slope = _advance(value, slope, lam, amp, series, h)
    trace: Reals = value[0] + slope[1]
    trace = 0.5 * trace * np.exp(-_TURN * Real(damping))
    return trace.reshape(x.shape)


def _taylor(f: PeriodicFunction, m: Reals, t: Real, falling: Reals) -> Reals:
    """Return the Taylor coefficients of f at t, in units of the step."""
    a, b = f.a.astype(Real), f.b.astype(Real)
    cos, sin = np.cos(m * t), np.sin(m * t)
    out = np.empty(_ORDER, dtype=Real)
    turned = ((cos, sin), (-sin, cos), (-cos, -sin), (sin, -cos))
    for k, (c, s) in enumerate(turned):
        out[k::4] = ((a * c + b * s) @ falling)[k::4]
    return out


def _advance(
    value: Reals, slope: Reals, lam2: Reals, mu: Reals, series: Reals, h: Real
) -> tuple[Reals, Reals]:
    """Advance y and y' of both unit starts, ``(2, n)``, by one step."""
    terms = np.zeros((_ORDER, *value.shape), dtype=Real)
    terms[0], terms[1] = value, slope * h
    for k in range(_ORDER - 2):
        total = lam2 * terms[k] + mu * np.tensordot(series[: k + 1], terms[k::-1], axes=1)
        terms[k + 2] = -h * h * total / ((k + 1) * (k + 2))
    powers = np.arange(_ORDER).astype(Real)
    # The smallest terms first.
    return terms[::-1].sum(axis=0), (powers[::-1, None, None] * terms[::-1]).sum(axis=0) / h
