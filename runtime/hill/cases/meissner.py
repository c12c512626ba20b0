"""Meissner's equation with two levels: its stability boundaries in closed form.

The coefficient is even about the middle of either interval.  Over half a turn, from one middle to
the other, J_2 - 1 = 2 y1' y2 and J_2 + 1 = 2 y1 y2': each boundary is a simple zero of one of four
functions, and the two ends of a region come from different ones.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....generated import hill_meissner
from ...core.errors import bad
from ...core.results import Check, provenance
from ..exact.matrix import Boundaries, check_regions
from ..half_trace import arguments, finite
from ..transfer import EPS
from .piecewise import piecewise_monodromy

Array = NDArray[np.float64]

_interval: Callable[..., tuple[Array, Array]] = hill_meissner.interval
_half_turn: Callable[..., tuple[Array, ...]] = hill_meissner.half_turn

# cosh of half an interval leaves the range of doubles beyond.
_STEEPEST = 600.0
_BISECTIONS = 80
_GOLDEN = 0.6180339887498949
_LEVEL_LIMIT = 8.0


def meissner_boundaries(
    mu: ArrayLike,
    regions: Sequence[int] = (1, 2),
    levels: tuple[float, float] = (1.0, -1.0),
    lengths: tuple[float, float] = (pi, pi),
    damping: ArrayLike = 0.0,
) -> Boundaries:
    """Return the exact boundaries of y'' + 2 K y' + (lam2 + mu f) y = 0 where f takes two values.

    Parameters
    ----------
    mu : array_like
        Any shape, any sign.
    regions : sequence of int
        Numbers n >= 0.  Region n >= 1 starts at lam2 = n^2/4 less mu times the mean of f; region 0
        reaches from minus infinity.
    levels : tuple of float
        The two values of f.
    lengths : tuple of float
        The lengths of their intervals [rad]; together 2 pi.
    damping : array_like
        K of Smith (7.38), at least zero; broadcasts with mu.

    Returns
    -------
    Boundaries
        As of :func:`hill_boundaries`.  ``error`` estimates the round-off.  The check is the
        distance of the half trace from its boundary level at the ends, over its error figure and
        what the error of the ends explains.

    Raises
    ------
    BadInput
        If an argument is not finite, the lengths are not positive or not together 2 pi, a region
        is not a whole number >= 0, K is negative, or mu is so large that a solution grows by more
        than exp(600).

    Notes
    -----
    Aannaque (7.10), (7.11), after Meissner.  Bisection on the phase of the solution, which rises
    with lam2, so that no boundary is missed or taken for another.  With damping the ends lie
    within the region without it, moved by K^2: J_2 has one extremum there, and passes
    cosh(2 pi K) on either side of it, or nowhere.
    """
    numbers = check_regions(regions)
    (amp, k), shape = arguments(mu=mu, damping=damping)
    amp, k = np.broadcast_to(amp, shape), np.broadcast_to(k, shape)
    f, t = _two(levels, lengths)
    if np.sqrt(np.abs(amp).max(initial=0.0) * np.ptp(f)) * pi > _STEEPEST:
        raise bad("mu", np.abs(amp).max(), f"sqrt(mu * jump) * pi <= {_STEEPEST:g}", "take less")
    flat, drag = amp.ravel(), k.ravel()
    lower = np.empty((len(numbers), flat.size))
    upper, error = np.empty_like(lower), np.empty_like(lower)
    for i, n in enumerate(numbers):
        ends = [_ends(flat, n, kind, f, t) for kind in _kinds(n)]
        found, spread = (np.stack(rows) for rows in zip(*ends, strict=True))
        lower[i] = found.min(axis=0) if n else -np.inf
        upper[i], error[i] = found.max(axis=0), spread.max(axis=0)
        hit = drag > 0.0
        if hit.any():
            sharp = lower[i, hit], upper[i, hit], error[i, hit]
            drawn = _Damped(flat[hit], drag[hit], n, f, t).ends(*sharp)
            lower[i, hit], upper[i, hit], error[i, hit] = drawn
    full = (len(numbers), *shape)
    return Boundaries(
        method="zeros of Meissner's factors",
        error=error.reshape(full),
        error_norm="absolute, entrywise, for either end",
        checks={"half trace at the ends": _check(numbers, flat, drag, (lower, upper), error, f, t)},
        provenance=provenance(),
        lower=lower.reshape(full),
        upper=upper.reshape(full),
        regions=numbers,
        mu=amp,
        damping=k,
    )


def coexistence_points(
    n: int,
    levels: tuple[float, float] = (1.0, -1.0),
    lengths: tuple[float, float] = (pi, pi),
) -> tuple[Array, Array]:
    """Return the points (lam2, mu) other than mu = 0 at which region n has no width.

    There all solutions are of period 2 pi (n even) or change sign after it (n odd): each interval
    holds a whole number of half waves, ``v_1 t_1 = j pi`` and ``v_2 t_2 = (n - j) pi``.

    Parameters
    ----------
    n : int
        Number of the region, from 1.
    levels, lengths : tuple of float
        As in :func:`meissner_boundaries`; the levels must differ.

    Returns
    -------
    lam2, mu : ndarray, shape (n - 1,) or (n - 2,)
        For j from n - 1 down to 1, without the one at mu = 0 where that is among them.

    Raises
    ------
    BadInput
        If n is no whole number from 1, or levels or lengths do not fit.
    """
    (number,) = check_regions((n,))
    if number < 1:
        raise bad("n", n, "a whole number >= 1", "region 0 has no lower end")
    f, t = _two(levels, lengths)
    if f[0] == f[1]:
        raise bad("levels", levels, "two different values", "equal ones give no regions at all")
    j = np.arange(number - 1, 0, -1)
    first, second = (j * pi / t[0]) ** 2, ((number - j) * pi / t[1]) ** 2
    other = j * t[1] != (number - j) * t[0]
    mu = (first - second)[other] / (f[0] - f[1])
    return np.asarray(first[other] - mu * f[0]), np.asarray(mu)


@dataclass(frozen=True)
class _Kind:
    """One of the four functions whose zeros are boundaries.

    Attributes
    ----------
    output : int
        Which of ``y1, y2, y1', y2'`` at half a turn vanishes.
    start : float
        Phase of the solution at the start: pi/2 for y1, 0 for y2.
    end : float
        Phase at the end for the lowest boundary of its kind.
    """

    output: int
    start: float
    end: float


_Y1, _Y2 = _Kind(0, 0.5 * pi, pi), _Kind(1, 0.0, pi)
_Y1_SLOPE, _Y2_SLOPE = _Kind(2, 0.5 * pi, 0.5 * pi), _Kind(3, 0.0, 0.5 * pi)


def _kinds(n: int) -> tuple[_Kind, ...]:
    if n == 0:
        return (_Y1_SLOPE,)
    return (_Y1, _Y2_SLOPE) if n % 2 else (_Y1_SLOPE, _Y2)


def _two(levels: tuple[float, float], lengths: tuple[float, float]) -> tuple[Array, Array]:
    f, t = finite("levels", levels), finite("lengths", lengths)
    for name, values in (("levels", f), ("lengths", t)):
        if values.shape != (2,):
            raise bad(name, f"shape {values.shape}", "two numbers", "use piecewise_monodromy")
    if np.any(t <= 0.0) or abs(float(t.sum()) - 2.0 * pi) > 1e-14 * 2.0 * pi:
        raise bad("lengths", lengths, "positive lengths, together 2 pi", "scale the angle")
    return f, t


def _ends(mu: Array, n: int, kind: _Kind, f: Array, t: Array) -> tuple[Array, Array]:
    """Return the boundary of region n that belongs to one kind, with its error, each ``(m,)``."""
    # y2 has its first zero where y1' has its second.
    order = n // 2 - 1 if kind is _Y2 else n // 2
    target, count = kind.end + order * pi, order + (kind.end == pi)
    reach = np.sort(np.stack([-mu * f[0], -mu * f[1]]), axis=0)
    slack = 1e-3 + EPS * np.abs(reach).max(axis=0)
    low, high = 0.25 * n * n + reach[0] - slack, 0.25 * n * n + reach[1] + slack
    for _ in range(_BISECTIONS // 2):
        middle = 0.5 * (low + high)
        above = _phase(middle, mu, kind, f, t) >= target
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    # Alone between the ends now, but for the round-off of the phase: the sign of the factor knows
    # the zero to the last digit.  Beyond it y is (-1)^j at j pi, y' of the other sign a quarter on.
    wide = (high - low) + 64.0 * EPS * (1.0 + n) * (1.0 + np.abs(high) + np.abs(reach).max(axis=0))
    low, high = low - wide, high + wide
    sign = (-1.0) ** count * (-1.0 if kind.output > 1 else 1.0)
    for _ in range(_BISECTIONS // 2):
        middle = 0.5 * (low + high)
        above = sign * _factor(middle, mu, kind, f, t)[0] > 0.0
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    root = 0.5 * (low + high)
    return root, _root_error(root, mu, kind, f, t) + (high - low)


def _root_error(root: Array, mu: Array, kind: _Kind, f: Array, t: Array) -> Array:
    _, noise = _factor(root, mu, kind, f, t)
    step = 1e-6 * (1.0 + np.abs(root))
    ends = [_factor(root + sign * step, mu, kind, f, t)[0] for sign in (1.0, -1.0)]
    slope = np.abs(ends[0] - ends[1]) / (2.0 * step)
    return np.asarray(noise / np.maximum(slope, 1e-300) + EPS * np.abs(root))


class _Damped:
    """The ends of one damped region, in ``x = lam2 - K^2`` of the equation without damping."""

    def __init__(self, mu: Array, k: Array, n: int, f: Array, t: Array) -> None:
        self.mu, self.k, self.n, self.f, self.t = mu, k, n, f, t
        # cosh(2 pi K) - 1 without cancellation.
        with np.errstate(over="ignore"):
            self.level = 2.0 * np.sinh(pi * k) ** 2

    def ends(self, low: Array, high: Array, error: Array) -> tuple[Array, Array, Array]:
        """Return lower, upper and error from those without damping; NaN where it is closed."""
        shift = self.k * self.k
        if self.n == 0:
            # Below, all levels are under -K^2 and the half trace is above cosh(2 pi K).
            far = -shift - np.max(np.outer(self.f, self.mu), axis=0) - 1e-3 * (1.0 + shift)
            upper, own = self._crossing(high, far)
            return np.full(high.shape, -np.inf), upper + shift, own + error + EPS * shift
        top = self._top(low, high)
        open_ = self._above(top)[0] > self.level
        sides = [self._crossing(end, top) for end in (low, high)]
        own = np.maximum(sides[0][1], sides[1][1]) + error + EPS * shift
        found = sides[0][0] + shift, sides[1][0] + shift, own
        lower, upper, spread = (np.where(open_, values, np.nan) for values in found)
        return lower, upper, spread

    def _above(self, x: Array) -> tuple[Array, Array]:
        """Return ``(-1)^n J - 1`` and its round-off."""
        kinds = _kinds(self.n) if self.n else (_Y1_SLOPE, _Y2)
        (a, da), (b, db) = (_factor(x, self.mu, kind, self.f, self.t) for kind in kinds)
        sign = -2.0 if self.n % 2 else 2.0
        with np.errstate(over="ignore", invalid="ignore"):
            return sign * a * b, 2.0 * (np.abs(a) * db + np.abs(b) * da)

    def _top(self, low: Array, high: Array) -> Array:
        """Return where the half trace is farthest out, by golden section."""
        for _ in range(_BISECTIONS):
            width = high - low
            left, right = low + (1.0 - _GOLDEN) * width, low + _GOLDEN * width
            rising = self._above(left)[0] < self._above(right)[0]
            low, high = np.where(rising, left, low), np.where(rising, high, right)
        return 0.5 * (low + high)

    def _crossing(self, outer: Array, inner: Array) -> tuple[Array, Array]:
        """Return where the level is passed between an edge and the inside, and its error."""
        edge, inside = outer, inner
        for _ in range(_BISECTIONS):
            middle = 0.5 * (outer + inner)
            above = self._above(middle)[0] > self.level
            outer, inner = np.where(above, outer, middle), np.where(above, middle, inner)
        root, span = 0.5 * (outer + inner), np.abs(inside - edge)
        value, noise = self._above(root)
        noise = noise + EPS * (1.0 + 2.0 * pi * self.k) * self.level
        step = 1e-6 * span
        slope = np.abs(self._above(root + step)[0] - self._above(root - step)[0])
        slope = slope / np.maximum(2.0 * step, 1e-300)
        # At the tip the end depends on the level as a square root.
        tip = span * np.sqrt(noise / np.maximum(np.abs(value), 1e-300))
        moved = np.minimum(noise / np.maximum(slope, 1e-300), np.maximum(tip, 0.0))
        return root, moved + EPS * np.abs(root)


def _factor(lam2: Array, mu: Array, kind: _Kind, f: Array, t: Array) -> tuple[Array, Array]:
    """Return the value of a factor and its round-off, each ``(m,)``."""
    q = lam2 + np.outer(f, mu)
    half = 0.5 * t
    (c1, s1), (c2, s2) = (_interval(q[i], half[i]) for i in (0, 1))
    value = _half_turn(c1, s1, q[0], c2, s2, q[1])[kind.output]
    # The levels round at the size of their parts; cosine and sine at that of their argument.
    own = EPS * (np.abs(lam2) + np.abs(np.outer(f, mu)) + np.abs(q))
    spread = []
    for i, (c, s) in enumerate(((c1, s1), (c2, s2))):
        moved = own[i] * half[i]
        cosine = EPS * np.abs(c) + moved * np.abs(s)
        sine = EPS * np.abs(s) + moved * half[i] * (np.abs(s) + half[i] * np.abs(c))
        spread.append((np.abs(c), np.abs(s), cosine, sine))
    (a1, b1, da1, db1), (a2, b2, da2, db2) = spread
    size = np.abs(q)
    noise = (
        a1 * da2 + a2 * da1 + size[0] * (b1 * db2 + b2 * db1) + own[0] * b1 * b2,
        a1 * db2 + b2 * da1 + a2 * db1 + b1 * da2,
        size[0] * (a2 * db1 + b1 * da2)
        + size[1] * (a1 * db2 + b2 * da1)
        + own[0] * b1 * a2
        + own[1] * a1 * b2,
        a1 * da2 + a2 * da1 + size[1] * (b1 * db2 + b2 * db1) + own[1] * b1 * b2,
    )
    return np.asarray(value), np.asarray(noise[kind.output])


def _phase(lam2: Array, mu: Array, kind: _Kind, f: Array, t: Array) -> Array:
    """Return the phase of (y', y) after half a turn, ``(m,)``; it rises with lam2."""
    phase = np.full(lam2.shape, kind.start)
    for level, length in zip(f, 0.5 * t, strict=True):
        q = lam2 + mu * level
        phase = np.where(q > 0.0, _turned(phase, q, length), _moved(phase, q, length))
    return phase


def _turned(phase: Array, q: Array, length: float) -> Array:
    """Advance the phase where the solution oscillates: in (y'/v, y) it turns evenly."""
    v = np.sqrt(np.maximum(q, 1e-300))
    even = _stretched(phase, v) + v * length
    return _stretched(even, 1.0 / v)


def _stretched(phase: Array, by: Array) -> Array:
    """Return the phase after y is multiplied by a positive factor: its quarter turn stays."""
    turns = np.rint(phase / pi)
    rest = phase - turns * pi
    return np.asarray(turns * pi + np.arctan2(by * np.sin(rest), np.cos(rest)))


def _moved(phase: Array, q: Array, length: float) -> Array:
    """Advance the phase where the solution does not oscillate: by less than half a turn."""
    c, s = _interval(np.minimum(q, 0.0), length)
    y, slope = np.sin(phase), np.cos(phase)
    found = np.arctan2(c * y + s * slope, c * slope - np.minimum(q, 0.0) * s * y)
    return np.asarray(found + 2.0 * pi * np.rint((phase - found) / (2.0 * pi)))


def _check(
    regions: tuple[int, ...],
    mu: Array,
    k: Array,
    ends: tuple[Array, Array],
    error: Array,
    f: Array,
    t: Array,
) -> Check:
    """Compare the half trace at the ends with its level, by the whole intervals' matrices."""
    worst, level = 0.0, 0.5 * (1.0 + np.exp(-4.0 * pi * k))
    for i, n in enumerate(regions):
        for found in ends if n else ends[1:]:
            # Closed regions drop out; so does what grows beyond all doubles.
            open_ = np.isfinite(found[i])
            q = found[i, open_, None] + np.outer(mu[open_], f)
            step, drag = error[i, open_, None], k[open_]
            there, later, earlier = (
                piecewise_monodromy(q + sign * step, t, drag) for sign in (0.0, 1.0, -1.0)
            )
            with np.errstate(invalid="ignore"):
                gap = np.abs(there.half_trace - (-1.0) ** n * level[open_])
                moved = np.abs(later.half_trace - there.half_trace)
                moved += np.abs(earlier.half_trace - there.half_trace)
                share = np.nan_to_num(gap / (there.error + moved + EPS))
            worst = max(worst, float(np.max(share, initial=0.0)))
    return Check(worst, _LEVEL_LIMIT)
