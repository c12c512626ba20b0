"""Several parameters: the standard method fails, the modified one stops at second order.

Truth: eigenvalues of the Fourier matrix in 50 digits, and the run time's own exact boundaries.
"""

import math
from fractions import Fraction

import pytest
import sympy as sp
from smith_chapter_8.modified import (
    common_solution_condition,
    modified_formulas,
    modified_method,
    psi,
    standard_method,
)
from smith_chapter_8.second_order import a, b, centre_and_coupling, m, n
from smith_chapter_8.strained import strained_boundaries
from smith_chapter_8.surd import ExactHarmonics, combine
from strained_truth import random_function

F = Fraction
ONE, TWO = random_function(31, count=5), random_function(32, count=4)
sigma = sp.Symbol("sigma", real=True)


def test_standard_method_contradicts_itself():
    found = standard_method((ONE, TWO), 2)
    assert not found.consistent
    (a2, b2), (c2, d2) = ONE.harmonic(2), TWO.harmonic(2)
    assert found.determinants == (a2 * d2 - b2 * c2,)
    for f, row in zip((ONE, TWO), found.ratios, strict=True):
        x, y = (float(v) for v in f.harmonic(2))
        for sign, (first, second) in zip((1, -1), row, strict=True):
            assert first == 1
            assert float(second) == pytest.approx(-(x + sign * math.hypot(x, y)) / y)
    ratios = [float(second) for row in found.ratios for _, second in row]
    assert min(abs(x - y) for x in ratios[:2] for y in ratios[2:]) > 0.05
    # A pair of quadratics shares a root exactly where the determinant vanishes.
    an, bn, cn, dn = sp.symbols("a_n b_n c_n d_n", real=True)
    assert sp.expand(common_solution_condition() + 4 * (an * dn - bn * cn) ** 2) == 0


@pytest.mark.parametrize("region", [1, 2, 3, 4])
def test_six_second_order_coefficients(region):
    """By the complex sums over harmonics, which the method does not use."""
    found = modified_method((ONE, TWO), region)
    bare = [f.without(region) for f in (ONE, TWO)]
    w = {}
    for key, weights in {(2, 0): (1, 0), (0, 2): (0, 1), (1, 1): (1, 1)}.items():
        centre, (re, im) = centre_and_coupling(combine(bare, weights), region)
        w[key] = (centre, re, im)
    w[1, 1] = tuple(x - y - z for x, y, z in zip(w[1, 1], w[2, 0], w[0, 2], strict=True))
    for sign, branch in ((-1, found.lower), (1, found.upper)):
        assert len(branch.alpha) == 9
        for key, (centre, re, im) in w.items():
            expected = centre - sign * (re * sp.cos(psi) - im * sp.sin(psi))
            assert sp.expand(branch.alpha[*key, 0] - expected) == 0
            left_over = re * sp.sin(psi) + im * sp.cos(psi)
            assert sp.expand(branch.excess[*key, 0] ** 2 - left_over**2) == 0
        assert branch.alpha[0, 0, 2] == -sp.Rational(1, 8 * region**2)
        for key, f in (((1, 0, 1), ONE), ((0, 1, 1), TWO)):
            cosine, sine = (sp.Rational(x) for x in f.harmonic(2 * region))
            expected = sign * (cosine * sp.cos(2 * psi) + sine * sp.sin(2 * psi)) / (4 * region**2)
            assert sp.expand(branch.alpha[key] - expected) == 0
        assert set(branch.constants) == {(1, 0, 0), (0, 1, 0), (0, 0, 1)}
        assert branch.constants[0, 0, 1] == 0


@pytest.mark.parametrize("region", [1, 2, 3])
def test_general_sums_are_those_of_given_functions(region):
    table = modified_formulas()
    found = modified_method((ONE, TWO), region)
    bare = [f.without(region) for f in (ONE, TWO)]
    bases = {"a": (bare[0], 0), "b": (bare[0], 1), "c": (bare[1], 0), "d": (bare[1], 1)}

    def at(term, harmonic):
        term = term.xreplace({n: sp.Integer(region), m: sp.Integer(harmonic)})
        values = {}
        for x in term.atoms(sp.Indexed):
            f, kind = bases[str(x.base)]
            index = int(x.indices[0])
            values[x] = sp.Rational(f.harmonic(index)[kind]) if index > 0 else 0
        return term.xreplace(values)

    for name, key in (("alpha_200", (2, 0, 0)), ("alpha_110", (1, 1, 0))):
        above, below = sorted(table[name].atoms(sp.Sum), key=lambda s: s.limits[0][2] != sp.oo)
        value = sum(at(above.function, k) for k in range(1, 6))
        value += sum(at(below.function, k) for k in range(1, (region - 1) // 2 + 1))
        if region % 2 == 0:
            (piece,) = table[name].atoms(sp.Piecewise)
            value += at(piece.args[0][0], 1)
        for sign, branch in ((-1, found.lower), (1, found.upper)):
            assert sp.expand(value.subs(sigma, sign) - branch.alpha[key]) == 0
    assert table["alpha_002"] == -1 / (8 * n**2)
    twice = sigma * (a[2 * n] * sp.cos(2 * psi) + b[2 * n] * sp.sin(2 * psi)) / (4 * n**2)
    assert sp.expand(table["alpha_101"] - twice) == 0


def test_three_of_six_equations_cannot_be_solved():
    found = modified_method((ONE, TWO), 2)
    assert not found.solvable
    for branch in (found.lower, found.upper):
        assert set(branch.excess) == {(2, 0, 0), (1, 1, 0), (0, 2, 0)}
        assert all(value != 0 for value in branch.excess.values())
        # In numbers, at psi of the direction (1, 1): far from zero.
        _, angle = found.polar((1.0, 1.0))
        assert min(abs(float(v.subs(psi, angle))) for v in branch.excess.values()) > 1e-3
    even = (ExactHarmonics.of(0, [1, 2, 1]), ExactHarmonics.of(0, [3, -1, 1]))
    held = modified_method(even, 2)
    for branch in (held.lower, held.upper):
        assert all(v.subs(psi, k * sp.pi) == 0 for v in branch.excess.values() for k in (0, 1))


def proportional():
    """Return two functions whose second harmonics are proportional, so that delta can vanish."""
    first = ExactHarmonics.of(F(1, 5), [F(4, 5), F(2, 5), F(1, 2)], [F(3, 10), F(1, 5), F(-1, 3)])
    second = ExactHarmonics.of(F(-1, 3), [F(-1, 2), F(3, 5)], [F(7, 10), F(3, 10)])
    return first, second


def test_third_order_has_delta_in_its_denominator():
    """Times delta the exact third order on a ray tends to the unsolved part squared, not to 0."""
    functions, region = proportional(), 2
    found = modified_method(functions, region)
    flat = (F(3, 5), F(-2, 5))
    assert found.polar([float(x) for x in flat])[0] < 1e-15
    products = []
    for off in (F(1, 100), F(1, 1000), F(1, 10000)):
        point = (flat[0] + off, flat[1])
        numbers = [float(x) for x in point]
        branches = strained_boundaries(combine(functions, point), region, 3).branches
        delta = found.polar(numbers)[0]
        square = found.unsolved(numbers) ** 2
        for sign, branch in zip((1, -1), branches, strict=True):
            products.append(sign * float(branch.alpha[2]) * delta / square)
            assert abs(products[-1] - 1) < 20 * off
    assert abs(found.unsolved(numbers)) > 0.04
