"""The run-time boundaries: the same orders as the exact derivation, down to their floor.

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
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.hill import boundary_series, perturbation_boundaries
from elastolink.runtime.hill.bloch import effective_operator
from exact_hill import exact_operator
from omitted_orders import FORMS

EPS = float(np.finfo(float).eps)
POINTS = tuple(Fraction(1, 2**k) for k in (3, 4, 5, 6, 7, 8, 10, 12, 15, 20))
# Fewer for functions of many harmonics, whose truth takes longer.
FEWER = tuple(Fraction(1, 2**k) for k in (5, 6, 8, 12, 20))
# Above this share of the floor an error shows its own slope to 0.1.
CLEAR = 30.0


def found_at(problem, form, order, points):
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
        form,
        outside="value",
    )
    return found.lower[0], found.upper[0]


def floor(problem, form, t):
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
        if form == "series":
            # Each coefficient of the root divides by the first once more.
            steep *= 2.0 * size / width
    return EPS * (0.25 * problem.n**2 + 8.0 * size * steep)


def compares(problem, form, order):
    """Compare values with the exact form, and the slopes of the errors with those of its errors."""
    points = FEWER if len(problem.functions[0].cosine) > 4 else POINTS
    ends = found_at(problem, form, order, points)
    for side in (-1, 1) if problem.n else (1,):
        ours = ends[(side + 1) // 2]
        errors, exact_errors, floors = [], [], []
        for t, value in zip(points, ours, strict=True):
            exact = problem.approximation(form, order, side, t)
            truth = problem.truth(side, t, digits=30)
            if exact is None or truth is None:
                assert np.isnan(value) == (exact is None)
                continue
            least = floor(problem, form, t)
            assert abs(MP.mpf(value) - exact) <= least
            errors.append(float(abs(MP.mpf(value) - truth)))
            exact_errors.append(float(abs(exact - truth)))
            floors.append(least)
        seen = 0
        for i in range(len(errors) - 1):
            if exact_errors[i] > exact_errors[i + 1] > CLEAR * floors[i + 1]:
                fall = np.log2([errors[i] / errors[i + 1], exact_errors[i] / exact_errors[i + 1]])
                assert abs(fall[0] - fall[1]) < 0.1
                seen += 1
        assert errors[-1] <= exact_errors[-1] + floors[-1]
        yield seen


def all_orders(problem):
    seen = 0
    for form in FORMS:
        for order in (1, 2, 3, 4, 5, 6):
            seen += sum(compares(problem, form, order))
    # The first orders alone show their slopes at more points.
    assert seen > 10


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


@pytest.mark.parametrize(
    ("name", "damped"),
    [("even and odd", True), *slow([("two mixed", False), ("three", True)])],
)
def test_the_operator_coefficient_by_coefficient(name, damped):
    """A and B of degree 1 to 8 beside the exact ones, relative to the largest of their degree."""
    for n in (0, 1, 2, 5):
        exact = exact_operator(PARTS[name], n, 8, damped)
        found = effective_operator([doubles(f) for f in PARTS[name]], n, 8, damped)
        for k in range(8):
            assert [tuple(row) for row in found.exponents[k].tolist()] == list(exact.exponents[k])
            scale = max(abs(complex(*map(float, pair))) for pair in exact.diagonal[k])
            for ours, theirs in (
                (found.diagonal[k], exact.diagonal[k]),
                (found.coupling[k], exact.coupling[k]),
            ):
                expected = np.array([complex(*map(float, pair)) for pair in theirs])
                scale = max(scale, np.abs(expected).max())
                assert np.abs(ours - expected).max() <= 64 * EPS * scale


@pytest.mark.parametrize("share", [1.02, 3.0])
def test_beyond_critical_damping(share):
    problem = curve((function("mixed"),), 1, share)
    for order in ORDERS:
        for form in FORMS:
            low, high = found_at(problem, form, order, POINTS[6:])
            assert np.all(np.isnan(low) & np.isnan(high))
    with pytest.raises(BadInput, match="damping"):
        boundary_series(doubles(function("mixed")), 1, 4, float(problem.drag[0]))
