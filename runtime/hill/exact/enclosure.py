"""Enclosures of eigenvalues of Hill's equation: exact residuals, block Kato-Temple bounds.

A group of trial functions close to the eigenfunctions of a group of eigenvalues gives the matrix
P of the operator in their span and the norm r of what leaves the span, both from exact integers.
Where all other eigenvalues keep a distance g from the group, each eigenvalue of the group differs
from its own one of P by no more than ``r^2 / (g - 2 r)``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ...core.errors import BadInput, bad
from .integer_products import (
    FUNCTION_BITS,
    PRODUCT_UNIT,
    VECTOR_BITS,
    HillOperator,
    Wave,
    inner,
    root_above,
    wave,
)
from .isolation import Spectrum

Array = NDArray[np.float64]

# Fractions of floats that bound something are enlarged by so much.
_SAFE = Fraction(1001, 1000)
_TURN_BITS = 60


@dataclass(frozen=True)
class Ball:
    """A proved enclosure: the value lies within ``radius`` of ``middle``."""

    middle: Fraction
    radius: Fraction


def enclosures(found: Spectrum, operator: HillOperator, first: int, last: int) -> list[Ball]:
    """Enclose the eigenvalues number first ... last, which stand clear of all others.

    Raises
    ------
    BadInput
        If the residuals are too large for the distance from the others.
    """
    waves = [wave(found.odd, found.vectors[:, j]) for j in range(first, last + 1)]
    images = [operator(x) for x in waves]
    coupling = [[inner(x, h) for h in images] for x in waves]
    overlap = [[inner(x, y) for y in waves] for x in waves]
    residual = _residual(waves, images, coupling, overlap)
    values = [Fraction(float(v)) for v in found.values]
    reach = Fraction(found.reach) + operator.rounding
    gaps = [values[last + 1] - values[last]]
    if first:
        gaps.append(values[first] - values[first - 1])
    gap = min(gaps) - 2 * reach
    balls = _inside(coupling, overlap)
    low, high = values[first] - reach - gap / 2, values[last] + reach + gap / 2
    # The eigenvalues of P must be those next to the group, and nothing else there.
    there = all(low <= b.middle - b.radius and b.middle + b.radius <= high for b in balls)
    if not (there and 4 * residual < gap):
        raise refusal(f"a residual of {float(residual):.1e} beside a gap of {float(gap):.1e}")
    spread = residual * residual / (gap - 2 * residual) + operator.rounding
    return [Ball(ball.middle, ball.radius + spread) for ball in balls]


def refusal(found: str) -> BadInput:
    """Return the error for a problem that cannot be certified."""
    return bad(
        "hill_boundaries(certified=True)",
        found,
        "eigenvalues that double precision tells apart",
        "take a smaller mu, lower regions or fewer harmonics",
    )


def _residual(
    waves: Sequence[Wave],
    images: Sequence[Wave],
    coupling: Sequence[Sequence[int]],
    overlap: Sequence[Sequence[int]],
) -> Fraction:
    """Bound the norm of what the operator takes out of the span of the trial functions."""
    total = 0
    size = len(waves)
    for i, image in enumerate(images):
        # Any combination may be taken off; the projection would be best.
        rest = image.scaled(VECTOR_BITS)
        for j in range(size):
            factor = (coupling[j][i] << VECTOR_BITS) // overlap[j][j]
            rest = rest.plus(waves[j], -factor)
        total += inner(rest, rest)
    tilt = _tilt(overlap)
    # Units: 2**-VECTOR_BITS of the trial functions, twice, and those of the operator; 4 H.
    unit = Fraction(1, PRODUCT_UNIT << VECTOR_BITS)
    square = Fraction(total) * unit * unit / (1 - tilt)
    return root_above(square)


def _tilt(overlap: Sequence[Sequence[int]]) -> Fraction:
    """Bound the norm of the deviation of the trial functions from an orthonormal set."""
    unit = 1 << (2 * VECTOR_BITS)
    rows = [
        sum(abs(v - (unit if i == j else 0)) for j, v in enumerate(row))
        for i, row in enumerate(overlap)
    ]
    return Fraction(max(rows), unit)


def _inside(coupling: Sequence[Sequence[int]], overlap: Sequence[Sequence[int]]) -> list[Ball]:
    """Enclose the eigenvalues of the operator within the span, rising."""
    unit = 4 << FUNCTION_BITS
    size = len(coupling)
    ritz = [Fraction(coupling[i][i], overlap[i][i]) for i in range(size)]
    if size == 1:
        return [Ball(ritz[0] / unit, Fraction(0))]
    # About their mean the values are small, and so are the errors of a rotation in doubles.
    mean = round(sum(ritz) / size)
    shifted = [[coupling[i][j] - mean * overlap[i][j] for j in range(size)] for i in range(size)]
    turn = _turn(shifted)
    inner_part = _congruent(turn, shifted)
    metric = _congruent(turn, overlap)
    values = [Fraction(inner_part[i][i], metric[i][i]) for i in range(size)]
    order = sorted(range(size), key=lambda i: values[i])
    # Off the diagonal, with the diagonal of the metric taken to 1.
    off = _off_norm(inner_part, metric)
    tilt = _off_norm(metric, metric)
    spread = max(abs(v) for v in values) + off
    radius = (off + tilt / (1 - tilt) * spread) * _SAFE
    return [Ball((mean + values[i]) / unit, radius / unit) for i in order]


def _turn(matrix: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return the eigenvectors of a symmetric matrix of integers, rounded to integers."""
    scale = max(max(abs(v) for v in row) for row in matrix) or 1
    floats = np.array([[v / scale for v in row] for row in matrix])
    vectors = np.linalg.eigh(0.5 * (floats + floats.T))[1]
    return [[int(v) for v in row] for row in np.rint(vectors * 2.0**_TURN_BITS)]


def _congruent(turn: Sequence[Sequence[int]], matrix: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return ``turn^T matrix turn``."""
    size = range(len(matrix))
    half = [[sum(matrix[i][k] * turn[k][j] for k in size) for j in size] for i in size]
    return [[sum(turn[k][i] * half[k][j] for k in size) for j in size] for i in size]


def _off_norm(matrix: Sequence[Sequence[int]], metric: Sequence[Sequence[int]]) -> Fraction:
    """Bound the norm of what is off the diagonal after scaling the metric's diagonal to 1."""
    size = len(matrix)
    least = min(metric[i][i] for i in range(size))
    rows = [sum(abs(matrix[i][j]) for j in range(size) if j != i) for i in range(size)]
    return Fraction(max(rows), least)
