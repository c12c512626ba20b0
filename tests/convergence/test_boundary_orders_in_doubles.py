"""The run-time boundaries beside the exact derivation, to their round-off.

The functions, mu and K are dyadic, so that both sides solve the very same problem.
"""

from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from boundary_cases import (
    LINKAGES,
    MIXED,
    ORDERS,
    PARTS,
    RAYS,
    REGIONS,
    SHARES,
    SYMMETRIC,
    curve,
    doubles,
    function,
    rest,
    slow,
    slow1,
)
from boundary_truth import MP
from elastolink.runtime.hill import boundary_series, perturbation_boundaries

EPS = float(np.finfo(float).eps)
POINTS = tuple(Fraction(1, 2**k) for k in (3, 4, 5, 6, 7, 8, 10, 12, 15, 20))


def found_at(problem, order, points):
    """Return lower and upper ends of the run-time function on the curve."""
    parts = [doubles(f) for f in problem.functions]
    mu = [np.array([float(w * t) for t in points]) for w in problem.weights]
    drag = np.array([float(problem.friction(t)) for t in points])
    several = len(parts) > 1
    found = perturbation_boundaries(
        parts if several else parts[0],
        mu if several else mu[0],
        (problem.n,),
        order,
        drag,
        outside="value",
    )
    return found.lower[0], found.upper[0]


def floor(problem, t):
    """Round-off of the level, of the shift and of the root, whose terms may cancel near the tip."""
    reach = sum(
        abs(w) * (abs(f.mean) + sum(map(abs, (*f.cosine, *f.sine))))
        for f, w in zip(problem.functions, problem.weights, strict=True)
    )
    size = float(reach * t + problem.friction(t) * problem.n)
    steep = 1.0
    if problem.damped and problem.n:
        _, root, square = problem.expansion(2)
        width = float(root[1] * t) * float(square) ** 0.5
        steep += size / width
    return EPS * (0.25 * problem.n**2 + 8.0 * size * steep)


def all_orders(problem):
    """Compare the ends with the exact forms, whose orders ``test_boundary_orders`` proves."""
    for order in ORDERS:
        ends = found_at(problem, order, POINTS)
        for side in (-1, 1) if problem.n else (1,):
            for t, value in zip(POINTS, ends[(side + 1) // 2], strict=True):
                exact = problem.approximation("uniform", order, side, t)
                if exact is None:
                    assert np.isnan(value)
                else:
                    assert abs(MP.mpf(value) - exact) <= floor(problem, t)


FAST = [
    ("mixed", 0, "undamped"),
    ("mixed", 1, "damped"),
    ("mixed", 2, "near critical"),
    ("odd", 3, "undamped"),
    ("cosine", 1, "undamped"),
]
REST = rest((*MIXED, *SYMMETRIC, *LINKAGES), (0, 1, 2, 3, 5), SHARES, FAST)


@pytest.mark.parametrize(("name", "n", "share"), [*FAST, *slow(REST)])
def test_one_parameter(name, n, share):
    all_orders(curve((function(name),), n, SHARES[share]))


@pytest.mark.parametrize(
    ("name", "share"),
    [
        ("even and odd", "undamped"),
        *slow([("two mixed", "damped"), ("one harmonic each", "damped"), ("three", "undamped")]),
    ],
)
def test_several_parameters(name, share):
    n = 1
    for weights in RAYS:
        all_orders(curve(PARTS[name], n, SHARES[share], weights[: len(PARTS[name])], highest=6))


@pytest.mark.parametrize("name", ["mixed", "odd", *slow1(("even", "sine", *LINKAGES))])
def test_the_coefficients_of_the_series(name):
    """alpha_1 ... alpha_8 of both ends, within their own figures."""
    for n, share in product((0, *REGIONS), SHARES.values()):
        if share and (n == 0 or not any(function(name).harmonic(n))):
            continue
        problem = curve((function(name),), n, share, highest=8)
        found = boundary_series(doubles(function(name)), n, 8, float(problem.drag[0]))
        assert found.passed
        ends = zip((-1, 1), (found.lower, found.upper), found.error, strict=True)
        for side, ours, figure in ends:
            exact = problem.coefficients(side)
            gap = np.array([float(abs(MP.mpf(x) - y)) for x, y in zip(ours, exact, strict=True)])
            assert np.all(gap <= figure)
