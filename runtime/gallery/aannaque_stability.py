"""Aannaque's Fig. 7.2 and appendix E: Meissner's J_2, Strutt's chart, surfaces of multipliers.

Strutt's chart is that of ``y'' + 2 K y' + (d + eps cos 2t) y = 0`` (7.2.3, appendix E).  With
theta = 2 t this is Hill's equation with lam2 = d / 4, mu = eps / 4 and damping K / 2; the period pi
becomes 2 pi, the multipliers over it are the same.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from itertools import pairwise
from math import ceil, pi, sqrt
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...generated import hill_meissner
from ..core.periodic_function import PeriodicFunction
from ..hill import critical_damping, discriminant, hill_boundaries
from .drawing import COLOURS, Array, Panels, outline
from .records import Drawn

COSINE = PeriodicFunction(a=[0.0, 1.0])
_interval: Callable[..., tuple[Array, Array]] = hill_meissner.interval
_two_intervals: Callable[..., tuple[Array, ...]] = hill_meissner.two_intervals
_half_turn: Callable[..., tuple[Array, ...]] = hill_meissner.half_turn


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
    lines = 4.0 * np.sort(np.concatenate([ends.lower[1:], ends.upper]), axis=0)
    edges = np.pad(np.clip(lines, low, high), ((1, 1), (0, 0)), constant_values=((low, high),) * 2)
    # Closer at the lines, where the multipliers change as a root.
    share = 0.5 - 0.5 * np.cos(pi * np.arange(per_band) / per_band)
    bands = [a + share[:, None] * (b - a) for a, b in pairwise(edges) if np.any(b > a)]
    grid = np.concatenate([*bands, edges[-1:]])
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


def figure_7_2(axes: Panels) -> Drawn:
    """Draw the curves J_2 = 1 and J_2 = -1 over the phases of the two intervals."""
    # The largest phase that is shown, over pi.
    ax, widest = axes[0], 4
    phase = np.linspace(1e-9, widest * pi, 601)
    x1, x2 = np.meshgrid(phase, phase, indexing="ij")
    # A signed measure that stays of order one keeps the contours smooth.
    excess = np.tanh(np.abs(_half_trace_2(x1, x2)) - 1.0)
    across = phase / pi
    ax.contourf(across, across, excess.T, levels=[0.0, 2.0], colors=["#e4e9ee"])
    levels = [(x / pi) ** 2 for x in (x1, x2)]
    (c1, s1), (c2, s2) = (_interval(q, 0.5 * pi) for q in levels)
    factors = _half_turn(c1, s1, levels[0], c2, s2, levels[1])
    plus, minus = COLOURS[:2]
    for factor, colour in zip(factors, (minus, plus, plus, minus), strict=True):
        ax.contour(across, across, factor.T, levels=[0.0], colors=[colour], linewidths=1.2)
    for n in range(1, 2 * widest):
        ends = np.clip([0.0, float(n)], n - widest, widest)
        ax.plot(ends, n - ends, color="0.55", lw=0.6, ls=(0, (1, 3)))
    for value, colour in ((1, plus), (-1, minus)):
        ax.plot([], [], color=colour, label=rf"$J_2 = {value}$")
    whole = range(1, widest + 1)
    pinched = np.array([*((j, k) for j in whole for k in whole), *((j - 0.5,) * 2 for j in whole)])
    ax.plot(*pinched.T, "o", color="0.15", ms=3.2, label="regions without width", clip_on=False)
    ax.plot([], [], color="0.55", lw=0.8, ls=(0, (1, 3)), label=r"$x_1 + x_2 = n\pi$")
    ax.set(xlim=(0.0, widest), ylim=(0.0, widest))
    for axis, name in ((ax.xaxis, "x_1"), (ax.yaxis, "x_2")):
        axis.set_ticks(range(widest + 1), ["0", "π", *(f"{i}π" for i in range(2, widest + 1))])
        axis.set_label_text(f"${name} = T v_{name[-1]} / 2$")
    # Unstable bands along a line of irrational slope, which meets no pinched point.
    slope, last = 1.0 / sqrt(3.0), 20
    along = np.linspace(0.0, (last + 0.5) * pi / (1.0 + slope), 40001)[1:]
    unstable = np.abs(_half_trace_2(along, slope * along)) > 1.0
    return Drawn([np.count_nonzero(unstable[1:] & ~unstable[:-1])])


@lru_cache(maxsize=1)
def _surfaces() -> MultiplierSurfaces:
    eps = np.linspace(0.0, 20.0, 141)
    return multiplier_surfaces((0.0, 30.0), eps, per_band=28)


def surface(axes: Panels, which: Literal["first", "second"]) -> Drawn:
    """Draw the real part of one multiplier over (d, eps), cut off at -1 and 1 (E.1 and E.2)."""
    from matplotlib import colormaps

    space: Any = axes[0]
    both = _surfaces()
    height = np.clip(getattr(both, which).real, -1.0, 1.0)
    faces = colormaps["cividis"](0.15 + 0.2 * (height[1:, 1:] + height[:-1, :-1] + 2.0))
    faces[..., :3] *= _light(both.d, both.eps, height)[..., None]
    look: dict[str, Any] = {"facecolors": faces, "shade": False, "antialiased": False}
    drawn = space.plot_surface(
        both.d, both.eps, height, rstride=1, cstride=1, linewidth=0.0, **look
    )
    # By the nearest corner: thin ridges then hide what is behind them.
    drawn.set_zsort("max")
    space.view_init(elev=46.0, azim=-66.0)
    space.set_box_aspect((1.5, 1.1, 0.6), zoom=1.1)
    size = np.abs(both.first)
    small, large = (float(size[part].max()) for part in (both.d < 5.0, both.d > 20.0))
    return Drawn([small / large])


def figure_e_3(axes: Panels) -> Drawn:
    """Draw the stability charts without and with damping."""
    left, right, damping = -2.0, 20.0, 0.1
    grid = np.linspace(0.0, 20.0, 201)
    numbers = _reaching(right, grid)
    tips = 4.0 * critical_damping(COSINE, None, numbers[1:], damping=0.5 * damping).mu
    # More values just above the tips that damping has blunted.
    share = np.append(1e-9, np.linspace(0.0, 1.0, 40)[1:] ** 2)
    near = np.add.outer(tips, (grid[1] - grid[0]) * share).ravel()
    fine = np.unique(np.concatenate([grid, near[near < grid[-1]]]))
    for ax, eps, k in zip(axes, (grid, fine), (0.0, damping), strict=True):
        ends = hill_boundaries(COSINE, 0.25 * eps, numbers, damping=0.5 * k)
        # Region 0 reaches to minus infinity: its end is put beside the picture.
        lower, upper = np.maximum(4.0 * ends.lower, left - 1.0), 4.0 * ends.upper
        for low, high in zip(lower, upper, strict=True):
            ax.fill_betweenx(eps, low, high, color="#b9c4d0", lw=0)
            ax.plot(*outline(low, high, eps), color="#1f3f5f", lw=0.9)
    squares = np.arange(1.0, 5.0) ** 2
    c, s = _interval(squares, pi)
    turns = np.stack([c, s, -squares * s, c], axis=-1).reshape(-1, 2, 2)
    powers = np.linalg.norm(np.linalg.matrix_power(turns, 1000), 2, axis=(1, 2))
    wide = [hill_boundaries(COSINE, 0.25 * eps, range(1, 7)).width for eps in (1, 20)]
    opened = tips[tips < grid[-1]]
    widths = (np.max(width[1:] / width[:-1]) for width in wide)
    return Drawn([np.max(powers), *widths, np.min(opened[1:] / opened[:-1])])
