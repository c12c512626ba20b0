"""Modes of the beam with an overhang in many digits, by cosh and sinh as they stand.

With 320 digits the textbook's shapes lose nothing; derivatives along the support's place are
differences.  And the points at which the emitted functions are judged.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Iterator
from functools import lru_cache

import mpmath
import numpy as np
from elastolink.generated import quick_return_overhang_modes as emitted
from judging import Point

DIGITS = 320
_STEP = mpmath.mpf(10) ** -60
_TRIG = (mpmath.sin, mpmath.cos, lambda v: -mpmath.sin(v), lambda v: -mpmath.cos(v))
_HYP = (mpmath.sinh, mpmath.cosh)


def near(a, x, order):
    """Return a derivative of ``sin x - (sin a / sinh a) sinh x``."""
    return _TRIG[order](x) - mpmath.sin(a) / mpmath.sinh(a) * _HYP[order % 2](x)


def far(b, y, order):
    """Return a derivative by y of the free bay's shape, times ``2 exp(-b)``."""
    first = mpmath.sin(b) + mpmath.sinh(b)
    second = mpmath.cos(b) + mpmath.cosh(b)
    cosines = _TRIG[(order + 1) % 4](y) + _HYP[(order + 1) % 2](y)
    sines = _TRIG[order](y) + _HYP[order % 2](y)
    return 2 * mpmath.exp(-b) * (first * cosines - second * sines)


def determinant(xi, beta):
    """Return the characteristic function over growing factors."""
    a, b = beta * xi, beta * (1 - xi)
    ours = (near(a, a, 1), near(a, a, 2))
    theirs = (-far(b, b, 1), far(b, b, 2))
    return 2 * mpmath.exp(-a) * mpmath.sinh(a) * (ours[0] * theirs[1] - ours[1] * theirs[0])


def slope_of(function, at):
    """Return a central difference that keeps hundreds of digits."""
    return (function(at + _STEP) - function(at - _STEP)) / (2 * _STEP)


@lru_cache(maxsize=256)
def amplitudes(xi, beta):
    """Return both amplitudes of a mode of unit square."""
    a, b = beta * xi, beta * (1 - xi)
    ours, theirs = (near(a, a, 1), near(a, a, 2)), (-far(b, b, 1), far(b, b, 2))
    left = ours[0] * theirs[0] + ours[1] * theirs[1]
    right = ours[0] ** 2 + ours[1] ** 2
    square = (1 - xi) * (right * far(b, mpmath.mpf(0), 0)) ** 2 / 4
    square -= xi * left**2 * near(a, mpmath.mpf(0), 1) * near(a, mpmath.mpf(0), 3) / 2
    return left / mpmath.sqrt(square), right / mpmath.sqrt(square)


@lru_cache(maxsize=256)
def root_rate(xi, beta):
    """Return the relative rate of a root: a quarter of slope times reaction over beta^4."""
    a, b = beta * xi, beta * (1 - xi)
    left, right = amplitudes(xi, beta)
    return (right * far(b, mpmath.mpf(0), 0)) ** 2 / 4 + (
        left**2 * near(a, mpmath.mpf(0), 1) * near(a, mpmath.mpf(0), 3) / 2
    )


def shape(xi, beta, eta, order, side):
    """Return a derivative by eta of the mode on one side of the support."""
    left, right = amplitudes(xi, beta)
    if side == "before":
        return left * beta**order * near(beta * xi, beta * eta, order)
    return right * (-beta) ** order * far(beta * (1 - xi), beta * (1 - eta), order)


def drift(xi, beta, eta, order, side):
    """Return a derivative by eta of the mode's derivative along xi, the root moving with it."""
    rate = root_rate(xi, beta)
    return slope_of(lambda h: shape(xi + h, beta * (1 + rate * h), eta, order, side), mpmath.mpf(0))


# ---------------------------------------------------------------- places and points

HELD_PINNED = (3.926602312047919, 7.068582745628732, 10.210176122813031)  # tan a = tanh a
HELD_FREE = (1.8751040687119611, 4.694091132974175, 7.854757438237613)  # 1 + cos b cosh b = 0
# Where the support meets a node: of slope in both bays, of moment in both, of a free-free mode.
NAMED = {
    "a node of slope": HELD_PINNED[0] / (HELD_PINNED[0] + HELD_FREE[1]),
    "another node of slope": HELD_PINNED[1] / (HELD_PINNED[1] + HELD_FREE[0]),
    "a node of moment": math.pi / (math.pi + HELD_PINNED[0]),
    "a node of the first free-free mode": 0.7758420986,
    "the tip": 1.0,
    "just before the tip": 0.999,
    "1e-9 before the tip": 1.0 - 1e-9,
    "a twentieth": 0.05,
    "a thousandth": 1e-3,
    "the middle": 0.5,
}


def exact_root(place, mode):
    """Return a root to many digits, from the emitted residual's bracket of a double."""
    from elastolink.runtime.systems.rod import overhang_roots

    start = overhang_roots(place, mode)[0, -1]
    with mpmath.workdps(DIGITS):
        root = mpmath.mpf(float(start))
        xi = mpmath.mpf(place)
        for _ in range(4):
            root -= determinant(xi, root) / slope_of(lambda at: determinant(xi, at), root)
        return root


def _cases():
    random = np.random.default_rng(505)
    for i in range(12):
        yield f"random {i}", float(random.uniform(0.03, 1.0)), int(random.integers(1, 61))
    for name, place in NAMED.items():
        for mode in (1, 2, 60):
            yield f"{name}, mode {mode}", place, mode


@lru_cache(maxsize=1)
def _roots():
    return tuple((name, place, float(exact_root(place, mode))) for name, place, mode in _cases())


def _near_points(place):
    return {"the pin": 0.0, "close to the pin": 1e-9, "midway": 0.4 * place, "the support": place}


def _far_points(place):
    found = {"the support": place, "the tip": 1.0}
    if place < 1.0:
        rest = 1.0 - place
        found |= {"midway": place + 0.6 * rest, "close to the tip": 1.0 - 1e-7 * rest}
    return found


def _points(function):
    wanted = tuple(inspect.signature(getattr(emitted, function)).parameters)
    for name, place, beta in _roots():
        base = {"place": place, "beta": beta}
        if function == "characteristic":
            yield Point(f"{name}, a root", base)
            yield Point(f"{name}, off a root", {"place": place, "beta": 0.93 * beta})
            continue
        if function == "end_values":
            yield Point(name, base)
            continue
        values = emitted.end_values(beta, place)
        base |= dict(zip(emitted.RETURNS["end_values"], map(float, values), strict=True))
        points = _near_points(place) if function.endswith("before") else _far_points(place)
        for where, eta in points.items():
            inputs = {**base, "eta": eta}
            yield Point(f"{name}, {where}", {key: inputs[key] for key in wanted})


def _integral_points(function):
    wanted = tuple(inspect.signature(getattr(emitted, function)).parameters)
    cases = _roots()
    for (name, place, beta), (_, _, other) in zip(cases, (*cases[1:], cases[0]), strict=True):
        inputs = {"place": place}
        for suffix, root in (("_1", beta), ("_2", other), ("", beta)):
            values = emitted.end_values(root, place)
            found = dict(zip(emitted.RETURNS["end_values"], map(float, values), strict=True))
            inputs |= {f"{key}{suffix}": value for key, value in (found | {"beta": root}).items()}
        yield Point(name, {key: inputs[key] for key in wanted})


def overhang_points(function: str) -> Iterator[Point]:
    """Yield random and nasty points of one emitted function."""
    return _integral_points(function) if function.endswith("_integrals") else _points(function)
