"""Integrals of piecewise polynomial shapes in exact fractions, from their definition alone."""

from functools import cache

import sympy as sp

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
