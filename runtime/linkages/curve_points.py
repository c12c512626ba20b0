"""Cusps and double points of a closed path, solved to round-off."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import pi
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from .circuits import Circuit, Complex, Taylor
from .linkage import EPS, TURN, Array

# A path: parameters, shape (n,), and order, to the series of the place (x + i y) there.
Path = Callable[[Array, int], Taylor]

_UNIFORM = 720
# Samples draw near a sharp turn by this ratio, down to this distance.
_GRADING, _NEAREST = 1.6, 1e-9
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


def double_points(path: Path, seeds: Array, stops: Array, size: float) -> Doubles:
    """Return the double points of one closed path (crunodes), each once.

    By Newton's method from pairs of parameters near them.  The equation is ``(z(s1) - z(s2)) /
    sin((s1 - s2)/2) = 0``, so that the trivial solution s1 = s2 does not draw it in.  Loops so
    small that it loses digits stay as they are, but for those that a cusp has swallowed.  Round-off
    is measured by a length of the given size.
    """
    pairs = seeds.T.copy()
    wide = np.abs(np.sin(0.5 * (pairs[1] - pairs[0]))) > 1e-2
    for _ in range(40 if np.any(wide) else 0):
        stepped = _newton(path, *pairs[:, wide])
        moved = np.max(np.abs(stepped - pairs[:, wide]))
        pairs[:, wide] = stepped
        if moved < 1e-13:
            break
    beside = np.abs(np.sin(0.5 * (pairs[:, :, None] - stops)))
    swallowed = np.any(np.all(beside < 1e-3, axis=0), axis=1)
    apart = np.abs(np.sin(0.5 * (pairs[1] - pairs[0]))) > 1e-6
    pairs = pairs[:, apart & ~swallowed] % TURN
    one, two = (path(s, 1) for s in pairs)
    gap = np.abs(one.c[0] - two.c[0])
    good = (gap <= 64 * EPS * size) & (_crossing_sine(one, two) > 64 * EPS)
    order = np.flatnonzero(good)
    return _each_once(path, pairs.T[order[np.argsort(gap[order], kind="stable")]])


def crossings(motion: Circuit, place: complex) -> Array:
    """Return pairs of parameters (k, 2) at which a point of coupler or block is in one place.

    Of the direction u of the link the crank demands ``2 Re(a u) = M``, the other joint ``2 Re(b u)
    = N``.  Two directions satisfy both where the one is a multiple of the other, ``a = r b`` and
    ``M = r N``: at the real roots r of a polynomial, and at the fixed pivot where r is infinite.
    """
    g, kind = place, motion.linkage.mechanism
    locus = {"four_bar": _four_bar, "slider_crank": _slider_crank, "quick_return": _quick_return}
    places, other = locus[kind](motion.sizes, g)
    pairs = []
    for p in places:
        crank = p.conjugate() * g, abs(p) ** 2 + abs(g) ** 2 - motion.sizes["crank"] ** 2
        factor, level = max(crank, other(p), key=lambda equation: abs(equation[0]))
        cosine = level / (2.0 * abs(factor))
        if not abs(cosine) < 1.0:
            continue
        turns = [complex(cosine, sign * np.sqrt(1.0 - cosine**2)) for sign in (1.0, -1.0)]
        both = [_parameter(motion, p, g, u * factor.conjugate() / abs(factor)) for u in turns]
        if None not in both:
            pairs.append(both)
    return np.array(pairs, dtype=float).reshape(-1, 2)


# Places p at which one equation for u is a multiple of the other, and b, N of the other joint at p.
Locus: TypeAlias = tuple[list[complex], Callable[[complex], tuple[complex, float]]]


def _four_bar(size: Mapping[str, float], g: complex) -> Locus:
    f, n, d = size["frame"], size["follower"], size["coupler"] - g
    square = [abs(d) ** 2, -2.0 * (d * g.conjugate()).real, abs(g) ** 2]
    terms = np.polymul([abs(d) ** 2 - n**2, abs(g) ** 2 - size["crank"] ** 2], square)
    terms = np.polyadd(terms, [f**2 * abs(d) ** 2, f**2 * abs(g) ** 2, 0.0])
    places = [f * r / (r - (g / d).conjugate()) for r in _real_roots(terms)]
    if abs(abs(d) - n) < 1e-6 * n:
        places.append(complex(f))
    return places, lambda p: ((p - f).conjugate() * d, n**2 - abs(p - f) ** 2 - abs(d) ** 2)


def _slider_crank(size: Mapping[str, float], g: complex) -> Locus:
    d, e = size["coupler"] - g, size["offset"]
    ratio = d / g
    least = abs(g) ** 2 - size["crank"] ** 2
    roots = _real_roots([abs(ratio) ** 2 + 2.0 * ratio.real, -2.0 * e, least])
    places = [1j * r * ratio.conjugate() for r in roots]
    return places, lambda p: (-1j * d, 2.0 * (e - p.imag))


def _quick_return(size: Mapping[str, float], g: complex) -> Locus:
    f, least = size["frame"], abs(g) ** 2 - size["crank"] ** 2
    terms = np.polymul([2.0 * g.imag, least], [1.0, 2.0 * g.imag, abs(g) ** 2])
    roots = _real_roots(np.polyadd(terms, [f**2, 0.0, 0.0]))
    places = [1j * r * f / (g.conjugate() - 1j * r) for r in roots]
    if abs(g.imag) < 1e-6 * abs(g):
        places.append(complex(-f))
    return places, lambda p: (-1j * (p + f).conjugate(), -2.0 * g.imag)


def _real_roots(terms: ArrayLike) -> Array:
    """Return the real roots of a polynomial, and those that may be real."""
    roots = np.roots(terms)
    return np.asarray(roots[np.abs(roots.imag) <= 1e-6 * np.abs(roots)].real)


def _parameter(motion: Circuit, p: complex, place: complex, u: complex) -> float | None:
    """Return where on the circuit the link has the direction u with its point at p."""
    pin = p - place * u
    if motion.linkage.mechanism == "four_bar":
        branch = np.sign(((motion.sizes["frame"] - pin).conjugate() * u).imag)
    elif motion.linkage.mechanism == "slider_crank":
        branch = np.sign(u.real)
    else:
        branch = np.sign((u.conjugate() * (pin + motion.sizes["frame"])).real)
    return motion.parameter(pin / motion.sizes["crank"], float(branch))


def _each_once(path: Path, pairs: Array) -> Doubles:
    """Sort pairs of parameters, and leave out those met before."""
    first, second = np.min(pairs, axis=1), np.max(pairs, axis=1)
    one, two = path(first, 1), path(second, 1)
    sine = _crossing_sine(one, two)
    kept: list[int] = []
    for i in range(len(first)):
        # Where the branches nearly touch, the crossing is loose along them.
        slack = 1e-9 + 1e3 * EPS / max(float(sine[i]), EPS)
        a, b = first[kept], second[kept]
        # How far the pairs are apart, either way round.
        ways = [np.maximum(_turn(first[i] - x), _turn(second[i] - y)) for x, y in ((a, b), (b, a))]
        if np.all(np.minimum(*ways) > slack):
            kept.append(i)
    kept.sort(key=lambda i: float(first[i]))
    chosen = np.column_stack([first[kept], second[kept]]).reshape(-1, 2)
    return Doubles(chosen, 0.5 * (one.c[0] + two.c[0])[kept], sine[kept])


def _crossing_sine(one: Taylor, two: Taylor) -> Array:
    product = np.abs(one.c[1]) * np.abs(two.c[1])
    sine = np.abs((one.c[1].conj() * two.c[1]).imag) / np.where(product > 0, product, 1.0)
    return np.asarray(np.where(product > 0, sine, 0.0))


def _turn(x: Array) -> Array:
    return np.asarray(np.abs((x + pi) % TURN - pi))


def _newton(path: Path, first: Array, second: Array) -> Array:
    """Return the next parameters, (2, k)."""
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
    return np.stack([first + x, second + y])
