"""Roots of many scalar functions at once, within brackets."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..transfer import EPS

Array = NDArray[np.float64]


def crossing(
    function: Callable[[Array, NDArray[np.intp]], Array], low: Array, high: Array
) -> Array:
    """Return the roots of functions negative at ``low`` and not at ``high``, Illinois' rule.

    All points advance at once; ``function`` is told which of them it is asked for.
    """
    every = np.arange(low.size)
    a, b = low.copy(), high.copy()
    fa, fb = function(a, every), function(b, every)
    side = np.zeros(low.size, dtype=np.int64)
    x, before = b.copy(), a.copy()
    for _ in range(100):
        resolution = 2.0 * EPS * np.abs(x)
        left = np.flatnonzero((np.abs(x - before) > resolution) & (np.abs(b - a) > resolution))
        if not left.size:
            break
        before[left] = x[left]
        rise = fb[left] - fa[left]
        new = b[left] - fb[left] * (b[left] - a[left]) / np.where(rise == 0.0, 1.0, rise)
        inside = (new >= a[left]) & (new <= b[left])
        x[left] = np.where(inside, new, 0.5 * (a[left] + b[left]))
        value = function(x[left], left)
        below = value < 0.0
        lower, upper = left[below], left[~below]
        # An end that stays twice counts half.
        fb[lower[side[lower] == -1]] *= 0.5
        fa[upper[side[upper] == 1]] *= 0.5
        a[lower], fa[lower], side[lower] = x[lower], value[below], -1
        b[upper], fb[upper], side[upper] = x[upper], value[~below], 1
    return x
