"""Boundaries in exact arithmetic: Bloch's operator against published series and other routes."""

from __future__ import annotations

import random
from fractions import Fraction

import mpmath
import pytest
from smith_chapter_8.exact import exact_operator, exact_series, run
from smith_chapter_8.strained import strained_boundaries
from smith_chapter_8.surd import ExactHarmonics, combine
from strained_truth import PUBLISHED, published, random_function

FIRST = ExactHarmonics.of(
    Fraction(1, 3), [Fraction(1, 2), Fraction(-2, 3)], [Fraction(1, 5), Fraction(3, 4)]
)
SECOND = ExactHarmonics.of(
    Fraction(-1, 7), [0, Fraction(2, 5), 1], [Fraction(1, 2), 0, Fraction(-1, 3)]
)
MATHIEU = ExactHarmonics.of(0, [0, -2])  # y'' + (a - 2 q cos 2x) y = 0


@pytest.mark.parametrize("name", PUBLISHED)
def test_mathieus_published_series(name):
    """DLMF 28.6.1-28.6.13: a_1 with -q for q is b_1."""
    wanted, n = published(name), 2 * int(name[1:])
    series = exact_series(exact_operator([MATHIEU], n, len(wanted)), [1])
    assert list(series.upper if name[0] == "a" else series.lower) == wanted
    assert series.split == (n // 2 if 0 < n <= 2 * len(wanted) else None)


# ---------------------------------------------------------------- against strained parameters

KINDS = {
    "mixed": lambda seed: random_function(seed, count=4),
    "even": lambda seed: ExactHarmonics.of(Fraction(1, 7), random_function(seed, 4).cosine),
    "odd": lambda seed: ExactHarmonics.of(Fraction(-1, 7), [], random_function(seed, 4).sine),
    "gaps": lambda seed: random_function(seed, count=6).without(1).without(2).without(4),
}


def same(series, strained):
    assert series.split == strained.split
    assert (series.upper, series.lower) == tuple(branch.alpha for branch in strained.branches)


@pytest.mark.parametrize("n", range(5))
@pytest.mark.parametrize("kind", KINDS)
def test_strained_parameters_give_the_same_series(kind, n):
    """Real, trigonometric and order by order, as Smith prints them."""
    f, order = KINDS[kind](100 + n), 5
    same(exact_series(exact_operator([f], n, order), [1]), strained_boundaries(f, n, order))
    if kind != "gaps":
        beta = Fraction(random.Random(n).randint(1, 9), 1000)
        series = exact_series(exact_operator([f], n, order, damped=True), [1, beta])
        same(series, strained_boundaries(f, n, order, beta))


@pytest.mark.parametrize("n", range(1, 5))
@pytest.mark.parametrize("count", [2, 3])
def test_several_parameters_are_strained_along_a_ray(n, count):
    rng = random.Random(10 * n + count)
    parts = [random_function(300 + 10 * n + i, count=3 + 2 * i) for i in range(count)]
    ray = [Fraction(rng.choice((-1, 1)) * rng.randint(1, 9), rng.randint(1, 9)) for _ in parts]
    beta = Fraction(1, 500) if any(combine(parts, ray).harmonic(n)) else Fraction(0)
    series = exact_series(exact_operator(parts, n, 4, damped=True), [*ray, beta])
    same(series, strained_boundaries(combine(parts, ray), n, 4, beta))


# ---------------------------------------------------------------- both columns, plain matrices


def rational(value):
    return mpmath.mpf(value.numerator) / value.denominator


def coefficient(part, m):
    """Return c_m of a function."""
    a, b = map(rational, part.harmonic(abs(m)))
    return a if m == 0 else mpmath.mpc(a, -b if m > 0 else b) / 2


class Matrices:
    """The recursion's algebra with dense matrices of many digits: Omega has both columns."""

    def __init__(self, parts, n, values, damping, reach):
        numbers = list(range(-reach, n + reach + 1))
        self.v = mpmath.matrix(len(numbers))
        for i, m in enumerate(numbers):
            for j, other in enumerate(numbers):
                for part, value in zip(parts, values, strict=True):
                    self.v[i, j] -= value * coefficient(part, m - other)
            self.v[i, i] -= 1j * damping * (2 * m - n)
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
        found = run(algebra, order)
        for k in range(order):
            h = found[f"h{k + 1}"]
            own, across = (mpmath.mpc(*map(rational, row[k])) for row in (a, b))
            wanted = [[own, across], [mpmath.conj(across), mpmath.conj(own)]] if n else [[own]]
            assert mpmath.norm(h - mpmath.matrix(wanted)) < mpmath.mpf(10) ** -45


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
