"""Rewritings that keep digits: they equal what they replace, and they do keep them."""

from __future__ import annotations

import math

import mpmath
import pytest
import sympy as sp
from elastolink.derive.safe import (
    UnsafeRewriting,
    bernstein_in_cosine,
    root_of_parts,
    solve_cosine_sine,
)
from hypothesis import given, settings
from hypothesis import strategies as st

a, b, c, d, s, cosine, root = sp.symbols("a b c d s cosine root")
upper, lower = sp.symbols("upper lower")


def as_cosine(expression):
    return expression.subs({upper: (1 + cosine) / 2, lower: (1 - cosine) / 2})


# ---------------------------------------------------------------- end values


@settings(max_examples=50, deadline=None, derandomize=True)
@given(st.lists(st.tuples(*(st.integers(-5, 5),) * 2), min_size=1, max_size=3))
def test_end_values_reproduce_any_product_of_linear_factors(pairs):
    expression = sp.prod([p * a + q * b * cosine + 1 for p, q in pairs])
    form = bernstein_in_cosine(sp.expand(expression), cosine, upper, lower)
    assert sp.expand(as_cosine(form) - expression) == 0
    assert not form.has(cosine)


def test_end_values_keep_the_digits_of_a_nearly_vanishing_length():
    """The law of cosines at 1e-9 rad with sides that differ by 1e-12: all digits against none."""
    form = bernstein_in_cosine(a**2 + b**2 - 2 * a * b * cosine, cosine, upper, lower)
    angle, one, other = 1e-9, 1.0, 1.0 - 1e-12
    half = {upper: math.cos(angle / 2) ** 2, lower: math.sin(angle / 2) ** 2}
    found = sp.lambdify((a, b, upper, lower), form, "math")(one, other, half[upper], half[lower])
    plain = one**2 + other**2 - 2 * one * other * math.cos(angle)
    with mpmath.workdps(50):
        x, y = mpmath.mpf(one), mpmath.mpf(other)
        exact = x**2 + y**2 - 2 * x * y * mpmath.cos(mpmath.mpf(angle))
        assert abs(found - exact) < 1e-15 * exact
        assert abs(plain - exact) > 1e-2 * exact


def test_a_factor_that_is_not_linear_is_refused():
    with pytest.raises(UnsafeRewriting, match="is not linear in cosine"):
        bernstein_in_cosine(a + b * cosine**2, cosine, upper, lower)


# ---------------------------------------------------------------- a cos x + b sin x = c


def test_the_solution_satisfies_equation_and_circle():
    cos, sin, discriminant = solve_cosine_sine(a, b, c, root)
    assert sp.cancel(a * cos + b * sin - c) == 0
    circle = sp.expand(sp.numer(sp.together(cos**2 + sin**2 - 1)))
    assert sp.rem(circle, root**2 - discriminant, root) == 0


# ---------------------------------------------------------------- parts of a known sum


def test_root_of_parts_is_the_root():
    form = root_of_parts((s - d, s + d), (a, b), root, s**2 - d**2)
    assert form == 2 * s * root / (a + b)
    exact = form.subs({a: s - d, b: s + d, root: sp.sqrt(s**2 - d**2)})
    assert sp.simplify(exact - sp.sqrt(s**2 - d**2)) == 0


def test_parts_that_do_not_make_the_product_are_refused():
    with pytest.raises(UnsafeRewriting, match="is not"):
        root_of_parts((s - d, s + d), (a, b), root, s**2 + d**2)
