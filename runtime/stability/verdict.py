"""Stable or not, with the slack that errors leave, and a spot check against multipliers."""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.families import Array, LinearPeriodic
from ..core.results import Check
from ..periodic import floquet_multipliers
from .chart_axes import damping_rate, on_grid
from .chart_sampling import Map, Sampler, Series
from .invariants import instability_kind, known_to, largest_modulus, root_uncertainty

_SPOTS = 5


class Judged(NamedTuple):
    """What is told of each point, ``(ny, nx)``; see :class:`~.chart.StabilityChart`."""

    largest: Array
    stable: NDArray[np.bool_]
    slack: Array
    undecided: NDArray[np.bool_]
    kind: NDArray[np.int8]


def judged(sampler: Sampler, series: Series, workers: Map) -> Judged:
    """Return what is told of each point, some rows at a time, which bounds the memory."""
    rows, points = series.values.shape[:2]
    # Points that are judged together.
    together = max(1, 250_000 // max(1, points))
    parts = [slice(start, start + together) for start in range(0, rows, together)]
    # Of one mode the verdict is quicker than the way to another process and back.
    run = map if sampler.hill else workers
    blocks = run(partial(_judge, sampler), ((part, series.rows(part)) for part in parts))
    return Judged(*(np.concatenate(columns) for columns in zip(*blocks, strict=True)))


def _judge(sampler: Sampler, item: tuple[slice, Series]) -> Judged:
    """Return what is told of the points of some rows."""
    part, series = item
    rows = sampler.rows(part)
    if rows.hill:
        half = np.abs(series.values[..., 0])
        level = _level(rows, half)
        largest = _larger_root(half, level)
        # An error of the half trace moves the boundary, where it is (1 + W) / 2.
        edge = 0.5 * (1.0 + level)
        slack = _larger_root(edge + series.error, level) - 1.0
        stable = half <= edge + series.error
        undecided = np.abs(half - edge) <= series.error
    else:
        error = series.error if series.errors is None else series.errors
        largest, stable, slack = largest_modulus(series.values, reduced=rows.reduced, error=error)
        # Unstable is only what some multiplier proves beyond its own error.
        doubtful = slack > 0.0 if rows.reduced else largest + slack >= 1.0
        undecided = np.isnan(largest) | (stable & doubtful)
    kind = instability_kind(series.values, stable, hill=rows.hill, reduced=rows.reduced)
    return Judged(largest, stable, slack, undecided, kind)


def _level(sampler: Sampler, half: Array) -> Array:
    """Return the determinant of the monodromy matrices of one mode."""
    if not sampler.damped:
        return np.ones_like(half)
    speed, _ = on_grid(sampler.names, sampler.axes, sampler.speed)
    rate = damping_rate(sampler.system, sampler.names, sampler.axes)
    return np.asarray(np.exp(-2 * np.pi * rate / speed) * np.ones_like(half))


def _larger_root(half: Array, level: Array) -> Array:
    """Return the largest modulus of the roots of ``rho^2 - 2 X rho + W`` at X >= 0.

    W is the determinant.
    """
    with np.errstate(over="ignore"):
        square = half**2
        real = square >= level
        root = half + np.sqrt(np.where(real, square - level, 0.0))
    return np.where(real, root, np.sqrt(level))


def spot_check(sampler: Sampler, series: Series, found: Judged) -> Check:
    """Compare a handful of points with their Floquet multipliers.

    The value is the worst gap of the largest modulus over what the errors allow.  The allowance
    comes from the multipliers themselves, not from the slack of the verdict.
    """
    rng = np.random.default_rng(1972)
    largest, stable = found.largest, found.stable
    i = rng.integers(0, largest.shape[0], _SPOTS)
    j = rng.integers(0, largest.shape[1], _SPOTS)
    point = {"speed": np.full(_SPOTS, sampler.speed)}
    point |= {sampler.names[0]: sampler.axes[0][j], sampler.names[1]: sampler.axes[1][i]}
    with np.errstate(over="ignore", invalid="ignore"):
        multipliers, known = _direct(sampler.system, point)
    modulus = np.abs(multipliers)
    usable = np.all(np.isfinite(modulus), axis=-1) & np.isfinite(largest[i, j])
    usable &= np.all(np.isfinite(series.values[i, j]), axis=-1)
    if not np.any(usable):
        return Check(0.0, 1.0)
    top = np.argmax(modulus, axis=-1)
    rows = np.arange(_SPOTS)
    error = _full_errors(series, i, j, modulus.shape[-1])
    own = root_uncertainty(np.where(usable[:, None], multipliers, 0.0), error)[rows, top]
    peak = np.where(usable, modulus[rows, top], 1.0)
    allowed = 4.0 * (own + known[rows, top]) + 1e-12 * peak
    gap = np.abs(peak - np.where(usable, largest[i, j], peak))
    # A growth beyond the allowance that is called stable is a gap as well.
    gap = np.where(stable[i, j], np.maximum(gap, peak - 1.0), gap)
    return Check(float(np.max((gap / allowed)[usable])), 1.0)


def _full_errors(series: Series, i: NDArray[np.int64], j: NDArray[np.int64], size: int) -> Array:
    """Return errors of all coefficients of characteristic polynomials at points, doubled."""
    values = series.values[i, j]
    if series.errors is None:
        known = known_to(values, series.error[i, j])[..., :1]
        return np.broadcast_to(2.0 * known, (len(i), size))
    known = known_to(values, series.errors[i, j])
    if known.shape[-1] < size:
        # Palindromic: the same again backwards, and a last coefficient that is 1.
        known = np.concatenate([known, known[:, -2::-1], np.zeros((len(i), 1))], axis=1)
    return 2.0 * known


def _direct(
    system: LinearPeriodic, point: dict[str, Array]
) -> tuple[NDArray[np.complex128], Array]:
    """Return multipliers and their errors at points, ``(points, 2n)`` each."""
    if any(name in system.geometry for name in point):
        members = [{name: float(v[i]) for name, v in point.items()} for i in range(_SPOTS)]
        each = [floquet_multipliers(system, **member) for member in members]
        return np.stack([e.multipliers for e in each]), np.stack([e.error for e in each])
    values: dict[str, Any] = {**point}
    found = floquet_multipliers(system, **values)
    return found.multipliers, found.error
