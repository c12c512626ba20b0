"""Roots of the beam with an overhang in many digits, and the points where its modes are judged."""

import inspect
import math
from collections.abc import Iterator
from functools import lru_cache

import mpmath
import numpy as np
import overhang_reference
from elastolink.generated import quick_return_overhang_modes as emitted
from elastolink.runtime.systems.rod import OverhangBasis
from judging import Point

# Of the hyperbolic functions of the 60th root determinants lose some 250.
DIGITS = 320

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
    """Return a root to many digits, next to the computed one."""
    start = OverhangBasis(mode).roots(np.array([place]))[0, -1]
    with mpmath.workdps(DIGITS):
        return overhang_reference.root(mpmath.mpf(place), float(start))


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
