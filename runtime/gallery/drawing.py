"""How the gallery draws: one look, legends and axes; linkages with pins, arrows and arcs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

CRANK_ANGLE = r"crank angle $\theta_2$ [deg]"
# Blue, orange, green, purple, grey, brown: distinct in print and by the colour-blind.
COLOURS = ("#1f5a8c", "#c8641e", "#3a7d44", "#7a4a9c", "#5c5c5c", "#8c2d04", "#2a9d9d", "#b8a000")

SETTINGS: dict[str, Any] = {
    "axes.prop_cycle": f"cycler(color={list(COLOURS)})",
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.labelsize": 9.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "xtick.direction": "out",
    "ytick.direction": "out",
}


def finish(
    axes: Sequence[Axes],
    columns: int,
    common: Mapping[str, Any],
    panels: Sequence[Mapping[str, Any]],
    legend: int,
) -> None:
    """Give each panel its settings, and all of them one legend below with so many columns.

    Labels that the panels share stand at the outer edges: below the last row, left of the first
    column.
    """
    for place, ax in enumerate(axes):
        look = dict(common)
        if place < len(axes) - columns and look.keys() & {"crank", "xlabel"}:
            look["xlabel"] = ""
        if place % columns and "ylabel" in look:
            look["ylabel"] = ""
        dress(ax, {**look, **(panels[place] if panels else {})})
    if legend:
        legend_below(axes, legend)


def dress(ax: Axes, settings: Mapping[str, Any]) -> None:
    """Set properties of axes, as ``Axes.set`` does, and what the gallery's axes share.

    ``crank``: turns of the crank along x, in degrees; ``title``: at the left; ``zero``: whether the
    line y = 0 is drawn; ``grid``: whether a grid is; ``bottom``: the lower end of y alone.
    """
    rest = dict(settings)
    turns = rest.pop("crank", 0)
    if turns:
        step = 60.0 if turns <= 1 else 180.0 if turns <= 4 else 360.0
        ticks = [step * i for i in range(round(360.0 * turns / step) + 1)]
        rest = {"xlim": (0.0, ticks[-1]), "xticks": ticks, "xlabel": CRANK_ANGLE, **rest}
    if "title" in rest:
        panel_title(ax, rest.pop("title"))
    if rest.pop("zero", False):
        ax.axhline(0.0, color="0.6", lw=0.8, zorder=1)
    if "bottom" in rest:
        ax.set_ylim(bottom=rest.pop("bottom"))
    if not rest.pop("grid", True):
        ax.grid(visible=False)
    ax.set(**rest)


def legend_below(axes: Sequence[Axes], columns: int) -> None:
    """Put one legend for all the axes under them, each label once; none where there is no label."""
    named: dict[str, Any] = {}
    for ax in axes:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            named.setdefault(label, handle)
    if named:
        axes[0].figure.legend(
            named.values(), named.keys(), loc="outside lower center", ncols=min(columns, len(named))
        )


def outline(lower: Array, upper: Array, height: Array) -> tuple[Array, Array]:
    """Return a region's outline as one line, closed at its tip where damping has blunted it."""
    real = np.isfinite(lower) & np.isfinite(upper)
    edge = np.concatenate([lower[real][::-1], upper[real]])
    return edge, np.concatenate([height[real][::-1], height[real]])


def mark_fractions(
    ax: Axes, speed: float, orders: Iterable[int], name: str, ends: tuple[float, float], low: bool
) -> None:
    """Mark a speed over whole numbers within two ends; those up to the eighth are named."""
    height, shift = (0.0, 3.0) if low else (1.0, -8.0)
    place: dict[str, Any] = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points"}
    for order in orders:
        at = speed / order
        if ends[0] < at < ends[1]:
            ax.axvline(at, color="0.6", lw=0.7, ls=(0, (1, 3)), zorder=1)
            if order <= 8:
                text = name.format(order)
                ax.annotate(
                    text, (at, height), xytext=(2.0, shift), fontsize=7, color="0.4", **place
                )


def panel_title(ax: Axes, text: str) -> None:
    """Write a panel's title at its left."""
    ax.set_title(text, loc="left", fontsize=9)


def turn(ax: Axes, theta: Array, values: Array, style: str = "-", **look: Any) -> None:
    """Draw values at the angles [rad] of a turn over degrees, closed at its end."""
    closed = np.degrees(np.append(theta, 2.0 * pi)), np.append(values, values[0])
    ax.plot(*closed, style, **look)


INK, GROUND = "#2b2b2b", "0.45"
LINK_COLOURS = {"crank": "#c8641e", "coupler": "#1f5a8c", "follower": "#3a7d44"}
_HALO = 2.5


def canvas(ax: Axes) -> None:
    """Make the axes a sheet to draw on: equal scales, no frame, no grid."""
    ax.set_axis_off()
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)


def bar(ax: Axes, start: ArrayLike, end: ArrayLike, colour: str = INK, **style: Any) -> None:
    """Draw a link as a rounded bar between two places."""
    (x, u), (y, v) = np.transpose([start, end])
    ax.plot([x, u], [y, v], color=colour, solid_capstyle="round", **{"lw": 3.2, **style})


def pin(ax: Axes, *places: ArrayLike, size: float = 5.5) -> None:
    """Draw pins as small open circles."""
    for place in places:
        ax.plot(*np.asarray(place), "o", mfc="w", mec=INK, mew=1.0, ms=size, zorder=6)


def pivot(ax: Axes, place: ArrayLike, unit: float) -> None:
    """Draw a fixed pivot: a foot on hatched ground, about ``unit`` wide."""
    x, y = np.asarray(place, dtype=float)
    foot = unit * np.array([[0.0, 0.0], [-0.5, -0.8], [0.5, -0.8]]) + (x, y)
    ax.fill(*foot.T, facecolor="0.88", edgecolor=GROUND, lw=0.9, zorder=1)
    ground = y - 0.8 * unit
    ax.plot([x - 0.9 * unit, x + 0.9 * unit], [ground, ground], color=GROUND, lw=1.0, zorder=1)
    for left in np.linspace(-0.9, 0.7, 6):
        ends = [x + (left + 0.2) * unit, x + left * unit]
        ax.plot(ends, [ground, ground - 0.25 * unit], color=GROUND, lw=0.7, zorder=1)
    pin(ax, place)


def four_bar(ax: Axes, joints: Mapping[str, ArrayLike], unit: float, letters: str = "ABCD") -> None:
    """Draw a four-bar linkage by its joints, with letters at A, B, C and D."""
    a, b, c, d = (np.asarray(joints[name], dtype=float) for name in "ABCD")
    for link, start, end in (("crank", a, b), ("coupler", b, c), ("follower", d, c)):
        bar(ax, start, end, LINK_COLOURS[link], zorder=3)
    pivot(ax, a, unit)
    pivot(ax, d, unit)
    pin(ax, b, c)
    middle = (a + b + c + d) / 4.0
    for name, letter in zip("ABCD", letters, strict=True):
        place = np.asarray(joints[name], dtype=float)
        away = place - middle
        shift = 13.0 * away / (np.hypot(*away) or 1.0)
        if name in "AD":
            shift = np.array([-13.0 if place[0] < middle[0] else 13.0, 2.0])
        write(ax, place, letter, shift, style="italic")


def _pair(place: ArrayLike) -> tuple[float, float]:
    x, y = np.asarray(place, dtype=float)
    return float(x), float(y)


def write(
    ax: Axes, place: ArrayLike, text: str, shift: ArrayLike = (0.0, 0.0), **style: Any
) -> None:
    """Write at a place, shifted by some points, on a pale halo so that lines do not cross it."""
    from matplotlib import patheffects

    ax.annotate(
        text,
        _pair(place),
        xytext=_pair(shift),
        textcoords="offset points",
        path_effects=[patheffects.withStroke(linewidth=_HALO, foreground="w")],
        **{"ha": "center", "va": "center", "fontsize": 9, "zorder": 9, **style},
    )


def arrow(
    ax: Axes, tail: ArrayLike, vector: ArrayLike, colour: str, text: str = "", side: float = 0.0
) -> None:
    """Draw a vector to the scale of the axes; its name beyond the head, some points to its left."""
    start, way = np.asarray(tail, dtype=float), np.asarray(vector, dtype=float)
    head = start + way
    ax.annotate(
        "",
        _pair(head),
        xytext=_pair(start),
        arrowprops={
            "arrowstyle": "-|>,head_length=0.45,head_width=0.2",
            "color": colour,
            "lw": 1.6,
            "shrinkA": 0.0,
            "shrinkB": 0.0,
            "mutation_scale": 14,
        },
        zorder=7,
    )
    # Annotations do not widen the limits of the axes.
    ax.update_datalim([start, head])
    ax.autoscale_view()
    if text:
        along = way / (np.hypot(*way) or 1.0)
        left = np.array([-along[1], along[0]])
        write(ax, head, text, 11.0 * along + side * left, color=colour)


def arc(
    ax: Axes,
    centre: ArrayLike,
    radius: float,
    ends: tuple[float, float],
    text: str = "",
    **style: Any,
) -> None:
    """Draw an arc between two angles [rad], its letter outside the middle."""
    angles = np.linspace(*ends, 61)
    x, y = np.asarray(centre, dtype=float)
    look = {"color": "0.35", "lw": 0.9, "zorder": 2, **style}
    ax.plot(x + radius * np.cos(angles), y + radius * np.sin(angles), **look)
    if text:
        middle = 0.5 * (ends[0] + ends[1])
        way = np.array([np.cos(middle), np.sin(middle)])
        write(ax, (x, y) + radius * way, text, 11.0 * way)


def turning_arrow(
    ax: Axes, centre: ArrayLike, radius: float, value: float, text: str, colour: str
) -> None:
    """Draw a couple as three quarters of a turn about a place, in the sense of its sign."""
    ends = (-0.65 * pi, 0.65 * pi)
    arc(ax, centre, radius, ends, color=colour, lw=1.5)
    x, y = np.asarray(centre, dtype=float)
    last = ends[1] if value >= 0 else ends[0]
    before = last - 0.12 * np.sign(last)
    tip, start = (
        (x + radius * np.cos(angle), y + radius * np.sin(angle)) for angle in (last, before)
    )
    style = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0.0, "shrinkB": 0.0}
    ax.annotate("", tip, xytext=start, arrowprops=style, zorder=7)
    write(ax, (x + radius, y), text, (4.0, 0.0), color=colour, ha="left")
