"""Boundaries of Hill's equation to 90 digits, from its matrix alone.

    y'' + 2 K y' + (lam2 + F(theta)) y = 0,   y in cos k theta, sin k theta, k = n/2 + whole

All unknowns but those of ``k = n/2`` are eliminated (Feshbach, Schur), in fixed point with whole
numbers of Python: a few hundred microseconds where floating point of that length takes
milliseconds.  What is left is ``H(x) v = x v`` with a real matrix of two rows (one for region 0),
and its eigenvalues are iterated to ``x``.  No perturbation theory enters: the matrix is cut where
90 digits do not notice.
"""

import math
from fractions import Fraction

import mpmath

BITS = 500
DIGITS = 90
ONE = 1 << BITS
# A square so little below zero is round-off of zero: two ends that coincide.
_NOUGHT = 1 << 20
COS, SIN = 0, 1

MP = mpmath.MPContext()
MP.dps = DIGITS


def fixed(value):
    """Return a rational number as a multiple of 2^-BITS."""
    exact = Fraction(value)
    return (exact.numerator << BITS) // exact.denominator


def number(value):
    """Return a fixed-point number as mpf, correct to DIGITS after the point."""
    return MP.ldexp(MP.mpf(value), -BITS)


def combined(functions, weights):
    """Return cosine and sine coefficients of a weighted sum of functions, in fixed point."""
    size = max(len(f.a) for f in functions)
    rows = [[Fraction(0)] * size, [Fraction(0)] * size]
    for f, weight in zip(functions, weights, strict=True):
        for row, part in zip(rows, (f.a, f.b), strict=True):
            for m, value in enumerate(part.tolist()):
                row[m] += Fraction(weight) * Fraction(value)
    return [[fixed(value) for value in row] for row in rows]


def hill_rows(a, b, drag, n, steps):
    """Return the matrix of lam2 as ``{(k2, kind): {(k2, kind): value}}`` with ``k2 = 2 k``.

    ``lam2 y = -y'' - 2 K y' - F y``, row by row, for k up to ``n/2 + steps``.
    """
    keys = [(k2, kind) for k2 in range(n % 2, n + 2 * steps + 1, 2) for kind in (COS, SIN)]
    if not n % 2:
        keys.remove((0, SIN))
    rows = {key: {} for key in keys}

    def put(k2, kind, column, value):
        # cos(-x) = cos x, sin(-x) = -sin x.
        if k2 < 0:
            k2, value = -k2, -value if kind == SIN else value
        if (k2, kind) in rows and value:
            row = rows[k2, kind]
            row[column] = row.get(column, 0) + value

    for key in keys:
        k2, kind = key
        put(k2, kind, key, (k2 * k2 << BITS) // 4 - a[0])
        # -2 K d/dtheta: cos k -> + 2 K k sin k, sin k -> -2 K k cos k.
        put(k2, 1 - kind, key, drag * k2 if kind == COS else -drag * k2)
        for m in range(1, len(a)):
            up, down = k2 + 2 * m, k2 - 2 * m
            put(up, kind, key, -a[m] // 2)
            put(down, kind, key, -a[m] // 2)
            # sin m cos k = (sin(k+m) - sin(k-m))/2, sin m sin k = (cos(k-m) - cos(k+m))/2.
            sign = 1 if kind == COS else -1
            put(up, 1 - kind, key, -sign * b[m] // 2)
            put(down, 1 - kind, key, sign * b[m] // 2)
    return rows


def schur(rows, n, x):
    """Return the matrix that is left of ``rows - x`` for k = n/2, with x added again."""
    return _eliminated(rows, n, x)[0]


def _eliminated(rows, n, x):
    """Return that matrix, and what went: pivots with their diagonals and rows, in order."""
    work = {key: dict(row) for key, row in rows.items()}
    for key, row in work.items():
        row[key] = row.get(key, 0) - x
    columns = {key: set() for key in work}
    for key, row in work.items():
        for column in row:
            columns[column].add(key)
    outer = sorted((key for key in work if key[0] > n), reverse=True)
    inner = sorted(key for key in work if key[0] < n)
    gone = []
    for pivot in (*outer, *inner):
        row = work.pop(pivot)
        diagonal = row.pop(pivot)
        gone.append((pivot, diagonal, row))
        for column in row:
            columns[column].discard(pivot)
        for other in columns[pivot]:
            if other == pivot:
                continue
            target = work[other]
            factor = (target.pop(pivot) << BITS) // diagonal
            for column, value in row.items():
                if column in target:
                    target[column] -= factor * value >> BITS
                else:
                    target[column] = -(factor * value >> BITS)
                    columns[column].add(other)
    kinds = (COS, SIN) if n else (COS,)
    left = [[work[n, i].get((n, j), 0) + (x if i == j else 0) for j in kinds] for i in kinds]
    return left, gone


def solutions(rows, n, x):
    """Return by key the cosines and sines of the solutions at an eigenvalue x, as mpf.

    They are two where both ends coincide.
    """
    left, gone = _eliminated(rows, n, x)
    if not n:
        return [_put_back(rows, gone, {(n, COS): ONE})]
    (p, q), (r, s) = left
    starts = [max((q, x - p), (x - s, r), key=lambda pair: max(map(abs, pair)))]
    if max(map(abs, starts[0])) < ONE // 10 ** (DIGITS - 10):
        starts = [(ONE, 0), (0, ONE)]
    return [_put_back(rows, gone, {(n, COS): c, (n, SIN): s}) for c, s in starts]


def _put_back(rows, gone, v):
    for pivot, diagonal, row in reversed(gone):
        v[pivot] = -sum(value * v[column] for column, value in row.items()) // diagonal
    return {key: number(v[key]) for key in rows}


def eigenvalue(matrix, side):
    """Return the lower (-1) or upper (+1) eigenvalue, None where they are not real."""
    if len(matrix) == 1:
        return matrix[0][0]
    (p, q), (r, s) = matrix
    square = ((p - s) * (p - s) >> BITS) + 4 * (q * r >> BITS)
    if square < -_NOUGHT:
        return None
    root = math.isqrt(max(square, 0) << BITS)
    return (p + s + side * root) // 2


def _fixed_point(rows, n, side, small, x):
    """Solve ``eigenvalue(schur(x)) = x`` by the secant method, from x."""
    found = eigenvalue(schur(rows, n, x), side)
    if found is None:
        return None
    gap, before = found - x, x
    if abs(gap) < small:
        return found
    x = found
    for _ in range(60):
        found = eigenvalue(schur(rows, n, x), side)
        if found is None:
            return None
        new = found - x
        if abs(new) < small:
            return found
        slope = new - gap
        step = -new * (x - before) // slope if slope else new
        before, gap, x = x, new, x + step
    raise ArithmeticError(f"region {n}: the iteration does not settle")


def _rings(a, b, digits):
    """Return how often the widest step has to be taken, not counting that the levels grow."""
    size = float(number(sum(map(abs, (*a[1:], *b[1:])))))
    each = 2.0 * math.log10(1.0 / size) if 0.0 < size < 0.5 else 1.0
    return max(1, math.ceil(0.7 * digits / max(each, 1.0)))


def boundary(functions, weights, drag, n, side, digits=DIGITS):
    """Return the lower (side -1) or upper (+1) end of region n; None where damping has closed it.

    The functions, taken as exact, are multiplied by the weights; the drag is K.  Truncation and
    iteration are accepted below ``10^-digits``.
    """
    a, b = combined(functions, weights)
    friction = fixed(drag)
    width = max(1, len(a) - 1)
    reach = width * _rings(a, b, digits)
    small, before = ONE // 10**digits, None
    while True:
        start = (n * n << BITS) // 4 if before is None else before
        found = _fixed_point(hill_rows(a, b, friction, n, reach), n, side, small, start)
        if found is None or (before is not None and abs(found - before) < 4 * small):
            return None if found is None else number(found)
        before, reach = found, reach + width


def near(rows, n, x, digits=DIGITS):
    """Return the eigenvalues that the iteration finds from x, in fixed point, the lower first."""
    found = []
    for side in (-1, 1)[: 2 if n else 1]:
        try:
            found.append(_fixed_point(rows, n, side, ONE // 10**digits, x))
        except ArithmeticError:
            continue
    return sorted(value for value in found if value is not None)


def coefficients(f, drag, n, side, order):
    """Return those of mu, mu^2, ... mu^order of one end, with K = drag mu, to 20 digits.

    The polynomial through the ends at mu = 2^-20, 2 2^-20, ...
    """
    step, count = Fraction(1, 2**20), order + 4
    places = range(1, count + 1)
    ends = [boundary((f,), (j * step,), Fraction(drag) * j * step, n, side) for j in places]
    powers = MP.matrix([[MP.mpf(j) ** k for k in places] for j in places])
    found = MP.lu_solve(powers, MP.matrix(ends) - MP.mpf(n * n) / 4)
    return [found[k] * 2 ** (20 * (k + 1)) for k in range(order)]
