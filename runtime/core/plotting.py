"""Plots: one place for axes, colours and files.  matplotlib loads when the first one is drawn."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .errors import bad
from .files import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes as Axes
    from matplotlib.figure import Figure
else:  # what annotations name; matplotlib loads with the first picture
    Axes = "matplotlib.axes.Axes"

# Revolutions per minute of one radian per second.
RPM = 30.0 / np.pi
FORMATS = (".png", ".svg", ".pdf")
# How a small text stands above a point of a curve.
ABOVE: dict[str, Any] = {"textcoords": "offset points", "ha": "center", "fontsize": 7}
_METADATA: dict[str, dict[str, Any]] = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": "elastolink"},
    ".pdf": {"CreationDate": None, "Creator": "elastolink", "Producer": None},
}


def new_figure(width: float = 8.0, height: float = 5.5) -> Figure:
    """Return an empty figure that no window manager knows of, inches by inches."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def axes_or_new(ax: Axes | None) -> Axes:
    """Return ``ax``, or the axes of a new figure where it is None."""
    return new_figure().add_subplot() if ax is None else ax


def coordinates_label(labels: Sequence[str]) -> str:
    """Return the label of an axis of coordinates: their names, of many the first and the last."""
    names = labels if len(labels) < 4 else (*labels[:2], "...", labels[-1])
    return ", ".join(names) + ("" if all("/" in name for name in labels) else " [SI]")


def draw_coordinates(
    ax: Axes | None, across: Any, q: NDArray[np.float64], labels: Sequence[str], xlabel: str
) -> Axes:
    """Draw coordinates ``(nx, n)`` over a row, in ``ax`` or new axes, and return the axes."""
    ax = axes_or_new(ax)
    for label, values in zip(labels, q.T, strict=True):
        ax.plot(across, values, label=label, linewidth=0.9)
    ax.set(xlabel=xlabel, ylabel=coordinates_label(labels))
    if len(labels) > 1:
        ax.legend()
    return ax


def multiplier_plane(ax: Axes | None) -> Axes:
    """Return axes for Floquet multipliers, in ``ax`` or new, with the unit circle drawn."""
    ax = axes_or_new(ax)
    circle = np.exp(1j * np.linspace(0.0, 2 * np.pi, 361))
    ax.plot(circle.real, circle.imag, color="0.6", linewidth=0.8)
    ax.set_aspect("equal")
    ax.set(xlabel="real part of multiplier", ylabel="imaginary part of multiplier")
    return ax


def check_picture_path(path: str | Path) -> Path:
    """Return the path of a picture that can be written; refuse it before any work starts."""
    target = Path(path)
    if target.suffix not in FORMATS:
        raise bad(str(target), repr(target.suffix), f"an ending of {FORMATS}", "rename the file")
    return require_writable(target)


def require_writable(target: Path) -> Path:
    """Return the path of a file that can be written; refuse any other."""
    import os

    if not target.parent.is_dir() or not os.access(target.parent, os.W_OK) or target.is_dir():
        found = "a place that cannot be written"
        raise bad(str(target), found, "a writable folder", "choose another")
    return target


def inline_picture(plot: Callable[[Axes], object]) -> str:
    """Return what a function draws into axes as an ``<img>`` element of HTML."""
    figure = new_figure(6.0, 4.0)
    plot(figure.add_subplot())
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=100, metadata=_METADATA[".png"])
    figure.clear()
    return f'<img src="data:image/png;base64,{base64.b64encode(buffer.getvalue()).decode()}">'


def save_figure(figure: Figure, path: str | Path) -> Path:
    """Write a figure as PNG, SVG or PDF, whole or not at all, the same bytes each time."""
    target = check_picture_path(path)
    return write_whole(target, figure_bytes(figure, target.suffix))


def figure_bytes(figure: Figure, ending: str) -> bytes:
    """Return a figure as a file of that ending; the same bytes each time."""
    import matplotlib as mpl

    buffer = io.BytesIO()
    with mpl.rc_context({"svg.hashsalt": "elastolink"}):
        figure.savefig(buffer, format=ending[1:], dpi=150, metadata=_METADATA[ending])
    return buffer.getvalue()
