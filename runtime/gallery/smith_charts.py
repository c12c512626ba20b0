"""Smith's Figs. 34 to 38: stability charts in lambda^2 and mu, and the space of two functions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np

from ..core.periodic_function import PeriodicFunction
from ..hill import (
    boundary_series,
    critical_damping,
    hill_boundaries,
    perturbation_boundaries,
)
from ..linkages import FourBar
from .drawing import COLOURS, Array, Axes, Panels, outline
from .records import Drawn
from .smith_linkages import linkage_of, series

_LINKAGE = linkage_of("(2,1,2,2)")
# Of the space: the region and the parameters' range.
_REGION, _REACH = 2, 0.6


def _to_order(f: PeriodicFunction, mu: Array, regions: Sequence[int], order: int) -> Array:
    """Return lower and upper ends by Smith's series (7.25), (7.37), ``(2, regions, mu)``.

    They are drawn beyond where they are good.
    """
    return np.stack([boundary_series(f, n, order)(mu) for n in regions], axis=1)


def _largest(one: Array, other: Array) -> float:
    return float(np.max(np.abs(one - other)))


def _edges(ax: Axes, mu: Array, ends: Array, style: str, colour: str, label: str) -> None:
    ax.plot(np.concatenate(ends).T, mu, style, color=colour, lw=1.3, label=label)


def _shade(ax: Axes, f: PeriodicFunction, mu: Array, regions: Sequence[int], left: float) -> None:
    """Shade the unstable regions of a chart and draw their exact boundaries."""
    exact = hill_boundaries(f, mu, regions)
    for low, high in zip(exact.lower, exact.upper, strict=True):
        ax.fill_betweenx(mu, np.maximum(low, left), high, color="#f4dcc8", lw=0)
    _edges(ax, mu, np.stack([exact.lower, exact.upper]), "-", COLOURS[5], "exact")


def figure_34(axes: Panels) -> Drawn:
    """Draw exact, first-order and second-order boundaries of a typical linkage."""
    ax, f, regions = axes[0], series(_LINKAGE), (1, 2, 3, 4)
    mu = np.linspace(0.0, 1.5, 151)
    _shade(ax, f, mu, (0, *regions, 5, 6), -1.5)
    exact, gaps = hill_boundaries(f, mu, (1,)), []
    for order, style, colour, label in (
        (1, "--", COLOURS[0], "first order"),
        (2, ":", COLOURS[2], "second order"),
    ):
        near = _to_order(f, mu, (*regions, 5), order)
        _edges(ax, mu, near, style, colour, label)
        gaps.append(_largest(near[:, 0], np.concatenate([exact.lower, exact.upper])))
    return Drawn(words={"first": gaps[0], "second": gaps[1]})


def figure_35(axes: Panels) -> Drawn:
    """Draw the unstable regions for four cranks, the other links being equal."""
    mu, regions, widths = np.linspace(0.0, 1.0, 121), (1, 2, 3), []
    for ax, crank in zip(axes, (0.5, 1.5, 3.0, 4.0), strict=True):
        f = series(FourBar(frame=6.0, crank=crank, coupler=6.0, follower=6.0))
        _shade(ax, f, mu, (0, *regions, 4), -1.0)
        _edges(ax, mu, _to_order(f, mu, regions, 2), ":", COLOURS[2], "second order")
        widths.append(hill_boundaries(f, 1.0, regions).width)
    short = widths[0]
    growth = min(float(np.min(b / a)) for a, b in pairwise(widths))
    return Drawn([short[1] / short[0], short[2] / short[0], growth])


def damped(axes: Panels, regions: list[int], dampings: list[float], top: float) -> None:
    """Draw regions up to a mu for several dampings, exact and, of a single one, to first order.

    Figs. 36 and 37.
    """
    f, ax = series(_LINKAGE), axes[0]
    for damping, colour in zip(dampings, COLOURS, strict=False):
        # Closer values above the tips, exact and by (7.51), where the outlines are flat.
        tips = 2.0 * damping * np.array(regions) / f.amplitudes[regions]
        if damping:
            exact = critical_damping(f, None, regions, damping=damping).mu
            tips = np.concatenate([tips, exact])
        near = np.outer(tips, 1.0 + 1e-9 + np.linspace(0.0, 0.3, 1 + 30 // len(tips)) ** 2).ravel()
        mu = np.unique(np.concatenate([np.linspace(0.0, top, 181), near[near < top]]))
        drawn = {"exact": ("-", hill_boundaries(f, mu, regions, damping=damping))}
        if len(regions) == 1:
            first = perturbation_boundaries(f, mu, regions, damping=damping, outside="value")
            drawn["first order"] = ("--", first)
        for name, (style, ends) in drawn.items():
            for low, high in zip(ends.lower, ends.upper, strict=True):
                label = f"K = {damping:g}, {name}"
                ax.plot(*outline(low, high, mu), style, color=colour, label=label)


@dataclass(frozen=True)
class _Pair:
    """The two functions, as in Smith (8.3): eps1 f1 + eps2 f2."""

    first: PeriodicFunction
    second: PeriodicFunction

    def along(self, eps1: float, eps2: float, amounts: Array) -> tuple[Array, Array]:
        """Return both ends of the region in lam2 at ``amounts * (eps1, eps2)``."""
        ends = hill_boundaries(self.first * eps1 + self.second * eps2, amounts, (_REGION,))
        return ends.lower[0], ends.upper[0]

    def to_order(self, eps1: Array, eps2: Array, order: int) -> tuple[Array, Array]:
        """Return both ends to an order in the parameters."""
        ends = perturbation_boundaries(
            [self.first, self.second], [eps1, eps2], (_REGION,), order=order, outside="value"
        )
        return ends.lower[0], ends.upper[0]


def figure_38(axes: Panels) -> Drawn:
    """Draw both boundary surfaces of one region and their first-order lines in the planes."""
    space: Any = axes[0]
    pair = _Pair(series(_LINKAGE, "f1"), series(_LINKAGE))
    turn, amounts = np.linspace(0.0, 0.5 * pi, 41), np.linspace(0.0, 1.0, 33)
    reach = np.minimum(_REACH / np.maximum(np.cos(turn), np.sin(turn)), 2.0 * _REACH)
    rays = [
        pair.along(r * np.cos(t), r * np.sin(t), amounts) for r, t in zip(reach, turn, strict=True)
    ]
    waves: tuple[Callable[[Array], Array], ...] = (np.cos, np.sin)
    eps1, eps2 = (np.outer(reach * wave(turn), amounts) for wave in waves)
    for which, (colour, side) in enumerate(zip(COLOURS, ("lower", "upper"), strict=False)):
        sheet, label = np.stack([ray[which] for ray in rays]), f"{side} boundary, exact"
        space.plot_surface(
            eps1, sheet, eps2, color=colour, alpha=0.45, rcount=41, ccount=33, linewidth=0.0
        )
        for ray in range(0, len(turn), 10):
            space.plot(eps1[ray], sheet[ray], eps2[ray], color=colour, lw=0.7)
        space.plot(eps1[:, -1], sheet[:, -1], eps2[:, -1], color=colour, lw=0.9, label=label)
    _first_order(space, pair)
    space.plot([0.0, 0.0], [0.0, 1.75], [0.0, 0.0], color="0.2", lw=1.0)
    space.set_box_aspect((1.0, 1.7, 1.0), zoom=1.12)
    space.view_init(elev=22.0, azim=-28.0)
    return Drawn(_space_values(pair), _order_errors(pair))


def _first_order(space: Any, pair: _Pair) -> None:
    """Draw the straight lines of the first order and name the points as the thesis does."""
    amounts, ink = np.array([0.0, 1.0]), "0.25"

    def name(place: tuple[float, float, float], text: str) -> None:
        space.plot(*([x] for x in place), "o", color=ink, ms=2.5, zorder=22)
        space.text(*place, f" {text}", fontsize=10, fontstyle="italic", zorder=23)

    for names, middle_name, share, (eps1, eps2) in (
        ("AB", "G", 0.8, (1.0, 0.0)),
        ("CD", "H", 0.8, (0.0, 1.0)),
        ("EF", "", 0.55, (1.0, 1.0)),
    ):
        x, z = share * _REACH * eps1 * amounts, share * _REACH * eps2 * amounts
        ends = pair.to_order(x, z, 1)
        for letter, end in zip(names, ends, strict=True):
            space.plot(x, end, z, "--", color=ink, lw=1.0, zorder=20, label="first order")
            name((x[1], end[1], z[1]), letter)
        if middle_name:
            middle = 0.5 * (ends[0] + ends[1])
            label = "middle, first order"
            space.plot(x, middle, z, ":", color=ink, lw=1.0, zorder=20, label=label)
            name((x[1], middle[1], z[1]), middle_name)
        space.plot([x[1]] * 2, [end[1] for end in ends], [z[1]] * 2, color=ink, lw=1.6, zorder=21)
    name((0.0, 0.25 * _REGION**2, 0.0), "P")
    name((0.0, 0.0, 0.0), "O")


def _order_errors(pair: _Pair) -> dict[str, float]:
    """Return how far the ends to first and second order are off on both sides."""
    share = np.array([0.8 * _REACH])
    words = {"share": float(share[0])}
    for side, eps1, eps2 in (("left", 1.0, 0.0), ("right", 0.0, 1.0)):
        exact = pair.along(eps1, eps2, share)
        for order in (1, 2):
            near = pair.to_order(share * eps1, share * eps2, order)
            words[f"{side}{order}"] = max(map(_largest, exact, near))
    return words


def _space_values(pair: _Pair) -> list[float]:
    """Return the least width over small parameters in all directions, and how harmonics fall."""
    # Parameters so small that second order adds less than twice their size.
    around, small = [], np.array([1e-4])
    for t in np.linspace(0.0, 2.0 * pi, 73):
        lower, upper = pair.along(float(np.cos(t)), float(np.sin(t)), small)
        around.append(float((upper - lower)[0] / small[0]))
    falls = [float(f.amplitudes[8] / f.amplitudes[1]) for f in (pair.first, pair.second)]
    return [min(around), max(falls)]
