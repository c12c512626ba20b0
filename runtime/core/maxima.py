"""Local maxima of rows, maxima and zeros of functions within brackets, all brackets at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .trigonometric import resampled

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
# Places within a bracket per pass: each pass keeps a quarter of it.
_WITHIN = 9


def local_maxima(values: Array) -> NDArray[np.intp]:
    """Return the places of the local maxima inside a row; NaN is none, nor what is beside it."""
    inner = values[1:-1]
    places: NDArray[np.intp] = np.flatnonzero((inner > values[:-2]) & (inner >= values[2:])) + 1
    return places


def summits(values: Array, most: int = 32) -> NDArray[np.intp]:
    """Return the places of the local maxima that may be the highest, of a whole turn's samples.

    A sample is lower than the summit beside it by an eighth of the second differences.  Of a row
    that all but stays the same, the highest samples are enough.
    """
    before, after = np.roll(values, 1), np.roll(values, -1)
    lower = np.max(values) - np.max(np.abs(before - 2.0 * values + after))
    tops = np.flatnonzero((values >= before) & (values >= after) & (values >= lower))
    chosen: NDArray[np.intp] = tops[np.argsort(-values[tops], kind="stable")[:most]]
    return chosen


def polished(samples: Array) -> tuple[Array, Array, Array]:
    """Return place, height and error of the summits beside the middle one of five even samples.

    Of samples ``(5, ...)``, by the quartic through them; places are in steps from the middle.  The
    error is a tenth of what the parabola through the inner three has otherwise: at eight samples to
    a half wave the quartic misses a thirtieth of that.
    """
    first, low, middle, high, last = samples
    bend = np.minimum(low - 2.0 * middle + high, -np.finfo(float).tiny)
    start = np.clip(0.5 * (low - high) / bend, -0.5, 0.5)
    rough = middle - 0.25 * (low - high) * start
    slope = (first - 8.0 * low + 8.0 * high - last) / 12.0
    second = (-first + 16.0 * low - 30.0 * middle + 16.0 * high - last) / 12.0
    third = (last - 2.0 * high + 2.0 * low - first) / 2.0
    fourth = first - 4.0 * low + 6.0 * middle - 4.0 * high + last
    place = start
    for _ in range(3):
        rise = slope + place * (second + place * (third / 2.0 + place * fourth / 6.0))
        curve = second + place * (third + place * fourth / 2.0)
        place = np.clip(place - rise / np.where(curve < 0.0, curve, bend), -0.6, 0.6)
    height = middle + place * (
        slope + place * (second / 2.0 + place * (third / 6.0 + place * fourth / 24.0))
    )
    height = np.maximum(height, middle)
    return place, height, 0.1 * np.abs(height - rough)


def largest_size(values: Array) -> tuple[float, float]:
    """Return the largest size of a periodic function, from even samples ``(nt,)``, and its error.

    Between the samples too, by the quartic of :func:`polished`; the error is twice the next two
    terms of Newton's series.  Few samples are interpolated before.  NaN where one is no number.
    """
    if not np.all(np.isfinite(values)):
        return float("nan"), float("inf")
    sizes = np.abs(resampled(values, max(len(values), 256)))
    tops = summits(sizes)
    steps, height, _ = polished(sizes[(tops + np.arange(-2, 3)[:, None]) % len(sizes)])
    best = int(np.argmax(height))
    place, top = float(steps[best]), float(height[best])
    seven = sizes[(tops[best] + np.arange(-3, 4)) % len(sizes)]
    fifth, sixth = np.max(np.abs(np.diff(seven, 5))), np.max(np.abs(np.diff(seven, 6)))
    missed = abs(place * (place**2 - 1.0) * (place**2 - 4.0)) * (
        fifth / 120.0 + abs(place) * sixth / 720.0
    )
    return top, 2.0 * float(missed) + 4.0 * _EPS * top


def turned_by_parabolas(
    first: Array, low: Array, middle: Array, high: Array, last: Array
) -> tuple[Array, Array]:
    """Return the middle ones of five even samples, extremes by parabolas, and what these may miss.

    With s steps from the middle to the extreme, at most a half, the third difference counts
    ``s (1 - s^2)/6`` and the fourth ``s^2 (1 - s^2)/8``.  Beside no extreme nothing is missed.
    """
    bend = low - 2.0 * middle + high
    extreme = ((middle - low) * (middle - high) >= 0) & (bend != 0)
    raised = (high - low) ** 2 / np.where(extreme, 8.0 * bend, 1.0)
    third = np.abs(last - 2.0 * high + 2.0 * low - first) / 32.0
    fourth = np.abs(first - 4.0 * low + 6.0 * middle - 4.0 * high + last) * (3.0 / 128.0)
    return np.where(extreme, middle - raised, middle), np.where(extreme, third + fourth, 0.0)


def narrowed(
    values: Callable[[Array], Array], low: Array, high: Array, passes: int, flat: float = 0.0
) -> tuple[Array, Array]:
    """Return brackets ``(k,)`` narrowed about their largest values.

    ``values`` takes places ``(k, 9)`` and gives values of that shape, NaN where there is none.  It
    ends early where the values in each bracket agree to ``flat``, relative, or it is round-off.
    """
    rows = np.arange(len(low))
    for _ in range(passes if len(low) else 0):
        inside = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, _WITHIN)
        tried = values(inside)
        best = np.argmax(np.where(np.isnan(tried), -np.inf, tried), axis=1)
        low = inside[rows, np.maximum(best - 1, 0)]
        high = inside[rows, np.minimum(best + 1, _WITHIN - 1)]
        settled = np.ptp(tried, axis=1) <= flat * np.abs(tried[rows, best])
        if np.all(settled | (high - low <= 1e-14 * np.maximum(1.0, np.abs(low)))):
            break
    return low, high


Index = NDArray[np.intp]


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
