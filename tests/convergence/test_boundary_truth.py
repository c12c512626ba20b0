"""The 90-digit boundaries against two other routes: a determinant and a continued fraction."""

from fractions import Fraction

import pytest
from boundary_cases import curve, doubles, function, trigonometric
from boundary_truth import MP, boundary, combined, fixed, hill_rows, number, schur
from elastolink.runtime.hill import hill_boundaries
from omitted_orders import real

SMALL = Fraction(1, 2**20)
CLOSE = MP.mpf(10) ** -60


def determinant(a, b, drag, n, lam2, reach):
    """Return the determinant of the matrix in exp(i k theta), complex, in floating point."""
    numbers = range(-reach, n + reach + 1)
    matrix = MP.matrix(len(numbers))
    for i, m in enumerate(numbers):
        k = MP.mpf(2 * m - n) / 2
        matrix[i, i] = MP.mpc(k * k - real(a[0]) - lam2, -2 * real(drag) * k)
        for j, other in enumerate(numbers):
            apart = m - other
            if apart and abs(apart) < len(a):
                sine = real(b[abs(apart)]) * (1 if apart > 0 else -1)
                matrix[i, j] = -MP.mpc(real(a[abs(apart)]), -sine) / 2
    return MP.det(matrix)


@pytest.mark.parametrize("share", [0.0, 0.4])
@pytest.mark.parametrize("n", [0, 1, 2, pytest.param(5, marks=pytest.mark.slow)])
def test_the_determinant_vanishes(n, share):
    name = "mixed, 2 harmonics"
    problem = curve((function(name),), n, share if n <= 2 else 0.0)
    a, b = combined(problem.functions, (SMALL,))
    for side in (-1, 1) if n else (1,):
        lam2, drag = problem.truth(side, SMALL), problem.friction(SMALL)
        h = MP.mpf(10) ** -30
        at, beside = (determinant(a, b, drag, n, lam2 + shift, 12) for shift in (0, h))
        assert abs(at * h / (beside - at)) < CLOSE


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("n", [1, 2, 3, 6])
def test_mathieu_by_a_continued_fraction(n, side):
    """DLMF 28.6.16-28.6.19 in one: the recursion of the harmonics from either end."""
    q = Fraction(3, 8)
    lam2 = boundary((function("cosine"),), (-q / 2,), Fraction(0), n, side)
    a, square = 4 * lam2, real(q) ** 2
    above = MP.zero
    for k in range(n + 160, n, -2):
        above = square / (k * k - a - above)
    # cos from 0 or 1, sin from 1 or 2: a_n is the upper end, b_n the lower one (q > 0).
    first = n % 2 or (0 if side > 0 else 2)
    below, k = MP.zero, first
    if n % 2 and n > 1:
        below, k = square / (1 + side * real(q) - a), 3
    while k < n:
        # Twice the square where the constant meets cos 2 z.
        weight = 2 if k == 0 else 1
        below = weight * square / (k * k - a - below)
        k += 2
    own = n * n + (side * real(q) if n == 1 else 0)
    assert abs(own - a - above - below) < CLOSE


def test_more_harmonics_change_nothing():
    f = trigonometric(21, 3)
    ends = [boundary((f,), (Fraction(1, 16),), Fraction(1, 512), 2, 1, steps=s) for s in (6, 90)]
    assert abs(ends[0] - ends[1]) < MP.mpf(10) ** -85


def test_what_is_left_for_one_harmonic_is_known():
    """f = cos theta in region 1 and no other harmonic: lam2 = 1/4 -+ mu/2."""
    rows = hill_rows([0, fixed(Fraction(1, 8))], [0, 0], 0, 1, 0)
    left = schur(rows, 1, fixed(Fraction(1, 4)))
    assert [[number(x) for x in row] for row in left] == [[0.1875, 0.0], [0.0, 0.3125]]


@pytest.mark.parametrize("n", [0, 1, 2, 3, 4])
def test_doubles_agree(n):
    f, drag = trigonometric(22, 4), Fraction(1, 1024 if n else 10**9)
    found = hill_boundaries(doubles(f), 0.25, (n,), float(drag) if n else 0.0)
    for side, end in ((-1, found.lower), (1, found.upper)):
        if n or side > 0:
            truth = boundary((f,), (Fraction(1, 4),), drag if n else 0, n, side)
            assert abs(float(truth) - end[0]) <= found.error[0]
