"""Stable or not, with the slack that errors leave, and a spot check against multipliers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..families import Array
from ..floquet.monodromy_matrix import floquet_multipliers
from ..results import Check
from .invariants import largest_modulus, root_uncertainty
from .sampling import Sampler, Series
from .structure import damping_rate, on_grid

_SPOTS = 5
Verdict = tuple[Array, NDArray[np.bool_], Array]


def verdict(sampler: Sampler, series: Series) -> Verdict:
    """Return the largest modulus, whether stable, and the slack, each ``(ny, nx)``."""
    if not sampler.hill:
        return largest_modulus(series.values, reduced=sampler.reduced, error=series.error)
    half = np.abs(series.values[..., 0])
    level = np.ones_like(half)
    if sampler.damped:
        speed, _ = on_grid(sampler.names, sampler.axes)
        rate = damping_rate(sampler.system, sampler.names, sampler.axes)
        level = np.exp(-2 * np.pi * rate / speed)
    largest = _larger_root(half, level)
    # An error of the half trace moves the boundary, where it is (1 + W) / 2.
    edge = 0.5 * (1.0 + level)
    slack = _larger_root(edge + series.error, level) - 1.0
    return largest, half <= edge + series.error, slack


def _larger_root(half: Array, level: Array) -> Array:
    """Return the largest modulus of the roots of ``rho^2 - 2 X rho + W`` at X >= 0.

    W is the determinant.
    """
    with np.errstate(over="ignore"):
        square = half**2
        real = square >= level
        root = half + np.sqrt(np.where(real, square - level, 0.0))
    return np.where(real, root, np.sqrt(level))


def spot_check(sampler: Sampler, series: Series, found: Verdict) -> Check:
    """Compare a handful of points with their Floquet multipliers.

    The value is the worst gap of the largest modulus over what the errors allow.  The allowance
    comes from the multipliers themselves, not from the slack of the verdict.
    """
    rng = np.random.default_rng(1972)
    largest, stable, _ = found
    i = rng.integers(0, largest.shape[0], _SPOTS)
    j = rng.integers(0, largest.shape[1], _SPOTS)
    point: dict[str, Any] = {sampler.names[0]: sampler.axes[0][j]}
    point[sampler.names[1]] = sampler.axes[1][i]
    speed = point.pop("speed", np.ones(_SPOTS))
    direct = floquet_multipliers(sampler.system, speed, **point)
    modulus = np.abs(direct.multipliers)
    usable = np.all(np.isfinite(modulus), axis=-1) & np.isfinite(largest[i, j])
    usable &= np.all(np.isfinite(series.values[i, j]), axis=-1)
    if not np.any(usable):
        return Check(0.0, 1.0)
    top = np.argmax(modulus, axis=-1)
    rows = np.arange(_SPOTS)
    size = np.max(np.abs(series.values[i, j]), axis=-1, initial=1.0)
    error = 2.0 * series.error[i, j] + 64 * np.finfo(float).eps * size
    own = root_uncertainty(np.where(usable[:, None], direct.multipliers, 0.0), error)[rows, top]
    peak = modulus[rows, top]
    allowed = 4.0 * (own + direct.error[rows, top]) + 1e-12 * peak
    gap = np.abs(peak - largest[i, j])
    # A growth beyond the allowance that is called stable is a gap as well.
    gap = np.where(stable[i, j], np.maximum(gap, peak - 1.0), gap)
    return Check(float(np.max((gap / allowed)[usable])), 1.0)
