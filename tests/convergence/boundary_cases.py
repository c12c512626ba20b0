"""Functions, dampings and directions for the tests of the boundaries' orders; all dyadic numbers.

Dyadic, so that doubles hold them exactly and the run-time functions solve the same problem.
"""

import random
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from elastolink.runtime.core.periodic_function import PeriodicFunction
from exact_hill import ExactHarmonics, combine
from hill_functions import functions
from omitted_orders import Curve

ORDERS = (1, 2, 3, 4, 5, 6)
REGIONS = (1, 2, 3, 4, 5, 6)
# Share of the damping that closes the tongue at first order.
SHARES = {"undamped": 0.0, "damped": 0.4, "near critical": 0.98}
# Orders derived: the first one that matters of those left out of order 6 is at most so high.
HIGHEST = 9
_LINKAGES = {"(5,1,5,2)": 8, "(10,1,10,4)": 8, "(2,1,2,2)": 9}


def trigonometric(seed, harmonics, cosines=True, sines=True, mean=True):
    """Return a polynomial of degree ``harmonics`` with random multiples of 1/16."""
    source = random.Random(seed)

    def some(there):
        return (
            Fraction(source.choice([-1, 1]) * source.randint(2, 16), 16) if there else Fraction(0)
        )

    rows = [[some(there) for _ in range(harmonics)] for there in (cosines, sines)]
    return ExactHarmonics.of(some(mean), *rows)


def rough(harmonics):
    """Return a function whose random coefficients fall as slowly as 1/m^1.5."""
    rng = np.random.default_rng(4)
    m = np.arange(harmonics + 1)
    size = 1.0 / (1.0 + m) ** 1.5
    b = rng.uniform(-1, 1, m.size) * size
    b[0] = 0.0
    return PeriodicFunction(rng.uniform(-1, 1, m.size) * size, b)


@cache
def function(name):
    """Return one of the functions by name."""
    if name in _LINKAGES:
        found, count = functions()[f"f3 {name}"], _LINKAGES[name]
        return ExactHarmonics.of(
            float(found.a[0]), found.a[1 : count + 1].tolist(), found.b[1 : count + 1].tolist()
        )
    half = Fraction(1, 2)
    return {
        "mixed": trigonometric(1, 3),
        "mixed, 4 harmonics": trigonometric(2, 4),
        "mixed, 2 harmonics": trigonometric(3, 2),
        "even": trigonometric(4, 3, sines=False),
        "odd": trigonometric(5, 3, cosines=False, mean=False),
        "cosine": ExactHarmonics.of(0, [1]),
        "sine": ExactHarmonics.of(0, [], [half]),
        "second harmonic": ExactHarmonics.of(half, [0, 1], [0, -half]),
        "odd harmonics": ExactHarmonics.of(0, [1, 0, half], [half, 0, -1]),
    }[name]


MIXED = ("mixed", "mixed, 4 harmonics", "mixed, 2 harmonics")
SYMMETRIC = ("even", "odd", "cosine", "sine", "second harmonic", "odd harmonics")
LINKAGES = tuple(_LINKAGES)


def dyadic(value, bits=24):
    return Fraction(round(value * 2**bits), 2**bits)


def curve(parts, n, share=0.0, weights=(1,), highest=HIGHEST):
    """Return the problem on a ray with damping that is a share of the critical one."""
    weights = tuple(map(Fraction, weights))
    real, imaginary = combine(parts, weights).harmonic(n) if n else (0, 0)
    critical = float(real * real + imaginary * imaginary) ** 0.5 / (2 * n) if n else 0.5
    return Curve(tuple(parts), weights, (dyadic(share * critical),), n, highest)


def doubles(f):
    """Return the run-time function with the same coefficients, exactly."""
    a = [float(x) for x in (f.mean, *f.cosine)]
    b = [float(x) for x in (0, *f.sine)]
    same = [Fraction(x) for x in (*a, *b)] == [f.mean, *f.cosine, 0, *f.sine]
    assert same
    return PeriodicFunction(a, b)


PARTS = {
    "two mixed": (trigonometric(11, 2), trigonometric(12, 2)),
    "even and odd": (trigonometric(13, 2, sines=False), trigonometric(14, 2, cosines=False)),
    "one harmonic each": (function("cosine"), function("second harmonic")),
    "three": (trigonometric(15, 1), trigonometric(16, 2), trigonometric(17, 2, sines=False)),
}
RAYS = ((1, Fraction(-5, 8), Fraction(3, 4)), (Fraction(1, 4), 1, Fraction(-1, 2)))


def slow(cases):
    return [pytest.param(*case, marks=pytest.mark.slow) for case in cases]


def closes(name, n, share):
    """Drag closes the region at once where f has no such harmonic."""
    return n > 0 and SHARES[share] > 0.0 and not any(function(name).harmonic(n))
