"""Aannaque's Fig. 7.2 and appendix E: Meissner's function J_2, and Strutt's chart."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import pairwise
from math import pi, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated import hill_meissner
from ..hill import hill_boundaries
from .records import Drawn, Quoted
from .smith_linkages import Array
from .strutt import (
    COSINE,
    MultiplierSurfaces,
    StruttChart,
    Which,
    multiplier_surfaces,
    strutt_chart,
)
from .style import COLOURS, legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_interval: Callable[..., tuple[Array, Array]] = hill_meissner.interval
_two_intervals: Callable[..., tuple[Array, ...]] = hill_meissner.two_intervals
_half_turn: Callable[..., tuple[Array, ...]] = hill_meissner.half_turn

_SHADE, _PLUS, _MINUS = "#e4e9ee", COLOURS[0], COLOURS[1]
_WIDEST = 4
_D_RANGE, _EPS_RANGE = (-2.0, 20.0), (0.0, 20.0)
_DAMPING = 0.1


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
    ax.contourf(across, across, excess.T, levels=[0.0, 2.0], colors=[_SHADE])
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
    ax.set_aspect("equal")
    ax.set_xlim(0.0, _WIDEST)
    ax.set_ylim(0.0, _WIDEST)
    for axis, name in ((ax.xaxis, "x_1"), (ax.yaxis, "x_2")):
        axis.set_ticks(range(_WIDEST + 1), ["0", "π", *(f"{i}π" for i in range(2, _WIDEST + 1))])
        axis.set_label_text(f"${name} = T v_{name[-1]} / 2$")
    ax.grid(visible=False)
    legend_below([ax])
    note = (
        "Both intervals are half a turn: only then is x_i the phase of its interval. On the line "
        "x1 + x2 = n pi the size of J_2 is 1 + (V - 1) sin^2 x1, which is nowhere below 1: region "
        "n is one band along that line, pinched where both phases are whole multiples of pi, and "
        "on the diagonal, where nothing is modulated."
    )
    return Drawn(tuple(_branch_rows()), (note,))


def _branch_rows() -> list[Quoted]:
    whole = np.arange(1, 13)
    j, k = np.meshgrid(whole.astype(float), whole.astype(float))
    lattice = np.abs(_half_trace_2(pi * j, pi * k) - (-1.0) ** (j + k))
    least = min(
        float(np.min((-1.0) ** n * _half_trace_2(x, n * pi - x)))
        for n in range(1, 13)
        for x in [np.linspace(1e-6, n * pi - 1e-6, 401)]
    )
    # An irrational slope: the line meets no pinched point.
    slope, last = 1.0 / sqrt(3.0), 20
    along = np.linspace(0.0, (last + 0.5) * pi / (1.0 + slope), 40001)[1:]
    unstable = np.abs(_half_trace_2(along, slope * along)) > 1.0
    bands = int(np.count_nonzero(unstable[1:] & ~unstable[:-1]))
    return [
        Quoted(
            "unstable bands along x2 = x1/sqrt(3) up to x1 + x2 = 20 pi",
            float(last),
            float(bands),
            0.0,
            "'infinitely many separate branches': one for each multiple of pi",
            "7.2.3",
        ),
        Quoted(
            "least size of J_2 on the lines x1 + x2 = n pi, n = 1 to 12",
            1.0,
            least,
            1e-9,
            "the end points are left out by 1e-6",
            "7.2.3",
        ),
        Quoted(
            "J_2 at x1 = j pi, x2 = k pi less (-1)^(j + k), worst of 144",
            0.0,
            float(np.max(lattice)),
            1e-12,
            "round-off of the phases",
            "7.2.3",
        ),
        _verdict_row(),
    ]


def _verdict_row() -> Quoted:
    from scipy.linalg import expm

    generator = np.random.default_rng(72)
    places = generator.uniform(0.1, _WIDEST * pi, (400, 2))
    agreeing = 0
    for x1, x2 in places:
        matrices = [expm(np.array([[0.0, 1.0], [-((x / pi) ** 2), 0.0]]) * pi) for x in (x1, x2)]
        largest = float(np.max(np.abs(np.linalg.eigvals(matrices[1] @ matrices[0]))))
        # A pair on the circle is off it by the root of round-off at most.
        agreeing += (abs(float(_half_trace_2(x1, x2))) > 1.0) == (largest > 1.0 + 1e-6)
    return Quoted(
        "share of (T, v1, v2) where J_2 and the multipliers give one verdict",
        1.0,
        agreeing / len(places),
        0.0,
        "400 random points; matrices by general exponentials",
        "7.2.3",
    )


# ---------------------------------------------------------------- appendix E


@lru_cache(maxsize=1)
def _surfaces() -> MultiplierSurfaces:
    eps = np.linspace(0.0, 20.0, 141)
    return multiplier_surfaces((0.0, 30.0), eps, per_band=28)


def surface_figure(which: Which) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the drawing of the real part of one multiplier over (d, eps)."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        found = _surfaces()
        space: Any = found.plot(axes[0], which)
        space.view_init(elev=46.0, azim=-66.0)
        space.set_box_aspect((1.5, 1.1, 0.6), zoom=1.1)
        note = (
            "Ranges of d and eps, damping and the order of the two are not stated: d to 30, eps to "
            "20, undamped; the first multiplier is the larger one. Cut off at -1 and 1 as in the "
            "document."
        )
        return Drawn(tuple(_surface_rows(found)), (note,))

    return draw


def _surface_rows(found: MultiplierSurfaces) -> list[Quoted]:
    size = np.abs(found.first)
    small, large = (float(size[part].max()) for part in (found.d < 5.0, found.d > 20.0))
    flat = np.cos(pi * np.sqrt(found.d[:, 0]))
    return [
        Quoted(
            "largest multiplier at d < 5 over the largest at d > 20",
            1.0,
            small / large,
            0.0,
            "'larger when d is small'",
            "Fig. E.1",
            relation=">",
        ),
        _steps_row(found),
        Quoted(
            "real part at eps = 0 less cos(pi sqrt(d))",
            0.0,
            float(np.max(np.abs(found.first[:, 0].real - flat))),
            1e-6,
            "root of round-off where both multipliers meet",
            "7.2.3",
        ),
    ]


def _steps_row(found: MultiplierSurfaces) -> Quoted:
    """Compare with the matrices of an equation in small steps, which know no half trace."""
    places = np.random.default_rng(75).integers(0, found.d.size, 60)
    d, eps = (values.ravel()[places] for values in (found.d, found.eps))
    step, matrix = 2.0 * pi / 2000, np.broadcast_to(np.eye(2), (60, 2, 2))
    for middle in step * (np.arange(2000) + 0.5):
        matrix = _interval_matrix(0.25 * (d + eps * np.cos(middle)), step) @ matrix
    there = np.sort(np.clip(np.linalg.eigvals(matrix).real, -1.0, 1.0), axis=-1)
    ours = np.stack([values.ravel()[places] for values in (found.first, found.second)], axis=-1)
    gap = np.abs(np.sort(np.clip(ours.real, -1.0, 1.0), axis=-1) - there)
    return Quoted(
        "real parts less those of 2000 constant steps, 60 points",
        0.0,
        float(np.max(gap)),
        0.01,
        "steps: second order, and its root at boundaries",
        "7.2.2",
    )


def figure_e_3(axes: Sequence[Axes]) -> Drawn:
    """Draw the stability charts without and with damping."""
    charts = [strutt_chart(k, _D_RANGE, _EPS_RANGE) for k in (0.0, _DAMPING)]
    for ax, chart in zip(axes, charts, strict=True):
        chart.plot(ax)
        ax.set_xticks([-2, *(i * i for i in range(5)), 20])
        panel_title(ax, f"K = {chart.damping:g}" if chart.damping else "no damping")
    note = (
        "Ranges are not stated: d from -2 to 20, eps to 20. Dark: unstable; lines: exact "
        "boundaries from the Hill matrix, while the document shades by multipliers alone. The "
        "damped chart is added for what the text says of damping."
    )
    return Drawn((*_tip_rows(), *_chart_rows(charts)), (note,))


def _tip_rows() -> list[Quoted]:
    numbers = (1, 2, 3, 4)
    squares = np.array([n * n for n in numbers])
    tips = hill_boundaries(COSINE, 0.25 * 1e-4, numbers)
    off = np.max(np.abs(4.0 * np.stack([tips.lower, tips.upper]) - squares))
    wide = [4.0 * hill_boundaries(COSINE, 0.25 * eps, (1, 2, 3, 4, 5, 6)).width for eps in (1, 20)]
    return [
        Quoted(
            "d at the tips of regions 1 to 4 less i^2",
            0.0,
            float(off),
            1e-4,
            "eps = 1e-4: region 1 is 1e-4 wide",
            "7.2.3",
        ),
        _flat_row(squares),
        *(
            Quoted(
                f"largest ratio of a region's width to that of the one before, eps = {eps}",
                1.0,
                float(np.max(w[1:] / w[:-1])),
                0.0,
                "regions 1 to 6: 'when d increases the regions become narrower'",
                "7.2.3",
                relation="<",
            )
            for eps, w in zip((1, 20), wide, strict=True)
        ),
    ]


def _flat_row(squares: Array) -> Quoted:
    growth = []
    for d in squares:
        matrix = _interval_matrix(np.asarray(d), pi)
        growth.append(float(np.linalg.norm(np.linalg.matrix_power(matrix, 1000), 2)))
    return Quoted(
        "growth over 1000 periods at eps = 0, d = i^2, i = 1 to 4",
        1.001,
        max(growth),
        0.0,
        "'where the solution is unstable' at eps = 0, read as any growth",
        "7.2.3",
        relation=">",
        differs="there the matrix is 1 or -1 and every solution is periodic; unstable for eps > 0",
    )


def _chart_rows(charts: Sequence[StruttChart]) -> list[Quoted]:
    damped = charts[1]
    lines = damped.boundary_eps
    tips = [
        float(lines[np.isfinite(row)][0])
        for n, row in zip(damped.regions, damped.upper, strict=True)
        if n
    ]
    growth = min(b / a for a, b in pairwise(tips))
    return [
        Quoted(
            "points of both charts that multipliers and boundaries judge differently",
            0.0,
            float(sum(chart.contradictions for chart in charts)),
            0.0,
            "221 x 201 points each",
            "Fig. E.3",
        ),
        Quoted(
            f"least growth from region to region of the eps that K = {damped.damping:g} needs",
            1.0,
            float(growth),
            0.0,
            "'the damping has greater effect when d is bigger'",
            "7.2.3",
            relation=">",
        ),
    ]
