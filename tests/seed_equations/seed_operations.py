"""Operations of the steady-state algorithms of Aannaque's section 6.8, counted from their steps.

An addition or a multiplication is one, a product of matrices ``(a, b) (b, c)`` takes
``(2 b - 1) a c``, a triangular decomposition ``(4 n^3 - 3 n^2 - n)/6``, each solution with it
``2 n^2 - n``.
"""

from __future__ import annotations


def _product(a, b, c):
    return (2 * b - 1) * a * c


def _solve(n, columns):
    return (4 * n**3 - 3 * n**2 - n) // 6 + columns * (2 * n**2 - n)


def newmark_steps(n):
    """Return the operations of the map of one Newmark step: q, q' and a column of loads."""
    wide = 2 * n + 1
    # q'' at the left end; q and v without the new acceleration; its matrix and right side.
    ahead = _solve(n, wide) + 4 * n * wide
    return (
        ahead + 4 * n * n + 2 * _product(n, n, wide) + n * wide + n + _solve(n, wide) + 4 * n * wide
    )


def operation_count(algorithm, *, intervals, freedoms, cycles=1, harmonics=1):
    """Return the operations of an algorithm that keeps the matrices of its intervals."""
    n, m = freedoms, 2 * freedoms
    if algorithm == "harmonic_balance":
        size = (2 * harmonics + 1) * n
        return 10 * size * size + _solve(size, 1)
    total = intervals * newmark_steps(n)
    if algorithm == "time_marching":
        return total + cycles * intervals * (_product(m, m, 1) + m)
    # Two passes with a column of loads, and the closing equation.
    each = _product(m, m, m + 1) + _product(m, m, 1) + 2 * m
    each += _solve(m, m) if algorithm == "closed_form" else 0
    return total + intervals * each + m + _solve(m, 1)
