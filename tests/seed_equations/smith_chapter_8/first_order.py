"""Stability boundaries of Hill's equation by strained parameters, derived by machine.

    y'' + 2 K y' + (lam2 + mu f(theta)) y = 0,  f = a0 + sum a_m cos m theta + b_m sin m theta

with ``lam2 = n^2/4 + mu alpha1 + ...`` and damping of the order of the parameter, ``K = mu beta``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import sympy as sp
from sympy.simplify.fu import TR8

n = sp.Symbol("n", integer=True, positive=True)
theta = sp.Symbol("theta", real=True)
mu, damping = sp.symbols("mu damping", real=True)
a0, an, bn = sp.symbols("a0 an bn", real=True)


@dataclass(frozen=True)
class FirstOrder:
    """First-order boundaries of region n.

    Attributes
    ----------
    centre : Expr
        Mean of the two boundaries in lam2.
    half_width_squared : Expr
        Square of half their distance; negative where damping has closed the tongue.
    condition : Matrix
        The 2 x 2 matrix of (7.22)/(7.45) whose determinant vanishes on a boundary, in the
        unknown ``alpha1`` and with ``beta = K / mu``.
    """

    centre: sp.Expr
    half_width_squared: sp.Expr
    condition: sp.ImmutableDenseMatrix


def first_order() -> FirstOrder:
    """Derive the first-order boundaries (Smith 7.16-7.25, with damping 7.41-7.49).

    Of ``f y0`` only the harmonics 0 and n of f reach the resonant harmonic n/2, for
    ``|m +- n/2| = n/2`` has no other solution in ``m >= 0``.
    """
    alpha1, beta, amplitude_cos, amplitude_sin = sp.symbols("alpha1 beta A B")
    phase = n * theta / 2
    y0 = amplitude_cos * sp.cos(phase) + amplitude_sin * sp.sin(phase)
    f = a0 + an * sp.cos(n * theta) + bn * sp.sin(n * theta)
    secular = TR8(sp.expand(-alpha1 * y0 - f * y0 - 2 * beta * sp.diff(y0, theta)))
    secular = sp.expand(secular)
    rows = [secular.coeff(trig(phase)) for trig in (sp.cos, sp.sin)]
    matrix, _ = sp.linear_eq_to_matrix(rows, (amplitude_cos, amplitude_sin))
    quadratic = sp.Poly(sp.expand(matrix.det()), alpha1)
    lead, linear, constant = quadratic.all_coeffs()
    centre = -linear / (2 * lead)
    spread = sp.expand((linear**2 - 4 * lead * constant) / (4 * lead**2))
    return FirstOrder(
        centre=n**2 / sp.Integer(4) + mu * centre,
        half_width_squared=sp.factor_terms(sp.expand(mu**2 * spread.subs(beta, damping / mu))),
        condition=sp.ImmutableDenseMatrix(matrix),
    )


@cache
def boundaries() -> Callable[..., tuple[float, float]]:
    """Return centre and squared half width as a function of ``n, mu, a0, an, bn, damping``."""
    found = first_order()
    symbols = (n, mu, a0, an, bn, damping)
    return sp.lambdify(symbols, (found.centre, found.half_width_squared), "numpy")
