"""Smith's first suggestion for further study: what the second mode does to the rigs' stability.

All unstable regions of two modes of the coupler by the complete equation, principal and
combination, each with its edges, undamped and with the damping measured at rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from ..hill import hill_boundaries
from ..periodic import floquet_multipliers
from ..scenes import load_scene
from ..stability import StabilityEdges, stability_edges
from .records import Drawn, Quoted, Table
from .smith_linkages import LBF_IN_S2, RIG, RPM, Array, Rig
from .style import COLOURS, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..core.families import LinearPeriodic

# Charts of the 1/16 in coupler, and the least and greatest inertia [lbf in s^2].
_CHARTS = ("84", "87")
_INERTIAS = (0.0058, 0.0190)
# Range of speeds over the first natural frequency.
_SPAN = (0.45, 0.95)
_SHOWN = 10
# Speeds in each region at which the damped system is looked at.
_INSIDE = 25
# Regions of the first mode alone, and how near to them, of the speed, those of two modes begin.
_NUMBERS = (2, 3, 4, 5, 6)
_NEAR = 0.005
_COLOUR = {"principal 1": COLOURS[0], "principal 2": COLOURS[1], "sum": COLOURS[3]}


@dataclass(frozen=True)
class _Region:
    """One unstable region in rpm: kind, label, ends without damping, about what damping leaves."""

    kind: str
    label: str
    lower: float
    upper: float
    damped: float

    @property
    def width(self) -> float:
        return self.upper - self.lower


@lru_cache(maxsize=16)
def _system(chart: str, damped: bool, modes: int = 2) -> LinearPeriodic:
    rig = RIG[chart]
    changes: dict[str, object] = {"model.modes": modes}
    if damped:
        changes["coupler.damping_ratio"] = _decrement(rig) / (2.0 * pi)
    return load_scene(rig.scene, overrides=changes).linear_system()


@lru_cache(maxsize=16)
def _edges(chart: str, inertia: float) -> StabilityEdges:
    low, high = (share * RIG[chart].frequency for share in _SPAN)
    return stability_edges(_system(chart, False), (low, high), follower_inertia=inertia * LBF_IN_S2)


def _decrement(rig: Rig) -> float:
    """Return the lowest logarithmic decrement that was measured at rest."""
    return float(load_scene(rig.scene).get("measured.log_decrement")[0])


def regions(chart: str, inertia: float) -> tuple[list[_Region], int]:
    """Return the regions that are open, widest first, and how many are closed.

    Regions that reach beyond the range, with an end that is not known, are left out.

    Parameters
    ----------
    chart : str
        Number of the rig's stability chart.
    inertia : float
        Follower inertia [lbf in s^2].
    """
    bare = _edges(chart, inertia)
    width = bare.upper - bare.lower
    kept = np.flatnonzero(width > 2.0 * bare.error)
    left = _left_by_damping(chart, inertia, bare.lower[kept], width[kept])
    beginnings = _first_mode(chart, inertia)
    first = {
        i: next((n for n, end in beginnings.items() if abs(low - end) < _NEAR * end), 0)
        for i, low in zip(kept.tolist(), (bare.lower[kept] / RPM).tolist(), strict=True)
        if bare.kind[i] == "principal"
    }
    second = [i for i, n in first.items() if not n]
    # Names that are not all of mode 2, counting down with the speed, are guesses.
    certain = bool(np.all(bare.modes[second] == 2) and np.all(np.diff(bare.harmonic[second]) == -1))
    found = []
    for i, share in zip(kept.tolist(), left.tolist(), strict=True):
        low, high = float(bare.lower[i]) / RPM, float(bare.upper[i]) / RPM
        name, label = bare.kind[i], bare.labels[i]
        if first.get(i):
            name, label = "principal 1", f"region {first[i]} of mode 1"
        elif name == "principal":
            name, label = "principal 2", label if certain else "region of mode 2"
        found.append(_Region(name, label, low, high, share * (high - low)))
    found.sort(key=lambda one: -one.width)
    return found, int(np.count_nonzero(width <= 2.0 * bare.error))


def _first_mode(chart: str, inertia: float) -> dict[int, float]:
    """Return the speeds [rpm] at which regions of the first mode alone begin, by number."""
    rig = RIG[chart]
    f = rig.form("complete").function(1.0, follower_inertia=inertia * LBF_IN_S2)
    upper = hill_boundaries(f, 1.0, _NUMBERS).upper
    return {
        n: float(rig.frequency / np.sqrt(end) / RPM)
        for n, end in zip(_NUMBERS, upper.tolist(), strict=True)
        if end > 0.0
    }


def _left_by_damping(chart: str, inertia: float, lower: Array, width: Array) -> Array:
    """Return the share of each region in which its own multiplier grows despite the damping.

    A region may lie within another one: what counts is that more multipliers are outside the unit
    circle within it than on either side of it.
    """
    places = np.concatenate([[-0.03, 1.03], np.linspace(0.0, 1.0, _INSIDE + 2)[1:-1]])
    speeds = lower[:, None] + width[:, None] * places
    found = floquet_multipliers(
        _system(chart, True), speeds.ravel(), follower_inertia=inertia * LBF_IN_S2
    )
    growing = np.sum(np.abs(found.multipliers) > 1.0 + found.error, axis=-1).reshape(speeds.shape)
    beside = np.min(growing[:, :2], axis=1)
    return np.asarray(np.mean(growing[:, 2:] > beside[:, None], axis=1))


def figure_table(axes: Sequence[Axes]) -> Drawn:
    """Draw the widths of all regions over the crank speed."""
    tables, rows = [], []
    cases = [(chart, inertia) for chart in _CHARTS for inertia in _INERTIAS]
    for ax, (chart, inertia) in zip(axes, cases, strict=True):
        found, closed = regions(chart, inertia)
        _panel(ax, found, f"{RIG[chart].name}, {inertia:g} lbf in s²")
        tables.append(_table(chart, inertia, found, closed))
        rows += _rows(chart, inertia, found)
    axes[0].legend(loc="upper left", fontsize=7)
    return Drawn(tuple(rows), tuple(_notes()), tuple(tables))


def _panel(ax: Axes, found: Sequence[_Region], title: str) -> None:
    names = {
        "principal 1": "mode 1",
        "principal 2": "mode 2",
        "sum": "modes 1 and 2, sum",
        "difference": "modes 1 and 2, difference",
    }
    for kind, label in names.items():
        chosen = [one for one in found if one.kind == kind and np.isfinite(one.width)]
        if not chosen:
            continue
        speed = [0.5 * (one.lower + one.upper) for one in chosen]
        colour = _COLOUR.get(kind, COLOURS[2])
        ax.plot(speed, [one.width for one in chosen], "o", mfc="none", color=colour, label=label)
        open_ = [i for i, one in enumerate(chosen) if one.damped > 0.0]
        ax.plot(
            [speed[i] for i in open_], [chosen[i].damped for i in open_], "o", color=colour, ms=4
        )
    ax.set_yscale("log")
    ax.set_ylim(1e-10, 1e3)
    ax.set_xlabel("crank speed [rpm]")
    ax.set_ylabel("width [rpm]")
    panel_title(ax, title)


def _table(chart: str, inertia: float, found: Sequence[_Region], closed: int) -> Table:
    rows = [
        (
            one.label,
            f"{one.lower:.3f}",
            f"{one.upper:.3f}",
            f"{one.width:.3g}",
            f"{one.damped:.2g}" if one.damped > 0.0 else "closed",
        )
        for one in found[:_SHOWN]
    ]
    more = f"; {len(found) - len(rows)} narrower, {closed} closed" if len(found) > _SHOWN else ""
    return Table(
        f"{RIG[chart].name}, follower inertia {inertia:g} lbf in s²: widest regions{more}",
        ("region", "from [rpm]", "to [rpm]", "width", "width when damped"),
        tuple(rows),
    )


def _rows(chart: str, inertia: float, found: Sequence[_Region]) -> list[Quoted]:
    """Set the first mode's regions with two modes beside those of the first mode alone."""
    rig = RIG[chart]
    rows = []
    beginnings = _first_mode(chart, inertia)
    for n in (3, 4):
        alone = beginnings[n]
        nearest = min((one.lower for one in found), key=lambda lower: abs(lower - alone))
        rows.append(
            Quoted(
                f"{rig.name}, {inertia:g}: region {n} of mode 1 begins at, one mode",
                alone,
                nearest,
                _NEAR * alone,
                "nearest beginning of a region of two modes: within 0.5 %",
                "9.6, suggestion 1",
                unit="rpm",
            )
        )
    return rows


def _notes() -> list[str]:
    cases = [(chart, inertia) for chart in _CHARTS for inertia in _INERTIAS]
    every = [(case, one) for case in cases for one in regions(*case)[0]]
    sums = [one for _, one in every if one.kind == "sum"]
    differences = [one for _, one in every if one.kind == "difference"]
    alive = [(case, one) for case, one in every if one.kind != "principal 1" and one.damped > 0.0]
    widest = [
        next(pair for pair in every if pair[0] == case and pair[1].kind != "principal 1")
        for case in cases
    ]
    parts = [
        f"{RIG[chart].name} at {inertia:g}: {one.label}, {one.width:.2g} rpm"
        for (chart, inertia), one in widest
    ]
    added = sum(_stable_alone(case, one) for case, one in alive)
    return [
        "Complete equation, two modes; rings: undamped, dots: about what the lowest decrement "
        f"measured at rest ({_decrement(RIG[_CHARTS[0]]):g}) leaves unstable. Speeds from "
        f"{_SPAN[0]:g} to {_SPAN[1]:g} of the first natural frequency.",
        "The widest region that owes itself to the second mode: " + "; ".join(parts) + ".",
        f"Of {len(sums)} regions of the sum kind the damping leaves "
        f"{sum(one.damped > 0.0 for one in sums)}; of the difference kind {len(differences)} are "
        f"open without damping. Of the second mode's own regions the damping leaves {len(alive)}, "
        f"of which {added} lie where the first mode alone is stable.",
    ]


def _stable_alone(case: tuple[str, float], one: _Region) -> bool:
    """Return True where the damped first mode alone is stable in the middle of a region."""
    chart, inertia = case
    found = floquet_multipliers(
        _system(chart, True, 1),
        0.5 * (one.lower + one.upper) * RPM,
        follower_inertia=inertia * LBF_IN_S2,
    )
    return bool(np.all(found.stable))
