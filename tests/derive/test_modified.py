"""Several parameters: the standard method fails, the modified one stops at second order.

Truth: eigenvalues of the Fourier matrix in 50 digits, and the run time's own exact boundaries.
"""

import math
from fractions import Fraction

import pytest
import sympy as sp
from elastolink.derive.perturbation.modified import (
    alternative_method,
    common_solution_condition,
    modified_formulas,
    modified_method,
    psi,
    standard_method,
    uniform_second_order,
)
from elastolink.derive.perturbation.second_order import a, b, centre_and_coupling, m, n
from elastolink.derive.perturbation.strained import strained_boundaries
from elastolink.derive.perturbation.surd import ExactHarmonics, combine
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import hill_boundaries
from strained_truth import random_function

F = Fraction
ONE, TWO = random_function(31, count=5), random_function(32, count=4)
sigma = sp.Symbol("sigma", real=True)


def exact(functions, region, parameters):
    """Return (lower, upper) from the Hill matrix of the run time."""
    whole = combine(functions, parameters)
    f = PeriodicFunction(
        [float(whole.mean), *map(float, whole.cosine)], [0.0, *map(float, whole.sine)]
    )
    found = hill_boundaries(f, 1.0, regions=(region,))
    return float(found.lower[0]), float(found.upper[0])


def gap(pair, truth):
    return max(abs(x - y) for x, y in zip(pair, truth, strict=True))


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


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (ExactHarmonics.of(0, [1, 2]), ExactHarmonics.of(0, [3, -1])),
        (ExactHarmonics.of(0, [], [1, 2]), ExactHarmonics.of(0, [], [3, -1])),
        (ONE, combine((ONE,), (-2,))),
        (ONE, ExactHarmonics.of(1, [1, 0, 1], [1, 0, 1])),
    ],
    ids=["even", "odd", "proportional, other sign", "no second harmonic"],
)
def test_where_the_standard_method_holds(first, second):
    assert standard_method((first, second), 2).consistent


def test_modified_method_at_first_order():
    found = modified_method((ONE, TWO), 2)
    for branch, half in ((found.lower, -1), (found.upper, 1)):
        assert branch.alpha[1, 0, 0] == -sp.Rational(ONE.mean)
        assert branch.alpha[0, 1, 0] == -sp.Rational(TWO.mean)
        assert branch.alpha[0, 0, 1] == sp.Rational(half, 2)
    delta, angle = found.polar((0.1, -0.2))
    (a2, b2), (c2, d2) = ((float(x) for x in f.harmonic(2)) for f in (ONE, TWO))
    assert delta * math.cos(angle) == pytest.approx(0.1 * a2 - 0.2 * c2)
    assert delta * math.sin(angle) == pytest.approx(0.1 * b2 - 0.2 * d2)


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


def test_three_methods_on_a_circle():
    """Errors over size^3: bounded for the uniform form everywhere, for the others far off only."""
    functions, region = proportional(), 2
    # Here delta vanishes: 3 * (2, 1)/5 - 2 * (3, 3/2)/5 = 0.
    flat = (F(3, 5), F(-2, 5))
    modified = modified_method(functions, region)
    base = math.atan2(float(flat[1]), float(flat[0]))
    assert modified.polar([0.6, -0.4])[0] < 1e-15
    table = {}
    for size in (F(1, 100), F(1, 200), F(1, 400)):
        for off in (0.0, 1e-3, 1e-2, 0.1, 0.5, 1.2, 2.0, 2.7):
            if off:
                point = tuple(F(g(base + off)) * size for g in (math.cos, math.sin))
            else:
                point = tuple(x * size for x in flat)
            truth = exact(functions, region, point)
            numbers = [float(x) for x in point]
            row = {
                "uniform": gap(uniform_second_order(functions, region, point), truth),
                "alternative": gap(alternative_method(functions, region, point), truth),
            }
            if off:
                row["modified"] = gap(modified.boundaries(numbers), truth)
            else:
                with pytest.raises(ValueError, match="delta_2 vanishes"):
                    modified.boundaries([0.0, 0.0])
            table[float(size), off] = row
    for (size, off), row in table.items():
        assert row["uniform"] < 0.25 * size**3
        if off > 1e-3:
            # Along a ray both are the same second-order series, to round-off.
            assert row["alternative"] == pytest.approx(row["modified"], abs=1e-13)
        elif off == 0.0:
            # On the flat ray itself the series in the ray's own order s = 2 holds.
            assert row["alternative"] < 0.25 * size**3
    for off in (0.5, 1.2, 2.0):
        one, other = table[0.01, off], table[0.005, off]
        assert math.log2(one["modified"] / other["modified"]) == pytest.approx(3.0, abs=0.1)
    # Towards that ray the error over size^3 grows like 1/delta: 0.1, 1, and 20 at 1/1000 rad.
    scaled = [table[0.0025, off]["modified"] / 0.0025**3 for off in (0.5, 1e-2, 1e-3)]
    assert scaled == pytest.approx([0.112, 1.07, 23.3], rel=0.02)
    for size in (0.01, 0.005, 0.0025):
        row = table[size, 1e-3]
        assert row["modified"] > 1000 * row["uniform"]


def test_alternative_method_does_not_depend_on_the_divisor():
    for point in ((F(1, 50), F(-1, 90)), (F(1, 90), F(1, 50)), (F(-1, 30), 0), (0, F(1, 30))):
        low, high = alternative_method((ONE, TWO), 1, point, order=1)
        whole = combine((ONE, TWO), point)
        cosine, sine = (float(x) for x in whole.harmonic(1))
        centre, half = 0.25 - float(whole.mean), math.hypot(cosine, sine) / 2
        assert (low, high) == pytest.approx((centre - half, centre + half), abs=1e-15)
    with pytest.raises(ValueError, match="expected a ray"):
        alternative_method((ONE, TWO), 1, (0, 0))


def test_more_than_two_parameters():
    functions = (ONE, TWO, random_function(33, count=3))
    found = modified_method(functions, 2)
    assert len(found.upper.alpha) == 4 + 10
    direction = (F(3, 5), F(-2, 5), F(1, 2))
    gaps = []
    for size in (F(1, 100), F(1, 200)):
        point = tuple(x * size for x in direction)
        gaps.append(gap(found.boundaries([float(x) for x in point]), exact(functions, 2, point)))
    assert math.log2(gaps[0] / gaps[1]) == pytest.approx(3.0, abs=0.15)
    assert gaps[0] < 1e-4


def test_bad_arguments_are_refused():
    for functions, region in (((), 1), ((ONE,), 0), ((ONE,), 1.5)):
        with pytest.raises(ValueError, match="expected at least one function"):
            modified_method(functions, region)
