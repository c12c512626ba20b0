"""How the gallery draws: one look, legends and axes; linkages with pins, arrows and arcs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

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


def legend_below(axes: Sequence[Axes], columns: int = 4) -> None:
    """Put one legend for all the axes under them, each label once."""
    handles, labels = [], []
    for ax in axes:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            if label not in labels:
                handles.append(handle)
                labels.append(label)
    axes[0].figure.legend(
        handles, labels, loc="outside lower center", ncols=min(columns, len(labels))
    )


def crank_axis(ax: Axes, turns: float = 1.0) -> None:
    """Label the horizontal axis as the crank angle in degrees."""
    last = 360.0 * turns
    step = 60.0 if turns <= 1 else 180.0 if turns <= 4 else 360.0
    ax.set_xlim(0.0, last)
    ax.set_xticks([step * i for i in range(round(last / step) + 1)])
    ax.set_xlabel(r"crank angle $\theta_2$ [deg]")


def panel_title(ax: Axes, text: str) -> None:
    """Write a panel's title at its left."""
    ax.set_title(text, loc="left", fontsize=9)


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
