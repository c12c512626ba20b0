"""How the gallery draws: one look, axes, legends, curves over a turn."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import pi
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import matplotlib.axes

Array = NDArray[np.float64]
Axes: TypeAlias = "matplotlib.axes.Axes"
# The panels of a figure, in the order of rows and columns; how a record's curves are drawn.
Panels: TypeAlias = "Sequence[matplotlib.axes.Axes]"
Looks: TypeAlias = Sequence[Mapping[str, Any]]

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
    axes: Panels,
    columns: int,
    common: Mapping[str, Any],
    panels: Sequence[Mapping[str, Any]],
    legend: int,
) -> None:
    """Give each panel its settings, and all of them one legend below with so many columns.

    Labels that the panels share stand at the outer edges: below the last row, left of the first
    column.  The legend has each label once; it is none where ``legend`` is 0 or nothing is named.
    """
    for place, ax in enumerate(axes):
        look = dict(common)
        if place < len(axes) - columns and look.keys() & {"crank", "xlabel"}:
            look["xlabel"] = ""
        if place % columns and "ylabel" in look:
            look["ylabel"] = ""
        dress(ax, {**look, **(panels[place] if panels else {})})
    named: dict[str, Any] = {}
    for ax in axes:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            named.setdefault(label, handle)
    if legend and named:
        below: dict[str, Any] = {"loc": "outside lower center", "ncols": min(legend, len(named))}
        axes[0].figure.legend(named.values(), named.keys(), **below)


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


def peak(values: NDArray[Any]) -> float:
    """Return the largest size."""
    return float(np.max(np.abs(values)))


def panel_title(ax: Axes, text: str) -> None:
    """Write a panel's title at its left."""
    ax.set_title(text, loc="left", fontsize=9)


def turn(ax: Axes, theta: Array, values: Array, *style: str, **look: Any) -> None:
    """Draw values at the angles [rad] of a turn over degrees, closed at its end."""
    closed = np.degrees(np.append(theta, 2.0 * pi)), np.append(values, values[0])
    ax.plot(*closed, *style, **look)
