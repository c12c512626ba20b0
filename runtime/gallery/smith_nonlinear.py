"""Smith's Figs. 62 to 78 and all speeds of chapter 9 by the nonlinear equation of the coupler.

And how far the linear equation suffices.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import pi
from typing import Any, NamedTuple, cast

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import find_peaks

from ..core.families import Nonlinear
from ..nonlinear import ResponseCurve, SweepResponse, response_curve, sweep_response
from ..nonlinear.orbit import Lost, Solver
from ..nonlinear.response import first_motion, linear_motion
from ..nonlinear.segments import Motion, NotFinite, Problem
from ..scenes import load_scene
from .drawing import COLOURS, Array, Axes, Panels, mark_fractions, panel_title
from .records import Drawn, contents
from .smith_linkages import LBF_IN_S2, RIG, RIGS, RPM, Rig
from .smith_responses import Response, response
from .smith_speeds import OBSERVATIONS, Observation

_MM = 1e3
_WAYS = {True: "run up", False: "run down"}


def coupler(
    rig: Rig, inertia: float, decrement: float = 0.0, modes: int = 1, crank: float = 1.0
) -> Nonlinear:
    """Return the inextensible coupler of a rig.

    Follower inertia [lbf in s^2], logarithmic decrement or that taken for the rig, length of the
    crank over the rig's.
    """
    scene = load_scene(rig.scene)
    changes = {
        "model.formulation": "inextensible",
        "model.modes": modes,
        "coupler.damping_ratio": (decrement or rig.decrement) / (2 * pi),
        "follower.inertia": inertia * LBF_IN_S2,
        "links.crank": crank * scene["links"]["crank"],
    }
    return cast("Nonlinear", load_scene(rig.scene, overrides=changes).system())


@dataclass(frozen=True)
class Bench(Response):
    """A rig on the test bench, for the nonlinear equation.

    Revolutions after which motions may repeat; ends of the slow test, its rate [rpm/s] and what
    disturbs q1 and its rate in each revolution; the decrement where not the rig's, and how many
    modes.
    """

    turns: int = 1
    first: float = 0.0
    last: float = 0.0
    rate: float = 0.0
    kicks: float = 1e-3
    decrement: float = 0.0
    modes: int = 1

    @property
    def system(self) -> Nonlinear:
        """The coupler."""
        return coupler(self.rig, self.inertia, self.decrement, self.modes)

    def reading(self, kind: str, order: int = 0) -> float:
        """Return the speed [rpm] at which something happens by the branches of a test.

        ``rise`` and ``fall``: the first and the second fold along the first branch, which a rising
        and a falling speed reach; ``two turns fall``: the lowest fold of two turns; ``onset``,
        ``end``: where the motion of one turn begins and ends to double, ``middle`` between them;
        ``peak``: the maximum of its order-th harmonic that is nearest to Omega/order.
        """
        found = specials(self)
        doublings = [p.speed for p in found if (p.kind, p.turns) == ("doubling", 1)]
        if kind in ("rise", "fall"):
            folds = [point.speed for point in found if (point.kind, point.branch) == ("fold", 0)]
            return folds[("rise", "fall").index(kind)]
        if kind == "two turns fall":
            return min(p.speed for p in found if (p.kind, p.turns) == ("fold", 2))
        if kind == "peak":
            return self._peak(order)
        ends = {"onset": min(doublings), "end": max(doublings)}
        return ends.get(kind, 0.5 * (ends["onset"] + ends["end"]))

    def _peak(self, order: int) -> float:
        curve, shown, turn = branches(self), self.system.shown, np.linspace(0.0, 2 * pi, 65)[:-1]
        first = np.flatnonzero(curve.branch == 0)
        lower = first[: np.argmin(np.append(curve.stable[first], False))]
        bent = [shown(curve.orbits[i].motion.at(turn)[0]) for i in lower]
        sizes, speed = np.abs(np.fft.rfft(bent, axis=-1))[:, order], curve.value[lower]
        size = CubicSpline(speed, sizes)
        flat = size.derivative().roots(extrapolate=False)
        tops = flat[size(flat, 2) < 0.0]
        return float(tops[np.argmin(np.abs(tops - self.rig.frequency / order))]) / RPM

    def other(self, name: str, kind: str) -> float:
        """Return a reading of another test."""
        return BENCHES[name].reading(kind)

    def apart(self, first: str, second: str) -> float:
        """Return one reading less another [rpm]."""
        return self.reading(first) - self.reading(second)

    def _amplitudes(self, speed: float) -> list[tuple[int, bool, float]]:
        """Return revolutions, stability and deflection [mm] of each motion at a speed [rpm]."""
        curve, found = branches(self), []
        value = curve.value - speed * RPM
        for i in np.flatnonzero((value[:-1] * value[1:] <= 0.0) & (np.diff(curve.branch) == 0)):
            share = value[i] / (value[i] - value[i + 1])
            before, after = curve.peak_to_peak[i : i + 2]
            size = _MM * float(before + share * (after - before))
            found.append((int(curve.turns[i]), bool(np.all(curve.stable[i : i + 2])), size))
        return found

    def stable(self, speed: float, *turns: int) -> float:
        """Return how many stable motions of so many turns there are at a speed [rpm]."""
        return sum(holds and count in turns for count, holds, _ in self._amplitudes(speed))

    def greater(self, fall: str, rise: str) -> float:
        """Return the largest stable deflection between two readings over that at the second."""
        low, high = self.reading(fall), self.reading(rise)
        curve = branches(self)
        inside = curve.stable & (curve.value >= low * RPM) & (curve.value <= high * RPM)
        largest = _MM * float(np.max(curve.peak_to_peak[inside]))
        return largest / max(size for _, holds, size in self._amplitudes(high) if holds)


BENCHES = {name: Bench(**row) for name, row in contents("smith")["bench"].items()}


@lru_cache(maxsize=32)
def branches(one: Bench) -> ResponseCurve:
    """Return the periodic motions over the range of the speed."""
    bounds = (one.low * RPM, one.high * RPM)
    return response_curve(one.system, "speed", bounds, turns=one.turns, rtol=1e-6)


@lru_cache(maxsize=32)
def slow_test(one: Bench) -> SweepResponse:
    """Return the motion while the speed rises slowly and falls again."""
    bounds = (one.first * RPM, one.last * RPM)
    return sweep_response(one.system, bounds, one.rate * RPM, kicks=one.kicks, rtol=1e-6)


class Special(NamedTuple):
    """A special point: kind, branch, revolutions, speed [rpm], deflection [mm, peak to peak]."""

    kind: str
    branch: int
    turns: int
    speed: float
    size: float


def specials(one: Bench) -> list[Special]:
    """Return the special points, in their order along the branches."""
    curve = branches(one)
    number = curve.special_branch
    turns = [int(curve.turns[curve.branch == at][0]) for at in number]
    speeds = (curve.special_value / RPM).tolist()
    sizes = (_MM * (curve.special_highest - curve.special_lowest)).tolist()
    rows = zip(curve.special, number.tolist(), turns, speeds, sizes, strict=True)
    return [Special(*row) for row in rows]


class _Way(NamedTuple):
    """One way of a slow test: speeds [rpm] rising, extremes of the deflection [mm]."""

    speed: Array
    lowest: Array
    highest: Array

    @property
    def size(self) -> Array:
        return self.highest - self.lowest

    def within(self, low: float, high: float) -> _Way:
        inside = (self.speed >= low) & (self.speed <= high)
        return _Way(*(part[inside] for part in self))

    def largest(self, low: float, high: float) -> float:
        """Return the speed [rpm] of the largest deflection within a range."""
        way = self.within(low, high)
        return float(way.speed[np.argmax(way.size)])

    def beats(self, low: float, high: float) -> float:
        """Return how many maxima the upper edge of the trace has within a range."""
        edge = self.within(low, high).highest
        return len(find_peaks(edge, prominence=0.01 * np.ptp(edge))[0])

    def level(self, below: float, above: float) -> float:
        """Return how far the mean level moves between two speeds, over the largest deflection."""
        mean = np.interp([below, above], self.speed, 0.5 * (self.lowest + self.highest))
        return float(abs(mean[1] - mean[0]) / np.max(self.within(below, above).size))


def _way(one: Bench, rising: bool) -> _Way:
    test = slow_test(one)
    at = np.flatnonzero(test.rising == rising)
    at = at[np.argsort(test.speed[at])]
    return _Way(test.speed[at] / RPM, _MM * test.lowest[at], _MM * test.highest[at])


def trace(
    axes: Panels,
    linear: Sequence[Any],
    name: str,
    rising: bool,
    traced: Sequence[Sequence[Any]],
    claims: Sequence[Sequence[Any]],
) -> Drawn:
    """Draw a recorded response: by the linear equation above, the slow test below.

    ``linear``: what :func:`.response` takes; name of the test and which way the speed goes; what
    section 9.5.3 says of the trace and of the test, as methods of both and what these take.
    """
    values = list(response(axes[:1], *linear).values)
    one, ax, (low, high) = BENCHES[name], axes[1], linear[2:4]
    way = _way(one, rising)
    label = f"{_WAYS[rising]}, {one.rate:g} rpm/s"
    ax.fill_between(way.speed, way.lowest, way.highest, color="#cfdce8", lw=0, label=label)
    curve = branches(one)
    curve.draw(ax, curve.lowest, curve.highest)
    seen = way.within(low, high)
    ax.set(xlim=(low, high), ylim=(1.2 * np.min(seen.lowest), 1.2 * np.max(seen.highest)))
    marks = one.rig.frequency / RPM, range(1, 13), "Ω/{}", (low, high)
    mark_fractions(ax, *marks, low=False)
    panel_title(axes[0], "complete linear equation")
    panel_title(ax, f"nonlinear equation, decrement {one.rig.decrement:g}")
    values += [getattr(way, method)(*given) for method, *given in traced]
    return Drawn([*values, *(getattr(one, method)(*given) for method, *given in claims)])


def figure_64(axes: Panels, name: str, speed: float) -> Drawn:
    """Draw the vibration of two turns at a speed [rpm]."""
    one, ax = BENCHES[name], axes[0]
    curve = branches(one)
    at = np.flatnonzero((curve.turns == 2) & curve.stable)
    near = curve.orbits[at[np.argmin(np.abs(curve.value[at] - speed * RPM))]]
    solver = curve.source
    motion = solver.settled(speed * RPM, near.motion)
    orbit, _ = solver.fine(speed * RPM, motion, solver.along_parameter(motion))
    theta = np.linspace(0.0, 4 * pi, 721)
    bent = _MM * one.system.shown(orbit.motion.at(np.mod(theta, 4 * pi))[0])
    ax.plot(np.degrees(theta), bent)
    turns = np.max(np.abs(bent[:361] - bent[360:])) / np.ptp(bent)
    return Drawn([orbit.motion.turns, turns, abs(orbit.multipliers[0])])


def figure_69(axes: Panels, name: str, speeds: Sequence[float]) -> Drawn:
    """Draw the peak-to-peak deflection, both ways; count the amplitudes at speeds [rpm]."""
    one, ax = BENCHES[name], axes[0]
    curve = branches(one)
    for rising, mark, colour in ((True, "o", COLOURS[2]), (False, "s", COLOURS[1])):
        way = _way(one, rising)
        # Every eighth revolution, and the larger of two: a motion of two turns alternates.
        size = np.maximum(way.size[:-1], way.size[1:])
        ax.plot(way.speed[:-1:8], size[::8], mark, ms=2.5, color=colour, label=_WAYS[rising])
    curve.draw(ax, curve.peak_to_peak)
    linear = _MM * (curve.linear_highest - curve.linear_lowest)
    ax.plot(curve.linear_value / RPM, linear, color="0.6", lw=0.8, label="linear")
    ax.set(
        xlim=(one.first, one.last),
        ylim=(0.0, 1.1 * max(np.max(_way(one, way).size) for way in _WAYS)),
    )
    half = 0.55 * one.rig.frequency
    values = curve.linear_value, curve.value[curve.stable & (curve.turns == 1)]
    heights = linear, curve.peak_to_peak[curve.stable & (curve.turns == 1)]
    tops = [v[np.argmax(np.where(v < half, h, 0.0))] for v, h in zip(values, heights, strict=True)]
    counts = [one.stable(speed, 1, 2) for speed in speeds]
    return Drawn([*counts, float(tops[1] - tops[0]) / RPM])


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
    moved = [abs(float(np.diff([one.reading(kind) for one in both])[0])) for kind in kinds]
    share = summary[-1][1] / len(_COMPARED)
    words: dict[str, object] = {
        "count": summary[-1][1],
        "all": len(_COMPARED),
        "entered": BENCHES["softening"].reading("rise"),
        "lost": BENCHES["softening"].reading("onset"),
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
    return BENCHES[name].reading(*what)


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
