"""Figures of periodic solutions on boundaries, against Fourier matrices in more digits.

The reference iterates on a whole subspace with a matrix of its own assembly: both ends of a region,
or an end and the next region's, so that pairs of any closeness are told apart.  Where they lie
close it computes with 60 digits, elsewhere in extended precision.
"""

from __future__ import annotations

import mpmath
import numpy as np
from boundary_truth import BITS, combined, fixed, hill_rows
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import boundary_solution, hill_boundaries
from honesty import extended, over_scenes

pytestmark = extended
THETA = np.linspace(0.0, 4.0 * np.pi, 61)
CLOSE = 1e-4


def scene(rng, strongest):
    """Return functions, parameters, region, end and damping."""
    count = 1 + int(rng.random() < 0.2)
    functions = []
    for _ in range(count):
        highest = int(rng.choice([1, 2, 4, 8]))
        a, b = rng.normal(size=(2, highest + 1)) * rng.uniform(0.3, 0.8) ** np.arange(highest + 1)
        b[0] = 0.0
        b *= rng.random() > 0.25  # even ones
        if rng.random() < 0.2:  # of period pi: every other region is closed
            a[1::2] = b[1::2] = 0.0
        functions.append(PeriodicFunction(a, b))
    mu = [float(10.0 ** rng.uniform(-6.0, strongest) * rng.choice([-1, 1])) for _ in functions]
    n = int(rng.integers(0, 7))
    end = "upper" if n == 0 else str(rng.choice(["lower", "upper"]))
    damping = 0.0 if rng.random() < 0.6 else float(10.0 ** rng.uniform(-8.0, -0.5))
    return functions, mu, n, end, damping


def more_digits(values, exact):
    """Return an array of long doubles, or of numbers of 60 digits."""
    if exact:
        return np.array([mpmath.mpf(float(v)) for v in values], dtype=object)
    return np.asarray(values, dtype=np.longdouble)


def as_long(values):
    high = np.array([float(v) for v in values])
    rest = np.array([float(v - h) for v, h in zip(values, high, strict=True)])
    return high.astype(np.longdouble) + rest


def fourier_matrix(functions, mu, damping, n, highest, exact):
    """Return ``2 k, sine`` of cos 0, cos 1, sin 1, ... and the matrix of ``-y'' - 2 K y' - F y``.

    In long doubles, or in numbers of 60 digits.
    """
    rows = hill_rows(*combined(functions, mu), fixed(damping), n % 2, highest - 1)
    columns = {key: place for place, key in enumerate(rows)}
    out = np.full((len(rows), len(rows)), mpmath.mpf(0))
    for row, entries in zip(out, rows.values(), strict=True):
        for key, value in entries.items():
            row[columns[key]] = mpmath.ldexp(mpmath.mpf(value), -BITS)
    return np.array(list(rows)), out if exact else as_long(out.ravel()).reshape(out.shape)


def eliminated(matrix):
    """Return a factored matrix, by Gauss with pivots."""
    matrix, order = matrix.copy(), np.arange(len(matrix))
    for j in range(len(matrix)):
        p = j + int(np.argmax(np.abs(matrix[j:, j])))
        matrix[[j, p]], order[[j, p]] = matrix[[p, j]], order[[p, j]]
        matrix[j + 1 :, j] /= matrix[j, j]
        matrix[j + 1 :, j + 1 :] -= matrix[j + 1 :, j, None] * matrix[j, None, j + 1 :]
    return matrix, order


def solved(factors, right):
    matrix, order = factors
    x = right[order].copy()
    for j in range(len(matrix)):
        x[j + 1 :] -= matrix[j + 1 :, j, None] * x[j]
    for j in range(len(matrix) - 1, -1, -1):
        x[j] /= matrix[j, j]
        x[:j] -= matrix[:j, j, None] * x[j]
    return x


def orthonormal(columns):
    found = []
    for column in columns.T:
        for _ in range(2):
            for other in found:
                column = column - other * np.sum(other * column)
        found.append(column / np.sum(column * column) ** 0.5)
    return np.stack(found, axis=-1)


def neighbours(functions, mu, n, end, damping):
    """Return the boundary, the distance to the next one of its period, and which is lower."""
    whole = sum((f * m for f, m in zip(functions[1:], mu[1:], strict=True)), functions[0] * mu[0])
    regions = [m for m in (n - 2, n, n + 2) if m >= 0]
    found = hill_boundaries(whole, 1.0, tuple(regions), damping)
    places = [
        (m, side, float(getattr(found, side)[i]))
        for i, m in enumerate(regions)
        for side in ("lower", "upper")
        if m or side == "upper"
    ]
    own = next(i for i, place in enumerate(places) if place[:2] == (n, end))
    target = places[own][2]
    gaps = [
        (abs(place[2] - target), i)
        for i, place in enumerate(places)
        if i != own and np.isfinite(place[2])
    ]
    gap, other = min(gaps, default=(np.inf, own + 1))
    return target, gap, own < other


def truth(given, found):
    """Return 2 k and kinds, the solution, and the space of all solutions that lie close by."""
    functions, mu, n, _, damping = given
    target, gap, first = neighbours(*given)
    exact = gap < CLOSE
    seen = np.flatnonzero(np.hypot(found.a, found.b) > 1e-14)[-1]
    # A way beyond these and back is 1e-28 of the coupling of the pair.
    highest = int(seen) + 2 + max(f.harmonics for f in functions)
    kinds, matrix = fourier_matrix(functions, mu, damping, n, highest, exact)
    pair = gap < 1e-2 * max(1.0, abs(target))
    # Between the two, or a little beyond both.
    away = max(0.55 * gap if pair else 0.0, 1e-7 * max(1.0, abs(target))) * (1 if first else -1)
    centred = matrix.copy()
    centred[np.diag_indices_from(matrix)] -= more_digits([target + away], exact)[0]
    factors = eliminated(centred)
    start = np.random.default_rng(0).normal(size=(1 + pair, len(matrix)))
    x = orthonormal(np.array([more_digits(row, exact) for row in start]).T)
    for _ in range(100):
        y = orthonormal(solved(factors, x))
        change = np.max(np.abs(y - x @ (x.T @ y)))
        x = y
        if change < (1e-50 if exact else 1e-18):
            break
    solution = x[:, 0]
    if pair:
        h = x.T @ (centred @ x)
        half = (h[0, 0] - h[1, 1]) / 2
        square = half * half + h[0, 1] * h[1, 0]
        root = abs(square) ** (more_digits([0.5], exact)[0]) * (-1 if first else 1)
        one, two = (h[0, 1], root - half), (root + half, h[1, 0])
        weight = max(one, two, key=lambda v: max(abs(v[0]), abs(v[1])))
        solution = x[:, 0] * weight[0] + x[:, 1] * weight[1]
    return kinds, solution, x


def deviation(given, found):
    """Return the largest deviation over theta from the true solution."""
    kinds, solution, space = truth(given, found)
    k, sine = 0.5 * kinds[:, 0], kinds[:, 1]
    scale = np.where(k == 0.0, 1.0, np.sqrt(np.longdouble(0.5)))
    places = kinds[:, 0] // 2
    kept = places < len(found.a)
    ours = np.zeros_like(scale)
    ours[kept] = np.stack([found.a, found.b])[sine[kept], places[kept]]
    ours *= scale
    if found.degenerate:
        basis = orthonormal(np.stack([as_long(c) for c in space.T], axis=-1) * scale[:, None])
        exact = basis @ (basis.T @ ours)
    else:
        exact = as_long(solution) * scale
        exact *= np.sign(np.sum(exact * ours)) / np.sqrt(np.sum(exact * exact))
    phase = np.multiply.outer(THETA.astype(np.longdouble), k.astype(np.longdouble))
    values = np.where(sine, np.sin(phase), np.cos(phase)) @ (exact / scale)
    return float(np.max(np.abs(found(THETA) - values)))


def compared(given, order):
    """Return the estimate and the deviation of a solution; None where there is none."""
    functions, mu, n, end, damping = given
    try:
        found = boundary_solution(functions, mu, n, end, order, damping)
    except BadInput as refusal:
        assert "closed by damping" in str(refusal) or "converge visibly" in str(refusal)
        return None
    with mpmath.workdps(60):
        return found.error, deviation(given, found)


@over_scenes(61, floor=1e-17)
def test_exact_solutions(rng):
    return compared(scene(rng, 2.0), None)


@over_scenes(62, floor=1e-17)
def test_solutions_to_an_order(rng):
    return compared(scene(rng, 0.0), int(rng.integers(1, 9)))
