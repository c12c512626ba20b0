"""Integrals against quadrature, Taylor polynomials against SymPy's own series."""

import itertools

import mpmath
import pytest
import sympy as sp
from elastolink.derive.integrals import (
    UnknownIntegrand,
    antiderivative,
    definite,
    mode_integral,
    mode_vector,
)
from elastolink.derive.series import taylor

x = sp.Symbol("x")
a, b, L = sp.symbols("a b L", positive=True)
m, n = sp.symbols("m n", integer=True, positive=True)
VALUES = {a: sp.Rational(13, 10), b: sp.Rational(7, 10), L: sp.Rational(9, 5)}
p = sp.Symbol("p", positive=True)


def quadrature(integrand: sp.Expr, lower: sp.Expr, upper: sp.Expr) -> mpmath.mpf:
    function = sp.lambdify(x, integrand.subs(VALUES), "mpmath")
    ends = [mpmath.mpf(sp.N(sp.sympify(e).subs(VALUES), 40)) for e in (lower, upper)]
    points = mpmath.linspace(*ends, 4)
    return mpmath.quad(function, points)


def close(value: sp.Expr, reference: mpmath.mpf) -> bool:
    found = mpmath.mpf(sp.N(sp.sympify(value).subs(VALUES), 40))
    return abs(found - reference) <= mpmath.mpf(10) ** -25 * (1 + abs(reference))


INTEGRANDS = [
    sp.S.One,
    x**3 - 2 * x + a,
    x**4 * sp.sin(a * x),
    x**2 * sp.cos(a * x + b) * sp.sin(3 * x),
    sp.sin(a * x) ** 2 * sp.cos(a * x),
    sp.sin(a * x) * sp.sin(2 * a * x) * sp.cos(b * x) * x,
    x**3 * sp.exp(-a * x),
    sp.exp(a * x) * sp.cos(b * x) * x**2,
    sp.sinh(a * x) * sp.cosh(b * x) * x,
    sp.cosh(a * x) ** 2,
    sp.sinh(a * x) * sp.sin(a * x) * x,
    sp.cosh(a * x + b) * sp.cos(a * x - 1) ** 2,
    (1 + x) ** 2 * (sp.sin(x) + sp.exp(x)) ** 2,
    sp.cos(b) * x,
]


@pytest.mark.parametrize("integrand", INTEGRANDS, ids=str)
def test_table_against_quadrature(integrand):
    with mpmath.workdps(40):
        reference = quadrature(integrand, b, L)
        assert close(definite(integrand, x, b, L), reference)
        primitive = antiderivative(integrand, x)
        assert close(primitive.subs(x, L) - primitive.subs(x, b), reference)


MODAL = [
    sp.sin(m * sp.pi * x) * sp.sin(n * sp.pi * x),
    x * sp.sin(m * sp.pi * x) * sp.sin(n * sp.pi * x),
    (1 - x**2) * sp.cos(m * sp.pi * x) * sp.cos(n * sp.pi * x),
    (1 - x) * sp.cos(m * sp.pi * x) * sp.sin(n * sp.pi * x),
    x**3 * sp.cos(n * sp.pi * x) * sp.sin(m * sp.pi * x),
    sp.exp(a * x) * sp.sin(m * sp.pi * x) * sp.sin(n * sp.pi * x),
]


@pytest.mark.parametrize("integrand", MODAL, ids=str)
def test_mode_integrals_for_all_small_mode_numbers(integrand):
    entries = mode_integral(integrand, x, m, n).matrix(3)
    with mpmath.workdps(40):
        for i, j in itertools.product(range(3), repeat=2):
            explicit = integrand.subs({m: i + 1, n: j + 1})
            assert close(entries[i, j], quadrature(explicit, sp.S.Zero, sp.S.One))


def test_mode_integral_on_a_link_of_symbolic_length():
    wave = sp.sin(m * sp.pi * x / L) * sp.sin(n * sp.pi * x / L)
    found = mode_integral(wave, x, m, n, sp.S.Zero, L)
    assert (found.diagonal, found.off_diagonal) == (L / 2, 0)
    # up to an interior point nothing simplifies, but the value is right
    part = mode_integral(wave * x, x, m, n, sp.S.Zero, L / 3).matrix(2)
    with mpmath.workdps(40):
        for i, j in itertools.product(range(2), repeat=2):
            explicit = (wave * x).subs({m: i + 1, n: j + 1})
            assert close(part[i, j], quadrature(explicit, sp.S.Zero, L / 3))


def test_mode_vector():
    found = mode_vector(x * sp.sin(m * sp.pi * x), x, m)
    assert sp.simplify(found.entry + (-1) ** m / (m * sp.pi)) == 0
    assert not found.entry.has(sp.sin, sp.cos)


@pytest.mark.parametrize(
    "integrand",
    [sp.tan(x), 1 / x, sp.sqrt(x), sp.sin(x**2), sp.exp(-(x**2)), sp.sin(x) ** a, sp.log(x)],
    ids=str,
)
def test_unknown_integrands_are_errors(integrand):
    with pytest.raises(UnknownIntegrand):
        definite(integrand, x, 1, 2)


def test_a_frequency_that_may_vanish_is_an_error():
    wave = sp.sin(m * sp.pi * x)
    with pytest.raises(UnknownIntegrand, match="may vanish"):
        mode_vector(wave * sp.cos(2 * sp.pi * x), x, m)
    with pytest.raises(UnknownIntegrand, match="may vanish"):
        definite(wave * sp.sin(n * sp.pi * x), x)
    with pytest.raises(UnknownIntegrand, match="may vanish"):
        mode_integral(wave * sp.sin(2 * n * sp.pi * x), x, m, n)
    # with explicit numbers the same integrals exist
    assert definite(wave.subs(m, 2) * sp.sin(2 * sp.pi * x), x) == sp.Rational(1, 2)


@pytest.mark.parametrize(
    "expression",
    [
        1 - sp.cos(p) * sp.cosh(p),
        (p**2 * sp.sin(2 * p) + 3) * sp.exp(-p),
        sp.cos(p / 3) ** 2 * sp.Symbol("a"),
    ],
)
def test_taylor_against_sympy(expression):
    found = taylor(expression, p, 4)
    order = sp.degree(found.remainder, p)
    series = sp.series(expression, p, 0, order + 1).removeO()
    assert sp.expand(found.value + found.remainder - series) == 0


@pytest.mark.parametrize(
    ("expression", "words"),
    [(1 / p, "no power and no exponential"), (1 + p**2, "no 3 non-zero terms")],
)
def test_what_has_no_such_series_is_refused(expression, words):
    with pytest.raises(ValueError, match=words):
        taylor(expression, p, 2)
