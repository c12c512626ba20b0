"""Strutt's chart and the surfaces of multipliers of ``y'' + 2 K y' + (d + eps cos 2t) y = 0``.

Aannaque 7.2.3 and appendix E.  With theta = 2 t this is Hill's equation with lam2 = d / 4,
mu = eps / 4 and damping K / 2; the period pi becomes 2 pi, the multipliers over it are the same.
"""

from __future__ import annotations

from itertools import pairwise
from math import ceil, pi, sqrt
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.periodic_function import PeriodicFunction
from ..hill import discriminant, hill_boundaries

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Which = Literal["first", "second"]

COSINE = PeriodicFunction(a=[0.0, 1.0])
_UNSTABLE, _LINE = "#b9c4d0", "#1f3f5f"
# Points so near to a boundary are on neither side of it.
_BESIDE = 1e-9


class StruttChart(NamedTuple):
    """Half traces over (d, eps), the ends in d of each region, and points judged differently."""

    d: Array
    eps: Array
    damping: float
    half_trace: Array
    regions: tuple[int, ...]
    lower: Array
    upper: Array
    boundary_eps: Array
    contradictions: int

    def plot(self, ax: Axes) -> Axes:
        """Shade the unstable regions over (d, eps) between their exact boundaries."""
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
    damping: float,
    d_range: tuple[float, float],
    eps_range: tuple[float, float],
    points: tuple[int, int] = (221, 201),
) -> StruttChart:
    """Return the stability chart: half traces on a grid, boundaries from Hill's matrix."""
    d, eps = (
        np.linspace(*ends, count) for ends, count in zip((d_range, eps_range), points, strict=True)
    )
    half = discriminant(COSINE, 0.25 * d[:, None], 0.25 * eps, 0.5 * damping)
    numbers = _reaching(d, eps)
    lines = _with_tips(eps, numbers, damping) if damping else eps
    ends = hill_boundaries(COSINE, 0.25 * lines, numbers, damping=0.5 * damping)
    lower, upper, error = 4.0 * ends.lower, 4.0 * ends.upper, 4.0 * np.nan_to_num(ends.error)
    inside, beside = np.zeros((2, *half.value.shape), dtype=bool)
    grid = np.searchsorted(lines, eps)
    for low, high, doubt in zip(lower[:, grid], upper[:, grid], error[:, grid], strict=True):
        near = doubt + _BESIDE * (1.0 + np.abs(d[:, None]))
        with np.errstate(invalid="ignore"):
            inside |= (d[:, None] > low) & (d[:, None] < high)
            beside |= (np.abs(d[:, None] - low) < near) | (np.abs(d[:, None] - high) < near)
    gap = np.abs(half.value) - half.level
    wrong = ~beside & (np.abs(gap) > half.error) & (inside != (gap > 0.0))
    seen = np.any(np.isfinite(upper) & (upper >= d[0]) & (lower <= d[-1]), axis=1)
    return StruttChart(
        d=d,
        eps=eps,
        damping=damping,
        half_trace=half.value,
        regions=tuple(n for n, shown in zip(numbers, seen, strict=True) if shown),
        lower=lower[seen],
        upper=upper[seen],
        boundary_eps=lines,
        contradictions=int(np.count_nonzero(wrong)),
    )


def _reaching(d: Array, eps: Array) -> tuple[int, ...]:
    """Return the regions whose ends may lie left of the chart's right edge."""
    farthest = float(d[-1]) + float(np.abs(eps).max())
    return tuple(range(ceil(sqrt(max(farthest, 0.0))) + 2))


def _with_tips(eps: Array, regions: tuple[int, ...], k: float) -> Array:
    """Return eps with more values just above the tips that damping has blunted."""

    def opened(values: Array, n: int) -> NDArray[np.bool_]:
        ends = hill_boundaries(COSINE, 0.25 * values, (n,), damping=0.5 * k)
        return np.asarray(np.isfinite(ends.upper[0]))

    more = [eps]
    for n in regions:
        open_ = opened(eps, n)
        for j in np.flatnonzero(open_[1:] != open_[:-1]):
            start, inner = (eps[j], eps[j + 1]) if open_[j + 1] else (eps[j + 1], eps[j])
            outer, tip = float(start), float(inner)
            for _ in range(6):
                between = np.linspace(outer, tip, 33)
                first = max(int(np.argmax(opened(between, n))), 1)
                outer, tip = float(between[first - 1]), float(between[first])
            more.append(tip + (inner - tip) * np.linspace(0.0, 1.0, 40) ** 2)
    return np.unique(np.concatenate(more))


class MultiplierSurfaces(NamedTuple):
    """Both multipliers over a grid of (d, eps).

    The first is the larger one or, of a pair on one circle, that with positive imaginary part.
    """

    d: Array
    eps: Array
    first: NDArray[np.complex128]
    second: NDArray[np.complex128]

    def plot(self, ax: Axes, which: Which) -> Axes:
        """Draw the real part of one multiplier as a surface, cut off at -1 and 1."""
        from matplotlib import colormaps

        space: Any = ax
        height = np.clip((self.first if which == "first" else self.second).real, -1.0, 1.0)
        faces = colormaps["cividis"](0.15 + 0.2 * (height[1:, 1:] + height[:-1, :-1] + 2.0))
        faces[..., :3] *= _light(self.d, self.eps, height)[..., None]
        drawn = space.plot_surface(
            self.d,
            self.eps,
            height,
            rstride=1,
            cstride=1,
            facecolors=faces,
            shade=False,
            linewidth=0.0,
            antialiased=False,
        )
        # By the nearest corner: thin ridges then hide what is behind them.
        drawn.set_zsort("max")
        space.set_zlim(-1.0, 1.0)
        space.set_xlabel("d")
        space.set_ylabel("ε")
        space.set_zlabel("real part")
        return ax


def _light(d: Array, eps: Array, height: Array) -> Array:
    """Return how bright each face of a surface is, lit from the front left and above."""
    place = np.stack([values / max(float(np.ptp(values)), 1e-300) for values in (d, eps, height)])
    place[2] *= 0.5
    along = place[:, 1:, 1:] - place[:, :-1, 1:]
    across = place[:, 1:, 1:] - place[:, 1:, :-1]
    normal = np.cross(along, across, axis=0)
    size = np.maximum(np.linalg.norm(normal, axis=0), 1e-300)
    upright = np.abs(normal[2]) / size
    facing = np.where(normal[2] < 0.0, -1.0, 1.0) * (0.7 * normal[0] - 0.5 * normal[1]) / size
    return np.asarray(np.clip(0.68 + 0.22 * upright + 0.25 * facing, 0.45, 1.0))


def multiplier_surfaces(
    d_range: tuple[float, float], eps: Array, per_band: int
) -> MultiplierSurfaces:
    """Return both multipliers without damping, on a grid that follows the lines where they meet.

    The surfaces have their kinks there; on this grid they are drawn sharp.
    """
    low, high = d_range
    numbers = _reaching(np.array([high]), eps)
    ends = hill_boundaries(COSINE, 0.25 * eps, numbers)
    lines = np.sort(np.concatenate([ends.lower[1:], ends.upper]), axis=0)
    sides = (np.full((1, eps.size), side) for side in (low, high))
    first, last = sides
    edges = np.concatenate([first, np.clip(4.0 * lines, low, high), last])
    # Closer at the lines, where the multipliers change as a root.
    share = 0.5 - 0.5 * np.cos(pi * np.arange(per_band) / per_band)
    bands = [a + share[:, None] * (b - a) for a, b in pairwise(edges) if np.any(b > a)]
    grid = np.concatenate([*bands, last])
    across = np.broadcast_to(eps, grid.shape)
    half = discriminant(COSINE, 0.25 * grid, 0.25 * across).value
    root = np.sqrt((half * half - 1.0).astype(complex))
    large = half + np.where(half < 0.0, -root, root)
    real = root.imag == 0.0
    return MultiplierSurfaces(
        grid, across, np.where(real, large, half + root), np.where(real, 1.0 / large, half - root)
    )
