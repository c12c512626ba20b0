"""Meissner's equation: Hill's equation whose coefficient takes constant values in turn.

On an interval of length t and constant q, ``u'' + q u = 0`` is solved in closed form; the matrix
of a turn is the product over the intervals.  Where there are two of them, the coefficient is even
about the middle of either; over half a turn, from one middle to the other, ``J - 1 = 2 y1' y2``
and ``J + 1 = 2 y1 y2'`` with J the half trace: each boundary is a simple zero of one of four
functions, and the two ends of a region come from different ones.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import log, pi

import numpy as np
from numpy.typing import ArrayLike

from ...generated import hill_meissner
from ..core.errors import bad
from ..core.maxima import bracketed_roots
from .checks import EPS, Array, Index, finite
from .transfer import Exponents, HalfTraces, in_parts, normalised, product

_interval: Callable[..., tuple[Array, Array]] = hill_meissner.interval

# cosh of more leaves the range of doubles; longer intervals are cut.
_STEEPEST = 300.0
# Powers of two that either of two products may gather beside such a matrix.
_HELD = int(1023.0 - _STEEPEST / log(2.0)) // 2
_MOST_INTERVALS = 2**16


@dataclass(frozen=True)
class Meissner:
    """A coefficient f of piecewise constant values, for ``discriminant`` and its like.

    ``discriminant`` and ``characteristic_exponents`` take any number of levels, and
    ``hill_boundaries`` two (Aannaque (7.9)-(7.11), after Meissner).  A smooth f in N steps, the
    method of Pipes and of Hsu (Aannaque 7.2.2), is ``Meissner.of(f(2 pi (arange(N) + 0.5) / N))``.

    Attributes
    ----------
    levels : tuple of float
        Value of f on each interval; the first begins at theta = 0.
    lengths : tuple of float
        Their lengths [rad], together 2 pi.

    Examples
    --------
    >>> import elastolink as el
    >>> print(el.discriminant(el.Meissner(levels=(1.0, -1.0)), lam2=[0.25, 0.6], mu=0.1).stable)
    [False  True]
    """

    levels: tuple[float, ...] = (1.0, -1.0)
    lengths: tuple[float, ...] = (pi, pi)

    # Of f itself, which is exact.
    error = 0.0

    def __post_init__(self) -> None:
        levels, lengths = finite("levels", self.levels), finite("lengths", self.lengths)
        if levels.ndim != 1 or not levels.size or levels.shape != lengths.shape:
            shapes = f"{levels.shape}, {lengths.shape}"
            raise bad("Meissner", shapes, "as many lengths as levels", "give a pair of lists")
        if lengths.min() <= 0.0 or abs(float(lengths.sum()) - 2.0 * pi) > 1e-12 * lengths.size:
            expected = "positive lengths, together 2 pi"
            raise bad("lengths", str(self.lengths)[:60], expected, "scale the angle")
        if lengths.size > _MOST_INTERVALS:
            raise bad("levels", lengths.size, f"at most {_MOST_INTERVALS}", "take fewer")
        object.__setattr__(self, "levels", tuple(levels.tolist()))
        object.__setattr__(self, "lengths", tuple(lengths.tolist()))

    @classmethod
    def of(cls, levels: ArrayLike) -> Meissner:
        """Return f with these levels on intervals of equal length."""
        values = tuple(finite("levels", levels).tolist())
        return cls(values, (2.0 * pi / max(len(values), 1),) * len(values))

    @property
    def mean(self) -> float:
        """Mean of f over a turn."""
        return float(np.dot(self.levels, self.lengths)) / (2.0 * pi)

    def bound(self) -> float:
        """Return the largest size of f."""
        return float(np.abs(self.levels).max())

    def __call__(self, theta: ArrayLike) -> Array:
        """Evaluate f at angles [rad] of any shape."""
        place = np.mod(finite("theta", theta), 2.0 * pi)
        ends = np.cumsum(self.lengths)[:-1]
        return np.asarray(np.take(self.levels, np.searchsorted(ends, place, side="right")))

    def half_trace_with_error(self, lam2: Array, mu: Array) -> HalfTraces:
        """Return half traces and errors at points ``(n,)``; see :class:`.transfer.Transfer`."""
        # Entries of all matrices of a part, so that they stay in the cache.
        return in_parts(self._product, lam2, mu, max(1, 2**16 // len(self.levels)))

    def _product(self, lam2: Array, mu: Array) -> HalfTraces:
        q, t, noise = self._cut(lam2, mu)
        m, error = _matrices(q, t[:, None], noise)
        # Once for the product of matrices, of two terms each.
        error += 2.0 * EPS * np.abs(m)
        before, exponents = _running(m)
        whole, exponent = before[:, :, -1], exponents[-1]
        # What the error of each matrix does to the trace: |after| error |before|.
        after, powers = _running(m.swapaxes(0, 1)[:, :, ::-1])
        last = np.abs(after[:, :, -2::-1].swapaxes(0, 1))
        lost = product(product(last, error), np.abs(before[:, :, :-1]))
        shift = np.minimum(exponents[:-1] + powers[-2::-1] - exponent, 1000)
        total = np.sum(np.ldexp(lost[0, 0] + lost[1, 1], shift), axis=0)
        # The determinant of the whole is 1.
        ahead, aside = whole[0, 0] * whole[1, 1], whole[0, 1] * whole[1, 0]
        unit = np.ldexp(1.0, np.maximum(-2 * exponent, -1074))
        defect = np.abs(ahead - aside - unit) / (np.abs(ahead) + np.abs(aside) + unit)
        return 0.5 * (whole[0, 0] + whole[1, 1]), 0.5 * total, exponent, defect

    def _cut(self, lam2: Array, mu: Array) -> tuple[Array, Array, Array]:
        """Return levels ``(N, n)``, lengths and rounding of the levels, long intervals cut."""
        f, t = np.array(self.levels), np.array(self.lengths)
        moved = np.outer(f, mu)
        q = lam2 + moved
        noise = EPS * (np.abs(lam2) + np.abs(moved) + np.abs(q))
        growth = np.sqrt(np.maximum(-q.min(axis=1, initial=0.0), 0.0)) * t
        parts = np.maximum(np.ceil(growth / _STEEPEST), 1.0)
        if not parts.sum() <= _MOST_INTERVALS:
            expected = f"at most {_MOST_INTERVALS}"
            raise bad("levels", f"{parts.sum():.3g} intervals", expected, "take smaller ones")
        times = parts.astype(int)
        return np.repeat(q, times, axis=0), np.repeat(t / parts, times), np.repeat(noise, times, 0)


def _running(m: Array) -> tuple[Array, Exponents]:
    """Return the products of the first 0 to N of matrices ``(2, 2, N, n)``, and their exponents."""
    _, _, count, points = m.shape
    parts, exponents = np.empty((2, 2, count + 1, points)), np.zeros((count + 1, points), np.int64)
    parts[:, :, 0] = part = np.eye(2)[:, :, None] * np.ones(points)
    # Powers of two are taken out before three such factors could overflow.
    sizes = np.frexp(np.abs(m).max(axis=(0, 1, 3)))[1].tolist()
    exponent, held = exponents[0], 0
    for i, size in enumerate(sizes):
        part, held = product(m[:, :, i], part), held + max(size, 0) + 1
        if held > _HELD:
            (part, exponent), held = normalised(part, exponent), 0
        parts[:, :, i + 1], exponents[i + 1] = part, exponent
    return parts, exponents


def _matrices(q: Array, t: Array, noise: Array) -> tuple[Array, Array]:
    """Return the matrices ``(2, 2, ...)`` of intervals and the errors of their entries."""
    c, s = _interval(q, t)
    turned, stretched = np.abs(q * t * s), np.abs(t * c)
    cosine = EPS * (2.0 * np.abs(c) + turned) + noise * np.abs(t * s)
    # ds/dq is (t c - s) / (2 q), and of the order t^2 s where q is small.
    slope = np.minimum(t * t, 0.5 / np.maximum(np.abs(q), 1e-300)) * (np.abs(s) + stretched)
    sine = EPS * (2.0 * np.abs(s) + stretched) + noise * slope
    lower = np.abs(q) * sine + (EPS * np.abs(q) + noise) * np.abs(s)
    return np.array([[c, s], [-q * s, c]]), np.array([[cosine, sine], [lower, cosine]])


# ---------------------------------------------------------------- boundaries of two levels


def meissner_ends(f: Meissner, mu: Array, n: int) -> tuple[Array, Array, Array]:
    """Return lower and upper end of region n and their error, each ``(m,)``, without damping.

    By bisection on the phase of the solution, which rises with lam2, so that no boundary is missed
    or taken for another.
    """
    if len(f.levels) != 2:
        fix = "discriminant and characteristic_exponents take any number"
        raise bad("Meissner", f"{len(f.levels)} levels", "two", fix)
    levels, lengths = np.array(f.levels), np.array(f.lengths)
    most = float(np.abs(mu).max(initial=0.0))
    if np.sqrt(most * np.ptp(levels)) * pi > 2.0 * _STEEPEST:
        raise bad("mu", most, f"sqrt(mu * jump) * pi <= {2.0 * _STEEPEST:g}", "take less")
    if n == 0:
        root, error = _root(levels, lengths, mu, n, 1, 0)
        return np.full(mu.shape, -np.inf), root, error
    kinds = ((0, 0), (1, 1)) if n % 2 else ((1, 0), (0, 1))
    roots, errors = zip(*(_root(levels, lengths, mu, n, *kind) for kind in kinds), strict=True)
    return np.minimum(*roots), np.maximum(*roots), np.maximum(*errors)


def _root(f: Array, t: Array, mu: Array, n: int, row: int, column: int) -> tuple[Array, Array]:
    """Return the boundary of region n of one kind, with its error, each ``(m,)``.

    There y1 (``column`` 0) or y2 (1), or the slope of it (``row`` 1), vanishes at half a turn.
    """
    # The phase is pi/2 at the start for y1, 0 for y2; at half a turn it is pi, or pi/2 where the
    # slope vanishes, on the lowest boundary.  y2 has its first zero where y1' has its second.
    start, end = 0.5 * pi * (1 - column), 0.5 * pi * (2 - row)
    target = end + (n // 2 - (row < column)) * pi
    reach = np.sort(-np.outer(f, mu), axis=0)
    size = np.abs(reach).max(axis=0)
    low, high = (
        0.25 * n * n + reach[i] + side * (1e-3 + EPS * size) for i, side in ((0, -1), (1, 1))
    )
    # Forty halvings of an interval of a few reach the resolution of doubles.
    for _ in range(40):
        middle = 0.5 * (low + high)
        above = _phase(middle, mu, start, f, t) >= target
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    # Alone between the ends now, but for the round-off of the phase: the factor knows the zero to
    # the last digit.
    wide = (high - low) + 64.0 * EPS * (1.0 + n) * (1.0 + np.abs(high) + size)

    def factor(which: Index, lam2: Array) -> tuple[Array, float]:
        return _factor(lam2, mu[which], row, column, f, t)[0], 0.0

    root, width, _ = bracketed_roots(factor, low - wide, high + wide)
    step = 1e-6 * (1.0 + np.abs(root))
    noise = _factor(root, mu, row, column, f, t)[1]
    ends = [_factor(root + side * step, mu, row, column, f, t)[0] for side in (1.0, -1.0)]
    slope = np.abs(ends[0] - ends[1]) / (2.0 * step)
    return root, noise / np.maximum(slope, 1e-300) + EPS * np.abs(root) + width


def _factor(
    lam2: Array, mu: Array, row: int, column: int, f: Array, t: Array
) -> tuple[Array, Array]:
    """Return what vanishes on a boundary of a kind and its round-off, each ``(m,)``."""
    moved = np.outer(f, mu)
    q = lam2 + moved
    m, error = _matrices(q, 0.5 * t[:, None], EPS * (np.abs(lam2) + np.abs(moved) + np.abs(q)))
    after, before = m[row, :, 1], m[:, column, 0]
    lost = np.abs(after) * error[:, column, 0] + error[row, :, 1] * np.abs(before)
    return np.asarray((after * before).sum(axis=0)), np.asarray(lost.sum(axis=0))


def _phase(lam2: Array, mu: Array, start: float, f: Array, t: Array) -> Array:
    """Return the phase of (y', y) after half a turn, ``(m,)``; it rises with lam2."""
    phase = np.full(lam2.shape, start)
    for level, length in zip(f, 0.5 * t, strict=True):
        q = lam2 + mu * level
        # Where the solution oscillates it turns evenly in (y'/v, y).
        v = np.sqrt(np.maximum(q, 1e-300))
        turned = _stretched(_stretched(phase, v) + v * length, 1.0 / v)
        # Where it does not, it turns by less than half a turn.
        flat = np.minimum(q, 0.0)
        c, s = _interval(flat, length)
        y, slope = np.sin(phase), np.cos(phase)
        moved = np.arctan2(c * y + s * slope, c * slope - flat * s * y)
        moved = moved + 2.0 * pi * np.rint((phase - moved) / (2.0 * pi))
        phase = np.where(q > 0.0, turned, moved)
    return phase


def _stretched(phase: Array, by: Array) -> Array:
    """Return the phase after y is multiplied by a positive factor: its quarter turn stays."""
    turns = np.rint(phase / pi)
    rest = phase - turns * pi
    return np.asarray(turns * pi + np.arctan2(by * np.sin(rest), np.cos(rest)))
