"""Symbolic meets numeric: the error of every order is what the orders left out say it is.

The approximations come from the machine derivation in exact rational numbers, the truth from the
Hill matrix to 90 digits (``boundary_truth``).  As t goes to zero their difference has to behave as
the first omitted coefficient that is not zero times its power of t.
"""

from fractions import Fraction
from itertools import product

import pytest
from boundary_cases import (
    HIGHEST,
    LINKAGES,
    MIXED,
    ORDERS,
    PARTS,
    RAYS,
    REGIONS,
    SHARES,
    SYMMETRIC,
    closes,
    curve,
    function,
    slow,
)
from boundary_truth import MP
from omitted_orders import FORMS, Curve, real

# So small that the next power changes a slope by 1e-5 at most, near critical damping too.
SMALL = Fraction(1, 2**20)
# At such a t the next power is out of the way.
SLOPE = 1e-3
# Extrapolated once, the coefficient keeps the error ~ t^2 times a ratio of coefficients.
DIGITS = 1e-7


def gaps(problem, form, order, side, at=(SMALL, SMALL / 2)):
    return [problem.approximation(form, order, side, t) - problem.truth(side, t) for t in at]


def slope(large, small):
    return MP.log(abs(large / small), 2)


def agrees(problem, form, order, side):
    """Compare slope and coefficient of the error with what is left out."""
    power, coefficient = problem.omitted(form, order, side)
    large, small = gaps(problem, form, order, side)
    if power is None:
        # Nothing is left out through the highest order: the error is smaller than its power.
        assert abs(large) < SMALL**problem.highest
        return
    assert power > order
    assert abs(slope(large, small) - power) < SLOPE
    t = real(SMALL)
    limit = 2 * small / (t / 2) ** power - large / t**power
    assert abs(limit / coefficient - 1) < DIGITS


def sides(n):
    return (-1, 1) if n else (1,)


def all_orders(problem, orders=ORDERS):
    assert problem.expansion(problem.highest) is not None
    for form in FORMS:
        for side in sides(problem.n):
            for order in orders:
                agrees(problem, form, order, side)


FAST = [
    ("mixed", 0, "undamped"),
    ("mixed", 1, "damped"),
    ("mixed", 2, "undamped"),
    ("mixed", 3, "near critical"),
    ("even", 1, "damped"),
    ("odd", 3, "undamped"),
    ("cosine", 1, "undamped"),
    ("sine", 1, "near critical"),
    ("second harmonic", 2, "damped"),
    ("odd harmonics", 2, "undamped"),
]
ALL = product((*MIXED, *SYMMETRIC, *LINKAGES), (0, *REGIONS), SHARES)
# Every fifth of all: each function, region and damping with most others.
REST = set([case for case in ALL if not closes(*case)][::5]) - set(FAST)


@pytest.mark.parametrize(("name", "n", "share"), [*FAST, *slow(sorted(REST))])
def test_one_parameter(name, n, share):
    all_orders(curve((function(name),), n, SHARES[share]))


WITHOUT = [("mixed", n) for n in REGIONS] + [("mixed, 4 harmonics", 2), ("even", 1)]


@pytest.mark.parametrize(("name", "n"), [*WITHOUT[:2], *slow(WITHOUT[2:])])
def test_where_the_harmonic_of_the_region_vanishes(name, n):
    """The ends part at order 2; the uniform form goes through without a loss of order."""
    problem = curve((function(name).without(n),), n)
    _, root, _ = problem.expansion(HIGHEST)
    assert root[1] == 0
    assert root[2] != 0
    all_orders(problem)
    # f(theta + pi) = -f(theta) leaves even powers alone.
    step = 2 if not any(any(problem.functions[0].harmonic(m)) for m in (2, 4)) else 1
    for order in ORDERS:
        expected = order + step - order % step
        assert all(problem.omitted("uniform", order, s)[0] == expected for s in (-1, 1))


@pytest.mark.parametrize("n", [1, pytest.param(3, marks=pytest.mark.slow)])
def test_damping_of_the_second_order_where_the_harmonic_vanishes(n):
    """K = beta t^2 leaves such a region open; both ends in all orders again."""
    f = function("mixed").without(n)
    _, root, square = curve((f,), n).expansion(HIGHEST)
    beta = Fraction(int(2**24 * real(root[2]) * MP.sqrt(real(square)) / (2 * n)), 2**24)
    problem = Curve((f,), (Fraction(1),), (Fraction(0), beta), n, HIGHEST)
    assert problem.expansion(HIGHEST) is not None
    for side in (-1, 1):
        for order in (2, 3, 4, 5, 6):
            agrees(problem, "uniform", order, side)
            agrees(problem, "series", order, side)


SEVERAL_FAST = [("two mixed", 1, "damped"), ("one harmonic each", 3, "undamped")]
SEVERAL_REST = [
    ("two mixed", 2, "undamped"),
    ("even and odd", 2, "damped"),
    ("even and odd", 5, "undamped"),
    ("one harmonic each", 1, "damped"),
    ("three", 1, "damped"),
    ("three", 4, "undamped"),
]


@pytest.mark.parametrize(("name", "n", "share"), [*SEVERAL_FAST, *slow(SEVERAL_REST)])
def test_several_parameters_along_rays(name, n, share):
    parts = PARTS[name]
    for weights in RAYS:
        weights = weights[: len(parts)]
        all_orders(curve(parts, n, SHARES[share], weights, highest=8), ORDERS)
