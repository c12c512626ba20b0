"""Meissner's half traces: the words, the printed forms, the recursion, and their digits."""

from __future__ import annotations

from itertools import combinations

import mpmath
import numpy as np
import pytest
import sympy as sp
from elastolink.derive.models.hill_meissner import MODEL
from elastolink.derive.projection import piecewise as pw
from elastolink.derive.safe import UnsafeRewriting
from elastolink.derive.spec import ModelSpec
from elastolink.generated import hill_meissner
from meissner_truth import interval, product

C, S = pw.big_cosine, pw.big_sine
V = pw.ratio


def test_two_and_three_intervals_are_the_printed_functions():
    """Aannaque (7.11)."""
    assert sp.expand(pw.half_trace(2) - (C(1) * C(2) - V(1, 2) * S(1) * S(2))) == 0
    printed = (
        C(1) * C(2) * C(3)
        - V(1, 2) * S(1) * S(2) * C(3)
        - V(1, 3) * S(1) * S(3) * C(2)
        - V(2, 3) * S(2) * S(3) * C(1)
    )
    assert sp.expand(pw.half_trace(3) - printed) == 0


def test_one_interval_is_a_cosine():
    assert pw.half_trace(1) == C(1)


def test_four_sines_have_a_factor_that_is_no_single_ratio():
    factor = pw.half_trace(4).coeff(S(1) * S(2) * S(3) * S(4))
    v1, v2, v3, v4 = map(pw.speed, range(1, 5))
    direct = (v1 * v3 / (v2 * v4) + v2 * v4 / (v1 * v3)) / 2
    assert sp.simplify(pw.in_speeds(factor, 4) - direct) == 0
    assert factor == V(1, 2) * V(3, 4) - V(1, 3) * V(2, 4) + V(1, 4) * V(2, 3)
    # Of the three products of pairs no single one will do.
    for product_ in (V(1, 2) * V(3, 4), V(1, 3) * V(2, 4), V(1, 4) * V(2, 3)):
        assert sp.simplify(pw.in_speeds(product_, 4) - direct) != 0


@pytest.mark.parametrize("count", [5, 6])
def test_longer_words_are_pfaffians(count):
    # half_trace compares each word with the product of the matrices.
    found = pw.half_trace(count)
    assert len(found.as_ordered_terms()) == 2 ** (count - 1)
    v = [pw.speed(i) for i in range(1, count + 1)]
    for chosen in combinations(range(count), count - count % 2):
        odd = sp.Mul(*(v[i] for i in chosen[::2])) / sp.Mul(*(v[i] for i in chosen[1::2]))
        word = next(w for w in pw.words(count) if w.sines == tuple(i + 1 for i in chosen))
        sign = (-1) ** (len(chosen) // 2)
        assert sp.simplify(pw.in_speeds(word.coefficient, count) - sign * (odd + 1 / odd) / 2) == 0


def test_words_that_are_wrong_are_refused(monkeypatch):
    monkeypatch.setattr(pw, "pfaffian", lambda chosen: pw.ratio(1, 2) ** (len(chosen) // 2))
    with pytest.raises(UnsafeRewriting, match="is not"):
        pw.half_trace(3)


def test_a_half_turn_that_is_wrong_is_refused(monkeypatch):
    monkeypatch.setattr(pw, "monodromy", lambda count: pw.Parts.of(2 * sp.eye(2)))
    with pytest.raises(UnsafeRewriting, match="is not"):
        pw.halves()


@pytest.mark.parametrize("count", [0, 13])
def test_too_few_or_too_many_intervals_are_refused(count):
    with pytest.raises(ValueError, match=f"found {count} intervals"):
        list(pw.words(count))


def test_the_words_of_twelve_intervals_are_all_there():
    assert sum(1 for _ in pw.words(3)) == 4
    sizes = [len(word.sines) for word in pw.words(7)]
    assert sizes == sorted(sizes) and len(sizes) == 64


def test_the_printed_latex():
    assert pw.latex_words(2) == "J_{2} = C_{1} C_{2} - V_{12} S_{1} S_{2}"
    four = pw.latex_words(4)
    pfaffian = r"\left(V_{12} V_{34} - V_{13} V_{24} + V_{14} V_{23}\right)"
    assert four.endswith(f"+ {pfaffian} S_{{1}} S_{{2}} S_{{3}} S_{{4}}")
    assert pw._latex(V(1, 10)) == "V_{1,10}" and pw._latex(V(1, 2)) == "V_{12}"


def test_the_sum_of_words_in_many_digits():
    """Six intervals with their own speeds and lengths: words against matrices."""
    random = np.random.default_rng(7)
    v, t = random.uniform(0.2, 3.0, 6), random.uniform(0.1, 2.0, 6)
    with mpmath.workdps(50):
        numbers, letters = {}, {}
        for i, (speed, length) in enumerate(zip(v, t, strict=True), start=1):
            level = mpmath.mpf(speed) ** 2
            at = interval({"level": level, "length": mpmath.mpf(length)})
            numbers |= {f"c{i}": at["cosine"], f"s{i}": at["sine"], f"q{i}": level}
            letters |= {f"C{i}": at["cosine"], f"S{i}": at["sine"] * mpmath.mpf(speed)}
            letters[f"v{i}"] = mpmath.mpf(speed)
        j6 = pw.in_speeds(pw.half_trace(6), 6)
        names = sorted(map(str, j6.free_symbols))
        found = sp.lambdify([sp.Symbol(n) for n in names], _plain(j6), "mpmath")(
            *(letters[n] for n in names)
        )
        assert abs(found - product(6)(numbers)["half_trace"]) < mpmath.mpf(10) ** -45


def _plain(expression):
    return expression.xreplace({s: sp.Symbol(s.name) for s in expression.free_symbols})


# ---------------------------------------------------------------- what is emitted


def states(count, seed):
    random = np.random.default_rng(seed)
    q, t = random.uniform(-2.0, 6.0, (count, 50)), random.uniform(0.1, 2.0, (count, 1))
    pairs = [hill_meissner.interval(q[i], t[i]) for i in range(count)]
    return [(c, s, q[i]) for i, (c, s) in enumerate(pairs)]


@pytest.mark.parametrize(
    ("count", "name"), [(2, "two_intervals"), (3, "three_intervals"), (4, "four_intervals")]
)
def test_the_recursion_gives_the_closed_forms(count, name):
    given = states(count, count)
    closed = getattr(hill_meissner, name)(*(x for state in given for x in state))
    parts = (np.ones(50), np.zeros(50), np.zeros(50), np.zeros(50))
    for state in given:
        parts = hill_meissner.one_more_interval(*parts, *state)
    size = np.max(np.abs(closed), axis=0)
    for one, other in zip(closed, parts, strict=True):
        np.testing.assert_array_less(np.abs(one - other), 1e-14 * (1.0 + size))


def test_the_edge_keeps_its_digits_next_to_coexistence():
    """J^2 - 1 is of the order 1e-16 here: from J alone nothing of it is left."""
    levels = np.array([9.0 * (1.0 + 1e-9), 1.0 - 2e-9])
    c, s = hill_meissner.interval(levels, np.pi)
    j, d, upper, lower = hill_meissner.two_intervals(c[0], s[0], levels[0], c[1], s[1], levels[1])
    numbers = {"q1": levels[0], "q2": levels[1]}
    with mpmath.workdps(60):
        for i in (1, 2):
            at = interval(
                {"level": mpmath.mpf(float(levels[i - 1])), "length": mpmath.mpf(float(np.pi))}
            )
            numbers |= {f"c{i}": at["cosine"], f"s{i}": at["sine"]}
        parts = product(2)({k: mpmath.mpf(x) for k, x in numbers.items()})
        exact = parts["half_trace"] ** 2 - 1
        # Two multiplications of numbers of order 1e-8, each known to a few 1e-16.
        assert abs(d * d + upper * lower - float(exact)) < 1e-23
        assert 1e-17 < abs(exact) < 1e-15
    assert abs(j * j - 1.0 - float(exact)) < 1e-15


@pytest.mark.parametrize("level", [1e-12, 1e-300, 5e-324, 0.0])
def test_both_branches_meet_where_the_level_vanishes(level):
    values = np.array([level, -level])
    cosine, sine = hill_meissner.interval(values, 2.0)
    # cos - cosh is -t^2 q, and the sines differ by t^3 q / 3.
    assert abs(cosine[0] - cosine[1]) <= 4.0 * level * 1.01 + 2.3e-16
    assert abs(sine[0] - sine[1]) <= 8.0 / 3.0 * level * 1.01 + 4.5e-16
    assert np.all(np.isfinite([cosine, sine]))


def test_a_half_turn_factors_the_distance_from_both_edges():
    q = np.linspace(-1.0, 20.0, 40)
    first, second = q[:, None], q[None, :]
    (c1, s1), (c2, s2) = (hill_meissner.interval(x, 0.5 * np.pi) for x in (first, second))
    y1, y2, slope1, slope2 = hill_meissner.half_turn(c1, s1, first, c2, s2, second)
    (c1, s1), (c2, s2) = (hill_meissner.interval(x, np.pi) for x in (first, second))
    j = hill_meissner.two_intervals(c1, s1, first, c2, s2, second)[0]
    np.testing.assert_allclose(1.0 + 2.0 * slope1 * y2, j, rtol=0.0, atol=2e-12)
    np.testing.assert_allclose(2.0 * y1 * slope2 - 1.0, j, rtol=0.0, atol=2e-12)


def test_the_model_describes_all_that_it_returns():
    spec = ModelSpec("hill", "meissner")
    described = MODEL.describe(spec)
    forms = MODEL.energies(spec).kernels
    assert [form.name for form in forms] == list(hill_meissner.RETURNS)
    for form in forms:
        assert {name for name, _ in form.form.outputs} <= set(described.results)
