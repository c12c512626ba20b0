"""The tip of a tongue to any order: two derivations, Smith's first order, and 50-digit truth."""

from fractions import Fraction

import mpmath as mp
import pytest
from elastolink.derive.perturbation.exact import exact_operator
from elastolink.derive.perturbation.surd import ExactHarmonics, Surd
from elastolink.derive.perturbation.thresholds import (
    operator_thresholds,
    polynomials,
    strained_thresholds,
)
from strained_truth import DIGITS, fourier_matrix, number, random_function

F = Fraction


@pytest.mark.parametrize("n", range(1, 7))
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_strained_parameters_and_effective_operator_agree_exactly(n, seed):
    # Three harmonics: regions 4 to 6 open at second order.
    f, order = random_function(seed), 6
    one = strained_thresholds(f, n, order)
    other = operator_thresholds(*polynomials(exact_operator([f], n, order, damped=True)), n, order)
    assert one == other
    assert one.split == (1 if n < 4 else 2)
    assert len(one.critical) == order + 1 - one.split


@pytest.mark.parametrize(
    ("f", "n"),
    [
        (ExactHarmonics.of(0, [3], [4]), 1),
        (ExactHarmonics.of(0, [1], []), 1),
        (ExactHarmonics.of(0, [-1, 2], []), 1),
        (ExactHarmonics.of(0, [], [1, -2]), 1),
        (ExactHarmonics.of(0, [], [-1, 2]), 1),
        (ExactHarmonics.of(0, [1], []), 3),
        (ExactHarmonics.of(F(1, 2), [1, 0, 1], []), 2),
    ],
)
def test_even_odd_and_degenerate_functions(f, n):
    one = strained_thresholds(f, n, 5)
    other = operator_thresholds(*polynomials(exact_operator([f], n, 5, damped=True)), n, 5)
    assert one == other
    if one.split == 1:
        a, b = f.harmonic(n)
        # Smith (7.51), solved for K.
        assert one.critical[0] == Surd.root((a * a + b * b) / (4 * n * n))


def tip(f, n, mu, damping, value):
    """Return K and lam2 where two eigenvalues of the Fourier matrix meet, by Newton's method.

    The 2 x 2 Schur complement on the resonant harmonics has a double root in lam2 there.
    """
    reach = 7
    inside = (reach, reach + n)
    size = 2 * reach + n + 1
    outside = [i for i in range(size) if i not in inside]

    def determinant(friction, lam2):
        matrix = fourier_matrix(f, mu, friction, n, reach) - lam2 * mp.eye(size)

        def part(rows, columns):
            return mp.matrix([[matrix[i, j] for j in columns] for i in rows])

        corner = part(inside, inside)
        for column, i in enumerate(inside):
            solved = mp.lu_solve(part(outside, outside), part(outside, (i,)))
            corner[:, column] -= part(inside, outside) * solved
        return mp.re(corner[0, 0] * corner[1, 1] - corner[0, 1] * corner[1, 0])

    h = mp.mpf(10) ** (-12)

    def equations(friction, lam2):
        high, middle, low = (determinant(friction, lam2 + s * h) for s in (1, 0, -1))
        return middle, (high - low) / (2 * h)

    return mp.findroot(equations, (damping, value), tol=1e-60, verify=False, maxsteps=4)


@pytest.mark.parametrize(("n", "split"), [(1, 1), (3, 2)])
def test_remainder_against_the_exact_tip(n, split):
    f = random_function(9, count=2)
    longest = 4
    series = strained_thresholds(f, n, longest)
    assert series.split == split
    with mp.workdps(DIGITS):
        critical = [mp.mpf(0)] * (split - 1) + [number(x) for x in series.critical]
        middle = [number(x) for x in series.tip]
        gaps = []
        for mu in (mp.mpf(1) / 100, mp.mpf(1) / 200):
            k, value = (sum(c * mu**j for j, c in enumerate(row, 1)) for row in (critical, middle))
            exact = tip(f, n, mu, k, value + mp.mpf(n * n) / 4)
            gaps.append((exact[0] - k, exact[1] - value - mp.mpf(n * n) / 4))
            shorter = sum(c * mu**j for j, c in enumerate(critical[:-1], 1))
            assert float((exact[0] - shorter) / mu**longest / critical[-1]) == pytest.approx(
                1, abs=0.1
            )
            # The inverse series returns to mu with an error of its own next order.
            back = series.least_parameter(float(exact[0]))
            assert back == pytest.approx(float(mu), rel=20 * float(mu) ** (longest - split + 1))
        for one, other in zip(*gaps, strict=True):
            assert float(mp.log(abs(one / other), 2)) == pytest.approx(longest + 1, abs=0.1)


def test_first_order_is_smiths_and_how_far_it_goes():
    f = ExactHarmonics.of(0, [F(1, 10), 1], [F(1, 20), F(1, 2)])
    series = strained_thresholds(f, 1, 8)
    a, b = f.harmonic(1)
    printed = 2 * 1 / float(Surd.root(a * a + b * b))  # mu_min / K by (7.51)
    assert 1 / float(series.critical[0]) == pytest.approx(printed, rel=1e-15)
    # The second harmonic widens the tongue: by K = 0.03 (7.51) asks for a fourth too much.
    ratios = [printed * k / series.least_parameter(k) for k in (0.01, 0.03)]
    assert ratios == pytest.approx([1.0896, 1.264], abs=1e-3)
    assert series.critical_damping(series.least_parameter(0.002)) == pytest.approx(0.002, rel=1e-5)


def test_no_tongue_and_bad_arguments():
    series = strained_thresholds(ExactHarmonics.of(F(1, 2), [0, 1]), 3, 6)
    assert series.split is None and series.critical == ()
    assert series.tip[0] == F(-1, 2)
    assert series.critical_damping(0.3) == 0.0
    assert series.least_parameter(0.1) == float("inf")
    with pytest.raises(ValueError, match="expected a whole number"):
        strained_thresholds(ExactHarmonics.of(0, [1]), 0, 3)
    f = ExactHarmonics.of(0, [1])
    for parts, damped in (([f], False), ([f, f], True)):
        with pytest.raises(ValueError, match="expected mu and K"):
            polynomials(exact_operator(parts, 1, 2, damped=damped))
