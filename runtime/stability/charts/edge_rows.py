"""Unstable regions along the speed at some rows of a chart, joined by their labels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.families import Array, LinearPeriodic
from ...core.results import Check
from ..edges import StabilityEdges, stability_edges

# Rows at which regions are traced: each takes a second or so.
_ROWS = 9


@dataclass(frozen=True)
class EdgeCurves:
    """Ends of unstable regions along the speed, at some values of the other axis.

    Attributes
    ----------
    at : ndarray, shape (m,)
        Values of the other axis.
    lower, upper : ndarray, shape (k, m)
        Speeds [rad/s]; NaN where the region is outside the chart or has no such end.
    error : ndarray, shape (k, m)
        Absolute error of either end [rad/s].
    modes : ndarray of int, shape (k, 2)
        The two modes, from 1.
    harmonic : ndarray of int, shape (k,)
        As in :class:`~.edges.StabilityEdges`.
    kind : tuple of str
        ``"principal"``, ``"sum"`` or ``"difference"``.
    check : Check
        Failed self-checks of all rows.
    """

    at: Array
    lower: Array
    upper: Array
    error: Array
    modes: NDArray[np.int64]
    harmonic: NDArray[np.int64]
    kind: tuple[str, ...]
    check: Check


def edge_curves(
    system: LinearPeriodic, names: tuple[str, str], axes: tuple[Array, Array]
) -> EdgeCurves:
    """Return the regions at up to nine rows across a chart whose one axis is the speed."""
    which = names.index("speed")
    values, speeds = axes[1 - which], axes[which]
    if len(values) > _ROWS:
        values = np.linspace(values[0], values[-1], _ROWS)
    span = float(speeds[0]), float(speeds[-1])
    rows = [stability_edges(system, span, **{names[1 - which]: float(v)}) for v in values]
    keys = sorted({key for row in rows for key in _keys(row)})
    ends = np.full((3, len(keys), len(rows)), np.nan)
    for column, row in enumerate(rows):
        for i, key in enumerate(_keys(row)):
            ends[:, keys.index(key), column] = row.lower[i], row.upper[i], row.error[i]
    failed = sum(not check.passed for row in rows for check in row.checks.values())
    return EdgeCurves(
        values,
        ends[0],
        ends[1],
        ends[2],
        np.array([key[1:3] for key in keys], dtype=np.int64).reshape(-1, 2),
        np.array([key[3] for key in keys], dtype=np.int64),
        tuple(key[0] for key in keys),
        Check(float(failed), 0.0),
    )


def _keys(row: StabilityEdges) -> list[tuple[str, int, int, int]]:
    found = zip(row.kind, row.modes.tolist(), row.harmonic.tolist(), strict=True)
    return [(kind, i, j, n) for kind, (i, j), n in found]
