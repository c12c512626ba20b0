"""The least parameter at which a damped region opens: search over the critical damping."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import BadInput
from ..exact.roots import crossing
from ..transfer import EPS
from .closing import Closing

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]
Closings = Callable[[Array], Closing]

# Values of mu per decade in the search for the first crossing, and how far it goes: to mu f of so
# many times the square of the region's number.
_PER_DECADE = 24
FARTHEST = 16.0
# How often a maximum between those values is looked at more closely, and by how much.
_ZOOMS, _ZOOM = 3, 8
# Where the search begins without damping: there any width will do.
_SMALLEST = 1e-3


@dataclass(frozen=True)
class Opening:
    """What the search found for one region, entry by entry."""

    least: Array
    lam2: Array
    error: Array
    absent: Mask
    outside: Mask
    gap: Array
    searched: Array

    @classmethod
    def nothing(cls, size: int) -> Opening:
        """Return the answer of a region that never opens."""
        infinite, unknown = np.full(size, np.inf), np.full(size, np.nan)
        flag = np.ones(size, dtype=bool)
        return cls(infinite, unknown, np.zeros(size), flag, ~flag, unknown.copy(), np.zeros(1))


def first_opening(closing: Closings, n: int, damping: Array, silent: bool, top: float) -> Opening:
    """Search one region: bracket the first crossing of the critical damping, and refine it."""
    out = Opening.nothing(damping.size)
    if silent or top == 0.0 or damping.size == 0:
        return out
    drag = damping[damping > 0.0]
    # Half traces grow with the first power of mu at most while mu f is small.
    least = min(1.0, 0.125 * n * float(drag.min())) if drag.size else _SMALLEST
    bottom = least * top / FARTHEST
    bottom /= max(n, float(damping.max())) ** 2
    decades = np.log10(top / bottom)
    grid = np.geomspace(bottom, top, int(np.ceil(_PER_DECADE * decades)) + 1)
    grid, highest, edge = _climb(closing, grid, float(damping.max()))
    out.searched[0] = grid[-1]
    # The first grid value above each K: the running maximum is in order.
    first = np.searchsorted(highest, damping, side="right")
    found = first < grid.size
    out.outside[:] = np.minimum(first, grid.size - 1) >= edge
    out.absent[:] = ~found & ~out.outside
    out.least[out.outside] = np.nan
    still = found & ~out.outside & (damping == 0.0)
    out.least[still], out.lam2[still] = 0.0, 0.25 * n * n
    there = np.flatnonzero(found & ~out.outside & (damping > 0.0))
    if there.size:
        low = np.where(first[there] > 1, grid[np.maximum(first[there] - 2, 0)], 0.25 * bottom)
        _refine(out, closing, damping, there, np.log(low), np.log(grid[first[there]]))
    return out


def _climb(closing: Closings, grid: Array, enough: float) -> tuple[Array, Array, int]:
    """Return the grid with the running maximum of the critical damping, as far as needed.

    Less its figure, and with the peaks between the values of the grid.  Also the place of the
    first value at which the orders do not converge.  A decade at a time: small values of mu need
    small matrices.
    """
    found, edge = np.zeros(0), -1
    for part in np.array_split(grid, -(-grid.size // _PER_DECADE)):
        try:
            known = closing(part)
        except BadInput:
            # Hill's matrix would be too large: the search ends here.
            if not found.size:
                raise
            break
        value = np.where(known.outside, -np.inf, known.damping - known.error)
        before = found.size
        found = np.concatenate([found, value])
        if known.outside.any():
            edge = before + int(np.argmax(known.outside))
            break
        if found.max() > enough:
            break
    grid = grid[: found.size]
    last = found.size if edge < 0 else edge
    peaks, tops = _peaks(closing, grid[:last], found[:last])
    order = np.argsort(np.concatenate([grid, peaks]), kind="stable")
    grid, found = (
        np.concatenate([own, more])[order] for own, more in ((grid, peaks), (found, tops))
    )
    return grid, np.maximum.accumulate(found), grid.size if edge < 0 else last + peaks.size


def _peaks(closing: Closings, grid: Array, value: Array) -> tuple[Array, Array]:
    """Return the places of maxima near those on a grid, and the values there."""
    inner = np.flatnonzero((value[1:-1] > value[:-2]) & (value[1:-1] >= value[2:])) + 1
    if not inner.size:
        return np.zeros(0), np.zeros(0)
    low, high = np.log(grid[inner - 1]), np.log(grid[inner + 1])
    each = np.arange(inner.size)
    for _ in range(_ZOOMS):
        x = np.linspace(low, high, _ZOOM + 1)
        known = closing(np.exp(x.ravel()))
        tops = np.where(known.outside, -np.inf, known.damping - known.error).reshape(x.shape)
        best, step = tops.argmax(axis=0), (high - low) / _ZOOM
        low, high = x[best, each] - step, x[best, each] + step
    return np.exp(x[best, each]), tops[best, each]


def _refine(
    out: Opening, closing: Closings, damping: Array, there: Index, low: Array, high: Array
) -> None:
    """Solve ``log K_crit(mu) = log K`` in log mu, and enter what is found."""
    wanted = damping[there]

    def excess(x: Array, which: Index) -> Array:
        k = closing(np.exp(x)).damping
        return np.asarray(np.log(np.maximum(k / wanted[which], 1e-3)))

    x = crossing(excess, low, high)
    at, step = closing(np.exp(x)), 1e-4
    with np.errstate(divide="ignore", invalid="ignore"):
        up, down = (closing(np.exp(x + d)).damping for d in (step, -step))
        slope = np.maximum((np.log(up) - np.log(down)) / (2.0 * step), 1e-3)
    rounding = 8.0 * EPS * wanted * (1.0 + slope * np.abs(x))
    out.least[there], out.lam2[there] = np.exp(x), at.lam2
    out.error[there] = np.exp(x) * ((at.error + rounding) / (wanted * slope) + 4.0 * EPS)
    out.gap[there] = np.abs(at.damping - wanted) / (at.error + rounding)
    lost = there[at.outside]
    out.outside[lost], out.least[lost] = True, np.nan
