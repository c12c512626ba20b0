"""Hill's equation with several small parameters, sorted by powers by machine (Smith chapter 8)."""

from __future__ import annotations

from functools import cache
from itertools import product

import sympy as sp
from smith_chapter_8.surd import ExactHarmonics

theta = sp.Symbol("theta", real=True)
n = sp.Symbol("n", integer=True, positive=True)
eps = sp.symbols("epsilon_1 epsilon_2", real=True)
delta, psi = sp.symbols("delta_n psi_n", real=True)
# Two functions, neither even nor odd, for counterexamples in numbers (n = 2).
TWO_FUNCTIONS = (
    ExactHarmonics.of("0.9", ["0.1", "0.4", "-0.5", "0.4"], ["0.7", "0.3", "-0.4", "-0.9"]),
    ExactHarmonics.of("0.8", ["-0.8", "0.2", "0.3", "-0.2"], ["0.5", "-0.6", "0.9", "-0.7"]),
)


def _name(letter, powers):
    return f"{letter}_{''.join(map(str, powers))}"


def alpha(*powers):
    """Return the coefficient alpha_ij or alpha_ijk of lambda^2."""
    return sp.Symbol(_name("alpha", powers), real=True)


def part(*powers):
    """Return y_ij or y_ijk as a function of theta."""
    return sp.Function(_name("y", powers))(theta)


def function(name):
    """Return a periodic function by its name."""
    return sp.Function(name)(theta)


@cache
def rows(parameters, coefficient, order=2):
    """Return the equations of y'' + {lambda^2 + coefficient} y = 0 by powers of the parameters."""
    powers = [k for k in product(range(order + 1), repeat=len(parameters)) if sum(k) <= order]

    def monomial(k):
        return sp.prod([x**i for x, i in zip(parameters, k, strict=True)])

    lam2 = n**2 / sp.Integer(4) + sum(alpha(*k) * monomial(k) for k in powers if sum(k))
    y = sum(part(*k) * monomial(k) for k in powers)
    left = sp.Poly(sp.expand(sp.diff(y, theta, 2) + (lam2 + coefficient) * y), *parameters)
    return {k: left.coeff_monomial(monomial(k)) for k in powers}


def operator(y):
    """Return y'' + (n/2)^2 y."""
    return sp.diff(y, theta, 2) + n**2 / sp.Integer(4) * y


def resonant(expression, region):
    """Return the coefficients of cos and sin(region theta/2) of a trigonometric sum."""
    z = sp.Symbol("z")
    powers = sp.expand(expression).rewrite(sp.exp)
    powers = powers.replace(sp.exp, lambda x: _power(x, z))
    expanded = sp.expand(powers)
    plus, minus = expanded.coeff(z, region), expanded.coeff(z, -region)
    return sp.expand(plus + minus), sp.expand(sp.I * (plus - minus))


def _power(exponent, z):
    """Write exp(i h theta/2 + c) as z^h exp(c)."""
    exponent = sp.expand(exponent)
    turning = exponent.coeff(theta)
    rest = sp.expand(exponent - turning * theta)
    return z ** (2 * turning / sp.I) * (sp.cos(rest / sp.I) + sp.I * sp.sin(rest / sp.I))
