"""The printed formulas, read back and evaluated, are the effective operator."""

from __future__ import annotations

import inspect
import itertools
import re

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.perturbation.effective import effective_operator
from elastolink.runtime.hill.perturbation.formulas import (
    HIGHEST_FORMULA,
    boundary_latex,
    solution_latex,
)

F = PeriodicFunction([0.4, 0.9, -0.5], [0.0, 0.3, 0.7])
ONE = PeriodicFunction([0.3, 1.0], [0.0, 0.5])
DRAG = 0.3


def lines(text):
    """Return the sums of a formula by their left sides."""
    body = text.removeprefix("\\begin{aligned}\n").removesuffix("\n\\end{aligned}")
    found, left = {}, ""
    for line in body.split(" \\\\\n"):
        head, _, rest = line.partition("&")
        left = head.strip() or left
        found[left] = found.get(left, "") + rest.removeprefix("= ").replace(r"\quad", "")
    return found


RULE = r"\text{in the sums: } c_{m-l}"


def evaluate(sums, name, f, n, order, m=None):
    """Read a sum as Python: indices as arguments, a space as a product.

    The coefficient between equal harmonics is the mean, unless the formula says that it is 0.
    """
    text = sums[name]
    mean = f.a[0]
    if RULE in sums:
        assert sums[RULE].split() == ["0", "(m", "=", "l)"]
        mean = 0.0
    c = np.concatenate([0.5 * (f.a + 1j * f.b)[:0:-1], [mean], 0.5 * (f.a - 1j * f.b)[1:]])
    numbers = range(-order * f.harmonics, n + order * f.harmonics + 1)
    others = [k for k in numbers if k * (k - n)]

    def harmonic(k):
        if k == "mean":
            return f.a[0]
        return c[k + f.harmonics] if abs(k) <= f.harmonics else 0.0

    def v(k, j):
        return 1j * (2 * k - n) * DRAG if k == j else harmonic(k - j)

    def total(term):
        count = len(inspect.signature(term).parameters)
        return sum(term(*values) for values in itertools.product(others, repeat=count))

    text = text.replace("c_{0}", "c('mean')").replace(r"\bar{c}_", "b_")
    text = re.sub(r"\b([cbv])_\{([^{}]*)\}", r"\1(\2)", re.sub(r"m_(\d)", r"m\1", text))
    text = re.sub(r"\^\{(\d+)\}", r"**\1", text)
    text = re.sub(r"\\frac\{([^{}]*)\}\{([^{}]*)\}", r"((\1)/(\2))", text)
    text = text.replace(r"\left(", "(").replace(r"\right)", ")")
    text = re.sub(r"(?<=[\w)]) (?=[\w(\\])", "*", text)
    # A sum reaches to the end of its fraction, which is one pair of parentheses by now.
    while match := re.search(r"\\sum_\{([^{}]*)\}\s*\*?\s*\(", text):
        depth, end = 1, match.end()
        while depth:
            depth += {"(": 1, ")": -1}.get(text[end], 0)
            end += 1
        inner = text[match.end() - 1 : end]
        text = f"{text[: match.start()]}total(lambda {match[1]}: {inner}){text[end:]}"
    names = {"c": harmonic, "b": lambda k: np.conj(harmonic(k)), "v": v, "total": total}
    return eval(text, {**names, "n": n, "m": m, "i": 1j, "K": DRAG})


@pytest.mark.parametrize("letter", [True, False])
@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("n", [0, 1, 2, 3])
def test_formulas_of_the_boundaries_read_back(n, damped, letter):
    order = 4
    operator = effective_operator([F], n, order, damped)
    values = [1.0, DRAG] if damped else [1.0]
    a, b = operator.components(values)
    found = lines(boundary_latex(order, None if letter and n else n, damped))
    for k in range(1, order + 1):
        assert evaluate(found, f"A_{{{k}}}", F, n, order) == pytest.approx(a[k - 1], abs=1e-13)
        if n:
            assert evaluate(found, f"B_{{{k}}}", F, n, order) == pytest.approx(b[k - 1], abs=1e-13)


@pytest.mark.parametrize("order", [5, 6])
def test_high_orders_read_back(order):
    """One harmonic: no path of six steps goes further than three from a resonant one."""
    a, b = effective_operator([ONE], 1, order).components([1.0])
    sums = lines(boundary_latex(order, 1))
    for name, value in (("A", a[-1]), ("B", b[-1])):
        found = evaluate(sums, f"{name}_{{{order}}}", ONE, 1, 3)
        assert found == pytest.approx(value, abs=1e-13)


@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("n", [0, 1, 2])
def test_formulas_of_the_solution_read_back(n, damped):
    order = 3
    operator = effective_operator([F], n, order, damped)
    harmonics, columns = operator.solution([1.0, DRAG] if damped else [1.0])
    found = lines(solution_latex(order, n or 0, damped))
    for m, column in zip(harmonics, columns.T, strict=True):
        if m * (m - n):
            for k in range(1, order + 1):
                value = evaluate(found, f"v_{{{k},m}}", F, n, order, int(m))
                assert value == pytest.approx(column[k], abs=1e-13)


@pytest.mark.parametrize("text", [boundary_latex, solution_latex])
@pytest.mark.parametrize("n", [None, 0, 1, 12])
@pytest.mark.parametrize("damped", [False, True])
def test_braces_and_environments_are_balanced(text, n, damped):
    for order in range(1, HIGHEST_FORMULA):
        found = text(order, n, damped)
        depth = 0
        for sign in found:
            depth += {"{": 1, "}": -1}.get(sign, 0)
            assert depth >= 0
        assert depth == 0
        assert found.count(r"\left") == found.count(r"\right")
        assert found.startswith("\\begin{aligned}\n") and found.endswith("\n\\end{aligned}")
        assert found.isascii()
        assert not re.search(r"\+ -|- -|\(-1\)|--", found)
        assert all(line.count("&") == 1 for line in found.splitlines()[1:-1])


def test_the_first_orders_are_what_one_writes_by_hand():
    found = lines(boundary_latex(3))
    assert found["A_{1}"] == "-c_{0}"
    assert found["B_{1}"] == "-c_{n}"
    assert found["A_{2}"] == r"-\sum_{m} \frac{c_{n-m} c_{m-n}}{m (m-n)}"
    assert found["B_{2}"] == r"-\sum_{m} \frac{c_{n-m} c_{m}}{m (m-n)}"
    assert lines(boundary_latex(1, 2, True))["A_{1}"] == "-c_{0} - i 2 K"
    assert r"\lambda^2 &= \frac{9}{4} + " in boundary_latex(1, 3)
    assert r"\lambda^2 &= 4 + " in boundary_latex(1, 4)
    assert lines(solution_latex(1))["v_{1,m}"] == r"\frac{1}{m (m-n)} c_{m-n}"


MISUSE = {
    "order 0": (lambda: boundary_latex(0), "order"),
    "order 7": (lambda: boundary_latex(7), "use effective_operator"),
    "order 6": (lambda: solution_latex(6), "from 1 to 5"),
    "order as a truth": (lambda: boundary_latex(True), "order"),
    "region": (lambda: boundary_latex(1, -1), "region"),
    "half region": (lambda: solution_latex(1, 0.5), "region"),
}


@pytest.mark.parametrize("case", MISUSE)
def test_misuse_is_refused_in_one_line(case):
    call, expected = MISUSE[case]
    with pytest.raises(BadInput, match=expected) as told:
        call()
    assert "\n" not in str(told.value)
