"""Steady states by harmonic balance: Fourier series of the motion and of all coefficients.

With ``q = sum_k q_k exp(i k nu theta)``, nu = 2 pi / period, the equation
``(M q' + A q)' = (A^T - C/w) q' + N q + F`` becomes

    sum_l (i nu k (i nu l M_{k-l} + A_{k-l}) - i nu l (A^T - C/w)_{k-l} - N_{k-l}) q_l = F_k

(Aannaque, section 6.4, with the series of every coefficient).  High modes that the motion does not
excite cost nothing: the harmonics are those of the motion, however stiff the system is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .equation import Equation

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_EPS = float(np.finfo(float).eps)
_FIRST = 12
# Unknowns up to which harmonics are added: a matrix of 400 MiB.
_MOST_UNKNOWNS = 5000


def balanced_motion(
    equation: Equation, rtol: float, samples: int
) -> tuple[Array, Array, Array, float]:
    """Return the periodic motion of the first member at even angles, its error and condition.

    q and dq/dtheta have shape ``(samples, n)``.  The error of each coordinate over its peak,
    ``(n,)``, is the difference to a motion of two thirds of the harmonics, times what the last
    third is expected to leave of it, and round-off; the condition number is that of the equations
    in scaled coordinates, infinite where they are singular.
    """
    harmonics = _FIRST
    before = _series(equation, 2 * harmonics // 3)[0]
    while True:
        waves, condition = _series(equation, harmonics)
        q, slope = _motion(equation, waves, samples)
        size = np.max(np.abs(q), axis=0)
        size = np.where(size > 0.0, size, 1.0)
        gap = np.max(np.abs(q - _motion(equation, before, samples)[0]), axis=0) / size
        # The last third tells how they fall where no mode answers in it or beyond.
        highest = np.max(equation.frequency[0]) * equation.period / (2.0 * np.pi)
        gap = _left(waves) * gap if highest < 2 * harmonics // 3 else gap
        error = gap + 8.0 * _EPS * min(condition, 1.0 / _EPS)
        more = (3 * harmonics) // 2
        enough = bool(np.all(error <= rtol)) or not np.isfinite(condition)
        if enough or (2 * more + 1) * equation.size > _MOST_UNKNOWNS:
            return q, slope, error, condition
        before, harmonics = waves, more


def _left(waves: ComplexArray) -> Array:
    """Return what share of an error the last third of the harmonics leaves, at most 1.

    Twice the root of the fall from the third before it: harmonics beyond may fall half as fast.
    """
    third = len(waves) // 3
    middle, last = (
        np.max(np.abs(part), axis=0) for part in (waves[-2 * third : -third], waves[-third:])
    )
    share: Array = np.minimum(1.0, 2.0 * np.sqrt(last / np.maximum(middle, np.finfo(float).tiny)))
    return share


def _series(equation: Equation, harmonics: int) -> tuple[ComplexArray, float]:
    """Return harmonics 0 to H of q in scaled coordinates, ``(H + 1, n)``, and the condition."""
    n, size = equation.size, 2 * harmonics + 1
    order = np.arange(-harmonics, harmonics + 1)
    rate = 2j * np.pi / equation.period * order
    angles = equation.even_angles()
    count = len(angles)
    feedback = equation.feedback(angles)

    def window(values: Array | None) -> ComplexArray | float:
        """Return the blocks of harmonic k - l, ``(size, size, n, n)``."""
        if values is None:
            return 0.0
        table = np.fft.fft(np.broadcast_to(values[0], (count, n, n)), axis=0) / count
        gaps = order[:, None] - order
        kept: ComplexArray = np.where(
            (2 * np.abs(gaps) < count)[..., None, None], table[gaps % count], 0.0
        )
        return kept

    fields = {
        name: window(equation.at(name, angles) if name in equation.fields else None)
        for name in ("mass", "gyroscopic", "stiffness")
    }
    outer, inner = rate[:, None, None, None], rate[None, :, None, None]
    blocks = outer * (inner * fields["mass"] + fields["gyroscopic"])
    blocks = blocks - inner * window(feedback) - fields["stiffness"]
    matrix = np.swapaxes(blocks, 1, 2).reshape(size * n, size * n)
    force = np.fft.fft(np.broadcast_to(equation.at("force", angles)[0], (count, n)), axis=0) / count
    load = np.where((2 * np.abs(order) < count)[:, None], force[order % count], 0.0)
    # Rows are weighed by their largest entry: inertia grows with the square of the harmonic.
    largest = np.max(np.abs(matrix), axis=1)
    if not np.all(largest > 0.0):
        return np.full((harmonics + 1, n), np.nan + 0j), float("inf")
    weights = 1.0 / largest
    weighed = weights[:, None] * matrix
    condition = float(np.linalg.cond(weighed)) if size * n <= 600 else _estimate(weighed)
    if not condition < 1.0 / _EPS:
        return np.full((harmonics + 1, n), np.nan + 0j), float("inf")
    waves = np.linalg.solve(weighed, weights * load.ravel()).reshape(size, n)
    half: ComplexArray = waves[harmonics:]
    return half, condition


def _estimate(matrix: ComplexArray) -> float:
    """Return an estimate of the condition number in the 1-norm."""
    from scipy.linalg.lapack import zgecon, zgetrf

    factors, _, info = zgetrf(matrix)
    if info:
        return float("inf")
    reciprocal, _ = zgecon(factors, float(np.max(np.sum(np.abs(matrix), axis=0))))
    return 1.0 / reciprocal if reciprocal else float("inf")


def _motion(equation: Equation, waves: ComplexArray, samples: int) -> tuple[Array, Array]:
    """Return coordinates and slopes at even angles from harmonics 0 to H."""
    rate = 2j * np.pi / equation.period * np.arange(len(waves))[:, None]
    turns = np.exp(2j * np.pi * np.outer(np.arange(samples), np.arange(len(waves))) / samples)
    weights = np.where(np.arange(len(waves)) == 0, 1.0, 2.0)[:, None]
    q = (turns @ (weights * waves)).real * equation.scale[0]
    slope = (turns @ (weights * rate * waves)).real * equation.scale[0]
    return q, slope
