"""Strutt charts: where y'' + 2 K y' + (d + eps f(2 t)) y = 0 is stable; Mathieu's equation first.

With theta = 2 t this is Hill's equation with lam2 = d / 4, mu = eps / 4 and damping K / 2; the
period pi of f(2 t) becomes 2 pi, and the monodromy matrix over it has the same multipliers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import ceil, pi, sqrt
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import bad
from ...core.inputs import is_whole
from ...core.periodic_function import PeriodicFunction
from ...core.results import Check, Result, provenance
from ..exact.matrix import hill_boundaries
from ..half_trace import HalfTrace, check_function, discriminant_grid, finite

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes

Array = NDArray[np.float64]

COSINE = PeriodicFunction(a=[0.0, 1.0])
_UNSTABLE, _LINE = "#b9c4d0", "#1f3f5f"
_SECTIONS, _ROUNDS, _NEAR_TIP = 33, 6, 40
# Points so near to a boundary are on neither side of it.
_BESIDE = 1e-9


@dataclass(frozen=True, kw_only=True)
class StruttChart(Result):
    """Stability over the plane of d and eps, with the exact boundaries.

    Attributes
    ----------
    half_trace : ndarray, shape (n, m)
        Half trace of the monodromy matrix over the period pi of the coefficient.
    error : ndarray, shape (n, m)
        Estimate of its absolute error.
    d, eps : ndarray, shape (n,) and (m,)
        The grid.
    damping : float
        K of 2 K y'.
    regions : tuple of int
        Numbers of the unstable regions that reach into the chart; region i starts at d = i^2.
    lower, upper : ndarray, shape (len(regions), k)
        Their ends in d; -inf below region 0, NaN where damping has closed one.
    boundary_error : ndarray, shape (len(regions), k)
        Estimate of the absolute error of either end.
    boundary_eps : ndarray, shape (k,)
        Values of eps of the boundaries: those of the grid, and closer ones at blunted tips.
    """

    half_trace: Array = field(repr=False)
    d: Array = field(repr=False)
    eps: Array = field(repr=False)
    damping: float
    regions: tuple[int, ...]
    lower: Array = field(repr=False)
    upper: Array = field(repr=False)
    boundary_error: Array = field(repr=False)
    boundary_eps: Array = field(repr=False)

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "half_trace": ("d", "eps"),
        "error": ("d", "eps"),
        "stable": ("d", "eps"),
        "d": ("d",),
        "eps": ("eps",),
        "regions": ("region",),
        "lower": ("region", "boundary_eps"),
        "upper": ("region", "boundary_eps"),
        "boundary_error": ("region", "boundary_eps"),
        "boundary_eps": ("boundary_eps",),
    }
    exported: ClassVar[tuple[str, ...]] = ("stable",)

    @property
    def level(self) -> float:
        """Half trace at which a multiplier is 1 (and, with a minus sign, -1)."""
        return _level(self.damping)

    @property
    def stable(self) -> NDArray[np.bool_]:
        """True where the motion is stable, shape (n, m)."""
        return np.asarray(np.abs(self.half_trace) < self.level)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Shade the unstable regions over (d, eps) between their exact boundaries."""
        from ...core.plotting import axes_or_new

        ax = axes_or_new(ax)
        lowest = float(self.d[0])
        for low, high in zip(self.lower, self.upper, strict=True):
            open_ = np.isfinite(high)
            eps = self.boundary_eps[open_]
            left, right = np.maximum(low[open_], lowest), np.maximum(high[open_], lowest)
            ax.fill_betweenx(eps, left, right, color=_UNSTABLE, lw=0)
            outline = np.concatenate([low[open_][::-1], high[open_]])
            ax.plot(outline, np.concatenate([eps[::-1], eps]), color=_LINE, lw=0.9)
        ax.set_xlim(lowest, float(self.d[-1]))
        ax.set_ylim(float(self.eps[0]), float(self.eps[-1]))
        ax.set_xlabel("d")
        ax.set_ylabel("ε")
        ax.grid(visible=False)
        return ax


def strutt_chart(
    damping: float = 0.0,
    d_range: tuple[float, float] = (-2.0, 20.0),
    eps_range: tuple[float, float] = (0.0, 20.0),
    points: tuple[int, int] = (221, 201),
    function: PeriodicFunction | None = None,
) -> StruttChart:
    """Return the stability chart of y'' + 2 K y' + (d + eps f(2 t)) y = 0.

    Parameters
    ----------
    damping : float
        K, at least zero.
    d_range, eps_range : tuple of float
        Ends of the chart, each the lower one first.
    points : tuple of int
        Points of the grid in d and in eps, at least 2 each.
    function : PeriodicFunction, optional
        f; by default the cosine, which makes it Mathieu's equation.

    Returns
    -------
    StruttChart
        Its checks: the determinants, and that the signs of the grid and the boundaries, found by
        two methods, tell the same of every point.

    Raises
    ------
    BadInput
        If a range is empty or not finite, K is negative, or there are fewer than 2 points.

    Notes
    -----
    Aannaque 7.2.3 and Fig. E.3.
    """
    f = COSINE if function is None else function
    check_function(f)
    d, eps = (
        np.linspace(*range_of(name, ends), count_of(name, count))
        for name, ends, count in zip(("d", "eps"), (d_range, eps_range), points, strict=True)
    )
    k = damping_of(damping)
    half = discriminant_grid(f, 0.25 * d, 0.25 * eps, 0.5 * k)
    numbers = reaching(f, d, eps)
    lines = _with_tips(f, eps, numbers, k) if k else eps
    found = hill_boundaries(f, 0.25 * lines, numbers, damping=0.5 * k)
    lower, upper, error = 4.0 * found.lower, 4.0 * found.upper, 4.0 * found.error
    seen = np.any(np.isfinite(upper) & (upper >= d[0]) & (lower <= d[-1]), axis=1)
    kept = tuple(n for n, shown in zip(numbers, seen, strict=True) if shown)
    place = np.searchsorted(lines, eps)
    apart = _contradictions(half, d, lower[:, place], upper[:, place], error[:, place], _level(k))
    return StruttChart(
        method="half trace on a grid; boundaries from the Hill matrix",
        error=half.error,
        error_norm="absolute, entrywise, of the half trace",
        checks={**half.checks, "points on the wrong side of a boundary": Check(apart, 0.0)},
        provenance=provenance(),
        half_trace=half.value,
        d=d,
        eps=eps,
        damping=k,
        regions=kept,
        lower=lower[seen],
        upper=upper[seen],
        boundary_error=error[seen],
        boundary_eps=lines,
    )


def _level(damping: float) -> float:
    return float(0.5 * (1.0 + np.exp(-2.0 * pi * damping)))


def range_of(name: str, ends: ArrayLike) -> tuple[float, float]:
    """Return the ends of a range.

    Raises
    ------
    BadInput
        If they are not two finite numbers, the lower one first.
    """
    found = finite(f"{name}_range", ends)
    if found.shape != (2,) or not found[0] < found[1]:
        raise bad(f"{name}_range", ends, "two numbers, the lower one first", "correct it")
    return float(found[0]), float(found[1])


def count_of(name: str, count: object) -> int:
    """Return a number of points.

    Raises
    ------
    BadInput
        If it is no whole number from 2.
    """
    if not is_whole(count, 2):
        raise bad("points", f"{count!r} in {name}", "whole numbers from 2", "for example 201")
    return int(count)


def damping_of(damping: float) -> float:
    """Return the damping K.

    Raises
    ------
    BadInput
        If it is not one number, at least zero.
    """
    k = finite("damping", damping)
    if k.ndim or k < 0.0:
        raise bad("damping", damping, "one number K >= 0", "damping takes energy out")
    return float(k)


def reaching(f: PeriodicFunction, d: Array, eps: Array) -> tuple[int, ...]:
    """Return the regions whose ends may lie left of the chart's right edge."""
    farthest = float(d[-1]) + float(np.abs(eps).max()) * f.bound()
    return tuple(range(ceil(sqrt(max(farthest, 0.0))) + 2))


def _with_tips(f: PeriodicFunction, eps: Array, regions: Sequence[int], k: float) -> Array:
    """Return eps with more values just above the tips that damping has blunted."""
    more = [eps]
    for n in regions:
        found = hill_boundaries(f, 0.25 * eps, (n,), damping=0.5 * k).upper[0]
        open_ = np.isfinite(found)
        changes = np.flatnonzero(open_[1:] != open_[:-1])
        for j in changes:
            inner, outer = (eps[j + 1], eps[j]) if open_[j + 1] else (eps[j], eps[j + 1])
            tip = _tip(f, n, k, float(outer), float(inner))
            more.append(tip + (inner - tip) * np.linspace(0.0, 1.0, _NEAR_TIP) ** 2)
    return np.unique(np.concatenate(more))


def _tip(f: PeriodicFunction, n: int, k: float, outer: float, inner: float) -> float:
    """Return the eps nearest to ``outer``, where the region is closed, at which it is open."""
    for _ in range(_ROUNDS):
        between = np.linspace(outer, inner, _SECTIONS)
        open_ = np.isfinite(hill_boundaries(f, 0.25 * between, (n,), damping=0.5 * k).upper[0])
        first = max(int(np.argmax(open_)), 1)
        outer, inner = float(between[first - 1]), float(between[first])
    return inner


def _contradictions(
    half: HalfTrace, d: Array, lower: Array, upper: Array, error: Array, level: float
) -> float:
    """Count the points that half trace and boundaries put on different sides."""
    place = d[:, None]
    inside = np.zeros(half.value.shape, dtype=bool)
    beside = np.zeros_like(inside)
    for low, high, own in zip(lower, upper, error, strict=True):
        near = np.nan_to_num(own) + _BESIDE * (1.0 + np.abs(place))
        with np.errstate(invalid="ignore"):
            inside |= (place > low) & (place < high)
            beside |= (np.abs(place - low) < near) | (np.abs(place - high) < near)
    gap = np.abs(half.value) - level
    clear = ~beside & (np.abs(gap) > half.error)
    return float(np.count_nonzero(clear & (inside != (gap > 0.0))))
