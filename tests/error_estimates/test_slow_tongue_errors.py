"""Upper estimates of tongues of high order, against widths of Hill's equation in 60 digits.

``w^2 q'' + (1 + share f) q = 0`` is an eigenproblem for ``1/w^2``.  With f even (and then turned by
any angle, which moves no boundary) the two ends of a tongue belong to a matrix for cosines and one
for sines, and are simple eigenvalues however close they are.
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.floquet.slow_driving import slow_tongues
from honesty import verdict
from scipy.linalg import eigh

DIGITS = 60
SHARES, SYSTEMS = 12, 18
SOME = [pytest.param(1, id="some"), pytest.param(SYSTEMS, marks=pytest.mark.slow, id="all")]


def random_shape(rng):
    """Return the coefficients of cos k theta, k = 0 ... H, of a function between -1 and 1."""
    highest = int(rng.integers(1, 4))
    a = rng.normal(size=highest) * rng.uniform(0.2, 0.9) ** np.arange(highest)
    return np.concatenate([[0.0], a / np.sum(np.abs(a))])


def oscillator(a, turn, unit):
    """Return one oscillator of frequency ``unit`` whose stiffness is pulled by a share of f."""
    waves = np.arange(len(a))

    def pull(theta):
        f = np.cos(np.multiply.outer(np.asarray(theta) - turn, waves)) @ a
        return unit**2 * f[:, None, None]

    terms = (
        Term("M", None, np.eye(1)),
        Term("K", None, unit**2 * np.eye(1)),
        Term("K", "share", pull),
    )

    def scales(values):
        return {"share": np.asarray(values["share"], dtype=float)}

    return LinearPeriodic(1, terms, {"share": 0.3}, scales)


def pencil(a, share, k, sign):
    """Return ``1 + share f`` among cos k theta (sign 1) or sin k theta (sign -1), as rows."""
    half = [mpmath.mpf(float(x)) * share / 2 for x in a]

    def coefficient(wave):
        return half[int(wave)] if wave < len(half) else mpmath.mpf(0)

    rows = []
    for i, one in enumerate(k):
        row = {}
        for j in range(max(0, i - len(a)), min(len(k), i + len(a) + 1)):
            value = coefficient(abs(one - k[j])) + sign * coefficient(one + k[j])
            # The constant is 1, not sqrt 2 times it.
            row[j] = value / mpmath.sqrt(2) ** ((one == 0) + (k[j] == 0)) + (i == j)
        rows.append(row)
    return rows


def times(rows, v):
    return [sum(value * v[j] for j, value in row.items()) for row in rows]


def solved(rows, right):
    """Solve a symmetric band without pivots; right is lost by nothing that 60 digits would feel."""
    rows, x = [dict(row) for row in rows], list(right)
    for j, row in enumerate(rows):
        for i in [i for i in row if i > j]:
            factor = rows[i][j] / row[j]
            for place, value in row.items():
                if place > j:
                    rows[i][place] = rows[i].get(place, mpmath.mpf(0)) - factor * value
            x[i] -= factor * x[j]
    for j in range(len(rows) - 1, -1, -1):
        known = sum(value * x[i] for i, value in rows[j].items() if i > j)
        x[j] = (x[j] - known) / rows[j][j]
    return x


def end(a, share, n, sign):
    """Return the speed at one end of the tongue of order n, in units of the frequency."""
    count = n + 25
    k = np.arange(count) + (0.5 if n % 2 else 0.0 if sign > 0 else 1.0)
    place = (n - 1) // 2 if n % 2 else n // 2 - (sign < 0)
    rows = pencil(a, mpmath.mpf(float(share)), k, sign)
    matrix = np.zeros((count, count))
    for i, row in enumerate(rows):
        for j, value in row.items():
            matrix[i, j] = float(value)
    vector = eigh(np.diag(k * k), matrix, subset_by_index=(place, place))[1][:, 0]
    squares = [mpmath.mpf(float(one)) ** 2 for one in k]
    v = [mpmath.mpf(float(x)) for x in vector]
    # Rayleigh's quotients: an error of 1e-14 of the vector becomes 1e-28, then 1e-84.
    for _ in range(2):
        heavy = times(rows, v)
        value = sum(s * x * x for s, x in zip(squares, v, strict=True))
        value /= sum(h * x for h, x in zip(heavy, v, strict=True))
        shifted = [{j: -value * entry for j, entry in row.items()} for row in rows]
        for i, square in enumerate(squares):
            shifted[i][i] += square
        v = solved(shifted, heavy)
        size = mpmath.sqrt(sum(x * x for x in v))
        v = [x / size for x in v]
    return 1 / mpmath.sqrt(value)


def width(a, share, n):
    with mpmath.workdps(DIGITS):
        return float(abs(end(a, share, n, 1) - end(a, share, n, -1)))


def scene(rng):
    """Return f, a system, shares, orders to measure, the order asked for, and the speed."""
    a, unit = random_shape(rng), float(10.0 ** rng.uniform(-2.0, 3.0))
    shares = np.sort(rng.uniform(0.15, 0.8, SHARES))
    first = int(rng.integers(4, 6))
    orders = range(first, first + int(rng.integers(6, 9)))
    lowest = int(rng.integers(orders[-1] + 2, 41))
    turn = float(rng.uniform(0.0, 2.0 * np.pi))
    return a, oscillator(a, turn, unit), shares, orders, lowest, 2.0 * unit / (lowest - 0.5)


@pytest.mark.parametrize("systems", SOME)
def test_estimates_lie_above_and_are_not_idle(systems):
    """Interfering waves among them, whose widths swing with the order."""
    rng = np.random.default_rng(35)
    ratios, measured = [], 0
    for _ in range(systems):
        a, system, shares, orders, lowest, speed = scene(rng)
        found = slow_tongues(system, speed, "share", shares, orders=orders)
        assert found.lowest[0] == lowest
        unit = speed * (lowest - 0.5) / 2.0
        for j, share in enumerate(shares):
            if np.isnan(found.slope[0, j]):
                continue
            lift, measured = found.error[0, j], measured + 1
            line = np.log(found.largest_width[0, j]) - lift
            above = np.log(width(a, share, lowest) * unit) - line
            # Upwards the figure has to cover; the line may lie too high by as much as it likes.
            ratios.append(np.array([lift / abs(above) if above > 0.0 else max(1.0, -lift / above)]))
    assert measured >= 0.95 * SHARES * systems
    verdict(ratios, 11 * systems)


def test_measured_widths_are_those_of_the_reference():
    a = np.array([0.0, 0.8, -0.2])
    found = slow_tongues(oscillator(a, 1.0, 3.0), 0.2, "share", [0.3, 0.6], orders=range(4, 9))
    for j, share in enumerate((0.3, 0.6)):
        for i, n in enumerate(found.order):
            with mpmath.workdps(DIGITS):
                ends = [end(a, share, int(n), sign) for sign in (1, -1)]
                exact = float(2 * abs(ends[0] - ends[1]) / (ends[0] + ends[1]))
            assert found.relative_width[0, j, i] == pytest.approx(exact, rel=1e-7)
