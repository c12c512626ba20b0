"""Aannaque's Fig. 7.2 and appendix E: Meissner's J_2, Strutt's chart, surfaces of multipliers.

Strutt's chart is that of ``y'' + 2 K y' + (d + eps cos 2t) y = 0`` (7.2.3, appendix E).  With
theta = 2 t this is Hill's equation with lam2 = d / 4, mu = eps / 4 and damping K / 2; the period pi
becomes 2 pi, the multipliers over it are the same.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import pairwise
from math import ceil, pi, sqrt
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...generated import hill_meissner
from ..core.periodic_function import PeriodicFunction
from ..hill import critical_damping, discriminant, hill_boundaries
from .drawing import COLOURS, Array, panel_title
from .records import Drawn

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Which = Literal["first", "second"]

COSINE = PeriodicFunction(a=[0.0, 1.0])
_UNSTABLE, _LINE = "#b9c4d0", "#1f3f5f"
# Points so near to a boundary are on neither side of it.
_BESIDE = 1e-9
_interval: Callable[..., tuple[Array, Array]] = hill_meissner.interval
_two_intervals: Callable[..., tuple[Array, ...]] = hill_meissner.two_intervals
_half_turn: Callable[..., tuple[Array, ...]] = hill_meissner.half_turn

_PLUS, _MINUS = COLOURS[0], COLOURS[1]
# The largest phase that Fig. 7.2 shows, over pi.
_WIDEST = 4


class StruttChart(NamedTuple):
    """Ends in d of the unstable regions over eps, and how many points are judged differently."""

    damping: float
    d_range: tuple[float, float]
    eps: Array
    regions: tuple[int, ...]
    lower: Array
    upper: Array
    contradictions: int

    def plot(self, ax: Axes) -> Axes:
        """Shade the unstable regions over (d, eps) between their exact boundaries."""
        for low, high in zip(self.lower, self.upper, strict=True):
            real = np.isfinite(high)
            eps = self.eps[real]
            ends = (np.maximum(end[real], self.d_range[0]) for end in (low, high))
            ax.fill_betweenx(eps, *ends, color=_UNSTABLE, lw=0)
            outline = np.concatenate([low[real][::-1], high[real]])
            ax.plot(outline, np.concatenate([eps[::-1], eps]), color=_LINE, lw=0.9)
        ax.set(xlim=self.d_range, ylim=(self.eps[0], self.eps[-1]), xlabel="d", ylabel="ε")
        ax.grid(visible=False)
        return ax


def strutt_chart(
    damping: float,
    d_range: tuple[float, float],
    eps_range: tuple[float, float],
    points: tuple[int, int] = (221, 201),
) -> StruttChart:
    """Return the boundaries from Hill's matrix, held against half traces on a grid."""
    d, grid = np.linspace(*d_range, points[0])[:, None], np.linspace(*eps_range, points[1])
    numbers = _reaching(d_range[1], grid)
    eps = grid
    if damping:
        # More values just above the tips that damping has blunted.
        tips = 4.0 * critical_damping(COSINE, None, numbers[1:], damping=0.5 * damping).mu
        share = np.append(1e-9, np.linspace(0.0, 1.0, 40)[1:] ** 2) * (grid[1] - grid[0])
        near = (tips[:, None] + share).ravel()
        eps = np.unique(np.concatenate([grid, near[(near > grid[0]) & (near < grid[-1])]]))
    ends = hill_boundaries(COSINE, 0.25 * eps, numbers, damping=0.5 * damping)
    lower, upper, error = 4.0 * ends.lower, 4.0 * ends.upper, 4.0 * np.nan_to_num(ends.error)
    half = discriminant(COSINE, 0.25 * d, 0.25 * grid, 0.5 * damping)
    inside, beside = np.zeros((2, *half.value.shape), dtype=bool)
    at = np.searchsorted(eps, grid)
    for low, high, doubt in zip(lower[:, at], upper[:, at], error[:, at], strict=True):
        near = doubt + _BESIDE * (1.0 + np.abs(d))
        with np.errstate(invalid="ignore"):
            inside |= (d > low) & (d < high)
            beside |= (np.abs(d - low) < near) | (np.abs(d - high) < near)
    gap = np.abs(half.value) - half.level
    wrong = ~beside & (np.abs(gap) > half.error) & (inside != (gap > 0.0))
    seen = np.any(np.isfinite(upper) & (upper >= d_range[0]) & (lower <= d_range[1]), axis=1)
    regions = tuple(n for n, shown in zip(numbers, seen, strict=True) if shown)
    count = int(np.count_nonzero(wrong))
    return StruttChart(damping, d_range, eps, regions, lower[seen], upper[seen], count)


def _reaching(highest: float, eps: Array) -> tuple[int, ...]:
    """Return the regions whose ends may lie left of the chart's right edge."""
    return tuple(range(ceil(sqrt(max(highest + float(np.abs(eps).max()), 0.0))) + 2))


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
        look: dict[str, Any] = {"facecolors": faces, "shade": False, "antialiased": False}
        drawn = space.plot_surface(
            self.d, self.eps, height, rstride=1, cstride=1, linewidth=0.0, **look
        )
        # By the nearest corner: thin ridges then hide what is behind them.
        drawn.set_zsort("max")
        space.set(zlim=(-1.0, 1.0), xlabel="d", ylabel="ε", zlabel="real part")
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
    numbers = _reaching(high, eps)
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


def _half_trace_2(x1: Array, x2: Array) -> Array:
    """Return J_2 with both intervals half a turn: (7.11) over the phases x1, x2."""
    c1, s1 = _interval((x1 / pi) ** 2, pi)
    c2, s2 = _interval((x2 / pi) ** 2, pi)
    return _two_intervals(c1, s1, (x1 / pi) ** 2, c2, s2, (x2 / pi) ** 2)[0]


def _interval_matrix(q: Array, length: float) -> Array:
    """Return the matrices ``(..., 2, 2)`` of intervals of constant coefficient: (7.9)."""
    c, s = _interval(q, length)
    return np.stack([c, s, -q * s, c], axis=-1).reshape(*np.shape(c), 2, 2)


def figure_7_2(axes: Sequence[Axes]) -> Drawn:
    """Draw the curves J_2 = 1 and J_2 = -1 over the phases of the two intervals."""
    ax = axes[0]
    phase = np.linspace(1e-9, _WIDEST * pi, 601)
    x1, x2 = np.meshgrid(phase, phase, indexing="ij")
    # A signed measure that stays of order one keeps the contours smooth.
    excess = np.tanh(np.abs(_half_trace_2(x1, x2)) - 1.0)
    across = phase / pi
    ax.contourf(across, across, excess.T, levels=[0.0, 2.0], colors=["#e4e9ee"])
    levels = [(x / pi) ** 2 for x in (x1, x2)]
    (c1, s1), (c2, s2) = (_interval(q, 0.5 * pi) for q in levels)
    factors = _half_turn(c1, s1, levels[0], c2, s2, levels[1])
    for factor, colour in zip(factors, (_MINUS, _PLUS, _PLUS, _MINUS), strict=True):
        ax.contour(across, across, factor.T, levels=[0.0], colors=[colour], linewidths=1.2)
    for n in range(1, 2 * _WIDEST):
        ends = np.clip([0.0, float(n)], n - _WIDEST, _WIDEST)
        ax.plot(ends, n - ends, color="0.55", lw=0.6, ls=(0, (1, 3)))
    for value, colour in ((1, _PLUS), (-1, _MINUS)):
        ax.plot([], [], color=colour, label=rf"$J_2 = {value}$")
    whole = range(1, _WIDEST + 1)
    pinched = np.array([*((j, k) for j in whole for k in whole), *((j - 0.5,) * 2 for j in whole)])
    ax.plot(*pinched.T, "o", color="0.15", ms=3.2, label="regions without width", clip_on=False)
    ax.plot([], [], color="0.55", lw=0.8, ls=(0, (1, 3)), label=r"$x_1 + x_2 = n\pi$")
    ax.set(xlim=(0.0, _WIDEST), ylim=(0.0, _WIDEST))
    for axis, name in ((ax.xaxis, "x_1"), (ax.yaxis, "x_2")):
        axis.set_ticks(range(_WIDEST + 1), ["0", "π", *(f"{i}π" for i in range(2, _WIDEST + 1))])
        axis.set_label_text(f"${name} = T v_{name[-1]} / 2$")
    return Drawn(_branch_values())


def _branch_values() -> list[float]:
    """Return bands along a line, the least J_2 on lines of regions, errors at points, verdicts."""
    whole = np.arange(1, 13)
    j, k = np.meshgrid(whole.astype(float), whole.astype(float))
    lattice = np.abs(_half_trace_2(pi * j, pi * k) - (-1.0) ** (j + k))
    lines = {n: np.linspace(1e-6, n * pi - 1e-6, 401) for n in range(1, 13)}
    least = min(float(np.min((-1.0) ** n * _half_trace_2(x, n * pi - x))) for n, x in lines.items())
    # An irrational slope: the line meets no pinched point.
    slope, last = 1.0 / sqrt(3.0), 20
    along = np.linspace(0.0, (last + 0.5) * pi / (1.0 + slope), 40001)[1:]
    unstable = np.abs(_half_trace_2(along, slope * along)) > 1.0
    bands = int(np.count_nonzero(unstable[1:] & ~unstable[:-1]))
    return [bands, least, np.max(lattice), _same_verdicts()]


def _same_verdicts() -> float:
    """Return the share of random points at which products of matrices are judged alike."""
    from scipy.linalg import expm

    generator = np.random.default_rng(72)
    places = generator.uniform(0.1, _WIDEST * pi, (400, 2))
    agreeing = 0
    for x1, x2 in places:
        matrices = [expm(np.array([[0.0, 1.0], [-((x / pi) ** 2), 0.0]]) * pi) for x in (x1, x2)]
        largest = float(np.max(np.abs(np.linalg.eigvals(matrices[1] @ matrices[0]))))
        # A pair on the circle is off it by the root of round-off at most.
        agreeing += (abs(float(_half_trace_2(x1, x2))) > 1.0) == (largest > 1.0 + 1e-6)
    return agreeing / len(places)


@lru_cache(maxsize=1)
def _surfaces() -> MultiplierSurfaces:
    eps = np.linspace(0.0, 20.0, 141)
    return multiplier_surfaces((0.0, 30.0), eps, per_band=28)


def surface(axes: Sequence[Axes], which: Which) -> Drawn:
    """Draw the real part of one multiplier over (d, eps), Figs. E.1 and E.2."""
    both = _surfaces()
    space: Any = both.plot(axes[0], which)
    space.view_init(elev=46.0, azim=-66.0)
    space.set_box_aspect((1.5, 1.1, 0.6), zoom=1.1)
    size = np.abs(both.first)
    small, large = (float(size[part].max()) for part in (both.d < 5.0, both.d > 20.0))
    flat = np.cos(pi * np.sqrt(both.d[:, 0]))
    gap = np.max(np.abs(both.first[:, 0].real - flat))
    return Drawn([small / large, _gap_to_steps(both), gap])


def _gap_to_steps(both: MultiplierSurfaces) -> float:
    """Compare with the matrices of an equation in small steps, which know no half trace."""
    places = np.random.default_rng(75).integers(0, both.d.size, 60)
    d, eps = (values.ravel()[places] for values in (both.d, both.eps))
    step, matrix = 2.0 * pi / 2000, np.broadcast_to(np.eye(2), (60, 2, 2))
    for middle in step * (np.arange(2000) + 0.5):
        matrix = _interval_matrix(0.25 * (d + eps * np.cos(middle)), step) @ matrix
    there = np.sort(np.clip(np.linalg.eigvals(matrix).real, -1.0, 1.0), axis=-1)
    ours = np.stack([values.ravel()[places] for values in (both.first, both.second)], axis=-1)
    gap = np.abs(np.sort(np.clip(ours.real, -1.0, 1.0), axis=-1) - there)
    return float(np.max(gap))


def figure_e_3(axes: Sequence[Axes]) -> Drawn:
    """Draw the stability charts without and with damping."""
    charts = [strutt_chart(k, (-2.0, 20.0), (0.0, 20.0)) for k in (0.0, 0.1)]
    for ax, chart in zip(axes, charts, strict=True):
        chart.plot(ax)
        ax.set_xticks([-2, *(i * i for i in range(5)), 20])
        panel_title(ax, f"K = {chart.damping:g}" if chart.damping else "no damping")
    numbers = (1, 2, 3, 4)
    squares = np.array([n * n for n in numbers])
    tips = hill_boundaries(COSINE, 0.25 * 1e-4, numbers)
    off = np.max(np.abs(4.0 * np.stack([tips.lower, tips.upper]) - squares))
    matrices = [_interval_matrix(np.asarray(d), pi) for d in squares]
    powers = [np.linalg.norm(np.linalg.matrix_power(matrix, 1000), 2) for matrix in matrices]
    wide = [4.0 * hill_boundaries(COSINE, 0.25 * eps, range(1, 7)).width for eps in (1, 20)]
    damped = charts[1]
    opened = [
        float(damped.eps[np.isfinite(row)][0])
        for n, row in zip(damped.regions, damped.upper, strict=True)
        if n
    ]
    return Drawn(
        [
            off,
            max(powers),
            *(np.max(w[1:] / w[:-1]) for w in wide),
            sum(chart.contradictions for chart in charts),
            min(b / a for a, b in pairwise(opened)),
        ]
    )
