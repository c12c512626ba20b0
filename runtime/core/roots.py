"""Zeros of many functions at once, each between two places."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_EPS = float(np.finfo(float).eps)


def bracketed_roots(
    function: Callable[[Index, Array], tuple[Array, Array | float]],
    first: Array,
    second: Array,
    values: tuple[Array, Array] | None = None,
) -> tuple[Array, Array, Array]:
    """Return the zeros of many functions between brackets, by Chandrupatla's rule.

    With them the width of the last bracket, 0 where the value is all error, and the slope between
    its ends, each ``(k,)``.  ``function`` takes numbers of functions and places, and returns values
    and their errors; ``values`` are those at the ends, where they are known.
    """
    if values is None:
        every = np.arange(len(first))
        values = function(every, first)[0], function(every, second)[0]
    a, fa, b, fb = np.array(second), np.array(values[1]), np.array(first), np.array(values[0])
    c, fc = np.array(b), np.array(fb)
    part = np.full(len(a), 0.5)
    # Where the value is all error, the bracket says nothing more; the slope is of one before.
    slope = np.divide(fb - fa, b - a, out=np.zeros_like(a), where=b != a)
    width = np.abs(b - a)
    active = np.flatnonzero(width > 0)
    for _ in range(100):
        if not len(active):
            break
        x = a[active] + part[active] * (b[active] - a[active])
        value, noise = function(active, x)
        same = np.sign(value) == np.sign(fa[active])
        c[active] = np.where(same, a[active], b[active])
        fc[active] = np.where(same, fa[active], fb[active])
        rows = active[~same]
        b[rows], fb[rows] = a[rows], fa[rows]
        a[active], fa[active] = x, value
        span = np.abs(b[active] - a[active])
        clear = (np.abs(value) > 8 * noise) & (span > 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            steep = (fb[active] - value) / (b[active] - x)
        slope[active] = np.where(clear, steep, slope[active])
        quiet = np.abs(value) <= 0.5 * noise
        width[active] = np.where(quiet, 0.0, span)
        ended = quiet | (span <= 4 * _EPS * np.abs(x))
        part[active] = _chandrupatla(a, b, c, fa, fb, fc, active)
        active = active[~ended]
    return a, np.minimum(width, np.abs(b - a)), slope


def _chandrupatla(
    a: Array, b: Array, c: Array, fa: Array, fb: Array, fc: Array, index: Index
) -> Array:
    """Return the part of the bracket to go next: inverse quadratic where safe, else one half."""
    xa, xb, xc, ya, yb, yc = (v[index] for v in (a, b, c, fa, fb, fc))
    with np.errstate(divide="ignore", invalid="ignore"):
        xi, phi = (xa - xb) / (xc - xb), (ya - yb) / (yc - yb)
        good = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi)
        part = ya / (yb - ya) * yc / (yb - yc)
        part = part + (xc - xa) / (xb - xa) * ya / (yc - ya) * yb / (yc - yb)
    part = np.where(good & np.isfinite(part), part, 0.5)
    with np.errstate(divide="ignore", invalid="ignore"):
        least = np.minimum(2 * _EPS * np.abs(xa) / np.abs(xb - xa), 0.5)
    return np.clip(part, least, 1 - least)
