"""The speeds that Smith quotes by three equations, and how far the linear one suffices."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from ..nonlinear.orbit import Lost, Solver
from ..nonlinear.response import first_motion, linear_motion
from ..nonlinear.segments import Motion, NotFinite, Problem
from .drawing import Axes, Panels, panel_title
from .records import Drawn, contents
from .smith_linkages import RIG, RIGS, Rig
from .smith_nonlinear import BENCHES, coupler, reading, specials
from .smith_speeds import OBSERVATIONS, Observation

_EQUATIONS = {"printed": "(6.17)", "complete": "complete", "nonlinear": "nonlinear"}
_COMPARED = tuple(one for one in OBSERVATIONS if one.nonlinear)
_LEAST = 0.0058  # follower inertia [lbf in s^2]
_TURN = np.linspace(0.0, 2.0 * np.pi, 129)[:-1]
# Speeds of the comparison over the coupler's frequency; the largest deflections, by the linear
# equation and over the length, that belong together.
_SPEEDS = np.linspace(0.16, 0.49, 45)
_BINS = (0.0, 0.0025, 0.005, 0.01, 0.02, 0.03, 0.04)

Rows = list[Sequence[Any]]


def quoted_speeds(axes: Panels, chart: str, cranks: Sequence[float]) -> Drawn:
    """Draw deviations from the quoted speeds, and what the linear equation is off; give tables.

    ``chart``, ``cranks``: a rig whose resonance at Omega/2 leans, with shorter cranks over its own.
    """
    quoted, summary = _deviations(axes[0])
    bins = _bins(axes[1])
    leaning = [_leaning(RIG[chart], crank) for crank in cranks]
    benches = [BENCHES[name] for name in ("least", "more", "softening")]
    points = [
        (one.rig.name, one.inertia, one.rig.decrement, p.kind, p.turns, p.speed, p.size)
        for one in benches
        for p in specials(one)
    ]
    # Bins below the first in which the linear equation is off by more than 1 %.
    good = [row for row in bins if row[-1] < 1.0]
    law = max(abs(row[-1]) for row in leaning)
    both = [BENCHES[name] for name in ("least", "two_modes")]
    kinds = ("rise", "fall", "onset", "end")
    moved = [abs(float(np.diff([reading(one, kind) for one in both])[0])) for kind in kinds]
    share = summary[-1][1] / len(_COMPARED)
    words: dict[str, object] = {
        "count": summary[-1][1],
        "all": len(_COMPARED),
        "entered": reading(BENCHES["softening"], "rise"),
        "lost": reading(BENCHES["softening"], "onset"),
        "within": good[-1][0].split()[-2],
        "there": good[-1][-1],
        "second": max(moved),
        "law": law,
        "leaned": 100.0 * float(np.sqrt(1e-3 / law)),
    }
    for name, row in zip(_EQUATIONS, summary, strict=True):
        words |= {f"rms_{name}": row[2], f"rest_{name}": row[3]}
    tables = (quoted, summary, points, bins, leaning)
    return Drawn((share, summary[-1][-1]), words, tables)


def _deviations(ax: Axes) -> tuple[Rows, Rows]:
    """Draw the deviations; return a table of the speeds and one of the equations."""
    quoted = np.array([one.speed for one in _COMPARED])
    speeds = np.array([[_speed(one, name) for one in _COMPARED] for name in _EQUATIONS])
    percent = 100.0 * (speeds / quoted - 1.0)
    nearest = np.argmin(np.abs(percent), axis=0)
    names, places = list(_EQUATIONS.values()), np.arange(len(_COMPARED))
    for gaps, name, marker in zip(percent, names, "s^o", strict=True):
        ax.plot(gaps, places, marker, ms=5, label=name)
    ax.axvline(0.0, color="0.4", lw=0.8)
    labels = [f"{one.rig.name}, {one.inertia:.4f}: {one.speed:.0f} rpm" for one in _COMPARED]
    ax.set_yticks(places, labels, fontsize=7)
    ax.invert_yaxis()
    panel_title(ax, "deviation from the quoted speeds")
    rows: Rows = []
    for i, one in enumerate(_COMPARED):
        cells = [f"{v:.1f} ({p:+.1f} %)" for v, p in zip(speeds[:, i], percent[:, i], strict=True)]
        read = contents("smith")["readings"][one.nonlinear[1]].format(*one.nonlinear[2:])
        place = (one.rig.name, one.inertia, one.meaning, one.speed)
        rows.append((*place, *cells, read, names[nearest[i]]))
    # Without the resonance that the text names otherwise.
    rest = [one.speed != 600.0 for one in _COMPARED]
    rms = [np.sqrt(np.mean(part**2, axis=1)) for part in (percent, percent[:, rest])]
    counts = [int(np.sum(nearest == i)) for i in range(len(names))]
    return rows, list(zip(names, counts, *rms, speeds[:, 1] / speeds[:, 0], strict=True))


def _speed(one: Observation, equation: str) -> float:
    """Return the crank speed [rpm] that an equation sets against a quoted one."""
    if equation != "nonlinear":
        return one.predicted(equation)
    name, *what = one.nonlinear
    return reading(BENCHES[name], *what)


class _Deflection:
    """Largest deflections of a rig's coupler over its length, nonlinear and linear."""

    def __init__(self, rig: Rig, crank: float = 1.0) -> None:
        self.system = coupler(rig, _LEAST, crank=crank)
        self.problem = Problem(self.system, "speed", 0.0)
        self.rest = self.motion = first_motion(self.problem)
        self.solver = Solver(self.problem, rig.frequency, 1e-6)

    def nonlinear(self, speed: float) -> float:
        """Return that of the motion next to the last one asked for."""
        self.motion = self.solver.settled(speed, self.motion)
        return self._largest(self.motion)

    def linear(self, speed: float) -> float:
        """Return that of the equation linearised about no deflection."""
        return self._largest(linear_motion(self.problem, speed, self.rest))

    def _largest(self, motion: Motion) -> float:
        watch = self.system.watch
        return float(np.max(watch(motion.at(_TURN)[0]))) if watch else float("nan")


def _bins(ax: Axes) -> Rows:
    """Draw how far the linear deflection of all rigs is off; return a row for each bin."""
    pairs = []
    for rig in RIGS:
        one, mine = _Deflection(rig), []
        for speed in rig.frequency * _SPEEDS:
            try:
                mine.append((one.linear(speed), one.nonlinear(speed)))
            except (Lost, NotFinite):
                break
        linear, bent = np.array(mine).T
        pairs.append((linear, 100.0 * np.abs(bent / linear - 1.0)))
        ax.plot(100.0 * linear, pairs[-1][1], ".", label=rig.name)
    panel_title(ax, "how far the linear deflection is off")
    share, off = np.concatenate(pairs, axis=1)
    rows: Rows = []
    for low, high in pairwise(_BINS):
        inside = off[(share >= low) & (share < high)]
        place = f"{100 * low:g} to {100 * high:g} %"
        rows.append((place, len(inside), np.median(inside), np.max(inside)))
    return rows


def _leaning(rig: Rig, crank: float) -> Sequence[Any]:
    """Return crank, deflection [%], shift of the peak at Omega/2 and of its height [%], the law."""
    one = _Deflection(rig, crank)
    (at, before), (moved, after) = (
        _top(size, 0.5 * rig.frequency) for size in (one.linear, one.nonlinear)
    )
    shift = moved / at - 1.0
    return (crank, 100.0 * after, 100.0 * shift, 100.0 * (after / before - 1.0), shift / after**2)


def _top(size: Callable[[float], float], near: float) -> tuple[float, float]:
    """Return place and height of a maximum within 4 % of a speed."""
    speeds = near * np.linspace(0.96, 1.04, 17)
    place = float(speeds[np.argmax([size(speed) for speed in speeds])])
    width = float(speeds[1] - speeds[0])
    for _ in range(3):  # parabolas, each a fifth as wide
        left, middle, right = (size(place + part * width) for part in (-1.0, 0.0, 1.0))
        place += 0.5 * (left - right) / (left - 2.0 * middle + right) * width
        width *= 0.2
    return place, size(place)
