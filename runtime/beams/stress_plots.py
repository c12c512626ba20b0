"""Pictures of stresses along beams."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .beam_result import stations_on

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .stress import StressResult

_MEGA = 1e-6


def draw(result: StressResult, ax: Axes | None = None) -> Axes:
    """Draw the stress at each beam's worst place over the crank angle, its static part dashed.

    Of one angle alone, the largest stress along the beams.
    """
    from ..core.plotting import axes_or_new

    ax = axes_or_new(ax)
    if len(result.theta) == 1:
        for link in result.maxima:
            own = stations_on(result.links, link)
            ax.plot(result.places[own], _MEGA * result.stress[0, own], label=link, linewidth=0.9)
        ax.set_xlabel("place x/length")
        ax.set_ylabel("largest stress [MPa]")
        ax.legend()
        return ax
    period = result.period
    closed = period is not None
    angles = np.degrees(result.theta if period is None else np.append(result.theta, period))
    for link, peak in result.maxima.items():
        parts = [result.at(link, peak.place, peak.fibre, name) for name in ("all", "quasi-static")]
        whole, still = (_MEGA * (np.append(p, p[:1]) if closed else p) for p in parts)
        label = f"{link}, x/length = {peak.place:.3g}"
        line = ax.plot(angles, whole, label=label, linewidth=0.9)[0]
        ax.plot(angles, still, "--", color=line.get_color(), linewidth=0.7)
        ax.plot(np.degrees(peak.theta), _MEGA * peak.value, "o", color=line.get_color(), ms=3)
    ax.set_xlabel("crank angle [deg]")
    ax.set_ylabel("stress at the worst fibre [MPa]")
    ax.set_title(f"{result.speed:.4g} rad/s; dashed: quasi-static", fontsize="medium")
    ax.legend()
    return ax
