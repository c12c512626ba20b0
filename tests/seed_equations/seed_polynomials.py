"""Beale & Scott's polynomial modes by machine: the matrices of (18), dimensional, as in the paper.

Only the modes (12)-(14) and what each matrix is an integral of enter; powers are integrated term by
term, exactly.  ``gamma(1, i, j)`` to ``gamma(5, i)`` are expressions in ``x_1``, its two rates and
``L`` for whole i and j; ``general`` leaves i and j open.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

x, x1, L = sp.symbols("x x_1 L", positive=True)
v1, a1 = sp.symbols(r"\dot{x}_1 \ddot{x}_1", real=True)
i, j = INDICES = sp.symbols("i j", positive=True, integer=True)
KINDS = (1, 2, 3, 4, 5)


def mode(n):
    """Return mode n on both sides of the block: (12), (13), (14)."""
    return x**n * (x - x1), x1 * x ** (n - 1) * (x - x1)


def rate(expression):
    """Differentiate by time; x_1 and its velocity move."""
    return sp.diff(expression, x1) * v1 + sp.diff(expression, v1) * a1


def integral(expression, lower, upper):
    """Integrate a sum of powers of x, whole or symbolic; a term that vanishes is dropped first."""
    total = sp.S.Zero
    for term in sp.Add.make_args(sp.expand(sp.powsimp(sp.expand(expression)))):
        factor, power = sp.powsimp(term).as_independent(x)
        if factor == 0:
            continue
        p = sp.expand(sp.log(power).diff(x) * x) if power != 1 else sp.S.Zero
        if sp.simplify(p + 1) == 0:
            total += factor * sp.log(upper / lower)
            continue
        total += factor * (upper ** (p + 1) - (lower ** (p + 1) if lower != 0 else 0)) / (p + 1)
    return total


def integrands(kind, m, n):
    """Return what a matrix is the integral of, on both sides: (18)."""
    found = []
    for one, other in zip(mode(m), mode(n), strict=True):
        pair = {
            1: one * other,
            2: one * rate(other),
            3: one * rate(rate(other)),
            4: sp.diff(one, x, 2) * sp.diff(other, x, 2),
            5: x * one,
        }
        found.append(pair[kind])
    return found


@cache
def gamma(kind, m, n=1):
    """Return one entry of a matrix of (18), or of its right-hand side for kind 5; whole m, n."""
    left, right = integrands(kind, m, n)
    return sp.expand(integral(left, sp.S.Zero, x1) + integral(right, x1, L))


@cache
def general(kind):
    """Return the entry with open indices, bay and tail, where no denominator vanishes."""
    left, right = integrands(kind, i, j)
    common = x1 ** ({1: 3, 2: 2, 3: 2, 4: -1}[kind] + i + j if kind < 5 else i + 3)
    bay = sum(
        sp.factor(sp.powsimp(factor * x1 ** (p + 1) / common)) / (p + 1)
        for p, factor in _by_power(left)
    )
    tail = sum(factor * (L ** (p + 1) - x1 ** (p + 1)) / (p + 1) for p, factor in _by_power(right))
    return common * bay, tail


def _by_power(integrand):
    """Yield the powers of x in a sum, highest first, each with its factored coefficient."""
    terms = {}
    for term in sp.Add.make_args(sp.expand(sp.powsimp(sp.expand(integrand)))):
        factor, power = sp.powsimp(term).as_independent(x)
        p = sp.expand(sp.log(power).diff(x) * x)
        terms[p] = terms.get(p, 0) + factor
    for p in sorted(terms, key=lambda p: -p.subs({i: 0, j: 0})):
        yield p, sp.factor(terms[p])


def typeset(kind):
    """Return the entry with open indices in LaTeX."""
    return sp.latex(sp.Add(*general(kind)))
