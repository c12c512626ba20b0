"""Published series of Mathieu's characteristic numbers, and random exact functions."""

import random
from fractions import Fraction

from smith_chapter_8.surd import ExactHarmonics

# DLMF 28.6.1-28.6.13 and Abramowitz & Stegun 20.2.25: a_r, b_r of y'' + (a - 2 q cos 2x) y = 0 less
# r^2, coefficients of q, q^2, ... as far as they are printed there (exact rational numbers).
PUBLISHED = {
    "a0": "0 -1/2 0 7/128 0 -29/2304 0 68687/18874368",
    "a1": "1 -1/8 -1/64 -1/1536 11/36864 49/589824 55/9437184 -83/35389440",
    "b1": "-1 -1/8 1/64 -1/1536 -11/36864 49/589824 -55/9437184 -83/35389440",
    "a2": "0 5/12 0 -763/13824 0 1002401/79626240 0 -1669068401/458647142400",
    "b2": "0 -1/12 0 5/13824 0 -289/79626240 0 21391/458647142400",
    "a3": "0 1/16 1/64 13/20480 -5/16384 -1961/23592960 -609/104857600",
    "b3": "0 1/16 -1/64 13/20480 5/16384 -1961/23592960 609/104857600",
    "a4": "0 1/30 0 433/864000 0 -5701/2721600000",
    "b4": "0 1/30 0 -317/864000 0 10049/2721600000",
    "a5": "0 1/48 0 11/774144 1/147456 37/891813888",
    "b5": "0 1/48 0 11/774144 -1/147456 37/891813888",
    "a6": "0 1/70 0 187/43904000 0 6743617/92935987200000",
    "b6": "0 1/70 0 187/43904000 0 -5861633/92935987200000",
}


def published(name):
    """Return the published coefficients of one characteristic number."""
    return [Fraction(x) for x in PUBLISHED[name].split()]


def random_function(seed, count=3, mean=True, denominator=10):
    """Return a function, neither even nor odd, of small random rational coefficients."""
    rng = random.Random(seed)

    def row():
        return [
            Fraction(rng.choice((-1, 1)) * rng.randint(1, 9), denominator) for _ in range(count)
        ]

    return ExactHarmonics.of(Fraction(rng.randint(1, 9), 10) if mean else 0, row(), row())
