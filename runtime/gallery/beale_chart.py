"""The stability chart that Beale and Scott left undone: crank speed and crank ratio."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING

import numpy as np

from ..core.families import Array
from ..frequencies import natural_frequencies
from ..periodic import floquet_multipliers
from ..stability import StabilityChart, stability_chart
from .beale_tip import FLEXIBLE, rod
from .records import Drawn, Quoted, Table
from .style import legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SPEEDS, _RATIOS = np.linspace(500.0, 4000.0, 1401), np.linspace(0.01, 0.2, 191)
_PRINTED: tuple[str, ...] = ("as_printed",)
_PHYSICS: tuple[tuple[tuple[str, ...], str], ...] = (
    (_PRINTED, "as printed"),
    ((), "with centrifugal tension"),
)
_BASES = (("polynomial", 3), ("overhang", 4))
_KINDS = (
    (-1, "#f0bd98", "multiplier below -1"),
    (1, "#c9783c", "multiplier above 1"),
    (2, "#a58fc9", "complex multipliers: combination"),
)
_PRACTICAL = (20.0, 0.3)
_ORDERS = 3
# Marks closer than this [rad/s] share one label.
_CLOSE = 150.0
# Regions whose beginning the chart shows: name, modes, order, crank ratio where they are read.
_REGIONS = (
    ("2 omega_1", 0, 0, 1, 0.01),
    ("omega_1 + omega_2", 0, 1, 1, 0.01),
    ("omega_2", 1, 1, 2, 0.05),
)


@lru_cache(maxsize=4)
def chart(formulation: str, modes: int, drop: tuple[str, ...]) -> StabilityChart:
    """Return the flexible rod's stability over crank speed and crank ratio."""
    system = rod(FLEXIBLE, formulation, modes, drop, links__crank_ratio=0.1)
    return stability_chart(system, ("speed", _SPEEDS), ("crank_ratio", _RATIOS))


@lru_cache(maxsize=4)
def frequencies(formulation: str, modes: int) -> Array:
    """Return the natural frequencies [rad/s] of the rod as the crank's length goes to zero."""
    return natural_frequencies(
        rod(FLEXIBLE, formulation, modes, _PRINTED, links__crank_ratio=1e-6)
    ).mean


def figure_chart(axes: Sequence[Axes]) -> Drawn:
    """Draw two bases, three polynomials and four overhang modes, with and without tension."""
    from matplotlib.colors import ListedColormap

    colours = ListedColormap(["#ffffff", *(colour for _, colour, _ in _KINDS)])
    panels = [(basis, physics) for basis in _BASES for physics in _PHYSICS]
    for ax, ((formulation, modes), (drop, words)) in zip(axes, panels, strict=True):
        found = chart(formulation, modes, drop)
        codes = sum((found.kind == kind) * (i + 1) for i, (kind, _, _) in enumerate(_KINDS))
        ax.pcolormesh(found.x, found.y, codes, cmap=colours, vmin=0, vmax=3, rasterized=True)
        _mark(ax, frequencies(formulation, modes))
        panel_title(ax, f"{modes} {formulation} modes, {words}")
        ax.set_xlim(_SPEEDS[0], _SPEEDS[-1])
        ax.set_ylim(-0.024, _RATIOS[-1])
        ax.set_yticks(np.linspace(0.0, 0.2, 5))
        ax.grid(visible=False)
    for _, colour, label in _KINDS:
        axes[0].fill([], [], color=colour, label=label)
    for ax in axes[2:]:
        ax.set_xlabel("crank speed [rad/s]")
    for ax in axes[::2]:
        ax.set_ylabel("crank ratio G/a$_x$")
    legend_below(axes[:1])
    return Drawn(tuple(_rows()), _NOTES, (_table(),))


_NOTES = (
    "The paper has no chart: it takes three hundred minutes for one point to be out of reach, "
    "and looks at speeds to 20 rad/s alone. The flexible rod without damping; multipliers at "
    "every point of the picture from series in speed and crank ratio, whose error is far below "
    "what can be seen. Points are 2.5 rad/s and 0.001 apart: narrower regions break up into dots. "
    "Marks at the foot: (omega_i + omega_j)/n, n to 3, of the rod at crank "
    "length 0, from which regions start.",
    "Tension changes the chart from a crank ratio of 0.1 on. Three polynomials put the second "
    "frequency 28 % too high, and with it the combination regions of the first two modes.",
)


def _mark(ax: Axes, omega: Array) -> None:
    """Mark the speeds from which regions start, at the foot of the axes, where they fit."""
    places = sorted(
        (float((omega[i] + omega[j]) / n), _name(i, j, n))
        for i, j in combinations_with_replacement(range(2), 2)
        for n in range(1, _ORDERS + 1)
    )
    groups: list[list[tuple[float, str]]] = []
    for place in places:
        if not _SPEEDS[0] <= place[0] <= _SPEEDS[-1]:
            continue
        ax.plot([place[0]], [0.0], "^", color="0.2", ms=4, zorder=6)
        if groups and place[0] - groups[-1][-1][0] < _CLOSE:
            groups[-1].append(place)
        else:
            groups.append([place])
    ax.axhline(0.0, color="0.2", lw=0.7)
    for i, group in enumerate(groups):
        # Neighbours stand on two lines, so that they do not meet.
        ax.annotate(
            ", ".join(name for _, name in group),
            (float(np.mean([speed for speed, _ in group])), 0.0),
            xytext=(0.0, -4.0 - 9.0 * (i % 2)),
            textcoords="offset points",
            ha="center",
            va="top",
            fontsize=6.5,
        )


def _name(i: int, j: int, n: int) -> str:
    if i == j and n == 2:
        return rf"$\omega_{i + 1}$"
    above = rf"2\omega_{i + 1}" if i == j else rf"\omega_{i + 1}+\omega_{j + 1}"
    if n == 1:
        return f"${above}$"
    return f"${above}/{n}$" if i == j else f"$({above})/{n}$"


def _rows() -> list[Quoted]:
    three, four = frequencies("polynomial", 3), frequencies("overhang", 4)
    speed, ratio = _PRACTICAL
    slow = rod(FLEXIBLE, "overhang", 2, _PRINTED, links__crank_ratio=ratio)
    largest = float(np.max(np.abs(floquet_multipliers(slow, speed, rtol=1e-9).multipliers)))
    reached = chart("overhang", 4, _PRINTED)
    return [
        Quoted(
            "first frequency at crank length 0, three polynomial modes over the converged one",
            1.0,
            float(three[0] / four[0]),
            0.1,
            "'just three modes was adequate' for small-crank zones: a tenth",
            "3.1",
        ),
        Quoted(
            "omega_1 + omega_2 at crank length 0, three polynomial modes over the converged one",
            1.0,
            float((three[0] + three[1]) / (four[0] + four[1])),
            0.1,
            "the same",
            "3.1",
            differs="not for combination zones: their speeds are a fifth too high",
        ),
        Quoted(
            "largest multiplier at 20 rad/s, crank ratio 0.3, two overhang modes",
            1.0,
            largest,
            1e-6,
            "no instabilities in the practical range: its fastest corner",
            "3.1",
        ),
        *(_starts(reached, four, *region) for region in _REGIONS),
    ]


def _starts(
    found: StabilityChart, omega: Array, name: str, i: int, j: int, n: int, ratio: float
) -> Quoted:
    """Compare the middle of a region on one of the chart's rows with where it should start."""
    start = float(omega[i] + omega[j]) / n
    row = found.kind[int(np.argmin(np.abs(found.y - ratio)))]
    kind = 2 if i != j else (-1) ** n
    near = found.x[(row == kind) & (np.abs(found.x - start) < 0.05 * start)]
    middle = float(np.mean(near)) if len(near) else float("nan")
    return Quoted(
        f"middle of region {name} at crank ratio {ratio:g} over its start, four overhang modes",
        1.0,
        middle / start,
        0.01,
        "'emanate from the line' of crank length 0: within a hundredth",
        "3.1",
    )


def _table() -> Table:
    rows = []
    for formulation, modes in _BASES:
        for drop, words in _PHYSICS:
            found = chart(formulation, modes, drop)
            shares = [100.0 * float(np.mean(found.kind == kind)) for kind, _, _ in _KINDS]
            cells = (f"{value:.1f}" for value in shares)
            error = f"{float(np.max(found.error)):.0e}"
            rows.append((f"{modes} {formulation}", words, *cells, error))
    shown = tuple(f"{label} [%]" for _, _, label in _KINDS)
    head = ("modes", "physics", *shown, "error of the invariants")
    return Table("Shares of the chart by kind of instability", head, tuple(rows))
