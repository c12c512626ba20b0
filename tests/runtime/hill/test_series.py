"""Coefficients of the boundaries and their formulas: published, derived otherwise, read back."""

import inspect
import itertools
import re
from fractions import Fraction

import elastolink as el
import numpy as np
import pytest
from boundary_cases import SHARES, drag, function
from boundary_truth import MP, coefficients
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import boundary_series
from elastolink.runtime.hill.bloch import effective_operator
from elastolink.runtime.hill.series import boundary_latex

MIXED = el.PeriodicFunction(a=[0.1, 1.0, 0.4, 0.15], b=[0.0, 0.3, -0.2, 0.1])
RULE = r"\text{in the sums: } c_{m-l}"


def test_no_width_to_first_order():
    gapless = el.PeriodicFunction(a=[0.0, 1.0, 0.0, 0.3], b=[0.0, 0.2, 0.0, 0.0])
    found = boundary_series(gapless, 2, 4)
    assert found.splitting == 2 and found.lower[0] == found.upper[0] == 0.0
    assert found.lower[1] < found.upper[1]
    # A function of period pi leaves the odd regions closed for ever.
    closed = boundary_series(el.PeriodicFunction(a=[0.0, 0.0, 1.0]), 1, 6)
    assert closed.splitting == 0 and np.array_equal(closed.lower, closed.upper)


def test_plot():
    ax = boundary_series(MIXED, 2, 2).plot()
    assert {line.get_label() for line in ax.get_lines()} >= {"exact", "order 1", "order 2"}


def test_small_differences_are_not_taken_for_zero():
    # cos theta + 1e-14 cos 2 theta: c_2 itself opens region 2.
    found = boundary_series(el.PeriodicFunction([0.0, 1.0, 1e-14]), 2, 2)
    assert found.splitting == 1
    assert found.upper[0] - found.lower[0] == pytest.approx(1e-14, rel=1e-13, abs=0)
    assert abs(found.upper[1] - found.lower[1]) == pytest.approx(0.5, rel=1e-13)
    # DLMF 28.6.14 for a = 4 lam2, q = 2 mu: a_n - b_n begins with 2 q^n / (4^(n-1) (n-1)!^2).
    for size in (1.0, 1e-3):
        found = boundary_series(el.PeriodicFunction([0.0, size]), 10, 10)
        width = 0.5 * (2 * size) ** 10 / (4.0**9 * 362880.0**2)
        assert found.splitting == 10
        assert found.upper[9] - found.lower[9] == pytest.approx(width, rel=1e-12, abs=0)
    # The same with a fiftieth harmonic, which takes no part.
    a = np.zeros(51)
    a[[1, 50]] = 0.01, 1.0
    found = boundary_series(el.PeriodicFunction(a), 3, 3)
    assert found.splitting == 3 and found.passed
    assert found.upper[2] - found.lower[2] == pytest.approx(0.02**3 / 128, rel=1e-12, abs=0)


def test_a_cancelled_difference_is_zero_within_its_error():
    """Region 4: ``B_2 = c_2^2 / 4 + 2 c_1 c_3 / 3`` vanishes with ``a_3 = -3 a_2^2 / (8 a_1)``."""
    a1, a2 = 0.7, 0.3
    f = el.PeriodicFunction([0.0, a1, a2, -3 * a2 * a2 / (8 * a1)])
    found = boundary_series(f, 4, 4)
    assert found.splitting == 3 and found.passed
    assert found.upper[1] == found.lower[1]
    # Terms of 0.02, some units of round-off.
    assert 1e-17 < found.error[0, 1] < 1e-14
    near = boundary_series(el.PeriodicFunction(f.a * [1, 1, 1, 1 + 1e-9]), 4, 4)
    assert near.splitting == 2


def test_the_error_of_the_function_is_no_difference():
    f = el.PeriodicFunction([0.0, 1.0, 1e-17], error=1e-15)
    found = boundary_series(f, 2, 3)
    assert found.splitting == 2
    assert found.error[0, 0] >= 1e-17


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


def evaluate(sums, name, f, n, order):
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
    return eval(text, {**names, "n": n, "i": 1j, "K": DRAG})


@pytest.mark.parametrize("letter", [True, False])
@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("n", [0, 1, 2, 3])
def test_formulas_of_the_boundaries_read_back(n, damped, letter):
    order = 4
    operator = effective_operator((F,), n, order, damped)
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
    a, b = effective_operator((ONE,), 1, order).components([1.0])
    sums = lines(boundary_latex(order, 1))
    for name, value in (("A", a[-1]), ("B", b[-1])):
        found = evaluate(sums, f"{name}_{{{order}}}", ONE, 1, 3)
        assert found == pytest.approx(value, abs=1e-13)


def test_the_first_orders_are_what_one_writes_by_hand():
    found = lines(boundary_latex(3))
    assert found["A_{1}"] == "-c_{0}"
    assert found["B_{1}"] == "-c_{n}"
    assert found["A_{2}"] == r"-\sum_{m} \frac{c_{n-m} c_{m-n}}{m (m-n)}"
    assert found["B_{2}"] == r"-\sum_{m} \frac{c_{n-m} c_{m}}{m (m-n)}"
    assert lines(boundary_latex(1, 2, True))["A_{1}"] == "-c_{0} - i 2 K"
    assert r"\lambda^2 &= \frac{9}{4} + " in boundary_latex(1, 3)
    assert r"\lambda^2 &= 4 + " in boundary_latex(1, 4)


ORDER = 8

# DLMF 28.6.1-28.6.13 and Abramowitz & Stegun 20.2.25: a_r, b_r of y'' + (a - 2 q cos 2x) y = 0 less
# r^2, coefficients of q, q^2, ... as far as they are printed there (exact rational numbers).
PUBLISHED = {
    "a0": "0 -1/2 0 7/128 0 -29/2304 0 68687/18874368",
    "a1": "1 -1/8 -1/64 -1/1536 11/36864 49/589824 55/9437184 -83/35389440",
    "b1": "-1 -1/8 1/64 -1/1536 -11/36864 49/589824 -55/9437184 -83/35389440",
    "a2": "0 5/12 0 -763/13824 0 1002401/79626240 0 -1669068401/458647142400",
    "b2": "0 -1/12 0 5/13824 0 -289/79626240 0 21391/458647142400",
    "a3": "0 1/16 1/64 13/20480 -5/16384 -1961/23592960 -609/104857600",
    "b3": "0 1/16 -1/64 13/20480 5/16384 -1961/23592960 609/104857600",
    "a4": "0 1/30 0 433/864000 0 -5701/2721600000",
    "b4": "0 1/30 0 -317/864000 0 10049/2721600000",
    "a5": "0 1/48 0 11/774144 1/147456 37/891813888",
    "b5": "0 1/48 0 11/774144 -1/147456 37/891813888",
    "a6": "0 1/70 0 187/43904000 0 6743617/92935987200000",
    "b6": "0 1/70 0 187/43904000 0 -5861633/92935987200000",
}

# In q: lam2 = a/4, mu f = -(q/2) cos theta.
DOUBLE = PeriodicFunction([0.0, -0.5])


@pytest.mark.parametrize("name", PUBLISHED)
def test_the_published_coefficients(name):
    exact = np.array([float(Fraction(x)) for x in PUBLISHED[name].split()])
    assert len(exact) == {"0": 8, "1": 8, "2": 8, "3": 7}.get(name[1], 6)
    found = boundary_series(DOUBLE, int(name[1]), ORDER)
    # For q > 0 a_m is the upper one.
    ours = 4 * (found.upper if name[0] == "a" else found.lower)[: len(exact)]
    eps = np.finfo(float).eps
    np.testing.assert_allclose(ours, exact, rtol=4 * eps, atol=4 * eps * abs(exact).max() ** 2)


# Without damping, with some, and near what closes the region.
REGIONS = [(0, 0.0), *zip(range(1, 7), 2 * SHARES, strict=True)]
SLOW = [pytest.param(name, marks=pytest.mark.slow) for name in ("even", "sine", "four harmonics")]


@pytest.mark.parametrize("name", ["mixed", "odd", *SLOW])
def test_the_coefficients_are_within_their_errors(name):
    """alpha_1 ... alpha_8 of both ends with and without damping, against Hill's matrix.

    The errors are some roundings of the largest one so far, but where the region nearly closes.
    """
    f = function(name)
    for n, share in REGIONS:
        damping = drag(f, n, share)
        found = boundary_series(f, n, 8, damping)
        assert found.passed
        if share < 0.9:
            largest = np.maximum.accumulate(np.max(np.abs([found.lower, found.upper]), axis=0))
            assert np.all(found.error <= 64 * 2.0**-53 * np.maximum(largest, 1e-3))
        for side, ours, error in zip((-1, 1), (found.lower, found.upper), found.error, strict=True):
            exact = coefficients(f, damping, n, side, 8)
            gap = np.array([float(abs(MP.mpf(x) - y)) for x, y in zip(ours, exact, strict=True)])
            assert np.all(gap <= error + 1e-20)
