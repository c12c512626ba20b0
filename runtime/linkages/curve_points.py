"""Cusps and double points of a closed path, found from samples and solved to round-off."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi

import numpy as np

from .circuits import Complex, Taylor
from .linkage import EPS, TURN, Array

# A path: parameters, shape (n,), and order, to the series of the place (x + i y) there.
Path = Callable[[Array, int], Taylor]

_UNIFORM = 720
# Samples draw near a sharp turn by this ratio, down to this distance.
_GRADING, _NEAREST = 1.6, 1e-9
_SERIES = 16
_ODD = range(1, _SERIES, 2)
_MOST_SEEDS = 3000
# A point whose speed falls below this part of its largest is said to stop: a cusp.
_STILL = 1e-11


@dataclass(frozen=True, eq=False)
class Slow:
    """Places at which a path runs slowest: parameter and speed there by the parameter."""

    parameter: Array
    speed: Array
    fastest: float

    @property
    def stops(self) -> Array:
        """The parameters of cusps."""
        return self.parameter[self.speed <= _STILL * self.fastest]


@dataclass(frozen=True, eq=False)
class Doubles:
    """Double points: both parameters (m, 2), the place, the sine between the two branches."""

    parameter: Array
    place: Complex
    sine: Array


def slowest(path: Path, sharp: Array) -> Slow:
    """Return all local minima of the speed.

    The derivative of the squared speed has a simple root at a cusp too, where the speed itself
    has a corner; bisection finds it whatever the speed left there.
    """
    s = _graded(sharp)
    at = path(s, 2)
    rate = _squared_speed_rate(at)
    fastest = float(np.max(np.abs(at.derivative(1))))
    following = np.roll(rate, -1)
    starts = np.flatnonzero((rate < 0) & (following >= 0))
    low, high = s[starts], np.append(s, s[0] + TURN)[starts + 1]
    for _ in range(60):
        middle = 0.5 * (low + high)
        rising = _squared_speed_rate(path(middle, 2)) >= 0
        low, high = np.where(rising, low, middle), np.where(rising, middle, high)
    least = _polished(path, 0.5 * (low + high), low, high)
    return Slow(least % TURN, np.abs(path(least, 1).derivative(1)), fastest)


def _polished(path: Path, s: Array, low: Array, high: Array) -> Array:
    """Take the step to the least speed once more; bisection stops at the noise of its sign."""
    at = path(s, 2)
    first, second = at.derivative(1), at.derivative(2)
    size = np.abs(second) ** 2
    step = np.where(size > 0, -(first * second.conj()).real / np.where(size > 0, size, 1.0), 0.0)
    near = s + step
    better = np.abs(path(near, 1).derivative(1)) < np.abs(first)
    inside = np.abs(step) <= 1e-6 + (high - low)
    return np.where(better & inside, near, s)


def _squared_speed_rate(at: Taylor) -> Array:
    return np.asarray((at.derivative(1).conj() * at.derivative(2)).real)


def _graded(sharp: Array) -> Array:
    """Return uniform parameters, and closer ones about sharp turns; increasing, in one turn."""
    uniform = (np.arange(_UNIFORM) + 0.5) * TURN / _UNIFORM
    levels = int(np.log(TURN / _UNIFORM / _NEAREST) / np.log(_GRADING)) + 1
    steps = TURN / _UNIFORM * _GRADING ** -np.arange(levels)
    near = np.concatenate([steps, [0.0], -steps])
    places = np.concatenate([uniform, (sharp[:, None] + near).ravel()]) % TURN
    return np.unique(places)


def double_points(path: Path, slow: Slow, sharp: Array, size: float) -> Doubles:
    """Return the double points of one closed path (crunodes), each once.

    Segments between samples seed Newton's method where their surroundings - boxes wide enough for
    the arcs - meet.  The equation is ``(z(s1) - z(s2)) / sin((s1 - s2)/2) = 0``, so that the
    trivial solution s1 = s2 does not draw it in.

    Parameters
    ----------
    path : callable
        The path.
    slow : Slow
        Its slowest places: a small loop sits about one of them.
    sharp : ndarray
        Parameters about which the path may turn sharply.
    size : float
        A length to measure round-off by.
    """
    loops, reach = _small_loops(path, slow, size)
    first, second = _seeds(path, _graded(np.concatenate([sharp, slow.parameter])))
    for _ in range(40 if first.size else 0):
        first, second = _newton(path, first, second)
    apart = (second - first + pi) % TURN - pi
    middle, half = first + 0.5 * apart, np.abs(np.sin(0.5 * apart))
    about = np.abs(np.sin(0.5 * (middle[:, None] - slow.parameter)))
    small = np.any((about < reach) & (half[:, None] < 0.5 * reach), axis=1) | (half < 1e-6)
    first, second = first[~small] % TURN, second[~small] % TURN
    one, two = path(first, 1), path(second, 1)
    gap = np.abs(one.c[0] - two.c[0])
    good = (gap <= 64 * EPS * size) & (_crossing_sine(one, two) > 64 * EPS)
    order = np.flatnonzero(good)
    order = order[np.argsort(gap[order], kind="stable")]
    pairs = np.column_stack([first, second])[order]
    return _each_once(path, np.concatenate([loops, pairs]))


def _each_once(path: Path, pairs: Array) -> Doubles:
    """Sort pairs of parameters, and leave out those met before."""
    first, second = np.min(pairs, axis=1), np.max(pairs, axis=1)
    one, two = path(first, 1), path(second, 1)
    sine = _crossing_sine(one, two)
    kept: list[int] = []
    for i in range(len(first)):
        # Where the branches nearly touch, the crossing is loose along them.
        slack = 1e-9 + 1e3 * EPS / max(float(sine[i]), EPS)
        if all(_distance(first, second, i, j) > slack for j in kept):
            kept.append(i)
    kept.sort(key=lambda i: float(first[i]))
    chosen = np.column_stack([first[kept], second[kept]]).reshape(-1, 2)
    return Doubles(chosen, 0.5 * (one.c[0] + two.c[0])[kept], sine[kept])


def _crossing_sine(one: Taylor, two: Taylor) -> Array:
    product = np.abs(one.c[1]) * np.abs(two.c[1])
    sine = np.abs((one.c[1].conj() * two.c[1]).imag) / np.where(product > 0, product, 1.0)
    return np.asarray(np.where(product > 0, sine, 0.0))


def _small_loops(path: Path, slow: Slow, size: float) -> tuple[Array, Array]:
    """Return the small loops about slowest places, (k, 2), and how far each place's series holds.

    With m the middle and t the half-width of a loop, ``(z(m + t) - z(m - t))/(2 t)`` is a series
    in t^2 that begins with z'(m): the difference of two near places never has to be taken.
    """
    c = path(slow.parameter, _SERIES).c
    last = np.maximum(np.abs(c[_SERIES - 1]), 1e-300)
    # Loops up to this half-width in the parameter are solved for as series about their middle.
    reach = np.minimum(0.02, (EPS * size / last) ** (1.0 / (_SERIES - 2)))
    widest = reach**2
    middle, across = slow.parameter, 1j * c[2]
    lift = (across.conj() * c[3]).real
    square = -(across.conj() * c[1]).real / np.where(lift != 0, lift, 1.0)
    for _ in range(12):
        # Beyond the reach of the series there is no small loop.
        square = np.clip(square, -widest, widest)
        value, by_middle, by_square = _loop_series(path(middle, _SERIES).c, square)
        determinant = (by_middle.conj() * by_square).imag
        determinant = np.where(determinant == 0, 1e-300, determinant)
        with np.errstate(over="ignore", invalid="ignore"):
            x = (by_square.conj() * value).imag / determinant
            y = -(by_middle.conj() * value).imag / determinant
        middle = middle + np.clip(np.nan_to_num(x), -reach, reach)
        square = square + np.clip(np.nan_to_num(y), -widest, widest)
    square = np.clip(square, -widest, widest)
    value, _, _ = _loop_series(path(middle, _SERIES).c, square)
    near = np.abs(np.sin(0.5 * (middle - slow.parameter))) < reach
    stands = slow.speed <= _STILL * slow.fastest
    good = (np.abs(value) <= 64 * EPS * size) & (square > 0) & near & ~stands
    # The outer half is left to the search among samples.
    good &= square < 0.25 * widest
    half = np.sqrt(square[good])
    loops = np.column_stack([middle[good] - half, middle[good] + half]) % TURN
    return loops.reshape(-1, 2), reach


def _loop_series(c: Complex, square: Array) -> tuple[Complex, Complex, Complex]:
    """Return the series of a loop in the squared half-width, and its two derivatives."""
    value = sum(c[k] * square ** (k // 2) for k in _ODD)
    by_middle = sum((k + 1) * c[k + 1] * square ** (k // 2) for k in _ODD)
    by_square = sum((k // 2) * c[k] * square ** (k // 2 - 1) for k in _ODD[1:])
    return np.asarray(value), np.asarray(by_middle), np.asarray(by_square)


def _distance(first: Array, second: Array, i: int, j: int) -> float:
    """Return how far two pairs of parameters are apart, either way round."""

    def turn(x: float) -> float:
        return abs((x + pi) % TURN - pi)

    straight = max(turn(first[i] - first[j]), turn(second[i] - second[j]))
    return min(straight, max(turn(first[i] - second[j]), turn(second[i] - first[j])))


def _newton(path: Path, first: Array, second: Array) -> tuple[Array, Array]:
    places, rates = path(np.concatenate([first, second]), 1).c.reshape(2, 2, -1)
    gap = places[0] - places[1]
    half = 0.5 * (first - second)
    sine = np.sin(half)
    sine = np.where(np.abs(sine) < 1e-12, 1e-12, sine)
    slope = 0.5 * gap * np.cos(half) / sine
    a, b = rates[0] - slope, slope - rates[1]
    determinant = (a.conj() * b).imag
    determinant = np.where(determinant == 0, 1e-300, determinant)
    with np.errstate(over="ignore", invalid="ignore"):
        x = (-gap * b.conj()).imag / -determinant
        y = (a.conj() * -gap).imag / determinant
    # The farther the step, the less it can be trusted.
    x, y = (np.clip(np.nan_to_num(step), -0.2, 0.2) for step in (x, y))
    return first + x, second + y


def _seeds(path: Path, s: Array) -> tuple[Array, Array]:
    """Return pairs of parameters near which the path may meet itself."""
    at = path(s, 2)
    z, bend = at.c[0], np.abs(at.derivative(2))
    ends = np.roll(z, -1)
    width = np.diff(np.append(s, s[0] + TURN))
    # Twice the rise of an arc over its chord.
    rise = np.maximum(bend, np.roll(bend, -1)) * width**2 / 4
    low_x = np.minimum(z.real, ends.real) - rise
    high_x = np.maximum(z.real, ends.real) + rise
    low_y = np.minimum(z.imag, ends.imag) - rise
    high_y = np.maximum(z.imag, ends.imag) + rise
    count = len(s)
    meet = (low_x[:, None] <= high_x) & (low_x <= high_x[:, None])
    meet &= (low_y[:, None] <= high_y) & (low_y <= high_y[:, None])
    i, j = np.nonzero(np.triu(meet, k=2))
    inner = (i > 0) | (j < count - 1)
    i, j = i[inner], j[inner]
    gap = _segment_gap(z[i], ends[i], z[j], ends[j])
    near = gap <= rise[i] + rise[j]
    if np.count_nonzero(near) > _MOST_SEEDS:
        # A path that all but retraces itself: the chords that cross say enough.
        near = gap == 0
    i, j = i[near][:_MOST_SEEDS], j[near][:_MOST_SEEDS]
    middle = s + 0.5 * width
    # The middles, and each end with the other's far end: two close crossings draw in one each.
    first = np.concatenate([middle[i], s[i], s[i] + width[i]])
    second = np.concatenate([middle[j], s[j] + width[j], s[j]])
    return first, second


def _segment_gap(a: Complex, b: Complex, c: Complex, d: Complex) -> Array:
    """Return the distance of segments ab and cd, zero where they cross."""

    def from_line(p: Complex, q: Complex, r: Complex) -> Array:
        along = q - p
        square = np.abs(along) ** 2
        share = ((r - p) * along.conj()).real / np.where(square > 0, square, 1.0)
        return np.asarray(np.abs(r - p - np.clip(share, 0, 1) * along))

    def side(p: Complex, q: Complex, r: Complex) -> Array:
        return np.asarray(np.sign(((q - p).conj() * (r - p)).imag))

    ends = (from_line(a, b, c), from_line(a, b, d), from_line(c, d, a), from_line(c, d, b))
    gap = np.minimum.reduce(ends)
    cross = (side(a, b, c) != side(a, b, d)) & (side(c, d, a) != side(c, d, b))
    return np.where(cross, 0.0, gap)
