"""Strained parameters in exact algebra: published series, the equations themselves, 50 digits."""

import math
from fractions import Fraction

import mpmath as mp
import pytest
import sympy as sp
from elastolink.derive.perturbation import second_order
from elastolink.derive.perturbation.second_order import centre_and_coupling, second_order_sums
from elastolink.derive.perturbation.strained import DampedAway, strained_boundaries
from elastolink.derive.perturbation.surd import ExactHarmonics, Surd, combine
from strained_truth import DIGITS, boundary, number, published, random_function

F = Fraction


@pytest.mark.parametrize("r", range(5))
def test_mathieu_series_are_the_published_ones(r):
    found = strained_boundaries(ExactHarmonics.of(0, [0, -2]), 2 * r, 8)
    names = [f"a{r}", f"b{r}"] if r else ["a0"]
    series = [published(name) for name in names]
    for expected in series:
        count = len(expected)
        matches = [list(b.alpha[:count]) == expected for b in found.branches]
        assert any(matches), (names, expected)
    if r:
        assert found.split == r
        first, second = (branch.alpha[r - 1] for branch in found.branches)
        assert float(first - second) > 0


ONE = (F(1), F(0))


def exponentials(wave):
    """Return the coefficients of exp(i p theta/2) as pairs of surds."""
    out = {}
    for p in wave.harmonics:
        a, b = wave.coefficient(p)
        if p == 0:
            out[0] = (a, Surd(F(0)))
        else:
            out[p], out[-p] = (a / 2, -b / 2), (a / 2, b / 2)
    return out


def added(into, p, value, factor=ONE):
    zero = Surd(F(0))
    re, im = into.get(p, (zero, zero))
    (x, y), (u, v) = value, factor
    into[p] = (re + x * u - y * v, im + x * v + y * u)


def residual(f, n, alpha, rates, solutions, k):
    """Return y_k'' + n^2/4 y_k + sum alpha_j y_{k-j} + f y_{k-1} + 2 sum beta_j y_{k-j}'."""
    out = {}
    for p, value in exponentials(solutions[k]).items():
        added(out, p, value, (F(n * n - p * p, 4), F(0)))
    for j in range(1, k + 1):
        for p, (x, y) in exponentials(solutions[k - j]).items():
            added(out, p, (x * alpha[j - 1], y * alpha[j - 1]))
            if j <= len(rates):
                added(out, p, (x, y), (F(0), rates[j - 1] * p))
    for p, value in exponentials(solutions[k - 1]).items():
        for m in range(len(f.cosine) + 1):
            a, b = f.harmonic(m)
            if m == 0:
                added(out, p, value, (a, F(0)))
            else:
                added(out, p + 2 * m, value, (a / 2, -b / 2))
                added(out, p - 2 * m, value, (a / 2, b / 2))
    return [part for value in out.values() for part in value if part]


CASES = {
    "mixed": (random_function(1), 2, (0,)),
    "mixed, odd region": (random_function(2), 3, (0,)),
    "damped": (random_function(3), 2, (F(1, 50),)),
    "damped at two orders": (random_function(4), 1, (F(1, 10), F(1, 7))),
    "even": (ExactHarmonics.of(F(1, 2), [1, F(1, 3)]), 2, (0,)),
    "odd": (ExactHarmonics.of(0, [], [1, F(1, 3)]), 1, (0,)),
    "c_n = 0": (ExactHarmonics.of(F(1, 5), [1, F(1, 3)], [F(1, 4), F(1, 6)]), 3, (0,)),
    "c_n = 0, damped": (ExactHarmonics.of(F(1, 5), [1, F(1, 3)], [1]), 4, (0, F(1, 2000))),
    "rational root, damped": (ExactHarmonics.of(0, [F(3, 2)], [2]), 1, (F(3, 4),)),
}


@pytest.mark.parametrize("case", CASES)
def test_every_equation_of_every_order_holds_exactly(case):
    f, n, damping = CASES[case]
    found = strained_boundaries(f, n, 5, damping)
    assert found.branches[0] != found.branches[1]
    for branch in found.branches:
        assert len(branch.alpha) == 5
        assert len(branch.solutions) == 6 - found.split
        for k, (a, b) in enumerate(branch.amplitudes):
            assert branch.solutions[k].coefficient(n) == (a, b)
            assert (a, b).count(0 if k else 1) >= 1
        for k in range(1, len(branch.solutions)):
            assert residual(f, n, branch.alpha, damping, branch.solutions, k) == []


@pytest.mark.parametrize(("a1", "b1"), [(0, 1), (0, -1), (1, 0), (-1, 0), (3, 4), (1, 1)])
@pytest.mark.parametrize("beta", [F(0), F(1, 3), F(-1, 3), F(9, 20)])
def test_first_order_where_the_printed_ratio_fails(a1, b1, beta):
    square = F(a1 * a1 + b1 * b1) - 4 * beta**2
    found = strained_boundaries(ExactHarmonics.of(F(2), [a1], [b1]), 1, 1, beta)
    assert found.radicand == square
    for sign, branch in zip((1, -1), found.branches, strict=True):
        alpha = branch.alpha[0]
        assert (alpha + 2) * (alpha + 2) * 4 == square
        assert (alpha + 2).sign() == sign
        A, B = branch.amplitudes[0]
        assert (alpha + 2 + F(a1, 2)) * A + (beta + F(b1, 2)) * B == 0
        assert (F(b1, 2) - beta) * A + (alpha + 2 - F(a1, 2)) * B == 0
        if b1 + 2 * beta and A:
            assert (A, B * (b1 + 2 * beta)) == (1, -(a1 + 2 * (alpha + 2)))


@pytest.mark.parametrize(("n", "beta"), [(1, F(0)), (2, F(0)), (4, F(0)), (1, F(1, 40)), (5, F(0))])
def test_remainder_falls_as_the_next_coefficient_says(n, beta):
    f = random_function(11, count=2)
    longest = 7
    found = strained_boundaries(f, n, longest, beta)
    with mp.workdps(DIGITS):
        for branch in found.branches:
            alpha = [number(a) for a in branch.alpha]
            gaps = []
            for mu in (mp.mpf(1) / 400, mp.mpf(1) / 800):
                series = [mp.mpf(n * n) / 4]
                for k, value in enumerate(alpha, 1):
                    series.append(series[-1] + value * mu**k)
                damping = mu * mp.mpf(beta.numerator) / beta.denominator
                exact = boundary(f, mu, damping, n, series[-1])
                assert abs(mp.im(exact)) < mp.mpf(10) ** (8 - DIGITS)
                gaps.append([mp.re(exact) - value for value in series])
            for order in range(1, longest):
                one, other = gaps[0][order], gaps[1][order]
                assert float(mp.log(abs(one / other), 2)) == pytest.approx(order + 1, abs=0.1)
                assert float(other * 800 ** (order + 1) / alpha[order]) == pytest.approx(1, abs=0.1)


def test_several_parameters_along_a_ray():
    f, g = random_function(5), random_function(6, count=2)
    whole = combine((f, g), (2, F(-1, 3)))
    assert whole.harmonic(2) == tuple(
        2 * x - y / 3 for x, y in zip(f.harmonic(2), g.harmonic(2), strict=True)
    )
    assert whole.harmonic(3) == tuple(2 * x for x in f.harmonic(3))
    found = strained_boundaries(whole, 1, 1)
    assert found.branches[0].alpha[0] + found.branches[1].alpha[0] == -2 * whole.mean


def test_degenerate_region_parts_at_its_own_order():
    # cos(theta): region n opens with mu^n, by Levy and Keller 2 (mu/2)^n / ((n-1)!)^2.
    for n in range(1, 7):
        found = strained_boundaries(ExactHarmonics.of(0, [1]), n, n)
        assert found.split == n
        one, other = (branch.alpha for branch in found.branches)
        assert one[:-1] == other[:-1]
        assert abs(one[-1].rational - other[-1].rational) == F(
            1, 2 ** (n - 1) * math.factorial(n - 1) ** 2
        )


def test_no_tongue_is_said_so():
    found = strained_boundaries(ExactHarmonics.of(F(1, 3)), 2, 6)
    assert found.split is None and found.radicand is None
    assert found.branches[0].alpha == found.branches[1].alpha == (F(-1, 3), 0, 0, 0, 0, 0)
    cosine, sine = (branch.solutions[0] for branch in found.branches)
    assert cosine.coefficient(2) == (1, 0) and sine.coefficient(2) == (0, 1)
    # cos(2 theta) leaves every odd region closed, to any order.
    assert strained_boundaries(ExactHarmonics.of(0, [0, 1]), 3, 8).split is None
    assert strained_boundaries(ExactHarmonics.of(0, [0, 1]), 4, 2).split == 2


def test_damping_beyond_and_at_the_critical_value_is_refused():
    f = ExactHarmonics.of(0, [0, 3], [0, 4])
    with pytest.raises(DampedAway, match="closes region 2 at order 1"):
        strained_boundaries(f, 2, 3, 2)
    with pytest.raises(DampedAway, match="critical for region 2"):
        strained_boundaries(f, 2, 3, F(5, 4))
    with pytest.raises(DampedAway, match="closes region 4 at order 1"):
        strained_boundaries(f, 4, 3, F(1, 10**9))
    assert strained_boundaries(f, 4, 3, (0, F(1, 10**9))).split == 2


@pytest.mark.parametrize(("region", "order"), [(-1, 2), (1, 0), (1.5, 2), (1, 2.0)])
def test_bad_numbers_are_refused(region, order):
    with pytest.raises(ValueError, match="expected a whole number"):
        strained_boundaries(ExactHarmonics.of(0, [1]), region, order)


def test_bad_coefficients_are_refused():
    with pytest.raises(ValueError, match="expected rational numbers"):
        ExactHarmonics.of(0, [float("nan")])
    with pytest.raises(ValueError, match="expected rational numbers"):
        ExactHarmonics.of("one half")


@pytest.mark.parametrize("n", range(1, 7))
def test_second_order_sums_give_the_closed_form(n):
    f = random_function(20 + n, count=14)
    w0, real, imaginary = second_order_sums().value(f, n)
    assert (w0, (real, imaginary)) == centre_and_coupling(f, n)

    # Over all harmonics at once: w0 = -sum |c_m|^2/(m(m-n)), W = sum c_m c_{n-m}/(m(n-m)).
    def c(m):
        a, b = f.harmonic(abs(m))
        return (a / 2, -b / 2 if m > 0 else b / 2)

    total = [F(0)] * 3
    for m in range(-20, 21):
        if m not in (0, n):
            (x, y), (u, v) = c(m), c(n - m)
            total[0] -= (x * x + y * y) / (m * (m - n))
            total[1] += (x * u - y * v) / (m * (n - m))
            total[2] += (x * v + y * u) / (m * (n - m))
    assert total == [w0, real, imaginary]
    # alpha_2 = w0 -+ Re(conj(c_n) W)/|c_n|, both signs.
    found = strained_boundaries(f, n, 2)
    for sign, branch in zip((1, -1), found.branches, strict=True):
        x, y = c(n)
        along = Surd.of(x * real + y * imaginary) / Surd.root(x * x + y * y)
        assert branch.alpha[1] == w0 - sign * along


def test_printed_notation_by_machine():
    m, n, a, b = second_order.m, second_order.n, second_order.a, second_order.b
    A0, B0 = second_order.A0, second_order.B0
    sums = second_order_sums()
    assert sp.expand(sums.P - A0 * (a[m] + a[m + n]) + B0 * (b[m] - b[m + n])) == 0
    assert sp.expand(sums.Q - A0 * (b[m] + b[m + n]) - B0 * (a[m] - a[m + n])) == 0
    assert sp.expand(sums.R - A0 * (a[m] + a[n - m]) - B0 * (b[m] + b[n - m])) == 0
    assert sp.expand(sums.S - A0 * (b[m] - b[n - m]) + B0 * (a[m] - a[n - m])) == 0
    assert sp.expand(sums.T - A0 * a[n / 2] - B0 * b[n / 2]) == 0
    assert all(n in part.free_symbols for part in sums.formulas())


def test_the_closed_form_is_uniform_and_the_printed_simplification_wrong():
    f, n = random_function(8), 2
    w0, (real, imaginary) = centre_and_coupling(f, n)
    a_n, b_n = f.harmonic(n)
    root = Surd.root(a_n * a_n + b_n * b_n)
    for sign, branch in zip((1, -1), strained_boundaries(f, n, 2).branches, strict=True):
        A, B = branch.amplitudes[0]
        # sigma, tau with A_1 = 0: minus the matrix of second order on (A_0, B_0), (7.33).
        sigma = (w0 + real) * A - imaginary * B
        tau = -imaginary * A + (w0 - real) * B
        half = root * F(sign, 2)
        determinant = (half - a_n / 2) * A - B * (b_n / 2)
        assert branch.alpha[1] == ((half - a_n / 2) * sigma - tau * (b_n / 2)) / determinant
        assert branch.amplitudes[1][1] == (tau * A - sigma * B) / determinant
        printed = sigma / (2 * A) - (sigma * a_n + tau * b_n) / (4 * A * root * sign)
        right = sigma / (2 * A) - (sigma * a_n + tau * b_n) / (2 * A * root * sign)
        assert branch.alpha[1] == right != printed
        assert determinant == A * root * sign


def test_surds():
    root = Surd.root(F(8, 9))
    assert (root.irrational, root.radicand) == (F(2, 3), 2)
    assert root * root == F(8, 9) and Surd.root(F(9, 4)) == F(3, 2)
    assert hash(Surd.root(F(9, 4))) == hash(F(3, 2)) and {Surd.of(2): "two"}[2] == "two"
    x = Surd(F(-3), F(1), 10)
    assert x.sign() == 1 and (-x).sign() == -1 and Surd.of(0).sign() == 0
    assert (1 / F(2) + x) * x.inverse() - x.inverse() / 2 == 1
    # The difference of two numbers that agree to 12 digits keeps all digits of its own.
    close = Surd(F(-665857), F(470832), 2)
    with mp.workdps(40):
        assert float(close) == float(470832 * mp.sqrt(2) - 665857)
    # sqrt(p^2 q) and p sqrt(q) are one number, however they came about.
    assert Surd(F(1), F(1), 2 * 1009**2) == Surd(F(1), F(1009), 2)
    assert Surd(F(1), F(1), 2) != Surd(F(1), F(1), 3) != Surd(F(1), F(-1), 3)
    assert x != "x" and sp.sqrt(10) - 3 == x.sympy()
    for attempt in (lambda: x + root, lambda: Surd.root(F(-1)), lambda: Surd(F(1), F(1))):
        with pytest.raises(ValueError, match="found"):
            attempt()
    with pytest.raises(ZeroDivisionError):
        Surd.of(0).inverse()
