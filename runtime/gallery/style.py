"""One look for all pictures of the gallery: lines, colours, legends beside the data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Blue, orange, green, purple, grey, brown: told apart in print and by the colour-blind.
COLOURS = ("#1f5a8c", "#c8641e", "#3a7d44", "#7a4a9c", "#5c5c5c", "#8c2d04", "#2a9d9d", "#b8a000")

SETTINGS: dict[str, Any] = {
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
