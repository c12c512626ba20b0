"""The effective operator of a region: against exact arithmetic, the equation itself, symmetries."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.generated import hill_recursion
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.perturbation.effective import HIGHEST_ORDER, effective_operator
from smith_chapter_8.exact import exact_operator
from smith_chapter_8.surd import ExactHarmonics

UNIT = 2.0**-53
# Number of parts, damping, order.
KINDS = [(1, False, 8), (1, True, 8), (2, False, 6), (2, True, 5), (3, False, 5), (3, True, 4)]


def random_parts(seed, count):
    """Return coefficients of the parts: a mean, cosines, sines (none in some)."""
    rng = np.random.default_rng(seed)
    harmonics = int(rng.integers(1, 8))
    decay = rng.uniform(0.2, 1.2) ** np.arange(harmonics)
    sines = 1.0 * (rng.random(count) < 0.7)
    return [
        (rng.normal(), decay * rng.normal(size=harmonics), s * decay * rng.normal(size=harmonics))
        for s in sines
    ]


def periodic(parts):
    return [PeriodicFunction([mean, *a], [0.0, *b]) for mean, a, b in parts]


class Upwards(np.ndarray):
    """Differences become sums: the recursion then adds up the sizes of all of its terms."""

    def __sub__(self, other):
        return self + other


def majorants(parts, n, order, damped):
    """Return for each order the sum of the sizes of all terms, every parameter being 1."""
    half = sum(0.5 * np.hypot(a, b) for _, a, b in parts)
    reach = (order // 2) * len(half)
    m = np.arange(-reach, n + reach + 1)
    v = sum(x * (np.eye(m.size, k=k) + np.eye(m.size, k=-k)) for k, x in enumerate(half, 1))
    v = v + damped * np.diag(np.abs(2.0 * m - n))
    levels = np.abs(m * (m - n)).astype(float)
    r = 1.0 / np.where(levels == 0.0, np.inf, levels)
    rows = np.flatnonzero(levels == 0.0)
    effective, _ = getattr(hill_recursion, f"order_{order}")(
        np.eye(m.size)[:, rows].view(Upwards),
        lambda x: (v @ x).view(Upwards),
        lambda x: (r[:, None] * x).view(Upwards),
        lambda x: x[rows],
        lambda x, h: (x @ h).view(Upwards),
    )
    return [float(np.max(h)) for h in effective]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("count, damped, order", KINDS)
def test_coefficients_are_the_exact_ones_to_a_few_roundings(count, damped, order, seed):
    """Measured over 4000 operators: at most 3.8 roundings of the sum of the sizes of the terms."""
    parts = random_parts(100 * count + seed, count)
    exact_parts = [ExactHarmonics.of(mean, a.tolist(), b.tolist()) for mean, a, b in parts]
    for n in range(7):
        exact = exact_operator(exact_parts, n, order, damped)
        found = effective_operator(periodic(parts), n, order, damped)
        allowed = majorants(parts, n, order, damped)
        allowed[0] = max(allowed[0], *(abs(mean) for mean, _, _ in parts))
        for k in range(order):
            assert found.exponents[k].tolist() == [list(row) for row in exact.exponents[k]]
            for one, other in ((found.diagonal, exact.diagonal), (found.coupling, exact.coupling)):
                wanted = np.array([complex(float(x), float(y)) for x, y in other[k]])
                assert np.max(np.abs(one[k] - wanted)) <= 8 * UNIT * allowed[k]


def matrix(parts, n, values, damping, reach):
    """Return Hill's matrix ``k^2 - 2 i K k - F`` for m = -reach ... n + reach."""
    m = np.arange(-reach, n + reach + 1)
    k = m - 0.5 * n
    out = np.diag(k * k - 2j * damping * k)
    for part, value in zip(parts, values, strict=True):
        c = 0.5 * (part.a - 1j * part.b)
        out -= value * part.a[0] * np.eye(m.size)
        for j in range(1, len(c)):
            out -= value * (c[j] * np.eye(m.size, k=-j) + c[j].conj() * np.eye(m.size, k=j))
    return out


@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("n", range(5))
def test_the_boundaries_are_eigenvalues_of_hills_matrix(n, damped):
    """No recursion in the reference: LAPACK on 2 x 30 harmonics, where the remainder is small."""
    parts = periodic(random_parts(7, 2))
    values = np.array([0.02, -0.03] + [0.004] * damped)
    a, b = (x.sum(0) for x in effective_operator(parts, n, 8, damped).components(values))
    root = np.sqrt(complex(abs(b) ** 2 - a.imag**2))
    found = [0.25 * n * n + a.real + s * root for s in ((-1, 1) if n else (0,))]
    whole = np.linalg.eigvals(matrix(parts, n, values[:2], values[2] if damped else 0.0, 30))
    for value in found:
        assert np.min(np.abs(whole - value)) < 1e-12


@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("n", [0, 1, 2, 3])
def test_the_solutions_obey_the_equation_to_the_order(n, damped):
    """``(H0 + V) Omega - Omega h`` on the whole column falls with the next power."""
    parts = periodic(random_parts(11, 2))
    order = 5
    operator = effective_operator(parts, n, order, damped)
    left = []
    for t in (2e-2, 1e-2):
        values = t * np.array([1.0, -0.7] + [0.3] * damped)
        harmonics, columns = operator.solution(values)
        column = columns.sum(axis=0)
        mirror = column[::-1].conj()
        a, b = (x.sum(0) for x in operator.components(values))
        assert column[harmonics == n] == 1.0
        if n:
            assert column[harmonics == 0] == 0.0
        reach = -int(harmonics[0])
        hill = matrix(parts, n, values[:2], values[2] if damped else 0.0, reach)
        rest = hill @ column - (0.25 * n * n + a) * column - (b.conj() * mirror if n else 0.0)
        left.append(np.max(np.abs(rest)))
    assert left[0] < 1e-6
    assert np.log2(left[0] / left[1]) == pytest.approx(order + 1, abs=0.2)


def test_components_have_the_shape_of_the_parameters():
    parts = periodic(random_parts(5, 2))
    operator = effective_operator(parts, 2, 4, True)
    assert operator.parameters == 3
    values = np.random.default_rng(1).normal(size=(3, 4, 5))
    a, b = operator.components(values)
    assert a.shape == b.shape == (4, 4, 5)
    harmonics, columns = operator.solution(values)
    assert columns.shape == (5, harmonics.size, 4, 5)
    one = operator.components(values[:, 2, 3])
    np.testing.assert_allclose(a[:, 2, 3], one[0], rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(columns[:, :, 2, 3], operator.solution(values[:, 2, 3])[1], 1e-12)
    assert operator.components(np.ones((3, 0)))[0].shape == (4, 0)
    # Polynomials, written out.
    for k in range(4):
        powers = np.prod(values[:, 1, 1] ** operator.exponents[k], axis=1)
        np.testing.assert_allclose(a[k, 1, 1], operator.diagonal[k] @ powers, rtol=1e-12)
        np.testing.assert_allclose(b[k, 1, 1], operator.coupling[k] @ powers, rtol=1e-12)


@pytest.mark.parametrize("n", [0, 1, 4])
def test_components_are_homogeneous(n):
    operator = effective_operator(periodic(random_parts(6, 2)), n, 6, True)
    values = np.array([0.3, -0.2, 0.1])
    once, twice = operator.components(values), operator.components(2 * values)
    for one, double in zip(once, twice, strict=True):
        np.testing.assert_array_equal(one * 2.0 ** np.arange(1, 7), double)


@pytest.mark.parametrize("n", [1, 2, 3])
def test_a_shift_of_the_angle_turns_b_and_leaves_a(n):
    mean, a, b = random_parts(8, 1)[0]
    angle = 0.7
    c = 0.5 * (a - 1j * b) * np.exp(1j * angle * np.arange(1, len(a) + 1))
    one = effective_operator(periodic([(mean, a, b)]), n, 7, True)
    two = effective_operator(periodic([(mean, 2 * c.real, -2 * c.imag)]), n, 7, True)
    for k in range(7):
        size = 1e-14 * np.max(np.abs(np.concatenate([one.diagonal[k], one.coupling[k]])))
        np.testing.assert_allclose(two.diagonal[k], one.diagonal[k], atol=size)
        turned = one.coupling[k] * np.exp(1j * angle * n)
        np.testing.assert_allclose(two.coupling[k], turned, atol=size)


def test_the_mean_moves_the_first_component_alone():
    (mean, a, b), n = random_parts(9, 1)[0], 3
    one = effective_operator(periodic([(0.0, a, b)]), n, 5)
    two = effective_operator(periodic([(mean, a, b)]), n, 5)
    assert two.diagonal[0] == one.diagonal[0] - mean
    for k in range(1, 5):
        assert two.diagonal[k] == one.diagonal[k]
        assert two.coupling[k] == one.coupling[k]


def test_signs_of_damping_and_of_the_angle():
    """K -> -K belongs to time reversed; an even f then gives the conjugates of A and B."""
    mean, a, _ = random_parts(10, 1)[0]
    operator = effective_operator(periodic([(mean, a, 0 * a)]), 2, 6, True)
    forth, back = operator.components([0.3, 0.1]), operator.components([0.3, -0.1])
    for one, other in zip(forth, back, strict=True):
        np.testing.assert_allclose(one, other.conj(), rtol=1e-13, atol=1e-16)


def test_region_zero_is_real_and_couples_nothing():
    operator = effective_operator(periodic(random_parts(12, 2)), 0, 7, True)
    assert all(np.all(row.imag == 0.0) for row in operator.diagonal)
    assert not any(np.any(row) for row in operator.coupling)


@pytest.mark.parametrize("n", [1, 3])
def test_orders_agree_where_they_overlap(n):
    """The support that is kept depends on the order; nothing that matters is left out."""
    parts = periodic(random_parts(13, 2))
    longest = effective_operator(parts, n, HIGHEST_ORDER)
    for order in range(1, HIGHEST_ORDER):
        found = effective_operator(parts, n, order)
        for k in range(order):
            size = 1e-14 * np.max(np.abs(longest.diagonal[k])) + 1e-15
            for name in ("diagonal", "coupling"):
                one, other = (getattr(operator, name)[k] for operator in (found, longest))
                np.testing.assert_allclose(one, other, rtol=0.0, atol=size)


def test_mathieus_equation():
    """y'' + (a - 2 q cos 2 theta) y = 0, DLMF 28.6.2: a_1 = 1 + q - q^2/8 - q^3/64 - ..."""
    operator = effective_operator([PeriodicFunction([0.0, 0.0, -2.0])], 2, 8)
    a, b = operator.components([1.0])
    wanted = [1, -1 / 8, -1 / 64, -1 / 1536, 11 / 36864, 49 / 589824, 55 / 9437184, -83 / 35389440]
    np.testing.assert_allclose(a + b, wanted, rtol=1e-14)


def test_equal_functions_share_one_operator_that_cannot_be_written():
    one, two = ([PeriodicFunction([0.0, 1.0], [0.0, 2.0])] for _ in range(2))
    operator = effective_operator(one, 1, 4)
    assert effective_operator(two, np.int64(1), 4, False) is operator
    assert effective_operator(two, 1, 4, True) is not operator
    for rows in (operator.exponents, operator.diagonal, operator.coupling):
        with pytest.raises(ValueError, match="read-only"):
            rows[1][:] = 0


def test_a_function_without_harmonics_moves_the_level_alone():
    operator = effective_operator([PeriodicFunction([0.5]), PeriodicFunction()], 2, 6)
    a, b = operator.components([2.0, 3.0])
    np.testing.assert_array_equal(a, [-1.0, 0, 0, 0, 0, 0])
    np.testing.assert_array_equal(b, np.zeros(6))


F = PeriodicFunction([0.0, 1.0])
MISUSE = {
    "no part": (lambda: effective_operator([], 1, 2), "parts"),
    "no function": (lambda: effective_operator([3.0], 1, 2), "parts"),
    "negative region": (lambda: effective_operator([F], -1, 2), "region"),
    "half region": (lambda: effective_operator([F], 0.5, 2), "region"),
    "order 0": (lambda: effective_operator([F], 1, 0), "order"),
    "order 11": (lambda: effective_operator([F], 1, 11), "order"),
    "order as a truth": (lambda: effective_operator([F], 1, True), "order"),
    "too large": (lambda: effective_operator([F * 1e200], 1, 4), "overflow"),
    "too few": (lambda: effective_operator([F], 1, 4, True).components([1.0]), "K last"),
    "a number": (lambda: effective_operator([F], 1, 4).components(1.0), "one row per part"),
    "nan": (lambda: effective_operator([F], 1, 4).components([np.nan]), "finite"),
    "inf": (lambda: effective_operator([F], 1, 4).solution([np.inf]), "finite"),
}


@pytest.mark.parametrize("case", MISUSE)
def test_misuse_is_refused_in_one_line(case):
    call, expected = MISUSE[case]
    with pytest.raises(BadInput, match=expected) as told:
        call()
    assert "\n" not in str(told.value)
