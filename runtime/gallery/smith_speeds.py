"""Smith's Figs. 82 to 87: charts of the six rigs, quoted speeds, printed and complete equation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import pi
from typing import Any, Literal

import numpy as np

from ..hill import discriminant, perturbation_boundaries
from ..scenes import load_scene
from ..stability.boundary_speeds import speed_boundaries
from .drawing import COLOURS, Array, Axes, Panels, peak
from .records import Drawn, contents
from .smith_linkages import (
    EQUATIONS,
    LBF_IN_S2,
    PROPORTIONS,
    RIG,
    RIGS,
    RPM,
    OfRig,
    Rig,
    end_load,
    linkage_of,
    region_name,
)

_REGIONS = (3, 4, 5, 6, 7, 8)
_TURN = np.linspace(0.0, 2 * pi, 1441)
_FILL = "#f7e3d3"
_LINKAGES = list(dict.fromkeys(rig.linkage for rig in RIGS))
_NAMES = {"reduced": "(6.18)", "printed": "(6.17)", "complete": "complete"}


@dataclass(frozen=True)
class Observation(OfRig):
    """One crank speed that chapter 9 quotes.

    Number of the rig's chart, follower inertia [lbf in s^2], number n of the unstable region
    2 Omega/n that it belongs to (0 for none), speed [rpm] as quoted or the middle of a range, the
    response that it is read from, what the text says of it and how it fixes the inertia, half of
    a range [rpm]; ``nonlinear``: test and reading of the nonlinear equation that are set against
    it.  By its kind it is set against the middle of the region (``resonance``, or a rise
    of amplitude; ``range``: unstable between two speeds), the lower end (``onset``: unstable above
    it) or the upper one (``end``: stable again above it).
    """

    inertia: float
    region: int
    speed: float
    kind: Literal["resonance", "onset", "end", "range", "stable"]
    figure: str
    meaning: str
    note: str = ""
    half_width: float = 0.0
    nonlinear: Sequence[Any] = ()

    @property
    def si_inertia(self) -> float:
        """Follower inertia [kg m^2]."""
        return self.inertia * LBF_IN_S2

    def predicted(self, equation: str) -> float:
        """Return the crank speed [rpm] that an equation sets against it."""
        ends = self.rig.ends(equation, self.si_inertia, (self.region,))
        low, high = (float(v) for v in ends[:, 0, 0] / RPM)
        if self.kind == "onset":
            return low
        return high if self.kind == "end" else 0.5 * (low + high)

    def percent(self, equation: str) -> float:
        """Return the computed speed less the quoted one, in percent of it."""
        return 100.0 * (self.predicted(equation) / self.speed - 1.0)

    @property
    def nearest(self) -> str:
        """The equation that comes nearest."""
        return min(EQUATIONS, key=lambda name: abs(self.predicted(name) - self.speed))


OBSERVATIONS = tuple(Observation(**row) for row in contents("smith")["observation"])
_COMPARED = tuple(one for one in OBSERVATIONS if one.region)


def chart(axes: Panels, figure: str, looks: Mapping[str, Mapping[str, Any]]) -> Drawn:
    """Draw the chart of one rig."""
    rig, ax = RIG[figure], axes[0]
    low, high = (end / RPM for end in load_scene(rig.scene).get("chart.x_range"))
    least, greatest = load_scene(rig.scene).get("chart.y_range")
    inertia = np.linspace(least, greatest, 61)
    _boundaries(ax, rig, inertia, high, looks)
    seen = [one for one in OBSERVATIONS if one.chart == figure]
    for one in seen:
        half = one.half_width or None
        ax.errorbar(1e3 * one.si_inertia, one.speed, half, **looks["all"], **looks[one.kind])
    _margins(ax, rig, (low, high))
    ax.set(xlim=(1e3 * least, 1e3 * greatest), ylim=(low, high))
    compared = [one for one in seen if one.region]
    sizes = order_sizes(rig)
    values = [one.predicted("complete") for one in compared]
    values += [max(sizes[name] for name in ("phi", "eps1 f1", "eps2 f2")), *_claims(rig)]
    rows = [
        (
            f"Fig. {one.figure}",
            one.meaning + (f" ({one.note})" if one.note else ""),
            one.inertia,
            region_name(one.region),
            one.speed,
            *(f"{one.predicted(name):.1f} ({one.percent(name):+.1f} %)" for name in EQUATIONS),
        )
        for one in compared
    ]
    return Drawn(values, tables=[rows] if seen else ())


def _boundaries(
    ax: Axes, rig: Rig, inertia: Array, high: float, looks: Mapping[str, Mapping[str, Any]]
) -> None:
    across = 1e3 * inertia
    # Beyond the picture every value does; infinite ones cannot be drawn.
    thesis, complete = (
        np.minimum(rig.ends(name, inertia, _REGIONS) / RPM, 10 * high)
        for name in ("reduced", "complete")
    )
    ax.fill_between([], [], color=_FILL, label="complete equation, unstable")
    for i, n in enumerate(_REGIONS):
        ax.fill_between(across, complete[0, i], complete[1, i], color=_FILL, lw=0)
        look = looks["odd" if n % 2 else "even"]
        for k in (0, 1):
            ax.plot(across, complete[k, i], color=COLOURS[1], lw=0.8)
            ax.plot(across, thesis[k, i], color=COLOURS[0], lw=1.3, **look)


def _margins(ax: Axes, rig: Rig, window: tuple[float, float]) -> None:
    """Set the measured inertias along the top, fractions of the frequency at the right."""
    for value in rig.inertias:
        ax.axvline(1e3 * value, color="0.85", lw=0.6, zorder=0)
    top, right = ax.secondary_xaxis("top"), ax.secondary_yaxis("right")
    names = [f"{value / LBF_IN_S2:.4f}" for value in rig.inertias]
    top.set_xticks(1e3 * rig.inertias, names, rotation=60, fontsize=7, ha="left")
    top.set_xlabel(r"measured inertias [lbf in s$^2$]", fontsize=8)
    speeds = {n: 2 * rig.frequency / n / RPM for n in range(2, 10)}
    shown = {n: speed for n, speed in speeds.items() if window[0] <= speed <= window[1]}
    right.set_yticks(list(shown.values()), [region_name(n) for n in shown], fontsize=8)
    right.set_ylabel("fractions of the coupler frequency", fontsize=8)


def order_sizes(rig: Rig) -> dict[str, float]:
    """Return the peak of each periodic term over that of the follower's, at the least inertia.

    Keys ``phi``, ``eps1 f1``, ``eps2 f2`` are the terms of (6.17); ``eps2 cos23`` and
    ``(pi^2/3 - 1/4) phi`` those that it leaves out of the first mode's equation.
    """
    follower = peak(rig.function("reduced", float(rig.inertias[0]))(_TURN))
    return {name: peak(term) / follower for name, term in _terms(rig.linkage, _TURN).items()}


def _terms(linkage: str, theta: Array) -> dict[str, Array]:
    links = linkage_of(linkage)
    parts, eps2 = end_load(links, theta), pi**2 * links.crank / (2 * links.coupler)
    return {
        "phi": parts["phi"],
        "eps1 f1": pi**2 / 3 * parts["f1"],
        "eps2 f2": eps2 * parts["f2"],
        "eps2 cos23": eps2 * parts["cos23"],
        "(pi^2/3 - 1/4) phi": (pi**2 / 3 - 0.25) * parts["phi"],
    }


def _claims(rig: Rig) -> list[float]:
    damping = []
    for row in contents("smith")["estimate"]:
        if row["chart"] == rig.figure:
            # K by (7.51), ``mu sqrt(a_n^2 + b_n^2)/(2 n)``, half way between two inertias.
            n, middle = row["region"], 0.5 * (row["stable"] + row["unstable"]) * LBF_IN_S2
            damping.append(float(rig.function("reduced", middle).amplitudes[n]) / (2 * n))
    if rig.figure == "82":
        speed = 230.0 * RPM
        ratio = rig.decrements[0] / (2 * pi) * rig.frequency / speed
        halves = [
            discriminant(rig.function("complete", i), (rig.frequency / speed) ** 2, 1.0, ratio)
            for i in rig.inertias
        ]
        return [max(float(abs(half.value) / half.level) for half in halves), *damping]
    quoted = {"83": [26.0 * 3.0 / 4.0], "84": [100.0 * (26.5 / 26.0 - 1.0)]}
    return quoted.get(rig.figure, damping)


def equations_table(axes: Panels) -> Drawn:
    """Draw the deviation of each equation from each quoted speed; give the tables."""
    ax, places = axes[0], np.arange(len(_COMPARED))
    for equation, marker in zip(EQUATIONS, "os^", strict=True):
        values = [one.percent(equation) for one in _COMPARED]
        ax.plot(values, places, marker, ms=5, label=_NAMES[equation])
    ax.axvline(0.0, color="0.4", lw=0.8)
    names = [
        f"{one.rig.name}, I {one.inertia:.4f}, {region_name(one.region)}: "
        f"{one.speed:.0f} rpm ({one.kind})"
        for one in _COMPARED
    ]
    ax.set_yticks(places, names, fontsize=7)
    ax.invert_yaxis()
    peaks: list[Sequence[Any]] = [
        [rig.name, *order_sizes(rig).values(), _ratio(rig.linkage)] for rig in RIGS
    ]
    others = [name for name in PROPORTIONS if name not in _LINKAGES]
    peaks += [[f"{name}, no rig", *[""] * 5, _ratio(name)] for name in others]
    observed = []
    for one in _COMPARED:
        speeds = (one.speed, *(one.predicted(name) for name in EQUATIONS), _NAMES[one.nearest])
        place = (one.rig.name, one.inertia, region_name(one.region), one.meaning)
        observed.append((*place, *speeds))
    moved, shifts, further = _shifts()
    count = sum(one.nearest == "complete" for one in _COMPARED)
    words: dict[str, object] = {
        "ratios": " and ".join(f"{_ratio(name):.2f}" for name in _LINKAGES),
        "count": count,
        "all": len(_COMPARED),
        "least": np.min(shifts),
        "most": np.max(shifts),
        "second": np.max(further),
    }
    for name in EQUATIONS:
        words |= zip((f"plain_{name}", f"fitted_{name}", f"edge_{name}"), _rms(name), strict=True)
    trends = (later / first for first, later in (_trend("first order"), _trend("complete")))
    numbers = (min(map(_ratio, _LINKAGES)), count / len(_COMPARED), *trends)
    return Drawn(numbers, words, (peaks, moved, observed, _summary()))


def _ratio(linkage: str) -> float:
    """Return the peak of the coupler part that (6.17) leaves out over that of the one it keeps."""
    phi, f1, f2, tension, more = _terms(linkage, _TURN).values()
    return peak(tension + more) / peak(f1 + f2 - phi)


def _shifts() -> tuple[list[Sequence[Any]], Array, Array]:
    """Return the ends of the unstable regions and how far they move, as a table and in rpm."""
    # In rpm: by the complete equation, and further by the second mode.

    def pair(values: Array) -> str:
        # Zero without a sign.
        low, high = (round(float(value), 1) + 0.0 for value in values)
        return f"{low:+.1f}, {high:+.1f}"

    rows: list[Sequence[Any]] = []
    shifts, further = [], []
    for rig in RIGS:
        # Those that the thesis observed with this linkage.
        regions = (3, 4, 5) if rig.linkage == "(10,1,10,4)" else (4, 5, 6)
        for inertia in (float(rig.inertias[0]), float(rig.inertias[-1])):
            ends = [rig.ends(name, inertia, regions)[..., 0] / RPM for name in EQUATIONS]
            for i, n in enumerate(regions):
                base, printed, complete = (values[:, i] for values in ends)
                shifts.append(complete - base)
                further.append(two_modes(rig, inertia, n) / RPM - complete)
                place = (rig.name, inertia / LBF_IN_S2, region_name(n))
                moves = (pair(move) for move in (printed - base, shifts[-1], further[-1]))
                rows.append((*place, f"{base[0]:.1f} to {base[1]:.1f}", *moves))
    return rows, np.abs(shifts), np.abs(further)


def two_modes(rig: Rig, inertia: float, n: int) -> Array:
    """Return the ends [rad/s] of a region of the first mode where the second is coupled with it."""
    alone = rig.ends("complete", inertia, (n,))[:, 0, 0]
    ends = speed_boundaries(
        rig.system("complete", 2),
        1 if n % 2 == 0 else -1,
        speed_range=(0.985 * float(alone[0]), 1.015 * float(alone[1])),
        follower_inertia=inertia,
    )
    share = np.sum(ends.cosine[..., 0] ** 2 + ends.sine[..., 0] ** 2, axis=-1)
    first = ends.speed[share > 0.5]
    return np.array([first[np.argmin(np.abs(first - end))] for end in alone])


@lru_cache(maxsize=4)
def _rms(equation: str) -> tuple[float, float, float]:
    """Return the root mean square deviation [%], with one frequency per coupler fitted, of edges.

    Edges are the speeds at which the motion becomes unstable or stable.
    """
    gaps = np.array([one.percent(equation) for one in _COMPARED])
    couplers = np.array([one.rig.thickness for one in _COMPARED])
    fitted = gaps - [np.mean(gaps[couplers == one]) for one in couplers]
    edges = gaps[[one.kind in {"onset", "end"} for one in _COMPARED]]
    plain, own, of_edges = (float(np.sqrt(np.mean(part**2))) for part in (gaps, fitted, edges))
    return plain, own, of_edges


def _summary() -> list[Sequence[Any]]:
    rows: list[Sequence[Any]] = []
    for name in EQUATIONS:
        count = sum(one.nearest == name for one in _COMPARED)
        errors = (f"{error:.1f} %" for error in _rms(name)[:2])
        rows.append((_NAMES[name], count, *errors, *_trend(name)))
    rows.append(("(6.18), first order", "", "", "", *_trend("first order")))
    rows.append(("quoted", "", "", "", "250", "220"))
    return rows


def _trend(equation: str) -> Array:
    """Return the middles of Omega/3 [rpm] at the least and the greatest inertia."""
    rig = RIG["82"]
    ends = rig.inertias[[0, -1]]
    if equation != "first order":
        return np.asarray(np.mean(rig.ends(equation, ends, (6,))[:, 0] / RPM, axis=0))
    # The larger inertia is beyond what first order may be trusted with: as Smith did all the same.
    bounds = perturbation_boundaries(rig.function("reduced", 1.0), ends, (6,), outside="value")
    speeds = rig.frequency / np.sqrt(np.stack([bounds.lower[0], bounds.upper[0]])) / RPM
    return np.asarray(np.mean(speeds, axis=0))
