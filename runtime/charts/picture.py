"""The picture of a stability chart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..families import Array
from ..plotting import axes_or_new

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .boundaries import BoundaryCurves
    from .chart import StabilityChart

_RPM = 60.0 / (2.0 * np.pi)
_LABELS = {
    "speed": "crank speed [rpm]",
    "follower_inertia": r"follower inertia $I_4$ [kg m$^2$]",
    "lam2": r"$\lambda^2$",
    "mu": r"$\mu$",
}
_UNSTABLE, _EXACT, _FIRST, _MARK = "#f2c6a8", "#8c2d04", "#2b5c8a", "#3a7d44"


def draw_chart(chart: StabilityChart, ax: Axes | None) -> Axes:
    """Shade unstable regions, draw boundaries, mark values, print the error figure."""
    from matplotlib.colors import ListedColormap

    ax = axes_or_new(ax)
    x, y = (_shown(n, v) for n, v in ((chart.x_name, chart.x), (chart.y_name, chart.y)))
    colours = ListedColormap(["#ffffff", _UNSTABLE])
    ax.pcolormesh(
        x,
        y,
        (~chart.stable).astype(float),
        cmap=colours,
        vmin=0,
        vmax=1,
        shading="nearest",
        rasterized=True,
    )
    ax.fill([], [], color=_UNSTABLE, label=f"unstable, from the {_what(chart)}")
    for curves, style, colour, label in (
        (chart.exact, "-", _EXACT, "exact boundary (Hill matrix)"),
        (chart.first_order, "--", _FIRST, "first-order boundary"),
    ):
        if curves is not None:
            _draw_curves(ax, chart, curves, style, colour, label)
    ax.set_xlim(x[0], x[-1])
    ax.set_ylim(y[0], y[-1])
    for label, values in chart.marks.items():
        _draw_marks(ax, _shown(chart.y_name, np.asarray(values)), label, float(x[0]))
    ax.set_xlabel(_LABELS.get(chart.x_name, chart.x_name))
    ax.set_ylabel(_LABELS.get(chart.y_name, chart.y_name))
    if chart.x_name == "speed" and np.isfinite(chart.natural_frequency):
        _draw_fractions(ax, chart)
    ax.text(
        0.99,
        0.01,
        f"error of the {_what(chart)} < {chart.error:.1e} (estimate)",
        transform=ax.transAxes,
        ha="right",
        va="bottom",
        fontsize=7,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.5},
    )
    # Below the axes, where it covers nothing.
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=2, fontsize=8, frameon=False)
    return ax


def _what(chart: StabilityChart) -> str:
    return "discriminant" if chart.error_norm.startswith("half trace") else "invariants"


def _shown(name: str, values: Array) -> Array:
    return values * _RPM if name == "speed" else values


def _draw_curves(
    ax: Axes, chart: StabilityChart, curves: BoundaryCurves, style: str, colour: str, label: str
) -> None:
    horizontal = curves.along == chart.x_name
    other = chart.y_name if horizontal else chart.x_name
    at = _shown(other, curves.at)
    first = True
    for ends in (curves.lower, curves.upper):
        for row in ends:
            values = _shown(curves.along, row)
            pair = (values, at) if horizontal else (at, values)
            ax.plot(*pair, style, color=colour, lw=1.0, label=label if first else None)
            first = False


def _draw_marks(ax: Axes, values: Array, label: str, left: float) -> None:
    for value in values:
        ax.axhline(value, color=_MARK, lw=0.6, alpha=0.7)
    ax.plot(np.full(len(values), left), values, ">", color=_MARK, ms=6, clip_on=False, label=label)


def _draw_fractions(ax: Axes, chart: StabilityChart) -> None:
    """Put the speeds 2 Omega / n on a second axis along the top, n the number of the region."""
    low, high = ax.get_xlim()
    ticks: list[float] = []
    labels: list[str] = []
    for n in range(1, 41):
        speed = 2.0 * chart.natural_frequency / n * _RPM
        if low <= speed <= high and (not ticks or ticks[-1] - speed > 0.045 * (high - low)):
            ticks.append(speed)
            labels.append(_fraction(n))
    top = ax.secondary_xaxis("top")
    top.set_xticks(ticks, labels, fontsize=8)
    top.set_xlabel(rf"fractions of the {chart.frequency_name} $\Omega$", fontsize=9)


def _fraction(n: int) -> str:
    if n == 2:
        return r"$\Omega$"
    return rf"$\Omega/{n // 2}$" if n % 2 == 0 else rf"$2\Omega/{n}$"
