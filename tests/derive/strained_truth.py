"""Truth for the strained-parameter route: random exact functions and boundaries to 50 digits."""

import random
from fractions import Fraction

import mpmath as mp
from elastolink.derive.perturbation.surd import ExactHarmonics

DIGITS = 50


def random_function(seed, count=3, mean=True, denominator=10):
    """Return a function, neither even nor odd, of small random rational coefficients."""
    rng = random.Random(seed)

    def row():
        return [
            Fraction(rng.choice((-1, 1)) * rng.randint(1, 9), denominator) for _ in range(count)
        ]

    return ExactHarmonics.of(Fraction(rng.randint(1, 9), 10) if mean else 0, row(), row())


def number(surd):
    """Return a surd in the working precision."""
    rational, irrational = (
        mp.mpf(x.numerator) / x.denominator for x in (surd.rational, surd.irrational)
    )
    return rational + irrational * mp.sqrt(surd.radicand)


def fourier_matrix(f, mu, damping, region, reach):
    """Return the matrix of lam2 v_m = (k^2 - 2 i K k) v_m - mu sum_j c_{m-j} v_j, k = m - n/2."""
    numbers = range(-reach, region + reach + 1)
    size = len(numbers)
    matrix = mp.zeros(size, size)
    for row, m in enumerate(numbers):
        for column, j in enumerate(numbers):
            a, b = f.harmonic(abs(m - j))
            if m == j:
                k = m - mp.mpf(region) / 2
                mean = mu * mp.mpf(a.numerator) / a.denominator
                matrix[row, column] = k**2 - 2j * damping * k - mean
            elif a or b:
                sign = 1 if m > j else -1
                real, imaginary = (mp.mpf(x.numerator) / x.denominator for x in (a, b))
                matrix[row, column] = -mu * (real - sign * 1j * imaginary) / 2
    return matrix


def boundary(f, mu, damping, region, start, reach=15, steps=4):
    """Return the eigenvalue of the Fourier matrix near a start, by inverse iteration."""
    matrix = fourier_matrix(f, mu, damping, region, reach)
    size = matrix.rows
    vector = mp.matrix([mp.mpf(1) / (1 + abs(i - size // 2)) + 0.1j * i for i in range(size)])
    value = mp.mpc(start)
    for _ in range(steps):
        solved = mp.lu_solve(matrix - value * mp.eye(size), vector)
        largest = max(range(size), key=lambda i: abs(solved[i]))
        value += vector[largest] / solved[largest]
        vector = solved / solved[largest]
        if mp.norm(matrix * vector - value * vector) < mp.mpf(10) ** (5 - DIGITS):
            break
    return value
