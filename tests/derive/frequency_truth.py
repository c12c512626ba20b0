"""Frequency functions and shapes of a vibrating beam by linear algebra, in many digits.

The general solution is fitted to unit displacements of the ends; forces are its derivatives there.
Rates with the squared frequency are differences, static values Hermite's polynomials.
"""

from collections.abc import Iterator
from functools import lru_cache

import mpmath
import numpy as np
from judging import Exact, Point, exact_at

MODULE = "beam_dynamic_stiffness"
DIGITS = 260  # of the smallest phases 1e-6, differences take 150 of them
STEP = mpmath.mpf(10) ** -50
# Generalised displacements v1, r1, v2, r2; place in the matrix of each function.
PLACES = {"1": (1, 3), "2": (3, 3), "3": (0, 3), "4": (2, 3), "5": (0, 2), "6": (2, 2)}
STATIC = {"1": 2, "2": 4, "3": 6, "4": -6, "5": -12, "6": 12, "7": 1, "8": -1}


def _waves(z, xi):
    """Return the four solutions and their derivatives to the third at a place, by rows."""
    a, fade, grow = z * xi, mpmath.exp(-z * xi), mpmath.exp(-z * (1 - xi))
    c, s = mpmath.cos(a), mpmath.sin(a)
    turns = ((c, s), (-s, c), (-c, -s), (s, -c))
    return [
        [z**k * turns[k][0], z**k * turns[k][1], (-z) ** k * fade, z**k * grow] for k in range(4)
    ]


@lru_cache(maxsize=4096)
def amplitudes(z):
    """Return amplitudes of the solutions, a column for each unit displacement of an end."""
    left, right = _waves(z, mpmath.mpf(0)), _waves(z, mpmath.mpf(1))
    return mpmath.inverse(mpmath.matrix([left[0], left[1], right[0], right[1]]))


@lru_cache(maxsize=4096)
def stiffness(z):
    """Return the matrix of end forces: shear and moment, outward positive at the right end."""
    left, right = _waves(z, mpmath.mpf(0)), _waves(z, mpmath.mpf(1))
    rows = mpmath.matrix([left[3], [-x for x in left[2]], [-x for x in right[3]], right[2]])
    return rows * amplitudes(z)


def plain(z):
    matrix = stiffness(z)
    return {f"F{i}": matrix[place] for i, place in PLACES.items()}


def axial(b):
    """From ``u'' = -b^2 u`` with one end moved: force at it, and at the other."""
    return {"F7": b * mpmath.cos(b) / mpmath.sin(b), "F8": -b / mpmath.sin(b)}


def _rates(function, x, power):
    """Return minus the derivative by ``x^power``."""
    above, below = function(x * (1 + STEP)), function(x * (1 - STEP))
    scale = power * x**power * 2 * STEP
    return {f"G{k[1:]}": -(above[k] - below[k]) / scale for k in above}


def _inertias(function, x, power):
    found = function(x)
    return {f"H{k[1:]}": (STATIC[k[1:]] - found[k]) / x**power for k in found}


def _shapes(z, xi):
    matrix = amplitudes(z)
    waves = _waves(z, xi)
    names = ("value", "slope", "curvature", "third")
    return {
        f"{kind}_{name}": sum(waves[k][j] * matrix[j, column] for j in range(4))
        for kind, column in (("deflection", 2), ("rotation", 3))
        for k, name in enumerate(names)
    }


def _stretch(b, xi):
    return {
        "stretch_value": mpmath.sin(b * xi) / mpmath.sin(b),
        "stretch_slope": b * mpmath.cos(b * xi) / mpmath.sin(b),
    }


def clamped_root(k):
    """Return the k-th root of ``cos z cosh z = 1``, from its equation without growth."""
    return mpmath.findroot(
        lambda z: mpmath.cos(z) - 1 / mpmath.cosh(z), (k + mpmath.mpf(1) / 2) * mpmath.pi
    )


def _count(z):
    near = int(mpmath.floor(z / mpmath.pi - mpmath.mpf(1) / 2))
    return {
        "bending_count": mpmath.mpf(
            sum(1 for k in (near, near + 1) if k > 0 and clamped_root(k) < z) + max(near - 1, 0)
        )
    }


def _axial_count(b):
    return {"axial_count": mpmath.ceil(b / mpmath.pi) - 1}


_FUNCTIONS = {
    "bending": lambda n: plain(n["z"]),
    "bending_rates": lambda n: _rates(plain, n["z"], 4),
    "bending_inertias": lambda n: _inertias(plain, n["z"], 4),
    "axial": lambda n: axial(n["b"]),
    "axial_rates": lambda n: _rates(axial, n["b"], 2),
    "axial_inertias": lambda n: _inertias(axial, n["b"], 2),
    "bending_poles": lambda n: _count(n["z"]),
    "axial_poles": lambda n: _axial_count(n["b"]),
    "bending_shapes": lambda n: _shapes(n["z"], n["xi"]),
    "axial_shapes": lambda n: _stretch(n["b"], n["xi"]),
}


def _phases() -> Iterator[tuple[str, float]]:
    random = np.random.default_rng(51)
    for i in range(60):
        yield f"random {i}", float(10.0 ** random.uniform(-6, 4))
    for value in (1.0, 1.5, 3.0, 4.0):
        for nudge in (-1e-9, 0.0, 1e-9):
            yield f"switch {value:g} {nudge:+g}", value + nudge
    for k in (1, 2, 3, 40, 3000):
        root = float(clamped_root(k))
        for nudge in (-1e-3, -1e-9, 0.0, 1e-9):
            yield f"pole {k} {nudge:+g}", root * (1 + nudge)
    for k in (1, 2, 7, 1000, 3183):
        for nudge in (-1e-12, 0.0, 1e-12):
            yield f"{k} pi {nudge:+g}", k * np.pi * (1 + nudge)


def _points(function: str) -> Iterator[Point]:
    name = "b" if function.startswith("axial") else "z"
    random = np.random.default_rng(52)
    for words, value in _phases():
        if not function.endswith("shapes"):
            counted = function.endswith("poles")
            given = {name: value}
            yield Point(words, {} if counted else given, given if counted else {})
            continue
        near = float(10.0 ** random.uniform(-6, 0))
        for xi in (near, 1.0 - near, float(random.uniform(0, 1))):
            yield Point(f"{words}, place {xi:.3g}", {"xi": xi, name: value})


@lru_cache(maxsize=16)
def exact_frequency_functions(function: str) -> tuple[Exact, ...]:
    """Return exact values, and the sizes that roundings of the inputs justify."""
    return tuple(exact_at(_FUNCTIONS[function], point, DIGITS) for point in _points(function))
