"""Edges of one tongue each, many at once: the gap of two multipliers, smooth through the edge.

For two multipliers r and s that meet on the unit circle,

    g = 2 - r/s - s/r = -(r - s)^2 / (r s)

is real: positive where both are on the circle, negative where they have left it, and smooth in the
speed, while their moduli start with a square root.  Near a narrow tongue it is a parabola.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.families import LinearPeriodic
from ...periodic import monodromy
from ...periodic.multipliers import conditions
from ...periodic.signatures import form_matrix
from .phase_events import Events

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Flags = NDArray[np.bool_]

_EPS = float(np.finfo(float).eps)
_TOGETHER = 256
_ROUNDS = 40
# Sign of the form, over the unit vector, from which it tells the two multipliers apart.
_TELLING = 1e-5


@dataclass(frozen=True)
class Pair:
    """Two multipliers at each of k places, all arrays of shape ``(k,)``.

    Attributes
    ----------
    gap : ndarray
        g; negative off the circle.
    noise : ndarray
        Absolute error of g.
    ahead : ndarray
        Argument by which the positive one is ahead of the negative one [rad]; 0 off the circle.
    plus, minus : ndarray
        Their arguments [rad].
    blur : ndarray
        Distance within which the two are not told apart.
    """

    gap: Array
    noise: Array
    ahead: Array
    plus: Array
    minus: Array
    blur: Array


class PairFunction:
    """The gap of given pairs of multipliers at given speeds.

    Parameters
    ----------
    system : LinearPeriodic
        Conservative.
    parameters : mapping
        Parameter values; numbers, or arrays of shape ``(k,)``, one value for each pair.
    rtol : float
        Of the monodromy matrices.
    """

    def __init__(
        self, system: LinearPeriodic, parameters: Mapping[str, float | Array], rtol: float
    ) -> None:
        self._system, self._parameters, self._rtol = system, parameters, rtol

    def __call__(self, which: NDArray[np.intp], speed: Array, plus: Array, minus: Array) -> Pair:
        """Return the pairs numbered ``which``, found by where they are expected."""
        parts: list[tuple[Array, ...]] = [(np.zeros(0),) * 6]
        for start in range(0, len(speed), _TOGETHER):
            part = slice(start, start + _TOGETHER)
            values = {
                name: np.asarray(value)[which[part]] if np.ndim(value) else value
                for name, value in self._parameters.items()
            }
            result = monodromy(self._system, speed[part], rtol=self._rtol, **values)
            with np.errstate(over="ignore"):
                scaled = np.ldexp(result.scaled, result.exponent[:, None, None])
            parts.append(_pairs(scaled, result.error, plus[part], minus[part]))
        columns = zip(*parts, strict=True)
        return Pair(*(np.concatenate(column) for column in columns))


def _pairs(matrices: Array, error: Array, plus: Array, minus: Array) -> tuple[Array, ...]:
    m = matrices.shape[-1]
    values, vectors = np.linalg.eig(matrices)
    values, vectors = values.astype(complex), vectors.astype(complex)
    form = np.real(np.diagonal(form_matrix(vectors), axis1=-2, axis2=-1))
    angle = np.angle(values)
    first = np.abs(_wrapped(angle - plus[:, None])) + 9.0 * (form < -_TELLING)
    second = np.abs(_wrapped(angle - minus[:, None])) + 9.0 * (form > _TELLING)
    cost = first[:, :, None] + second[:, None, :]
    # Off the circle the two have the same argument and inverse moduli.
    cost += np.abs(np.log(np.abs(values[:, :, None] * values[:, None, :])))
    cost[:, np.arange(m), np.arange(m)] = np.inf
    best = np.argmin(cost.reshape(len(cost), -1), axis=-1)
    rows = np.arange(len(best))
    i, j = best // m, best % m
    r, s = values[rows, i], values[rows, j]
    gap = np.real(-((r - s) ** 2) / (r * s))
    shift = perturbation_size(matrices, error)
    with np.errstate(invalid="ignore", over="ignore"):
        own = conditions(vectors)
        both = own[rows, i] + own[rows, j]
        sway = np.abs(r - s) * both
    size = np.linalg.norm(matrices, axis=(-2, -1))
    sway = np.where(np.isfinite(sway), np.minimum(sway, 4 * size), 4 * size)
    ahead = np.where(gap > 0.0, _wrapped(np.angle(r) - np.angle(s)), 0.0)
    noise = 2 * shift * sway + 4 * shift**2
    return gap, noise, ahead, np.angle(r), np.angle(s), shift * both


def perturbation_size(matrices: Array, error: Array) -> Array:
    """Return how large the error of matrices is in the Frobenius norm, shape ``(nb,)``.

    ``error`` is the largest error of an entry over the largest entry.
    """
    m = matrices.shape[-1]
    size = m * error * np.max(np.abs(matrices), axis=(-2, -1))
    value: Array = size + 4 * m * _EPS * np.linalg.norm(matrices, axis=(-2, -1))
    return value


def _wrapped(angle: Array) -> Array:
    value: Array = np.mod(angle + np.pi, 2 * np.pi) - np.pi
    return value


@dataclass(frozen=True)
class Edges:
    """Edges of tongues, each array of shape ``(k,)``.

    Attributes
    ----------
    lower, upper : ndarray
        Speeds [rad/s]; equal where the tongue is too narrow to be told from none; NaN where the
        range ended first.
    error : ndarray
        Absolute error of either edge.
    least : ndarray
        Width below which the tongue would not be told from none.
    phase : ndarray
        Argument of the multiplier at the edges, or inside [rad].
    """

    lower: Array
    upper: Array
    error: Array
    least: Array
    phase: Array


def refined_edges(function: PairFunction, events: Events) -> Edges:
    """Return the edges of the tongues in which pairs meet.

    A parabola through three values of g leads to its least value; where that is negative beyond
    its error, both zeros are bracketed and solved for.
    """
    search = _Search(function, events)
    search.run()
    k = len(events.low)
    ends, errors = np.full((2, k), np.nan), np.zeros((2, k))
    phase = np.array(search.phase)
    for side in (0, 1):
        outer = (events.low, events.high)[side]
        known = np.flatnonzero(search.found & np.isfinite(outer))
        roots, error, at = search.edge(known, side)
        ends[side, known], errors[side, known] = roots, error
        phase[known] = at
    closed = ~search.found
    ends[:, closed] = search.bottom[closed]
    errors[:, closed] = 0.5 * search.least[closed]
    return Edges(ends[0], ends[1], np.max(errors, axis=0), search.least, phase)


class _Search:
    """The state of a search for the least gap of each pair."""

    def __init__(self, function: PairFunction, events: Events) -> None:
        self.function, self.events = function, events
        k = len(events.low)
        self.x = np.stack([events.low, events.high])
        self.angles = np.stack([events.plus.T, events.minus.T])
        self.g = np.full((2, k), np.nan)
        self.old = np.full((2, k), np.nan)
        self.bottom = np.array(events.inside)
        self.depth = np.full(k, np.nan)
        self.least = np.zeros(k)
        self.phase = np.zeros(k)
        self.found = np.zeros(k, dtype=bool)
        self.sides = np.zeros((2, k))
        self.slope = np.full(k, np.nan)

    def run(self) -> None:
        """Find for each pair a speed off the circle, or the least gap."""
        blur = np.zeros(len(self.bottom))
        for side in (0, 1):
            index = np.flatnonzero(np.isfinite(self.x[side]))
            pair = self._at(index, self.x[side, index])
            self.g[side, index], self.sides[side, index] = pair.gap, np.sign(pair.ahead)
            blur[index] = np.maximum(blur[index], pair.blur)
            self._keep(side, index, pair)
        with np.errstate(invalid="ignore", divide="ignore"):
            reach = np.sqrt(np.maximum(self.g[0], 0)) + np.sqrt(np.maximum(self.g[1], 0))
            self.slope = reach / (self.x[1] - self.x[0])
            least = 4 * blur / self.slope
        self.least = np.where(np.isfinite(least), least, 0.0)
        begun = np.flatnonzero(np.isfinite(self.bottom))
        self._try(begun, self.bottom[begun])
        active = np.flatnonzero(~self.found & np.all(np.isfinite(self.x), axis=0))
        for _ in range(_ROUNDS):
            if not len(active):
                break
            ended = self._try(active, self._next(active))
            active = active[~ended]

    def _at(self, index: NDArray[np.intp], speed: Array) -> Pair:
        """Evaluate pairs where interpolation between the brackets expects them."""
        low, high = self.x[:, index]
        both = np.isfinite(low) & np.isfinite(high) & (high > low)
        with np.errstate(invalid="ignore", divide="ignore"):
            part = np.where(both, (speed - low) / (high - low), np.where(np.isfinite(low), 0, 1))
        plus, minus = ((1 - part) * a[0, index] + part * a[1, index] for a in self.angles)
        return self.function(index, speed, plus, minus)

    def _keep(self, side: int, index: NDArray[np.intp], pair: Pair) -> None:
        """Remember the arguments at a bracket's end, on the turn of the expected ones."""
        for which, found in enumerate((pair.plus, pair.minus)):
            usual = self.angles[which, side, index]
            self.angles[which, side, index] = usual + _wrapped(found - usual)

    def _next(self, index: NDArray[np.intp]) -> Array:
        """Return where a parabola has its least value, or else where the phases should cross."""
        (low, high), (g_low, g_high) = self.x[:, index], self.g[:, index]
        x3, g3 = self.old[:, index]
        with np.errstate(invalid="ignore", divide="ignore"):
            left, right = np.sqrt(np.maximum(g_low, 0)), np.sqrt(np.maximum(g_high, 0))
            crossing = low + (high - low) * left / (left + right)
            d1, d2 = (g_high - g_low) / (high - low), (g3 - g_low) / (x3 - low)
            curve = (d2 - d1) / (x3 - high)
            vertex = 0.5 * (low + high) - 0.5 * d1 / curve
            usable = np.isfinite(vertex) & (curve > 0)
            usable &= (vertex > low) & (vertex < high)
            place = np.where(usable, vertex, crossing)
        margin = 1e-3 * (high - low)
        place = np.where(np.isfinite(place), place, 0.5 * (low + high))
        value: Array = np.clip(place, low + margin, high - margin)
        return value

    def _try(self, index: NDArray[np.intp], speed: Array) -> Flags:
        """Evaluate new places, move the brackets, and tell which pairs need no more."""
        pair = self._at(index, speed)
        with np.errstate(invalid="ignore", divide="ignore"):
            width = 2 * np.sqrt(pair.noise + np.maximum(-pair.gap, 0)) / self.slope[index]
        off = pair.gap < -pair.noise
        self.found[index] = off
        self.bottom[index], self.phase[index] = speed, pair.plus
        self.depth[index] = pair.gap
        rounding = 8 * _EPS * speed
        on_low = np.sign(pair.ahead) == self.sides[0, index]
        for side, moves in ((0, on_low & ~off), (1, ~on_low & ~off)):
            rows = np.flatnonzero(moves & np.isfinite(self.x[side, index]))
            own = index[rows]
            self.old[0, own], self.old[1, own] = self.x[side, own], self.g[side, own]
            self.x[side, own], self.g[side, own] = speed[rows], pair.gap[rows]
            chosen = Pair(*(getattr(pair, f)[rows] for f in Pair.__dataclass_fields__))
            self._keep(side, own, chosen)
        closed = (pair.gap <= pair.noise) | (self.x[1, index] - self.x[0, index] <= rounding)
        closed &= ~off
        if np.any(closed):
            own = index[closed]
            self.least[own] = np.maximum(width[closed], self.least[own]) + rounding[closed]
        ended: Flags = off | closed
        return ended

    def edge(self, index: NDArray[np.intp], side: int) -> tuple[Array, Array, Array]:
        """Return one edge of open tongues, its error, and the argument there."""
        outer, inner = self.x[side, index], self.bottom[index]
        record: list[Pair] = []

        def gap(rows: NDArray[np.intp], speed: Array) -> tuple[Array, Array]:
            pair = self._at(index[rows], speed)
            record.append(pair)
            return pair.gap, pair.noise

        roots, width, slope = bracketed_roots(
            gap, outer, inner, self.g[side, index], self.depth[index]
        )
        last = self._at(index, roots)
        with np.errstate(divide="ignore", invalid="ignore"):
            error = last.noise / np.abs(slope)
        error = np.where(np.isfinite(error), error, np.abs(outer - inner))
        middle = 0.5 * np.angle(np.exp(2j * last.plus) * np.exp(1j * (last.minus - last.plus)))
        turn = np.exp(1j * middle)
        turn = np.where(np.real(turn * np.exp(-1j * last.plus)) < 0, -turn, turn)
        return roots, error + width + 16 * _EPS * roots, np.angle(turn)


Gap = Callable[[NDArray[np.intp], Array], tuple[Array, Array]]


def bracketed_roots(
    function: Gap, first: Array, second: Array, f_first: Array, f_second: Array
) -> tuple[Array, Array, Array]:
    """Return the zeros of many functions between brackets, by Chandrupatla's rule.

    Parameters
    ----------
    function : callable
        Takes numbers of functions and places, returns values and their errors.
    first, second : ndarray, shape (k,)
        Brackets; the values have opposite signs.
    f_first, f_second : ndarray, shape (k,)
        Values there.

    Returns
    -------
    root, width, slope : ndarray, shape (k,)
        The zero, the width of the last bracket where the value was beyond its error, else 0, and
        the slope between the last bracket's ends.
    """
    a, fa, b, fb = np.array(second), np.array(f_second), np.array(first), np.array(f_first)
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
    a: Array, b: Array, c: Array, fa: Array, fb: Array, fc: Array, index: NDArray[np.intp]
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
