"""Beale and Scott's Figs. 11 and 12: frequency over the cycle, beating, and its resonances."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..core.families import Array, LinearPeriodic
from ..frequencies import ResonanceCurve, natural_frequencies, resonance_curve
from ..periodic import floquet_multipliers
from .beale_tip import FLEXIBLE, rod, tip_from_rest
from .records import Drawn, Quoted, Table
from .style import COLOURS, crank_axis, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_RATIO, _QUOTED = 0.2, 900.0
_PRINTED, _COMPLETE = ("as_printed",), ()
_ENOUGH = 6
_TURNS = 60
_STEPS = 192
# Damping of the resonance curves: internal, this part of critical in the first mode.
_DAMPING, _STIFFNESS = 0.01, 0.7e11 * 0.5208e-6
_SPEEDS = np.geomspace(150.0, 1000.0, 240)


@lru_cache(maxsize=16)
def _rod(
    formulation: str, modes: int, drop: tuple[str, ...], ratio: float = _RATIO
) -> LinearPeriodic:
    return rod(FLEXIBLE, formulation, modes, drop, links__crank_ratio=ratio)


def mean_frequency(formulation: str = "polynomial", modes: int = 3, ratio: float = _RATIO) -> float:
    """Return the mean first natural frequency [rad/s] over the crank angle."""
    return float(natural_frequencies(_rod(formulation, modes, _PRINTED, ratio), 0.0, 1).mean[0])


def figure_11(axes: Sequence[Axes]) -> Drawn:
    """Draw the first natural frequency with the crank held, against its angle."""
    ax = axes[0]
    for formulation, modes, style in (("polynomial", 3, "-"), ("overhang", _ENOUGH, "--")):
        found = natural_frequencies(_rod(formulation, modes, _PRINTED))
        colour = COLOURS[0] if formulation == "polynomial" else COLOURS[1]
        label = f"{modes} {formulation} modes, mean {found.mean[0]:.1f} rad/s"
        ax.plot(np.degrees(found.theta), found.frequency[:, 0], style, color=colour, label=label)
        ax.axhline(found.mean[0], color=colour, lw=0.6, ls=(0, (1, 3)))
    crank_axis(ax)
    ax.set_ylabel("first natural frequency [rad/s]")
    legend_below(axes)
    first = natural_frequencies(_rod("polynomial", 3, _PRINTED)).frequency[:, 0]
    rows = (
        Quoted(
            "mean first natural frequency, three polynomial modes",
            _QUOTED,
            mean_frequency(),
            50.0,
            "a round hundred",
            "3.2",
            unit="rad/s",
        ),
        Quoted(
            "greatest over least first natural frequency",
            1.5,
            float(np.max(first) / np.min(first)),
            0.0,
            "'large variations': more than half as much again",
            "3.2",
            relation=">",
        ),
    )
    note = (
        "The natural frequency of the rod at rest; the crank's speed plays no part. The converged "
        "mean is 5 % lower than that of three polynomials."
    )
    return Drawn(rows, (note,))


def figure_12(axes: Sequence[Axes]) -> Drawn:
    """Draw the tip from rest near the mean frequency: three polynomials, and converged modes."""
    mean = mean_frequency()
    panels = (
        (axes[0], "polynomial", 3, ((_PRINTED, mean), (_PRINTED, _QUOTED))),
        (axes[1], "overhang", _ENOUGH, ((_PRINTED, _QUOTED), (_COMPLETE, _QUOTED))),
    )
    peaks: dict[tuple[str, tuple[str, ...], float], Array] = {}
    for ax, formulation, modes, runs in panels:
        for place, (drop, speed) in enumerate(runs):
            theta, tip = _tip(formulation, modes, drop, speed)
            physics = "as printed" if drop else "with tension"
            label = f"{modes} {formulation} modes, {physics}, {speed:.4g} rad/s"
            colour = COLOURS[place + (0 if formulation == "polynomial" else 2)]
            ax.plot(theta / (2 * np.pi), tip, color=colour, lw=0.7, label=label)
            turn = (len(tip) - 1) // _TURNS
            peaks[formulation, drop, speed] = np.abs(tip[1:]).reshape(_TURNS, turn).max(axis=1)
        ax.set_xlim(0.0, float(_TURNS))
        ax.set_ylabel("tip deflection [m]")
    axes[1].set_xlabel("revolutions of the crank")
    legend_below(axes, columns=2)
    return Drawn(tuple(_beating_rows(peaks, mean)), _BEATING_NOTES, (_multiplier_table(mean),))


def _tip(formulation: str, modes: int, drop: tuple[str, ...], speed: float) -> tuple[Array, Array]:
    return tip_from_rest(_rod(formulation, modes, drop), speed, turns=_TURNS, steps=_STEPS)


_BEATING_NOTES = (
    "The linear equations hold to deflections of about 5 % of the length: what is drawn is their "
    "solution, not the motion of a rod.",
    "The paper's beating is that of a model with three polynomials. With converged modes the "
    "printed equations are unstable at 900 rad/s: a pair of multipliers of modulus 1.063 off the "
    "real axis, a combination region. At the mean of three polynomials, 917 rad/s, they are not. "
    "With centrifugal tension the region lies elsewhere.",
)


def _beating_rows(
    peaks: dict[tuple[str, tuple[str, ...], float], Array], mean: float
) -> list[Quoted]:
    three = peaks["polynomial", _PRINTED, mean]
    where, six = "3.2", _rod("overhang", _ENOUGH, _PRINTED)
    return [
        Quoted(
            "largest tip deflection, three polynomial modes at their mean frequency",
            1.0,
            float(np.max(three)),
            0.0,
            "'of the order of meters'",
            where,
            relation=">",
            unit="m",
        ),
        Quoted(
            "least over largest peak of a turn, the same",
            0.5,
            float(np.min(three) / np.max(three)),
            0.0,
            "'beating': the amplitude falls to less than half",
            where,
            relation="<",
        ),
        Quoted(
            "largest multiplier, three polynomial modes at their mean frequency",
            1.0,
            _largest(_rod("polynomial", 3, _PRINTED), mean),
            1e-9,
            "'not unbounded'",
            where,
        ),
        Quoted(
            f"largest multiplier, {_ENOUGH} overhang modes at 900 rad/s",
            1.0,
            _largest(six, _QUOTED),
            1e-3,
            "'not unbounded'",
            where,
            differs="converged modes lie in a combination region: the motion is unbounded",
        ),
    ]


def _largest(system: LinearPeriodic, speed: float) -> float:
    found = floquet_multipliers(system, speed, rtol=1e-9)
    return float(np.max(np.abs(found.multipliers)))


def _multiplier_table(mean: float) -> Table:
    rows = []
    converged = mean_frequency("overhang", _ENOUGH)
    for drop in (_PRINTED, _COMPLETE):
        for formulation, modes in (("polynomial", 3), *(("overhang", n) for n in (2, 4, _ENOUGH))):
            cells = [f"{modes} {formulation} modes", "as printed" if drop else "with tension"]
            for speed in (_QUOTED, mean, converged):
                found = floquet_multipliers(_rod(formulation, modes, drop), speed, rtol=1e-9)
                largest = float(np.max(np.abs(found.multipliers)))
                growth = 0.0 if found.stable else float(found.growth)
                cells.append(f"{largest:.5f}, {growth:.2f} 1/s")
            rows.append(tuple(cells))
    speeds = tuple(f"at {speed:.1f} rad/s" for speed in (_QUOTED, mean, converged))
    header = ("modes", "physics", *speeds)
    return Table("Largest multiplier and growth rate, crank ratio 0.2", header, tuple(rows))


@lru_cache(maxsize=4)
def resonances(ratio: float) -> ResonanceCurve:
    """Return the damped resonance curve of the flexible rod's tip at a crank ratio.

    Two overhang modes, with tension; internal damping, 1 % of critical in the first mode.
    """
    system = _rod("overhang", 2, _COMPLETE, ratio)
    drag = 2 * _DAMPING * _STIFFNESS / mean_frequency("overhang", 2, ratio)
    return resonance_curve(system.with_parameters(internal_damping=drag), _SPEEDS)


def figure_resonances(axes: Sequence[Axes]) -> Drawn:
    """Draw the largest steady tip deflection against the crank speed, for three crank ratios."""
    ax = axes[0]
    rows = []
    for place, ratio in enumerate((0.05, 0.1, 0.2)):
        curve = resonances(ratio)
        speed, peak = curve.joined
        ax.semilogy(speed, peak, color=COLOURS[place], label=f"crank ratio {ratio:g}")
        ax.plot(curve.maxima, curve.maxima_peak, "o", color=COLOURS[place], ms=3)
        mean = float(curve.mean_frequency[0])
        first = curve.mode == 1
        rows += [
            Quoted(
                f"resonant speed times {order} over the mean frequency, crank ratio {ratio:g}",
                1.0,
                float(order * speed / mean),
                0.07,
                "7 %: no fixed frequency",
                "3.2",
            )
            for order, speed in zip(curve.order[first], curve.maxima[first], strict=True)
            if order <= 4
        ]
        rows.append(_tenth(ratio))
        for order in range(1, 6) if ratio == _RATIO else ():
            ax.axvline(mean / order, color="0.7", lw=0.6, ls=(0, (1, 3)))
    ax.set_xlabel("crank speed [rad/s]")
    ax.set_ylabel("largest tip deflection [m]")
    legend_below(axes)
    note = (
        "Periodic motion with internal damping, 1 % of critical in the first mode, by two overhang "
        "modes with tension; dotted: the mean first natural frequency over n at the crank ratio "
        "0.2. The inhomogeneous instabilities are there, at omega_1/n of the mean frequency, "
        "however much the frequency varies over the cycle."
    )
    return Drawn(tuple(rows), (note,))


def _tenth(ratio: float) -> Quoted:
    speed = mean_frequency(ratio=ratio) / 10
    _, tip = tip_from_rest(_rod("polynomial", 3, _PRINTED, ratio), speed, turns=10, steps=1440)
    return Quoted(
        f"largest tip deflection at a tenth of the mean frequency, crank ratio {ratio:g}",
        0.05,
        float(np.max(np.abs(tip))),
        0.0,
        "'small': within 5 % of the length, ten turns from rest",
        "3.2",
        relation="<",
        unit="m",
    )
