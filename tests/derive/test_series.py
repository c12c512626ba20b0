"""Taylor polynomials against SymPy's own series."""

from __future__ import annotations

import pytest
import sympy as sp
from elastolink.derive.series import taylor

p = sp.Symbol("p", positive=True)


@pytest.mark.parametrize(
    "expression",
    [
        1 - sp.cos(p) * sp.cosh(p),
        sp.sinh(p) - sp.sin(p),
        (p**2 * sp.sin(2 * p) + 3) * sp.exp(-p),
        sp.cos(p / 3) ** 2 * sp.Symbol("a"),
    ],
)
def test_against_sympy(expression):
    found = taylor(expression, p, 4)
    order = sp.degree(found.remainder, p)
    series = sp.series(expression, p, 0, order + 1).removeO()
    assert sp.expand(found.value + found.remainder - series) == 0
    assert len(sp.Add.make_args(sp.collect(found.value, p))) == 4


@pytest.mark.parametrize("expression", [1 / p, sp.sqrt(p), sp.exp(p**2), sp.log(1 + p)])
def test_other_kinds_are_refused(expression):
    with pytest.raises(ValueError, match="is no power and no exponential"):
        taylor(expression, p, 2)


def test_a_polynomial_ends():
    with pytest.raises(ValueError, match="no 3 non-zero terms"):
        taylor(1 + p**2, p, 2)
