"""Independent check of boundaries: the half trace at the ends stands at the level of a boundary."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ...core.errors import BadInput
from ...core.periodic_function import PeriodicFunction
from ...core.results import Check
from ..half_trace import HalfTrace, discriminant

Array = NDArray[np.float64]

_SAMPLE = 24
# The figures are estimates, and slope and curvature come from differences.
LIMIT = 4.0
_STEP = 1e-4


def boundary_checks(
    f: PeriodicFunction,
    mu: Array,
    damping: Array,
    regions: tuple[int, ...],
    lower: Array,
    upper: Array,
    error: Array,
    undecided: NDArray[np.bool_],
) -> Mapping[str, Check]:
    """Compare the half trace at a sample of ends with the level that it has on a boundary.

    Parameters
    ----------
    f : PeriodicFunction
        The coefficient function.
    mu, damping : ndarray, shape (n,)
        Factor and K.
    regions : tuple of int
        Numbers of the regions.
    lower, upper, error : ndarray, shape (len(regions), n)
        Ends in lam2 and their error figure.
    undecided : ndarray of bool, same shape
        Where neither open nor closed could be told.

    Returns
    -------
    mapping of str to Check
        The largest deviation from the level over what the error figures explain: slope times the
        figure of the end, half the curvature times its square (the slope vanishes where a region
        is closed), and the figure of the half trace.  NaN, which fails, where the half trace
        cannot be computed; left out where there is no finite end.  Also how many regions are
        undecided, if any are.
    """
    told: dict[str, Check] = {}
    if np.any(undecided):
        told["regions neither open nor closed"] = Check(float(np.count_nonzero(undecided)), 0.0)
    ends = np.stack([lower, upper])
    places = np.argwhere(np.isfinite(ends))
    if not len(places):
        return told
    side, row, column = sample_of(places)
    lam2, size = ends[side, row, column], error[row, column]
    numbers = np.asarray(regions)[row]
    name = "half trace at the ends over what the figures explain"
    try:
        found, explained = half_trace_near(f, lam2, size, mu[column], damping[column])
    except BadInput:
        return {**told, name: Check(np.nan, LIMIT)}
    level = np.where(numbers % 2 == 0, 1.0, -1.0) * found.level
    with np.errstate(invalid="ignore", over="ignore"):
        share = np.abs(found.value[1] - level) / explained
    return {**told, name: Check(float(share.max()), LIMIT)}


def sample_of(places: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return an even sample of places ``(n, d)``, its ends included, by coordinate."""
    chosen = np.unique(np.linspace(0, len(places) - 1, min(_SAMPLE, len(places))).round())
    return np.asarray(places[chosen.astype(int)].T)


def half_trace_near(
    f: PeriodicFunction, lam2: Array, error: Array, mu: Array, damping: Array
) -> tuple[HalfTrace, Array]:
    """Return the half trace beside, at and beside lam2, and what error figures explain at it.

    Parameters
    ----------
    f : PeriodicFunction
        The coefficient function.
    lam2, error : ndarray, shape (n,)
        Places and their error figures.
    mu, damping : ndarray, shape (n,)
        Factor and K.

    Returns
    -------
    HalfTrace, ndarray
        Values of shape ``(3, n)``, the middle one at lam2; deviations ``(n,)`` by slope, curvature
        and the figure of the half trace.

    Raises
    ------
    BadInput
        If the half trace cannot be computed.
    """
    step = _STEP * (1.0 + np.sqrt(np.abs(lam2)))
    found = discriminant(f, lam2 + step * np.array([[-1.0], [0.0], [1.0]]), mu, damping)
    with np.errstate(invalid="ignore", over="ignore"):
        before, at, after = found.value
        slope = np.abs(after - before) / (2.0 * step)
        bend = np.abs(after - 2.0 * at + before) / step**2
        return found, slope * error + 0.5 * bend * error**2 + found.error[1]
