"""The effective operator in exact arithmetic: published series, determinants at 60 digits."""

from __future__ import annotations

from fractions import Fraction

import mpmath
import pytest
from elastolink.derive import bloch as bloch
from smith_chapter_8.exact import exact_operator, exact_series
from smith_chapter_8.surd import ExactHarmonics

FIRST = ExactHarmonics.of(
    Fraction(1, 3), [Fraction(1, 2), Fraction(-2, 3)], [Fraction(1, 5), Fraction(3, 4)]
)
SECOND = ExactHarmonics.of(
    Fraction(-1, 7), [0, Fraction(2, 5), 1], [Fraction(1, 2), 0, Fraction(-1, 3)]
)
EVEN = ExactHarmonics.of(0, [Fraction(3, 2), Fraction(-1, 4), Fraction(2, 7)])
MATHIEU = ExactHarmonics.of(0, [0, -2])  # y'' + (a - 2 q cos 2x) y = 0


def fractions(text):
    return [Fraction(part) for part in text.split()]


# DLMF 28.6.1-28.6.13: coefficients of q, q^2, ...; a_1 with -q for q is b_1.
PUBLISHED = {
    (0, "upper"): "0 -1/2 0 7/128 0 -29/2304 0 68687/18874368",
    (2, "upper"): "1 -1/8 -1/64 -1/1536 11/36864 49/589824 55/9437184 -83/35389440",
    (2, "lower"): "-1 -1/8 1/64 -1/1536 -11/36864 49/589824 -55/9437184 -83/35389440",
    (4, "upper"): "0 5/12 0 -763/13824 0 1002401/79626240 0 -1669068401/458647142400",
    (4, "lower"): "0 -1/12 0 5/13824 0 -289/79626240 0 21391/458647142400",
    (6, "upper"): "0 1/16 1/64 13/20480 -5/16384 -1961/23592960 -609/104857600",
    (6, "lower"): "0 1/16 -1/64 13/20480 5/16384 -1961/23592960 609/104857600",
    (8, "upper"): "0 1/30 0 433/864000 0 -5701/2721600000",
    (8, "lower"): "0 1/30 0 -317/864000 0 10049/2721600000",
}


@pytest.mark.parametrize("n, branch", PUBLISHED)
def test_mathieus_published_series(n, branch):
    wanted = fractions(PUBLISHED[n, branch])
    found = exact_series(exact_operator([MATHIEU], n, len(wanted)), [1])
    assert list(getattr(found, branch)) == wanted
    assert found.split == (None if n == 0 else n // 2)


# ---------------------------------------------------------------- against determinants


def coefficient(parts, values, m):
    """Return c_m of the combined function."""
    total = mpmath.mpc(0)
    for part, value in zip(parts, values, strict=True):
        a, b = part.harmonic(abs(m))
        size = 1 if m == 0 else mpmath.mpf(1) / 2
        sign = 1 if m > 0 else -1
        total += value * size * (mpmath.mpf(a.numerator) / a.denominator)
        total -= 1j * sign * value * size * (mpmath.mpf(b.numerator) / b.denominator)
    return total


def matrix(parts, n, values, damping, reach):
    """Return Hill's matrix ``k^2 - 2 i K k - F`` for m = -reach ... n + reach, without n^2/4."""
    numbers = range(-reach, n + reach + 1)
    out = mpmath.matrix(len(numbers))
    for i, m in enumerate(numbers):
        for j, other in enumerate(numbers):
            out[i, j] = -coefficient(parts, values, m - other)
        out[i, i] += m * (m - n) - 1j * damping * (2 * m - n)
    return out


def rational(value):
    return mpmath.mpf(value.numerator) / value.denominator


# ---------------------------------------------------------------- both columns, plain matrices


class Matrices:
    """The recursion's algebra with dense matrices of many digits: Omega has both columns."""

    def __init__(self, parts, n, values, damping, reach):
        self.v = matrix(parts, n, values, damping, reach)
        numbers = list(range(-reach, n + reach + 1))
        for i, m in enumerate(numbers):
            self.v[i, i] -= m * (m - n)
        self.levels = [m * (m - n) for m in numbers]
        self.resonant = [numbers.index(m) for m in dict.fromkeys((n, 0))]
        self.start = mpmath.matrix(len(numbers), len(self.resonant))
        for column, row in enumerate(self.resonant):
            self.start[row, column] = 1

    def act(self, x):
        return self.v * x

    def project(self, x):
        return mpmath.matrix([[x[row, j] for j in range(x.cols)] for row in self.resonant])

    def resolve(self, x):
        out = x.copy()
        for i, level in enumerate(self.levels):
            for j in range(x.cols):
                out[i, j] = -x[i, j] / level if level else 0
        return out

    def combine(self, x, h):
        return x * h


@pytest.mark.parametrize("n", [0, 1, 2, 5])
def test_both_columns_of_plain_matrices_give_a_b_and_their_conjugates(n):
    parts, direction, order = (FIRST, SECOND), (Fraction(2, 3), Fraction(-3, 5), Fraction(1, 4)), 5
    a, b = exact_operator(parts, n, order, True).components(direction)
    with mpmath.workdps(50):
        values = [rational(x) for x in direction]
        algebra = Matrices(parts, n, values[:2], values[2], 3 * order)
        found = bloch.run(algebra, order)
        for k in range(order):
            h = found[f"h{k + 1}"]
            own, across = (mpmath.mpc(*map(rational, row[k])) for row in (a, b))
            wanted = [[own, across], [mpmath.conj(across), mpmath.conj(own)]] if n else [[own]]
            assert mpmath.norm(h - mpmath.matrix(wanted)) < mpmath.mpf(10) ** -45


# ---------------------------------------------------------------- relations of exact results


def test_several_parameters_are_one_combined_function():
    """Smith (8.39)-(8.43): the boundaries know F alone."""
    weights, drag = (Fraction(3), Fraction(-2, 5)), Fraction(1, 8)
    pairs = list(zip(weights, (FIRST, SECOND), strict=True))
    rows = [[sum(w * f.harmonic(m)[i] for w, f in pairs) for m in range(4)] for i in (0, 1)]
    both = ExactHarmonics.of(rows[0][0], rows[0][1:], rows[1][1:])
    for n in (0, 1, 3):
        several = exact_operator((FIRST, SECOND), n, 6, True).components((*weights, drag))
        single = exact_operator((both,), n, 6, True).components((1, drag))
        assert several == single


def test_the_first_order_is_the_mean_the_harmonic_and_the_drag():
    for n in (1, 2):
        found = exact_operator([FIRST], n, 1, True)
        a_n, b_n = FIRST.harmonic(n)
        assert found.exponents == (((1, 0), (0, 1)),)
        assert found.diagonal == (((-FIRST.mean, 0), (0, -n)),)
        assert found.coupling == (((-a_n / 2, b_n / 2), (0, 0)),)


def test_an_even_function_gives_real_coefficients_and_a_turned_one_a_phase():
    real = exact_operator([EVEN], 3, 6)
    assert all(y == 0 for rows in (real.diagonal, real.coupling) for row in rows for _, y in row)
    # f(theta + pi/2): c_m i^m, so that B gets i^n and A stays.
    turned = ExactHarmonics.of(0, [0, Fraction(1, 4), 0], [Fraction(-3, 2), 0, Fraction(2, 7)])
    found = exact_operator([turned], 3, 6)
    assert found.diagonal == real.diagonal
    assert found.coupling == tuple(tuple((y, -x) for x, y in row) for row in real.coupling)


# ---------------------------------------------------------------- series


def test_what_has_no_real_series_is_refused():
    single = ExactHarmonics.of(0, [1])
    with pytest.raises(ValueError, match="closes the region"):
        exact_series(exact_operator([single], 1, 2, True), (1, 1))
    # |c_1| = n K: at the tip of the tongue S begins with a higher power.
    with pytest.raises(ValueError, match="meets its tip"):
        exact_series(exact_operator([single], 1, 2, True), (1, Fraction(1, 2)))
    # No third order connects the harmonics: coexistence as far as is seen.
    series = exact_series(exact_operator([single], 4, 3), [1])
    assert series.split is None
    assert series.upper == series.lower
