"""Two independent derivations of the boundaries meet in exact arithmetic.

Strained parameters (real, trigonometric, order by order as Smith prints them) against Bloch's
recursion on the complex resonant harmonics and the root of its 2 x 2 operator.
"""

import random
from fractions import Fraction

import pytest
from smith_chapter_8.exact import exact_operator, exact_series
from smith_chapter_8.second_order import centre_and_coupling
from smith_chapter_8.strained import strained_boundaries
from smith_chapter_8.surd import ExactHarmonics, combine
from strained_truth import random_function

F = Fraction
ORDER = 6
KINDS = {
    "mixed": lambda seed: random_function(seed, count=8),
    "mixed, short": lambda seed: random_function(seed, count=2),
    "even": lambda seed: ExactHarmonics.of(F(1, 7), random_function(seed, count=7).cosine),
    "odd": lambda seed: ExactHarmonics.of(F(-1, 7), [], random_function(seed, count=7).sine),
    "gaps": lambda seed: random_function(seed, count=7).without(1).without(2).without(4),
}


def same(series, found):
    assert series.split == found.split
    assert (series.upper, series.lower) == tuple(branch.alpha for branch in found.branches)


@pytest.mark.parametrize("n", range(7))
@pytest.mark.parametrize("kind", KINDS)
def test_undamped(kind, n):
    f = KINDS[kind](100 + n)
    same(exact_series(exact_operator([f], n, ORDER), [1]), strained_boundaries(f, n, ORDER))


@pytest.mark.parametrize("n", range(7))
@pytest.mark.parametrize("kind", ["mixed", "even", "odd"])
def test_damped(kind, n):
    f = KINDS[kind](200 + n)
    beta = F(random.Random(n).randint(1, 9), 1000)
    series = exact_series(exact_operator([f], n, ORDER, damped=True), [1, beta])
    same(series, strained_boundaries(f, n, ORDER, beta))


@pytest.mark.parametrize("n", range(1, 7))
@pytest.mark.parametrize("count", [2, 3])
def test_several_parameters(n, count):
    rng = random.Random(10 * n + count)
    parts = [random_function(300 + 10 * n + i, count=3 + 2 * i) for i in range(count)]
    direction = [F(rng.choice((-1, 1)) * rng.randint(1, 9), rng.randint(1, 9)) for _ in parts]
    beta = F(1, 500) if any(combine(parts, direction).harmonic(n)) else F(0)
    series = exact_series(exact_operator(parts, n, 4, damped=True), [*direction, beta])
    same(series, strained_boundaries(combine(parts, direction), n, 4, beta))


@pytest.mark.parametrize("n", range(1, 7))
def test_second_order_of_the_operator_is_w0_and_W(n):
    f = random_function(500 + n, count=14)
    operator = exact_operator([f], n, 2)
    a, b = operator.components([1])
    w0, (real, imaginary) = centre_and_coupling(f, n)
    cosine, sine = f.harmonic(n)
    assert a[1] == (w0, 0)
    # B_1 = -c_n or its conjugate, by the order of the basis; B_2 = W likewise.
    assert b[0] in ((-cosine / 2, sine / 2), (-cosine / 2, -sine / 2))
    turn = 1 if b[0][1] == sine / 2 else -1
    assert b[1] == (real, turn * imaginary)
