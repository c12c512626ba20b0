"""The picture of unstable regions along the speed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...core.plotting import axes_or_new

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .tracing import StabilityEdges

_RPM = 30.0 / np.pi
_CLOSED = "closed: too narrow to be told from none"
_COLOURS = {"principal": "#c05a1f", "sum": "#6b3d8f", "difference": "#2b7a78"}


def draw_edges(found: StabilityEdges, ax: Axes | None) -> Axes:
    """Draw each region as a bar, closed ones as a grey dot, one row for each pair of modes."""
    ax = axes_or_new(ax)
    low, high = (speed * _RPM for speed in found.speed_range)
    pairs = sorted({tuple(pair) for pair in found.modes.tolist()})
    seen: set[str] = set()
    order = np.argsort(found.lower, kind="stable")
    last = dict.fromkeys(pairs, -np.inf)
    for i in order:
        kind, pair = found.kind[i], tuple(found.modes[i].tolist())
        row = pairs.index(pair)
        begin = found.lower[i] * _RPM if np.isfinite(found.lower[i]) else low
        end = found.upper[i] * _RPM if np.isfinite(found.upper[i]) else high
        closed = bool(found.upper[i] - found.lower[i] <= 2 * found.error[i])
        kind = _CLOSED if closed else kind
        label = None if kind in seen else kind
        seen.add(kind)
        if closed:
            ax.plot(begin, row, ".", color="0.6", ms=2.5, label=label)
            continue
        ax.fill_between([begin, end], row - 0.3, row + 0.3, color=_COLOURS[kind], lw=0)
        ax.plot([begin, begin], [row - 0.3, row + 0.3], color=_COLOURS[kind], lw=0.8, label=label)
        middle = 0.5 * (max(begin, low) + min(end, high))
        # Numbers that would run into each other are left out.
        if middle - last[pair] > 0.03 * (high - low):
            ax.text(middle, row + 0.36, f"{found.harmonic[i]}", fontsize=7, ha="center")
            last[pair] = middle
    ax.set_yticks(range(len(pairs)), [_name(pair) for pair in pairs])
    ax.set_ylim(-0.6, len(pairs) - 0.3)
    ax.set_xlim(low, high)
    ax.set_xlabel("crank speed [rpm]")
    ax.set_title("unstable regions; the numbers are harmonics", fontsize=9)
    if seen:
        ax.legend(
            loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=3, fontsize=8, frameon=False
        )
    return ax


def _name(pair: tuple[int, ...]) -> str:
    return f"mode {pair[0]}" if pair[0] == pair[1] else f"modes {pair[0]}, {pair[1]}"
