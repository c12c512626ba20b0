"""Beale and Scott's Figs. 11 and 12, resonances, and the stability chart that they left undone."""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations_with_replacement

import numpy as np

from ..core.families import Array, LinearPeriodic
from ..frequencies import ResonanceCurve, natural_frequencies, resonance_curve
from ..periodic import floquet_multipliers
from ..stability import StabilityChart, stability_chart
from .beale_tip import AS_PRINTED, ENOUGH, FLEXIBLE, peak, rod, tip_from_rest
from .drawing import COLOURS, Axes, Panels, panel_title
from .records import Drawn

_RATIO, _QUOTED = 0.2, 900.0
_COMPLETE: tuple[str, ...] = ()
# Speeds of the chart [rad/s].
_SPEEDS = np.linspace(500.0, 4000.0, 1401)
_PANELS = [
    (formulation, modes, drop, words)
    for formulation, modes in (("polynomial", 3), ("overhang", 4))
    for drop, words in ((AS_PRINTED, "as printed"), (_COMPLETE, "with centrifugal tension"))
]
_KINDS = (
    (-1, "#f0bd98", "multiplier below -1"),
    (1, "#c9783c", "multiplier above 1"),
    (2, "#a58fc9", "complex multipliers: combination"),
)


@lru_cache(maxsize=16)
def _rod(
    formulation: str, modes: int, drop: tuple[str, ...], ratio: float = _RATIO
) -> LinearPeriodic:
    return rod(FLEXIBLE, formulation, modes, drop, links__crank_ratio=ratio)


def mean_frequency(formulation: str = "polynomial", modes: int = 3, ratio: float = _RATIO) -> float:
    """Return the mean first natural frequency [rad/s] over the crank angle."""
    return float(natural_frequencies(_rod(formulation, modes, AS_PRINTED, ratio), 0.0, 1).mean[0])


def figure_11(axes: Panels) -> Drawn:
    """Draw the first natural frequency with the crank held, against its angle."""
    ax = axes[0]
    for formulation, modes, style, colour in (
        ("polynomial", 3, "-", COLOURS[0]),
        ("overhang", ENOUGH, "--", COLOURS[1]),
    ):
        held = natural_frequencies(_rod(formulation, modes, AS_PRINTED))
        label = f"{modes} {formulation} modes, mean {held.mean[0]:.1f} rad/s"
        ax.plot(np.degrees(held.theta), held.frequency[:, 0], style, color=colour, label=label)
        ax.axhline(held.mean[0], color=colour, lw=0.6, ls=(0, (1, 3)))
    first = natural_frequencies(_rod("polynomial", 3, AS_PRINTED)).frequency[:, 0]
    return Drawn([mean_frequency(), np.max(first) / np.min(first)])


def figure_12(axes: Panels) -> Drawn:
    """Draw the tip from rest near the mean frequency: three polynomials, and converged modes."""
    mean, heights, turns = mean_frequency(), [], 60
    for k, (formulation, modes, drop, speed) in enumerate(
        (
            ("polynomial", 3, AS_PRINTED, mean),
            ("polynomial", 3, AS_PRINTED, _QUOTED),
            ("overhang", ENOUGH, AS_PRINTED, _QUOTED),
            ("overhang", ENOUGH, _COMPLETE, _QUOTED),
        )
    ):
        system = _rod(formulation, modes, drop)
        theta, tip = tip_from_rest(system, speed, turns=turns, steps=192)
        physics = "as printed" if drop else "with tension"
        label = f"{modes} {formulation} modes, {physics}, {speed:.4g} rad/s"
        axes[k // 2].plot(theta / (2 * np.pi), tip, color=COLOURS[k], lw=0.7, label=label)
        heights.append(np.abs(tip[1:]).reshape(turns, -1).max(axis=1))
    three = heights[0]
    values = [np.max(three), np.min(three) / np.max(three)]
    values += [_largest("polynomial", 3, mean), _largest("overhang", ENOUGH, _QUOTED)]
    rows = []
    speeds = (_QUOTED, mean, mean_frequency("overhang", ENOUGH))
    for drop in (AS_PRINTED, _COMPLETE):
        for formulation, modes in (("polynomial", 3), *(("overhang", n) for n in (2, 4, ENOUGH))):
            cells = [f"{modes} {formulation} modes", "as printed" if drop else "with tension"]
            for speed in speeds:
                motion = floquet_multipliers(_rod(formulation, modes, drop), speed, rtol=1e-9)
                growth = 0.0 if motion.stable else float(motion.growth)
                cells.append(f"{peak(motion.multipliers):.5f}, {growth:.2f} 1/s")
            rows.append(cells)
    return Drawn(values, {"speeds": speeds}, [rows])


def _largest(formulation: str, modes: int, speed: float) -> float:
    motion = floquet_multipliers(_rod(formulation, modes, AS_PRINTED), speed, rtol=1e-9)
    return peak(motion.multipliers)


@lru_cache(maxsize=4)
def resonances(ratio: float) -> ResonanceCurve:
    """Return the damped resonance curve of the flexible rod's tip at a crank ratio.

    Two overhang modes, with tension; internal damping, 1 % of critical in the first mode.
    """
    system = _rod("overhang", 2, _COMPLETE, ratio)
    stiffness = 0.7e11 * 0.5208e-6
    drag = 2 * 0.01 * stiffness / mean_frequency("overhang", 2, ratio)
    speeds = np.geomspace(150.0, 1000.0, 240)
    return resonance_curve(system.with_parameters(internal_damping=drag), speeds)


def figure_resonances(axes: Panels) -> Drawn:
    """Draw the largest steady tip deflection against the crank speed, for three crank ratios."""
    ax = axes[0]
    values: list[float] = []
    for ratio in (0.05, 0.1, _RATIO):
        curve = resonances(ratio)
        curve.plot(ax).lines[-1].set_label(f"crank ratio {ratio:g}")
        mean, first = float(curve.mean_frequency[0]), curve.mode == 1
        at = zip(curve.order[first], curve.maxima[first], strict=True)
        values += [order * speed / mean for order, speed in at if order <= 4]
        system = _rod("polynomial", 3, AS_PRINTED, ratio)
        values.append(peak(tip_from_rest(system, mean_frequency(ratio=ratio) / 10, turns=10)[1]))
        for order in range(1, 6) if ratio == _RATIO else ():
            ax.axvline(mean / order, color="0.7", lw=0.6, ls=(0, (1, 3)))
    return Drawn(values)


@lru_cache(maxsize=4)
def chart(formulation: str, modes: int, drop: tuple[str, ...]) -> StabilityChart:
    """Return the flexible rod's stability over crank speed and crank ratio."""
    system = _rod(formulation, modes, drop, 0.1)
    return stability_chart(system, ("speed", _SPEEDS), ("crank_ratio", np.linspace(0.01, 0.2, 191)))


@lru_cache(maxsize=4)
def frequencies(formulation: str, modes: int) -> Array:
    """Return the natural frequencies [rad/s] of the rod as the crank's length goes to zero."""
    return natural_frequencies(_rod(formulation, modes, AS_PRINTED, 1e-6)).mean


def figure_chart(axes: Panels) -> Drawn:
    """Draw two bases, three polynomials and four overhang modes, with and without tension."""
    from matplotlib.colors import ListedColormap

    colours, rows = ListedColormap(["#ffffff", *(colour for _, colour, _ in _KINDS)]), []
    for ax, (formulation, modes, drop, words) in zip(axes, _PANELS, strict=True):
        points = chart(formulation, modes, drop)
        codes = sum((points.kind == kind) * (i + 1) for i, (kind, _, _) in enumerate(_KINDS))
        ax.pcolormesh(points.x, points.y, codes, cmap=colours, vmin=0, vmax=3, rasterized=True)
        _mark(ax, frequencies(formulation, modes))
        panel_title(ax, f"{modes} {formulation} modes, {words}")
        shares = (100.0 * float(np.mean(points.kind == kind)) for kind, _, _ in _KINDS)
        rows.append((f"{modes} {formulation}", words, *shares, np.max(points.error)))
    for _, colour, label in _KINDS:
        axes[0].fill([], [], color=colour, label=label)
    return Drawn(_chart_values(), tables=[rows])


def _mark(ax: Axes, omega: Array) -> None:
    """Mark the speeds from which regions start, at the foot of the axes, where they fit."""
    places = sorted(
        (float((omega[i] + omega[j]) / n), _name(i, j, n))
        for i, j in combinations_with_replacement(range(2), 2)
        for n in range(1, 4)
    )
    groups: list[list[tuple[float, str]]] = []
    for place in places:
        if not _SPEEDS[0] <= place[0] <= _SPEEDS[-1]:
            continue
        ax.plot([place[0]], [0.0], "^", color="0.2", ms=4, zorder=6)
        # Marks closer than 150 rad/s share one label.
        if groups and place[0] - groups[-1][-1][0] < 150.0:
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


def _chart_values() -> list[float]:
    """Return frequencies of two bases, a practical rod's multiplier, where regions start."""
    three, four = frequencies("polynomial", 3), frequencies("overhang", 4)
    slow = floquet_multipliers(_rod("overhang", 2, AS_PRINTED, 0.3), 20.0, rtol=1e-9)
    return [
        three[0] / four[0],
        (three[0] + three[1]) / (four[0] + four[1]),
        peak(slow.multipliers),
        _start(0, 0, 1, 0.01),
        _start(0, 1, 1, 0.01),
        _start(1, 1, 2, 0.05),
    ]


def _start(i: int, j: int, n: int, ratio: float) -> float:
    """Return the middle of a region at a crank ratio over where it should start."""
    points, omega = chart("overhang", 4, AS_PRINTED), frequencies("overhang", 4)
    start = float(omega[i] + omega[j]) / n
    row = points.kind[int(np.argmin(np.abs(points.y - ratio)))]
    kind = 2 if i != j else (-1) ** n
    near = points.x[(row == kind) & (np.abs(points.x - start) < 0.05 * start)]
    return (float(np.mean(near)) if len(near) else float("nan")) / start
