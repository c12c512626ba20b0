"""Checks of boundary speeds against monodromy matrices, an independent route."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ..core.families import LinearPeriodic
from ..core.results import Check
from ..periodic import Monodromy, monodromy
from ..periodic.first_order import canonical_form

Array = NDArray[np.float64]

_MOST_BOUNDARIES = 256
# Most that a singular value, relative to the matrix, may be and still count as zero.
_MOST_DEFECT = 0.01
# Widest gaps between boundaries whose middles are test speeds.
_GAPS = 14


def at_boundaries(
    system: LinearPeriodic,
    speed: Array,
    sign: NDArray[np.int64],
    error: Array,
    parameters: Mapping[str, float],
) -> dict[str, Check]:
    """Compare with monodromy matrices, at the worst boundary against what its error allows.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    speed, error : ndarray
        Boundary speeds and their errors [rad/s], shape ``(k,)``.
    sign : ndarray of int
        +1 or -1, shape ``(k,)``.
    parameters : mapping
        Parameter values that replace the system's own.

    Returns
    -------
    dict
        Empty where there is no boundary.
    """
    if not len(speed):
        return {}
    pick = np.unique(np.linspace(0, len(speed) - 1, _MOST_BOUNDARIES).round().astype(int))
    speed, sign, error = speed[pick], sign[pick], error[pick]
    matrices = monodromy(system, speed, **parameters)
    value = _smallest(matrices, sign)
    form = canonical_form(system, speed, parameters)
    turning = 2 * form.rate * system.period
    width = matrices.matrix.shape[-1]
    limit = 8 * width * (matrices.error + (1 + turning) * error / speed)
    limit = np.minimum(limit, _MOST_DEFECT)
    worst = int(np.argmax(value / limit))
    return {"monodromy": Check(float(value[worst]), float(limit[worst]))}


def parity(
    system: LinearPeriodic,
    found: Sequence[tuple[int, Array]],
    span: tuple[float, float],
    parameters: Mapping[str, float],
) -> Check:
    """Count the contradictions between boundaries and signs of det(monodromy - multiplier).

    The determinant changes sign with every boundary, a double one counted twice.  It is taken at
    the ends of the range and in the widest gaps between boundaries.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    found : sequence of (int, ndarray)
        Multiplier, and all its boundary speeds in the range [rad/s].
    span : pair of float
        The range [rad/s].
    parameters : mapping
        Parameter values that replace the system's own.
    """
    wrong = 0
    for sign, boundaries in found:
        rising = np.sort(boundaries)
        speed = _test_speeds(rising, span)
        matrices = monodromy(system, speed, **parameters)
        signs = np.linalg.slogdet(_shifted(matrices, np.full(len(speed), sign)))[0]
        sure = _smallest(matrices, np.full(len(speed), sign)) > 100 * matrices.error
        count = np.searchsorted(rising, speed)
        expected = np.where(count % 2 == 0, 1.0, -1.0)
        agreed = (signs * expected)[sure]
        # The sign at the lowest speed is not known beforehand: the majority stands for it.
        wrong += int(min(np.sum(agreed > 0), np.sum(agreed < 0)))
    return Check(float(wrong), 0.0)


def _test_speeds(boundaries: Array, span: tuple[float, float]) -> Array:
    """Return the ends of the range and the middles of the widest gaps, in logarithms."""
    marks = np.log(np.concatenate([[span[0]], boundaries, [span[1]]]))
    while len(marks) <= _GAPS:
        widest = int(np.argmax(np.diff(marks)))
        middle = (marks[widest] + marks[widest + 1]) / 2
        marks = np.insert(marks, widest + 1, middle)
    widths = np.diff(marks)
    widest_gaps = np.sort(np.argsort(-widths, kind="stable")[:_GAPS])
    middles = (marks[widest_gaps] + marks[widest_gaps + 1]) / 2
    return np.concatenate([[span[0]], np.exp(middles), [span[1]]])


def _shifted(matrices: Monodromy, sign: NDArray[np.int64]) -> Array:
    unit = np.eye(matrices.matrix.shape[-1])
    shrink = np.ldexp(1.0, -matrices.exponent)[:, None, None]
    value: Array = matrices.scaled - shrink * (sign[:, None, None] * unit)
    return value


def _smallest(matrices: Monodromy, sign: NDArray[np.int64]) -> Array:
    """Return the smallest singular value of (matrix - multiplier) over the matrix."""
    norm = np.linalg.norm(matrices.scaled, axis=(-2, -1))
    value: Array = np.linalg.svd(_shifted(matrices, sign), compute_uv=False)[:, -1] / norm
    return value
