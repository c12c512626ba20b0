"""Section 9.5.5 of Smith: damping estimated from which regions are unstable, by any order, exactly.

The thesis reads the damping K of two rigs from four unstable regions with its first-order formula
(7.51).  Here the same readings are made with higher orders and with the exact equation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import pi
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from ..hill import critical_damping, perturbation_boundaries
from ..hill.bloch import effective_operator
from ..scenes import load_scene
from .records import Drawn, Quoted, Table
from .smith_linkages import LBF_IN_S2, RIG, Array, Rig, region_name
from .style import COLOURS, legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ORDERS = (1, 2, 3, 4, 6)
_SCAN = np.linspace(0.0, 0.5, 5001)


@dataclass(frozen=True)
class Estimate:
    """One damping that section 9.5.5 quotes.

    Attributes
    ----------
    chart : str
        Number of the rig's stability chart.
    region : int
        Number n of the unstable region 2 Omega/n.
    stable, unstable : float
        Follower inertias [lbf in s^2] between which the region opens.
    quoted : float
        K as the thesis gives it.
    stated : bool
        True where the thesis states the two inertias for the estimate; otherwise they are the
        measured neighbours for which its formula gives its figure.
    """

    chart: str
    region: int
    stable: float
    unstable: float
    quoted: float
    stated: bool

    @property
    def rig(self) -> Rig:
        """The linkage and coupler."""
        return RIG[self.chart]

    @property
    def name(self) -> str:
        """Chart and region in a few words."""
        return f"Fig. {self.chart}, {region_name(self.region)}"


ESTIMATES = (
    Estimate("82", 5, 0.0069, 0.0079, 0.02, stated=True),
    Estimate("82", 6, 0.0130, 0.0149, 0.01, stated=False),
    Estimate("85", 4, 0.0130, 0.0149, 0.005, stated=False),
    Estimate("85", 3, 0.0058, 0.0079, 0.02, stated=False),
)


@lru_cache(maxsize=512)
def critical(estimate: Estimate, inertia: float, equation: str, order: int | None) -> float:
    """Return the damping K at which the region of an estimate closes.

    Parameters
    ----------
    estimate : Estimate
        Rig and region.
    inertia : float
        Follower inertia [lbf in s^2].
    equation : str
        ``"reduced"`` is (6.18), the equation of the thesis' charts.
    order : int or None
        Of the perturbation, whether or not it converges at so large a parameter; NaN where that
        order leaves the region open at any damping.  None for the exact value.
    """
    f = estimate.rig.function(equation, inertia * LBF_IN_S2)
    n = estimate.region
    if order is None:
        return float(critical_damping(f, 1.0, (n,)).damping[0])
    points = np.stack([np.ones_like(_SCAN), _SCAN])
    a, b = effective_operator([f], n, order, damped=True).components(points)
    left = np.abs(b.sum(axis=0)) - np.abs(a.sum(axis=0).imag)
    (crossings,) = np.nonzero((left[:-1] > 0.0) & (left[1:] <= 0.0))
    if not crossings.size:
        return float("nan")
    k = int(crossings[0])
    share = left[k] / (left[k] - left[k + 1])
    return float(_SCAN[k] + share * (_SCAN[k + 1] - _SCAN[k]))


def _diverges(estimate: Estimate, order: int) -> bool:
    """Return True where the order does not visibly converge at the stable inertia."""
    f, regions = estimate.rig.function("reduced", estimate.stable * LBF_IN_S2), (estimate.region,)
    closing = critical_damping(f, 1.0, regions).damping[0]
    return bool(perturbation_boundaries(f, 1.0, regions, order, closing).outside[0])


def at_rest(estimate: Estimate) -> tuple[float, float]:
    """Return K from the logarithmic decrements measured at rest, at the speed of the region.

    A decrement d is a rate ``d Omega / 2 pi`` in time: ``K = d Omega / (2 pi omega_2)``.
    """
    f = estimate.rig.function("reduced", estimate.stable * LBF_IN_S2)
    place = float(critical_damping(f, 1.0, (estimate.region,)).lam2[0])
    low, high = load_scene(estimate.rig.scene).get("measured.log_decrement")
    factor = np.sqrt(place) / (2.0 * pi)
    return float(low * factor), float(high * factor)


def figure_table(axes: Sequence[Axes]) -> Drawn:
    """Draw the damping that closes each region over the follower's inertia."""
    for ax, one in zip(axes, ESTIMATES, strict=True):
        _panel(ax, one)
    legend_below(axes, columns=3)
    notes = (
        "K closes the region; (6.18) is the equation of the thesis' charts. The inertias belong to "
        "the estimate for the first panel; for the others the text does not state them, and those "
        "measured are marked between which (7.51) gives the quoted K.",
        *_conclusion(),
    )
    files = (("damping_estimates.md", damping_document()),)
    return Drawn(tuple(_rows()), notes, (_table(),), files)


def _panel(ax: Axes, one: Estimate) -> None:
    measured = one.rig.inertias / LBF_IN_S2
    inertia = np.linspace(0.95 * measured[0], 1.02 * measured[-1], 31)

    def curve(equation: str, order: int | None) -> Array:
        return np.array([critical(one, float(value), equation, order) for value in inertia])

    ax.plot(inertia, curve("reduced", 1), "--", color=COLOURS[0], label="(7.51)")
    ax.plot(inertia, curve("reduced", 2), ":", color=COLOURS[2], label="second order")
    ax.plot(inertia, curve("reduced", None), color=COLOURS[5], label="exact, (6.18)")
    ax.plot(inertia, curve("complete", None), color=COLOURS[3], label="exact, complete equation")
    ax.fill_between(inertia, *at_rest(one), color="0.92", lw=0, label="decrements at rest")
    ax.hlines(one.quoted, one.stable, one.unstable, color="black", lw=3.0, label="quoted")
    ax.set_ylim(0.0, 0.16)
    ax.set_xlabel("follower inertia [lbf in s²]")
    ax.set_ylabel("critical damping $K$")
    panel_title(ax, f"{one.name}, {one.rig.name}")


def _rows() -> list[Quoted]:
    return [
        Quoted(
            f"K from {one.name}",
            one.quoted,
            0.5
            * (critical(one, one.stable, "reduced", 1) + critical(one, one.unstable, "reduced", 1)),
            0.15 * one.quoted,
            "(7.51), middle of the two inertias; one digit is quoted",
            "9.5.5",
        )
        for one in ESTIMATES
    ]


def _table() -> Table:
    header = ("region", "inertia", "quoted", *(_order_name(k) for k in _ORDERS))
    header += ("exact, (6.18)", "exact, complete", "decrement at rest")
    rows = []
    for one in ESTIMATES:
        cells = [one.name, f"{one.stable:g}-{one.unstable:g}", f"{one.quoted:g}"]
        for order in _ORDERS:
            star = "*" if _diverges(one, order) else ""
            cells.append(_span(one, "reduced", order) + star)
        cells += [_span(one, name, None) for name in ("reduced", "complete")]
        low, high = at_rest(one)
        rows.append((*cells, f"{low:.2f}-{high:.2f}"))
    return Table("Damping K that closes the region", header, tuple(rows))


def _order_name(order: int) -> str:
    return "(7.51)" if order == 1 else f"order {order}"


def _span(one: Estimate, equation: str, order: int | None) -> str:
    ends = [critical(one, value, equation, order) for value in (one.stable, one.unstable)]
    return "-".join("none" if np.isnan(end) else f"{end:.3f}" for end in ends)


def _middle(one: Estimate, equation: str, order: int | None) -> float:
    return 0.5 * sum(critical(one, value, equation, order) for value in (one.stable, one.unstable))


def _conclusion() -> list[str]:
    first = [_middle(one, "reduced", 1) for one in ESTIMATES]
    exact = [_middle(one, "reduced", None) for one in ESTIMATES]
    complete = [_middle(one, "complete", None) for one in ESTIMATES]
    spans = [
        critical(one, value, "reduced", None)
        for one in ESTIMATES
        for value in (one.stable, one.unstable)
    ]
    ratio = [b / a for a, b in zip(first, exact, strict=True)]
    middles = [0.5 * sum(at_rest(one)) for one in ESTIMATES]
    rest = [a / b for a, b in zip(middles, complete, strict=True)]
    quoted = [a / one.quoted for a, one in zip(middles, ESTIMATES, strict=True)]
    return [
        "The first estimate's inertias are stated, and (7.51) gives its quoted figure to the one "
        "digit that it has; for the other three the text states no inertia, and the measured ones "
        "are taken for which (7.51) gives the quoted figure. Read with "
        f"the exact boundaries of the same equation the four give K = {_list(exact)} instead of "
        f"{_list(first)}: {_list(ratio, 1)} times as much. The complete equation gives "
        f"{_list(complete)}.",
        "If the inertias taken are the right ones, then, the four estimates differ among "
        f"themselves by {max(exact) / min(exact):.1f} and not by {max(first) / min(first):.1f} "
        f"({max(complete) / min(complete):.1f} with the complete equation), middle of a bracket "
        "against middle; the brackets themselves are wide: together they reach from "
        f"{min(spans):.3f} to {max(spans):.3f}. The damping quoted is then too small.",
        "No order of the series helps: at these parameters it does not converge (starred: refused "
        "by its own error figure). (7.51) is right only where mu is small.",
        "The logarithmic decrements of the coupler at rest give, middle over middle, "
        f"{_list(rest, 1)} times the exact value for the complete equation, and "
        f"{_list(quoted, 1)} times the quoted one.",
    ]


def _list(values: Sequence[float], digits: int = 3) -> str:
    texts = [f"{value:.{digits}f}" for value in values]
    return f"{', '.join(texts[:-1])} and {texts[-1]}"


def damping_document() -> str:
    """Return the text of ``docs/damping_estimates.md``."""
    table = _table()
    lines = [
        "# Damping read from stability charts",
        "",
        "Written by `elastolink reproduce smith --figure table_damping --out DIR`; every number is",
        "computed. Smith, section 9.5.5, takes K from the follower inertia at which a region turns",
        "from stable to unstable. A starred order refuses its number; it is shown all the same.",
        "",
    ]
    for paragraph in _conclusion():
        lines += [fill(paragraph, 110), ""]
    return "\n".join([*lines, *table.markdown(), ""])
