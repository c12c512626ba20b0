"""Smith's rigs further: damping read from unstable regions (9.5.5), regions of two modes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.periodic_function import PeriodicFunction
from ..hill import critical_damping, perturbation_boundaries
from ..hill.bloch import effective_operator
from ..periodic import FloquetMultipliers, floquet_multipliers
from ..stability import stability_edges
from .drawing import Array, Looks, Panels, panel_title
from .records import Drawn, contents
from .smith_linkages import LBF_IN_S2, RIG, RPM, OfRig, region_name


@dataclass(frozen=True)
class Estimate(OfRig):
    """One damping that section 9.5.5 quotes, of the unstable region 2 Omega/n of a chart's rig.

    ``stable`` and ``unstable`` are follower inertias [lbf in s^2] between which the region opens:
    stated in the thesis for the first estimate, the measured neighbours for which its formula gives
    its value else; ``quoted`` is K as the thesis gives it.
    """

    region: int
    stable: float
    unstable: float
    quoted: float

    @property
    def name(self) -> str:
        """Chart and region in a few words."""
        return f"Fig. {self.chart}, {region_name(self.region)}"

    def both(self, equation: str, order: int | None) -> tuple[float, float]:
        """Return the critical damping at the two inertias."""
        low, high = (critical(self, i, equation, order) for i in (self.stable, self.unstable))
        return low, high

    @property
    def at_rest(self) -> tuple[float, float]:
        """K from the logarithmic decrements measured at rest, at the speed of the region.

        A decrement d is a rate ``d Omega / 2 pi`` in time: ``K = d Omega / (2 pi omega_2)``.
        """
        place = critical_damping(self.at_stable, 1.0, (self.region,)).lam2[0]
        least, _, most = self.rig.decrements
        factor = float(np.sqrt(place)) / (2.0 * pi)
        return least * factor, most * factor

    @property
    def at_stable(self) -> PeriodicFunction:
        """The coefficient of (6.18) at the stable inertia."""
        return self.rig.function("reduced", self.stable * LBF_IN_S2)


ESTIMATES = tuple(Estimate(**row) for row in contents("smith")["estimate"])


@lru_cache(maxsize=512)
def critical(estimate: Estimate, inertia: float, equation: str, order: int | None) -> float:
    """Return the damping K at which the region of an estimate closes, at an inertia [lbf in s^2].

    By ``reduced``, (6.18), the equation of the thesis' charts, or ``complete``.
    """
    f = estimate.rig.function(equation, inertia * LBF_IN_S2)
    return closing(f, estimate.region, order)


def closing(f: PeriodicFunction, n: int, order: int | None) -> float:
    """Return the damping K at which region n of a coefficient closes.

    To an order of the perturbation, whether or not it converges at so large a parameter, NaN where
    that order leaves the region open at any damping, or exactly (None).
    """
    if order is None:
        return float(critical_damping(f, 1.0, (n,)).damping[0])
    # Up to K = 0.5, several times what was measured.
    scan = np.linspace(0.0, 0.5, 5001)
    points = np.stack([np.ones_like(scan), scan])
    a, b = effective_operator((f,), n, order, damped=True).components(points)
    left = np.abs(b.sum(axis=0)) - np.abs(a.sum(axis=0).imag)
    (crossings,) = np.nonzero((left[:-1] > 0.0) & (left[1:] <= 0.0))
    if not crossings.size:
        return float("nan")
    beside = crossings[0] + np.array([1, 0])
    return float(np.interp(0.0, left[beside], scan[beside]))


def estimates_table(axes: Panels, looks: Looks) -> Drawn:
    """Draw the damping that closes each region over the follower's inertia."""
    values = []
    for ax, one in zip(axes, ESTIMATES, strict=True):
        measured = one.rig.inertias / LBF_IN_S2
        inertia = np.linspace(0.95 * measured[0], 1.02 * measured[-1], 31)
        ways = (("reduced", 1), ("reduced", 2), ("reduced", None), ("complete", None))
        for way, look in zip(ways, looks, strict=True):
            damping = [critical(one, float(value), *way) for value in inertia]
            ax.plot(inertia, damping, **look)
        ax.fill_between(inertia, *one.at_rest, color="0.92", lw=0, label="decrements at rest")
        ax.hlines(one.quoted, one.stable, one.unstable, color="black", lw=3.0, label="quoted")
        panel_title(ax, f"{one.name}, {one.rig.name}")
        values.append(0.5 * sum(one.both("reduced", 1)))
    return Drawn(values, _estimate_words(), [_estimates()])


def _estimates() -> list[list[str]]:
    """Return the damping that closes each region, by each order and exactly."""

    def span(one: Estimate, equation: str, order: int | None) -> str:
        ends = one.both(equation, order)
        return "-".join("none" if np.isnan(end) else f"{end:.3f}" for end in ends)

    def by_order(one: Estimate, order: int) -> str:
        """Return the span, starred where the order does not converge at the stable inertia."""
        f, numbers = one.at_stable, (one.region,)
        closing = critical_damping(f, 1.0, numbers).damping[0]
        outside = perturbation_boundaries(f, 1.0, numbers, order, closing).outside[0]
        return span(one, "reduced", order) + ("*" if outside else "")

    rows = []
    for one in ESTIMATES:
        cells = [one.name, f"{one.stable:g}-{one.unstable:g}", f"{one.quoted:g}"]
        cells += [by_order(one, order) for order in (1, 2, 3, 4, 6)]
        cells += [span(one, name, None) for name in ("reduced", "complete")]
        rows.append([*cells, "-".join(f"{end:.2f}" for end in one.at_rest)])
    return rows


def _exact_over_first(estimate: Estimate, hertz: float) -> float:
    """Return exact over first-order K of (6.18), were the coupler's frequency another one [Hz]."""
    rig = estimate.rig
    lighter = (rig.frequency / (2.0 * pi * hertz)) ** 2
    mass = lighter * float(rig.system("reduced").parameters["mass_per_length"])
    first, exact = 0.0, 0.0
    for inertia in (estimate.stable, estimate.unstable):
        f = rig.function("reduced", inertia * LBF_IN_S2, mass_per_length=mass)
        first += closing(f, estimate.region, 1)
        exact += closing(f, estimate.region, None)
    return exact / first


def _estimate_words() -> dict[str, object]:
    def texts(values: Sequence[float], digits: int = 3) -> str:
        parts = [f"{value:.{digits}f}" for value in values]
        return f"{', '.join(parts[:-1])} and {parts[-1]}"

    def spread(values: Sequence[float]) -> float:
        return max(values) / min(values)

    first, exact, complete = (
        [0.5 * sum(one.both(name, order)) for one in ESTIMATES]
        for name, order in (("reduced", 1), ("reduced", None), ("complete", None))
    )
    spans = [end for one in ESTIMATES for end in one.both("reduced", None)]
    middles = [0.5 * sum(one.at_rest) for one in ESTIMATES]
    third = ESTIMATES[2]
    third_ratios = [_exact_over_first(third, hertz) for hertz in (12.2, 13.25)]
    return {
        "third": texts(third_ratios, 1),
        "exact": texts(exact),
        "first": texts(first),
        "ratio": texts([b / a for a, b in zip(first, exact, strict=True)], 1),
        "complete": texts(complete),
        "exact_spread": spread(exact),
        "first_spread": spread(first),
        "complete_spread": spread(complete),
        "low": min(spans),
        "high": max(spans),
        "rest": texts([a / b for a, b in zip(middles, complete, strict=True)], 1),
        "quoted": texts([a / one.quoted for a, one in zip(middles, ESTIMATES, strict=True)], 1),
    }


# The second mode: charts of the 1/16 in coupler, the least and greatest inertia [lbf in s^2].
_CASES = tuple((chart, inertia) for chart in ("84", "87") for inertia in (0.0058, 0.0190))


class _Region(NamedTuple):
    """One unstable region in rpm, and what the lowest measured decrement leaves of its width."""

    kind: str
    label: str
    lower: float
    upper: float
    width: float
    damped: float

    @property
    def middle(self) -> float:
        return 0.5 * (self.lower + self.upper)


@lru_cache(maxsize=16)
def regions(chart: str, inertia: float) -> tuple[list[_Region], int]:
    """Return the open regions at an inertia [lbf in s^2], widest first, and how many are closed.

    Regions that reach beyond the range, with an end that is not known, are left out.
    """
    rig = RIG[chart]
    speeds = (0.45 * rig.frequency, 0.95 * rig.frequency)
    bare = stability_edges(rig.system(modes=2), speeds, follower_inertia=inertia * LBF_IN_S2)
    width = bare.width
    kept = np.flatnonzero(width > 2.0 * bare.error)
    left = _left_by_damping(chart, inertia, bare.lower[kept], width[kept])
    opened = []
    for i, share in zip(kept.tolist(), left.tolist(), strict=True):
        low, high = float(bare.lower[i]) / RPM, float(bare.upper[i]) / RPM
        kind = bare.kind[i]
        if kind == "principal":
            kind = f"principal {bare.modes[i, 0]}"
        opened.append(_Region(kind, bare.labels[i], low, high, high - low, share * (high - low)))
    opened.sort(key=lambda one: -one.width)
    return opened, int(np.count_nonzero(width <= 2.0 * bare.error))


def _left_by_damping(chart: str, inertia: float, lower: Array, width: Array) -> Array:
    """Return the share of each region in which its own multiplier grows despite the damping."""
    # A region may lie within another one: what counts is that more multipliers are outside the unit
    # circle within it than on either side of it.
    places = np.concatenate([[-0.03, 1.03], np.linspace(0.0, 1.0, 27)[1:-1]])
    speeds = lower[:, None] + width[:, None] * places
    motion = _damped(chart, inertia, 2, speeds.ravel())
    outside = np.abs(motion.multipliers) > 1.0 + motion.error
    growing = np.sum(outside, axis=-1).reshape(speeds.shape)
    beside = np.min(growing[:, :2], axis=1)
    return np.asarray(np.mean(growing[:, 2:] > beside[:, None], axis=1))


def _damped(chart: str, inertia: float, modes: int, speeds: ArrayLike) -> FloquetMultipliers:
    """Return the multipliers with the lowest logarithmic decrement that was measured at rest."""
    system = RIG[chart].system(modes=modes, decrement=RIG[chart].decrements[0])
    return floquet_multipliers(system, speeds, follower_inertia=inertia * LBF_IN_S2)


def modes_table(axes: Panels, looks: Mapping[str, Mapping[str, Any]]) -> Drawn:
    """Draw the widths of all regions of two modes over the crank speed."""
    tables, titles = [], []
    for ax, (chart, inertia) in zip(axes, _CASES, strict=True):
        opened, closed = regions(chart, inertia)
        for kind, look in looks.items():
            chosen = [one for one in opened if one.kind == kind and np.isfinite(one.width)]
            if not chosen:
                continue
            middles, widths, damped = np.array([(r.middle, r.width, r.damped) for r in chosen]).T
            ax.plot(middles, widths, "o", mfc="none", **look)
            ax.plot(middles[damped > 0.0], damped[damped > 0.0], "o", color=look["color"], ms=4)
        panel_title(ax, f"{RIG[chart].name}, {inertia:g} lbf in s²")
        tables.append([(*one[1:5], one.damped or "closed") for one in opened[:10]])
        rest = f"; {len(opened) - 10} narrower, {closed} closed" if len(opened) > 10 else ""
        titles.append(
            f"{RIG[chart].name}, follower inertia {inertia:g} lbf in s²: widest regions{rest}"
        )
    return Drawn(words={**_mode_words(), "titles": titles}, tables=tables)


def _mode_words() -> dict[str, object]:
    every = [(case, one) for case in _CASES for one in regions(*case)[0]]
    sums = [one for _, one in every if one.kind == "sum"]
    others = [(case, one) for case, one in every if one.kind != "principal 1"]
    alive = [(case, one) for case, one in others if one.damped > 0.0]
    widest = [next(pair for pair in others if pair[0] == case) for case in _CASES]
    parts = [
        f"{RIG[chart].name} at {inertia:g}: {one.label}, {one.width:.2g} rpm"
        for (chart, inertia), one in widest
    ]
    return {
        "decrement": RIG[_CASES[0][0]].decrements[0],
        "widest": "; ".join(parts),
        "sums": len(sums),
        "sums_left": sum(one.damped > 0.0 for one in sums),
        "differences": sum(one.kind == "difference" for _, one in every),
        "alive": len(alive),
        # Where the damped first mode alone is stable in the middle of the region.
        "added": sum(bool(np.all(_damped(*c, 1, r.middle * RPM).stable)) for c, r in alive),
    }
