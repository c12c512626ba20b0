"""Aannaque's Fig. 6.1: where Newmark's scheme is stable."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .records import Drawn, Quoted
from .style import COLOURS, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def figure_6_1(axes: Sequence[Axes]) -> Drawn:
    """Draw the regions of stability of Newmark's scheme over gamma and beta."""
    ax = axes[0]
    right = np.linspace(0.5, 1.2, 71)
    pairs, real = 0.25 * (right + 0.5) ** 2, 0.5 * right
    ax.axvspan(0.0, 0.5, color="#c9ced3", lw=0.0)
    ax.fill_between(right, 0.0, real, color="#f1dcc6", lw=0.0)
    ax.fill_between(right, real, pairs, color="#dfeadf", lw=0.0)
    ax.fill_between(right, pairs, 0.8, color="#c2dcc4", lw=0.0)
    ax.plot(right, pairs, color=COLOURS[0], label=r"$(\gamma + 1/2)^2/4$")
    ax.plot(right, real, color=COLOURS[1], ls="--", label=r"$\gamma/2$")
    ax.axvline(0.5, color="0.3", lw=0.8)
    marks = (("mean acceleration", 0.25, "o"), ("linear acceleration", 1.0 / 6.0, "s"))
    for name, place, mark in marks:
        ax.plot(0.5, place, mark, color="0.1", ms=5, label=name, ls="none")
    for x, y, words in (
        (0.25, 0.5, "unstable"),
        (0.85, 0.15, "stable up to a step"),
        (0.75, 0.62, "stable at every step"),
    ):
        ax.text(x, y, words, ha="center", va="center")
    ax.set_xlim(0.0, 1.2)
    ax.set_ylim(0.0, 0.8)
    ax.set_xlabel(r"$\gamma$")
    ax.set_ylabel(r"$\beta$")
    ax.grid(visible=False)
    legend_below([ax])
    note = (
        "No damping. Between the two lines the multipliers of long steps are real and within the "
        "unit circle: (6.11) bounds the pairs, stability ends at gamma/2."
    )
    return Drawn(tuple(_newmark_rows()), (note,))


def _least_beta(gamma: float) -> float:
    """Return the least beta that is stable at every step."""
    from .newmark_stability import newmark_limit

    low, high = 0.0, 1.0
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if np.isinf(newmark_limit(gamma, middle)) else (middle, high)
    return 0.5 * (low + high)


def _misjudged() -> int:
    """Return at how many points the multipliers are not those of the region drawn."""
    from .newmark_stability import newmark_regions

    # Between the lines, on which the regions meet.
    gamma, beta = np.meshgrid(np.arange(0.013, 1.2, 0.04), np.arange(0.003, 0.8, 0.04))
    drawn = 1 + (beta > 0.5 * gamma).astype(int) + (beta > 0.25 * (gamma + 0.5) ** 2)
    drawn = np.where(gamma < 0.5, 0, drawn)
    return int(np.count_nonzero(drawn != newmark_regions(gamma, beta)))


def _newmark_rows() -> list[Quoted]:
    from .newmark_stability import newmark_limit

    limits = newmark_limit(np.array([0.49, 0.5, 0.51]), 0.25)
    return [
        Quoted(
            "points of 600 whose multipliers are not those of the region drawn",
            0.0,
            float(_misjudged()),
            0.0,
            "steps to 1e6 rad",
            "Fig. 6.1",
        ),
        Quoted(
            "least beta that is stable at every step, gamma = 1/2",
            0.25,
            _least_beta(0.5),
            1e-6,
            "steps to 1e6 rad",
            "6.2.3",
        ),
        Quoted(
            "the same, gamma = 0.9",
            0.49,
            _least_beta(0.9),
            1e-6,
            "(gamma + 1/2)^2/4 read as the limit",
            "6.2.3",
            differs="sufficient, not necessary: the limit is gamma/2 = 0.45; between the two the "
            "multipliers are real, within the circle",
        ),
        Quoted(
            "longest stable step, gamma = 0.49, beta = 1/4",
            0.0,
            float(limits[0]),
            0.0,
            "stable where gamma is 1/2 or more, with damping left out",
            "6.2.3",
        ),
        Quoted(
            "longest stable step omega h, gamma = 1/2, beta = 1/6",
            float(np.sqrt(12.0)),
            float(newmark_limit(0.5, 1.0 / 6.0)),
            1e-6,
            "4/(1 - 4/6) = 12 by (6.11)",
            "6.2.3",
            unit="rad",
        ),
    ]
