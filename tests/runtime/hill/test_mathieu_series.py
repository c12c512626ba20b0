"""Mathieu's equation ``y'' + (a - 2 q cos 2 z) y = 0``: published series, digit for digit.

With theta = 2 z it is Hill's equation with ``lam2 = a/4`` and ``mu f = -(q/2) cos theta``; the
m-th region lies between b_m and a_m.  Source of the numbers: NIST Digital Library of Mathematical
Functions, 28.6.1-28.6.14 (eigenvalues) and 28.6.21-28.6.26 (functions); the eigenvalues are those
of Abramowitz & Stegun 20.2.25.  What lies beyond the published powers is decided by the continued
fractions 28.6.16-28.6.19, expanded here in exact rational numbers.
"""

from fractions import Fraction

import numpy as np
import pytest
from boundary_truth import MP, boundary
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.perturbation.boundaries import perturbation_boundaries
from elastolink.runtime.hill.perturbation.coefficients import boundary_series
from smith_chapter_8.exact import exact_operator, exact_series
from smith_chapter_8.strained import strained_boundaries
from smith_chapter_8.surd import ExactHarmonics
from strained_truth import PUBLISHED, published

ORDER = 8
# In q: lam2 = a/4, mu f = -(q/2) cos theta.
FUNCTION = ExactHarmonics.of(0, [Fraction(-1, 2)])
DOUBLE = PeriodicFunction([0.0, -0.5])


def parted(name):
    """Return the number m and the end: a_m is the upper one for q > 0."""
    return int(name[1:]), 1 if name[0] == "a" else -1


def from_operator(name):
    m, side = parted(name)
    found = exact_series(exact_operator([FUNCTION], m, ORDER), (1,))
    return [4 * value for value in (found.upper if side > 0 else found.lower)]


def from_strained(name):
    m, side = parted(name)
    upper, lower = strained_boundaries(FUNCTION, m, ORDER).branches
    return [4 * value for value in (upper if side > 0 else lower).alpha]


def product(one, other):
    out = [Fraction(0)] * (ORDER + 1)
    for i, x in enumerate(one):
        for j, y in enumerate(other[: ORDER + 1 - i]):
            out[i + j] += x * y
    return out


def inverse(series):
    out = [1 / series[0]]
    for k in range(1, ORDER + 1):
        out.append(-sum(series[j] * out[k - j] for j in range(1, k + 1)) / series[0])
    return out


def from_continued_fraction(name):
    """Expand DLMF 28.6.16-28.6.19 in q, each round of the iteration with an order more."""
    m, side = parted(name)
    square = [Fraction(int(k == 2)) for k in range(ORDER + 1)]

    def level(k, a):
        own = [Fraction(k * k if j == 0 else 0) - x for j, x in enumerate(a)]
        if k == 1:
            own[1] += side
        return own

    def less(one, other):
        return [x - y for x, y in zip(one, other, strict=True)]

    a = [Fraction(m * m)] + [Fraction(0)] * ORDER
    for _ in range(ORDER + 1):
        above = below = [Fraction(0)] * (ORDER + 1)
        for k in range(m + 2 * ORDER, m, -2):
            above = product(square, inverse(less(level(k, a), above)))
        for k in range(m % 2 or (0 if side > 0 else 2), m, 2):
            twice = [x * (2 if k == 0 else 1) for x in square]
            below = product(twice, inverse(less(level(k, a), below)))
        # 0 = m^2 [+ side q] - a - above - below; the constant meets cos 2 z twice from below too.
        both = [x + y * (2 if m == 0 else 1) for x, y in zip(below, above, strict=True)]
        a = [x - y for x, y in zip(level(m, [Fraction(0)] * (ORDER + 1)), both, strict=True)]
    return a[1:]


@pytest.mark.parametrize("name", PUBLISHED)
def test_the_published_coefficients(name):
    expected = published(name)
    assert len(expected) == {"0": 8, "1": 8, "2": 8, "3": 7}.get(name[1], 6)
    for found in (from_operator(name), from_strained(name), from_continued_fraction(name)):
        assert len(found) == ORDER
        assert found[: len(expected)] == expected


@pytest.mark.parametrize("name", PUBLISHED)
def test_beyond_what_is_published_all_routes_agree(name):
    expected = from_continued_fraction(name)
    assert from_operator(name) == expected
    assert from_strained(name) == expected


@pytest.mark.parametrize("m", [7, 8, 9, 12])
def test_the_general_term(m):
    """DLMF 28.6.14, for m >= 7."""
    m2 = Fraction(m * m)
    expected = [
        0,
        1 / (2 * (m2 - 1)),
        0,
        (5 * m2 + 7) / (32 * (m2 - 1) ** 3 * (m2 - 4)),
        0,
        (9 * m2**2 + 58 * m2 + 29) / (64 * (m2 - 1) ** 5 * (m2 - 4) * (m2 - 9)),
    ]
    for kind in "ab":
        assert from_operator(f"{kind}{m}")[:6] == expected


@pytest.mark.parametrize("m", [1, 2, 3, 4])
def test_the_width_of_a_region(m):
    """DLMF 28.6.15: the first difference of a_m and b_m is 2 / (2^(m-1) (m-1)!)^2 q^m."""
    high, low = from_operator(f"a{m}"), from_operator(f"b{m}")
    difference = [x - y for x, y in zip(high, low, strict=True)]
    factorial = np.prod(range(1, m), dtype=int)
    assert difference[: m - 1] == [0] * (m - 1)
    assert difference[m - 1] == Fraction(2, int(2 ** (m - 1) * factorial) ** 2)


@pytest.mark.parametrize("name", PUBLISHED)
def test_the_value_to_ninety_digits(name):
    """The truncated series against the eigenvalue: what is left is of the power that follows."""
    m, side = parted(name)
    series, q = from_operator(name), Fraction(1, 10**6)
    truth = 4 * boundary((FUNCTION,), (q,), Fraction(0), m, side)
    total = m * m + sum(value.rational * q**k for k, value in enumerate(series, 1))
    gap = abs(truth - MP.mpf(total.numerator) / total.denominator)
    assert gap < MP.mpf(10) ** (-6 * (ORDER + 1))


@pytest.mark.parametrize("name", PUBLISHED)
def test_the_run_time_series(name):
    """Both the coefficients of the run time and the steps between the orders of its boundaries."""
    m, side = parted(name)
    exact = np.array([float(x) for x in from_operator(name)])
    found = boundary_series(DOUBLE, m, ORDER)
    ours = 4 * (found.upper if side > 0 else found.lower)
    eps = np.finfo(float).eps
    np.testing.assert_allclose(ours, exact, rtol=4 * eps, atol=4 * eps * abs(exact).max() ** 2)
    if m == 0 and side < 0:
        return
    values = [m * m]
    for order in range(1, ORDER + 1):
        ends = perturbation_boundaries(DOUBLE, 1.0, (m,), order, form="series", outside="value")
        values.append(4 * (ends.upper if side > 0 else ends.lower)[0])
    np.testing.assert_allclose(np.diff(values), exact, rtol=0, atol=8 * eps * max(1, m * m))


# DLMF 28.6.21-28.6.26 for the ratios of the coefficients, free of the normalisation: those of
# cos 3z, cos 5z ... to that of the leading harmonic.
def harmonics(m, side, order):
    """Return ``{k: series in q}`` of the solution divided by its leading coefficient."""
    branch = strained_boundaries(FUNCTION, m, order + 3).branches[0 if side > 0 else 1]
    kind = 0 if side > 0 else 1
    out = {}
    for k in range(m % 2, m + 2 * order + 1, 2):
        out[k] = [wave.coefficient(k)[kind] for wave in branch.solutions[: order + 1]]
    return out


def test_the_periodic_solutions():
    """28.6.22-28.6.25: with the leading coefficient as unit, to the order q^2.

    ce_1 = cos z - (q/8) cos 3z + (q^2/128)(2/3 cos 5z - 2 cos 3z - cos z) ...; division by
    1 - q^2/128 changes nothing to this order but the own coefficient.  se_1 likewise.
    """
    one = Fraction(1)
    ce1 = harmonics(1, 1, 2)
    assert ce1[1] == [1, 0, 0]
    assert ce1[3] == [0, -one / 8, -one / 64]
    assert ce1[5] == [0, 0, one / 192]
    se1 = harmonics(1, -1, 2)
    assert se1[1] == [1, 0, 0]
    assert se1[3] == [0, -one / 8, one / 64]
    assert se1[5] == [0, 0, one / 192]
    # ce_2 = cos 2z - (q/4)(cos 4z/3 - 1) + (q^2/128)(cos 6z/3 - 76/9 cos 2z) ...
    ce2 = harmonics(2, 1, 2)
    assert ce2[0] == [0, one / 4, 0]
    assert ce2[2] == [1, 0, 0]
    assert ce2[4] == [0, -one / 12, 0]
    assert ce2[6] == [0, 0, one / 384]
    # se_2 = sin 2z - (q/12) sin 4z + (q^2/128)(sin 6z/3 - 4/9 sin 2z) ...
    se2 = harmonics(2, -1, 2)
    assert se2[2] == [1, 0, 0]
    assert se2[4] == [0, -one / 12, 0]
    assert se2[6] == [0, 0, one / 384]
