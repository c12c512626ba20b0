"""Functions and dampings for the tests of the boundaries' orders; all are dyadic numbers."""

import random
from functools import cache

import numpy as np
from elastolink.runtime.core.periodic_function import PeriodicFunction

# Share of the damping that closes the tongue at first order.
SHARES = (0.0, 0.4, 0.98)


def trigonometric(seed, harmonics, cosines=True, sines=True, mean=True):
    """Return a polynomial of degree ``harmonics`` with random multiples of 1/16."""
    source = random.Random(seed)

    def some(there):
        return source.choice([-1, 1]) * source.randint(2, 16) / 16 if there else 0.0

    a, b = ([some(there) for _ in range(harmonics)] for there in (cosines, sines))
    return PeriodicFunction([some(mean), *a], [0.0, *b])


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
    return {
        "mixed": trigonometric(1, 3),
        "four harmonics": trigonometric(2, 4),
        "even": trigonometric(4, 3, sines=False),
        "odd": trigonometric(5, 3, cosines=False, mean=False),
        "cosine": PeriodicFunction([0.0, 1.0]),
        "sine": PeriodicFunction([0.0], [0.0, 0.5]),
    }[name]


def drag(f, n, share):
    """Return K over mu, a share of what closes region n at first order."""
    return share * float(f.amplitudes[n]) / (2 * n) if 0 < n <= f.harmonics else 0.0
