"""The picture of a stability chart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..core.families import Array
from ..core.plotting import RPM, axes_or_new

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .chart import EdgeCurves, StabilityChart
    from .chart_boundaries import BoundaryCurves

_LABELS = {
    "speed": "crank speed [rpm]",
    "follower_inertia": r"follower inertia $I_4$ [kg m$^2$]",
    "lam2": r"$\lambda^2$",
    "mu": r"$\mu$",
    "crank_ratio": r"crank ratio $\epsilon$",
}
_EXACT, _NEAR, _MARK = "#8c2d04", "#2b5c8a", "#3a7d44"
# By kind of instability; the shades differ in lightness too.
_SHADES = {-1: "#f2c6a8", 1: "#e0a070", 2: "#b9a3d6"}
_WORDS = {
    -1: "odd regions (multiplier below -1)",
    1: "even regions (multiplier above 1)",
    2: "combination (complex multipliers)",
}
# Relative width up to which a region is drawn as a hair.
_NARROW = 1e-4
_EDGES = {"principal": "#8c2d04", "sum": "#5b2d8c", "difference": "#1f6f6b"}


def draw_chart(chart: StabilityChart, ax: Axes | None) -> Axes:
    """Shade unstable regions, draw boundaries, mark values, print the error."""
    ax = axes_or_new(ax)
    x, y = (_shown(n, v) for n, v in ((chart.x_name, chart.x), (chart.y_name, chart.y)))
    _shade(ax, chart, x, y)
    order = "first-order boundary" if chart.order == 1 else f"boundary of order {chart.order}"
    for curves, style, colour, label in (
        (chart.exact, "-", _EXACT, "exact boundary (Hill matrix)"),
        (chart.perturbation, "--", _NEAR, order),
    ):
        if curves is not None:
            text = label if _reach_in(chart, curves) else f"{label}: none here"
            _draw_curves(ax, chart, curves, style, colour, text)
    if chart.edges is not None:
        _draw_edges(ax, chart, chart.edges)
    ax.set_xlim(x[0], x[-1])
    ax.set_ylim(y[0], y[-1])
    for label, values in chart.marks.items():
        _draw_marks(ax, _shown(chart.y_name, np.asarray(values)), label, float(x[0]))
    ax.set_xlabel(_LABELS.get(chart.x_name, chart.x_name))
    ax.set_ylabel(_LABELS.get(chart.y_name, chart.y_name))
    if chart.x_name == "speed" and np.isfinite(chart.natural_frequency):
        _draw_fractions(ax, chart)
    what = "discriminant" if chart.error_norm.startswith("half trace") else "invariants"
    ax.text(
        0.99,
        0.01,
        f"error of the {what} < {chart.error:.1e} (estimate)",
        transform=ax.transAxes,
        ha="right",
        va="bottom",
        fontsize=7,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.5},
    )
    # Below the axes, where it covers nothing.
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=2, fontsize=8, frameon=False)
    return ax


def _shade(ax: Axes, chart: StabilityChart, x: Array, y: Array) -> None:
    from matplotlib.colors import ListedColormap

    codes = np.zeros(chart.kind.shape)
    colours = ["#ffffff"]
    for kind, colour in _SHADES.items():
        here = chart.kind == kind
        if np.any(here):
            colours.append(colour)
            codes[here] = len(colours) - 1
    ax.pcolormesh(
        x,
        y,
        codes,
        cmap=ListedColormap(colours),
        vmin=0,
        vmax=max(len(colours) - 1, 1),
        shading="nearest",
        rasterized=True,
    )
    for kind, colour in _SHADES.items():
        if colour in colours:
            ax.fill([], [], color=colour, label=f"unstable: {_WORDS[kind]}")


def _draw_edges(ax: Axes, chart: StabilityChart, edges: EdgeCurves) -> None:
    """Draw the ends of traced regions between the rows at which they are known, with labels."""
    horizontal = chart.x_name == "speed"
    at = _shown(chart.y_name if horizontal else chart.x_name, edges.at)
    seen: set[str] = set()
    low, high = (RPM * v for v in ((chart.x if horizontal else chart.y)[[0, -1]]))
    for i, kind in enumerate(edges.kind):
        with np.errstate(invalid="ignore"):
            narrow = not np.any(edges.upper[i] - edges.lower[i] > _NARROW * edges.lower[i])
        for ends in (edges.lower[i], edges.upper[i]):
            pair = (ends * RPM, at) if horizontal else (at, ends * RPM)
            label = None if kind in seen else f"{kind} regions, traced"
            ax.plot(*pair, color=_EDGES[kind], lw=0.35 if narrow else 0.8, label=label)
            seen.add(kind)
        if kind == "principal":
            continue
        # Labels stand at the row nearest to the end of the axis where the region is in the chart.
        known = np.flatnonzero((edges.lower[i] * RPM > low) & (edges.lower[i] * RPM < high))
        if len(known):
            text = (
                "+".join(map(str, edges.modes[i]))
                if kind == "sum"
                else "-".join(map(str, edges.modes[i][::-1]))
            )
            place = (edges.lower[i, known[-1]] * RPM, at[known[-1]])
            ax.annotate(
                f"{text}, {edges.harmonic[i]}",
                place if horizontal else place[::-1],
                fontsize=6,
                color=_EDGES[kind],
                rotation=90 if horizontal else 0,
                va="top" if horizontal else "center",
                ha="right",
            )


def _shown(name: str, values: Array) -> Array:
    return values * RPM if name == "speed" else values


def _reach_in(chart: StabilityChart, curves: BoundaryCurves) -> bool:
    values = chart.x if curves.along == chart.x_name else chart.y
    ends = np.concatenate([curves.lower, curves.upper])
    with np.errstate(invalid="ignore"):
        return bool(np.any((ends >= values[0]) & (ends <= values[-1])))


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
        speed = 2.0 * chart.natural_frequency / n * RPM
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
