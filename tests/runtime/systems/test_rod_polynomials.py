"""Polynomial and two-segment bases: exact integrals, span, condition, continuity, refusals."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from elastolink.runtime.systems.rod import PolynomialBasis, TwoSegmentBasis
from elastolink.runtime.systems.rod.polynomials import integrals
from rod_bases import frequencies

eta, xi = sp.symbols("eta xi", positive=True)

FACTORS = {
    "overlap": (lambda e: e, lambda e: e),
    "drift": (lambda e: e, lambda e: sp.diff(e, xi)),
    "drift_drift": (lambda e: sp.diff(e, xi), lambda e: sp.diff(e, xi)),
    "bending": (lambda e: sp.diff(e, eta, 2), lambda e: sp.diff(e, eta, 2)),
    "bending_drift": (lambda e: sp.diff(e, eta, 2), lambda e: sp.diff(e, eta, 2, xi)),
    "tension": (lambda e: sp.diff(e, eta) * (1 - eta**2) / 2, lambda e: sp.diff(e, eta)),
    "moment": (lambda e: e * eta, None),
    "mean": (lambda e: e, None),
}


def weighted(upper, lower, count):
    """Return polynomials orthogonal on [0, 1] with (1 - x)^upper x^lower, norm 1, first one > 0.

    By Gram and Schmidt, from the weight alone.
    """
    weight = (1 - eta) ** upper * eta**lower

    def inner(p, q):
        return sp.integrate(sp.expand(p * q * weight), (eta, 0, 1))

    found: list[sp.Expr] = []
    for k in range(count):
        p = eta**k - sum(inner(eta**k, q) / inner(q, q) * q for q in found)
        found.append(sp.expand(p))
    return [p / sp.sqrt(inner(p, p)) for p in found]


@cache
def polynomial_shapes(size, orthogonal):
    """Return Beale & Scott's modes on both sides of the block."""
    powers = weighted(0, 1, size) if orthogonal else [eta**k for k in range(size)]
    return [(eta * p * (eta - xi), xi * p * (eta - xi)) for p in powers]


@cache
def two_segment_shapes(size):
    """Return the shapes of two segments, on both sides of the block."""
    bays, tails = size // 2, (size - 1) // 2
    first, last = eta / xi, (eta - xi) / (1 - xi)

    def turn(upper, lower, count, end):
        p = weighted(upper, lower, count + 1)[-1]
        return p / p.subs(eta, end)

    def on(p, s):
        return p.subs(eta, s) if p.has(eta) else p

    bay, tail = turn(3, 2, bays, 1), turn(0, 3, tails, 0)
    found = [(xi * first * (first - 1) * on(bay, first), (1 - xi) * last * on(tail, last))]
    left = [xi * first * (1 - first) ** 2 * on(p, first) for p in weighted(4, 2, bays)]
    right = [(1 - xi) * last**2 * on(p, last) for p in weighted(0, 4, tails)]
    found += [(0, right[k // 2]) if k % 2 else (left[k // 2], 0) for k in range(size - 1)]
    return [(sp.sympify(a), sp.sympify(b)) for a, b in found]


def entry(name, shapes, place, m, n):
    """Return one entry of an array to 40 digits at a rational place of the block."""
    one, other = FACTORS[name]
    total = sp.S.Zero
    for side, (lower, upper) in enumerate(((0, place), (place, 1))):
        integrand = one(shapes[m][side]) * (other(shapes[n][side]) if other else 1)
        integrand = sp.Poly(sp.expand(integrand.subs(xi, place)), eta, extension=True)
        whole = integrand.integrate()
        total += whole.eval(upper) - whole.eval(lower)
    return sp.N(total, 40)


PLACES = np.array([0.2, 0.3999, 0.59997, 0.75, 0.9])
BASES = (
    PolynomialBasis(3),
    PolynomialBasis(4, orthogonal=False),
    TwoSegmentBasis(1),
    TwoSegmentBasis(2),
    TwoSegmentBasis(5),
)
CASES = [
    (PolynomialBasis(3), lambda: polynomial_shapes(3, True)),
    (PolynomialBasis(4, orthogonal=False), lambda: polynomial_shapes(4, False)),
    (TwoSegmentBasis(4), lambda: two_segment_shapes(4)),
]


def exact(name, shapes, place):
    """Return one array at a rational place of the block."""
    columns = range(1 if name in ("moment", "mean") else len(shapes))
    found = [[float(entry(name, shapes, place, m, n)) for n in columns] for m in range(len(shapes))]
    return np.array(found) if len(columns) > 1 else np.array(found)[:, 0]


@pytest.mark.parametrize(
    ("names", "numerators"),
    [(("drift", "tension"), (10,)), pytest.param(FACTORS, (4, 10, 15), marks=pytest.mark.slow)],
    ids=["two", "all"],
)
@pytest.mark.parametrize(("basis", "shapes"), CASES, ids=[repr(case[0]) for case in CASES])
def test_integrals_are_those_of_exact_fractions(basis, shapes, names, numerators):
    """To 16 roundings of the largest entry; 6 are the most that were seen."""
    for name in names:
        for place in (sp.Rational(k, 16) for k in numerators):
            ours = basis.array(name, np.array([float(place)]))[0]
            truth = exact(name, shapes(), place)
            assert np.abs(ours - truth).max() <= 16 * 2.0**-53 * np.abs(truth).max()


@pytest.mark.parametrize("name", FACTORS)
@pytest.mark.parametrize("basis", [PolynomialBasis(20), TwoSegmentBasis(20)], ids=repr)
def test_integrals_of_many_shapes_against_quadrature(basis, name):
    """Tables against integrals at each place in long doubles, to 64 roundings of the largest."""
    places, degree = PLACES.astype(np.longdouble), 2 * basis.size + 31
    truth = integrals(name, basis._sampler, ("left", "right"), places, degree)
    ours = basis.array(name, PLACES)
    size = np.abs(truth).max(axis=tuple(range(1, truth.ndim)), keepdims=True)
    assert np.max(np.abs(ours - truth) / size) <= 64 * 2.0**-53


@pytest.mark.parametrize("basis", BASES, ids=repr)
def test_shapes_hold_at_pin_and_block_and_keep_their_slope(basis):
    for place in PLACES:
        at = np.array([place])
        ends = basis.shapes(np.array([0.0, place]), at)
        assert np.abs(ends).max() == 0.0
        near = np.array([place, np.nextafter(place, 1.0)])
        slopes = basis.shapes(near, at, derivative=1)[0]
        assert slopes[0] == pytest.approx(slopes[1], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(("basis", "shapes"), CASES, ids=[repr(case[0]) for case in CASES])
@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_derivatives_along_the_rod(basis, shapes, order):
    place, points = sp.Rational(5, 8), [sp.Rational(k, 16) for k in (0, 3, 9, 10, 11, 16)]
    ours = basis.shapes(np.array(points, dtype=float), np.array([float(place)]), order)[0]
    for point, row in zip(points, ours, strict=True):
        side = 0 if point <= place else 1
        truth = [
            sp.diff(shape[side], eta, order).subs({xi: place, eta: point}) for shape in shapes()
        ]
        assert row == pytest.approx([float(value) for value in truth], rel=1e-13, abs=1e-13)


def test_block_at_the_tip():
    """The tail vanishes: a pinned beam of full length, beta = pi."""
    beta = np.sqrt(frequencies(PolynomialBasis(10), 1.0))
    assert beta[:2] == pytest.approx([np.pi, 2 * np.pi], rel=1e-6)
    assert np.all(np.isfinite(PolynomialBasis(3).shapes(np.array([0.5, 1.0]), np.array([1.0]))))
