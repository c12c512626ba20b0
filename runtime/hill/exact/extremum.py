"""The largest half trace in an undamped region of Hill's equation, as the exponent it stands for.

In region n the half trace D has one extremum; ``arccosh(max |D|) / (2 pi)`` is the largest Floquet
exponent there, and so the damping that closes the region.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.polynomial import chebyshev as series
from numpy.typing import NDArray

from ...core.chebyshev import analysis, nodes
from ...core.periodic_function import PeriodicFunction
from ..half_trace import discriminant
from ..transfer import EPS

Array = NDArray[np.float64]

# Half the length of the stretch over which a narrow region is resolved, and what narrow means:
# far enough from all nodes that the half trace less its level keeps its digits there.
_STRETCH, _NARROW = 0.25, 0.01
_NODES, _MOST_NODES = 16, 256
# Half traces at a time: beyond some thousand scattered points they would be interpolated.
_CHUNK = 4096
_TAIL = 1e-13
# Beyond this excess of the half trace over its level the exponent is a mere logarithm.
_LOGARITHMIC = 1e12
# How far the logarithm of the half trace may go, and the most halvings that look for its scale.
_RANGE, _HALVINGS = 600.0, 40


def largest(
    f: PeriodicFunction, n: int, mu: Array, ends: tuple[Array, Array], slack: Array
) -> Array:
    """Return the largest exponent, the lam2 at which it stands and its error, shape ``(3, n)``.

    Parameters
    ----------
    f : PeriodicFunction
        The coefficient function.
    n : int
        Number of the region, at least 1.
    mu : ndarray, shape (n,)
        Factors of f.
    ends : (low, high)
        The undamped boundaries there.
    slack : ndarray, shape (n,)
        Their error.
    """
    low, high = ends
    found = np.zeros((3, mu.size))
    narrow = high - low < _NARROW
    for these, solve in ((narrow, _narrow), (~narrow, _wide)):
        if these.any():
            found[:, these] = solve(f, n, mu[these], low[these], high[these], slack[these])
    return found


def _excess(
    f: PeriodicFunction, n: int, lam2: Array, mu: Array, drag: Array | float = 0.0
) -> tuple[Array, Array]:
    """Return ``(|D| - 1) exp(-2 pi drag)`` inside the region (negative beyond it) and its error."""
    shape = lam2.shape
    x, y, k = (np.broadcast_to(item, shape).ravel() for item in (lam2, mu, drag))
    value, error = np.empty(x.size), np.empty(x.size)
    for start in range(0, x.size, _CHUNK):
        part = slice(start, start + _CHUNK)
        found = discriminant(f, x[part] + np.square(k[part]), y[part], k[part])
        value[part], error[part] = found.value, found.error
    sign = 1.0 if n % 2 == 0 else -1.0
    return (sign * value - np.exp(-2.0 * np.pi * k)).reshape(shape), error.reshape(shape)


def _scale(f: PeriodicFunction, n: int, mu: Array, low: Array, high: Array) -> Array:
    """Return exponents that keep the half traces of wide regions in the range of doubles."""
    found = np.zeros(mu.size)
    # No solution grows faster than where the coefficient is at its most negative.
    top = np.sqrt(np.maximum(np.abs(mu) * f.bound() - low, 0.0))
    left = np.flatnonzero(2.0 * np.pi * top > _RANGE)
    bottom = np.zeros(mu.size)
    for _ in range(_HALVINGS):
        if not left.size:
            break
        lam2 = 0.5 * (low + high)[left] + 0.5 * (high - low)[left] * nodes(_NODES)[:, None]
        size = _excess(f, n, lam2, mu[left], found[left])[0].max(axis=0)
        over, under = ~(size < np.exp(_RANGE)), size < np.exp(-_RANGE)
        bottom[left[over]], top[left[under]] = found[left[over]], found[left[under]]
        left = left[over | under]
        found[left] = 0.5 * (bottom + top)[left]
    return found


def _exponent(excess: Array) -> Array:
    """Return ``arccosh(1 + x) / (2 pi)`` without cancellation, and without overflow."""
    few = np.minimum(excess, _LOGARITHMIC)
    near = np.log1p(few + np.sqrt(few * (2.0 + few)))
    # log(2 + 2 x) from here on; the next term is 1 / (4 x^2).
    far = np.log(np.maximum(excess, 1.0)) + np.log(2.0) + 1.0 / np.maximum(excess, 1.0)
    return np.asarray(np.where(excess > _LOGARITHMIC, far, near) / (2.0 * np.pi))


def _logarithm(x: Array) -> Array:
    """Return ``arccosh(x) / (2 pi)`` for a large x of which a factor was taken out."""
    return np.asarray(np.log(2.0 * np.maximum(x, np.finfo(float).tiny)) / (2.0 * np.pi))


def _narrow(f: PeriodicFunction, n: int, mu: Array, low: Array, high: Array, slack: Array) -> Array:
    """Return K, the lam2 of the largest half trace and the error of K for narrow regions.

    ``|D| - 1 = (lam2 - low)(high - lam2) g`` with g smooth across the region: g comes from points
    well outside, where nothing cancels, and the width from the two ends.
    """
    centre, half = 0.5 * (low + high), 0.5 * (high - low)
    t = nodes(_NODES)[:, None]
    lam2 = centre + _STRETCH * t
    value, error = _excess(f, n, lam2, mu)
    product = (lam2 - low) * (high - lam2)
    c = analysis(_NODES) @ (value / product)
    tail = np.abs(c[-2:]).sum(axis=0) + np.max(np.abs(error / product), axis=0)
    slope = series.chebder(c)
    place = np.zeros_like(centre)
    for _ in range(6):
        x = place * half / _STRETCH
        g, rise = _at(c, x), _at(slope, x) / _STRETCH
        place = 0.5 * (1.0 - place * place) * half * rise / g
    g = np.maximum(_at(c, place * half / _STRETCH), 0.0)
    k = _exponent(half * half * (1.0 - place * place) * g)
    rate = np.sqrt(2.0 * g) / (2.0 * np.pi)
    figure = rate * slack + 0.5 * k * tail / np.maximum(g, EPS) + 4.0 * EPS * k
    return np.stack([k, centre + place * half, figure])


def _wide(f: PeriodicFunction, n: int, mu: Array, low: Array, high: Array, slack: Array) -> Array:
    """Do the same for wide regions: the half trace is interpolated across the region itself."""
    centre, half = 0.5 * (low + high), 0.5 * (high - low)
    count, out = _NODES, np.empty((3, mu.size))
    drag = _scale(f, n, mu, low, high)
    left = np.arange(mu.size)
    while left.size:
        m, h = centre[left], half[left]
        value, error = _excess(f, n, m + h * nodes(count)[:, None], mu[left], drag[left])
        c = analysis(count) @ value
        tail, most = np.abs(c[-2:]).sum(axis=0), np.abs(value).max(axis=0)
        done = (tail <= _TAIL * most + error.max(axis=0)) | (count >= _MOST_NODES)
        if done.any():
            place = _peak(c[:, done])
            x = np.maximum(_at(c[:, done], place), 0.0)
            figure = tail[done] + error[:, done].max(axis=0) + 4.0 * EPS * most[done]
            k, steep = _exponent(x), np.sqrt(x) * np.sqrt(2.0 + x)
            scaled = drag[left[done]] > 0.0
            k = np.where(scaled, drag[left[done]] + _logarithm(x), k)
            steep = np.where(scaled, x, steep)
            reply = figure / np.maximum(2.0 * np.pi * steep, np.where(scaled, 0.0, EPS))
            out[:, left[done]] = k, m[done] + h[done] * place, reply + 4.0 * EPS * k
        left, count = left[~done], 2 * count
    return out


def _at(c: NDArray[Any], x: Array) -> Array:
    """Evaluate one Chebyshev series per point."""
    return np.asarray(series.chebval(x, c, tensor=False))


def _peak(c: Array) -> Array:
    """Return the place of the largest value of each series on [-1, 1]."""
    grid = np.linspace(-1.0, 1.0, 8 * len(c) + 1)
    values = np.asarray(series.chebval(grid, c))
    place: Array = grid[np.argmax(values, axis=1)]
    first, second = series.chebder(c), series.chebder(c, 2)
    step = 2.0 / (8 * len(c))
    for _ in range(4):
        bend = _at(second, place)
        move = np.where(bend < 0.0, -_at(first, place) / np.where(bend < 0.0, bend, 1.0), 0.0)
        place = np.asarray(np.clip(place + np.clip(move, -step, step), -1.0, 1.0))
    return place
