"""Smith's Fig. 38: the stability space of Hill's equation with two periodic functions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.periodic_function import PeriodicFunction
from ..hill import hill_boundaries, perturbation_boundaries
from .records import Drawn, Quoted
from .smith_linkages import Array, end_load, f3_series, linkage_of
from .style import COLOURS, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LINKAGE, _REGION = "(2,1,2,2)", 2
_REACH = 0.6
# Shares of the reach at which AB, CD and EF are drawn.
_PLANE, _INSIDE = 0.8, 0.55
_LOW, _HIGH, _FIRST = COLOURS[0], COLOURS[1], "0.25"
# Where limits for small parameters are taken; second order adds less than twice this.
_SMALL = 1e-4


@dataclass(frozen=True)
class _Pair:
    """The two functions, as in Smith (8.3): eps1 f1 + eps2 f2."""

    first: PeriodicFunction
    second: PeriodicFunction

    def along(self, eps1: float, eps2: float, amounts: Array) -> tuple[Array, Array]:
        """Return both ends of the region in lam2 at ``amounts * (eps1, eps2)``."""
        found = hill_boundaries(self.first * eps1 + self.second * eps2, amounts, (_REGION,))
        return found.lower[0], found.upper[0]

    def to_order(self, eps1: Array, eps2: Array, order: int) -> tuple[Array, Array]:
        """Return both ends to an order in the parameters."""
        found = perturbation_boundaries(
            [self.first, self.second], [eps1, eps2], (_REGION,), order=order, outside="value"
        )
        return found.lower[0], found.upper[0]


def _functions() -> _Pair:
    linkage = linkage_of(_LINKAGE)
    return _Pair(
        PeriodicFunction.from_callable(lambda theta: end_load(linkage, theta).f1),
        f3_series(_LINKAGE),
    )


def figure_38(axes: Sequence[Axes]) -> Drawn:
    """Draw both boundary surfaces of one region and their first-order lines in the planes."""
    space: Any = axes[0]
    pair = _functions()
    turn = np.linspace(0.0, 0.5 * pi, 41)
    reach = np.minimum(_REACH / np.maximum(np.cos(turn), np.sin(turn)), 2.0 * _REACH)
    amounts = np.linspace(0.0, 1.0, 33)
    rays = [
        pair.along(r * np.cos(t), r * np.sin(t), amounts) for r, t in zip(reach, turn, strict=True)
    ]
    eps1, eps2 = (np.outer(reach * wave(turn), amounts) for wave in (np.cos, np.sin))
    for which, colour in ((0, _LOW), (1, _HIGH)):
        sheet = np.stack([ray[which] for ray in rays])
        space.plot_surface(
            eps1, sheet, eps2, color=colour, alpha=0.45, rcount=41, ccount=33, linewidth=0.0
        )
        for ray in range(0, len(turn), 10):
            space.plot(eps1[ray], sheet[ray], eps2[ray], color=colour, lw=0.7)
        space.plot(eps1[:, -1], sheet[:, -1], eps2[:, -1], color=colour, lw=0.9)
    _first_order(space, pair)
    _frame(space)
    for colour, style, label in (
        (_LOW, "-", "lower boundary, exact"),
        (_HIGH, "-", "upper boundary, exact"),
        (_FIRST, "--", "first order"),
        (_FIRST, ":", "middle, first order"),
    ):
        space.plot([], [], [], style, color=colour, label=label)
    legend_below([space])
    return Drawn(tuple(_rows(pair)), tuple(_notes(pair)))


def _first_order(space: Any, pair: _Pair) -> None:
    """Draw the straight lines of the first order and name the points as the thesis does."""
    amounts = np.array([0.0, 1.0])
    for names, (eps1, eps2) in (("AB", (1.0, 0.0)), ("CD", (0.0, 1.0)), ("EF", (1.0, 1.0))):
        share = (_INSIDE if names == "EF" else _PLANE) * _REACH
        ends = pair.to_order(share * eps1 * amounts, share * eps2 * amounts, 1)
        across = [end[1] for end in ends]
        places = share * eps1 * amounts, share * eps2 * amounts
        for name, end in zip(names, ends, strict=True):
            space.plot(places[0], end, places[1], "--", color=_FIRST, lw=1.0, zorder=20)
            _name(space, (places[0][1], end[1], places[1][1]), name)
        if names != "EF":
            middle = 0.5 * (ends[0] + ends[1])
            space.plot(places[0], middle, places[1], ":", color=_FIRST, lw=1.0, zorder=20)
            _name(space, (places[0][1], middle[1], places[1][1]), "G" if names == "AB" else "H")
        space.plot([places[0][1]] * 2, across, [places[1][1]] * 2, color=_FIRST, lw=1.6, zorder=21)
    _name(space, (0.0, 0.25 * _REGION**2, 0.0), "P")
    _name(space, (0.0, 0.0, 0.0), "O")


def _name(space: Any, place: tuple[float, float, float], text: str) -> None:
    space.plot(*([x] for x in place), "o", color=_FIRST, ms=2.5, zorder=22)
    space.text(*place, f" {text}", fontsize=10, fontstyle="italic", zorder=23)


def _frame(space: Any) -> None:
    space.plot([0.0, 0.0], [0.0, 1.75], [0.0, 0.0], color="0.2", lw=1.0)
    space.set_xlabel(r"$\epsilon_1$")
    space.set_ylabel(r"$\lambda^2$")
    space.set_zlabel(r"$\epsilon_2$")
    space.set_xlim(0.0, _REACH)
    space.set_ylim(0.0, 1.75)
    space.set_zlim(0.0, _REACH)
    ticks = [0.0, 0.2, 0.4, 0.6]
    space.set_xticks(ticks)
    space.set_zticks(ticks)
    space.set_box_aspect((1.0, 1.7, 1.0), zoom=1.12)
    space.view_init(elev=22.0, azim=-28.0)


def _notes(pair: _Pair) -> list[str]:
    share = np.array([_PLANE * _REACH])
    gaps = []
    for eps1, eps2 in ((1.0, 0.0), (0.0, 1.0)):
        exact = pair.along(eps1, eps2, share)
        for order in (1, 2):
            near = pair.to_order(share * eps1, share * eps2, order)
            gaps.append(max(float(np.max(np.abs(a - b))) for a, b in zip(exact, near, strict=True)))
    return [
        "The thesis draws the space diagrammatically. Here region 2 of (2,1,2,2) is computed, with "
        "f1 and f3 of (6.17); f3 is the f2 of (8.3). Surfaces: exact; broken and dotted lines: "
        "first order, (8.43).",
        f"At eps = {share[0]:.2g} the first-order ends are off by {gaps[0]:.3f} in lambda^2 on the "
        f"eps1 side and {gaps[2]:.3f} on the other, second-order ends by {gaps[1]:.3f} and "
        f"{gaps[3]:.3f}.",
    ]


def _rows(pair: _Pair) -> list[Quoted]:
    n = _REGION
    a, b, c, d = pair.first.a[n], pair.first.b[n], pair.second.a[n], pair.second.b[n]
    squares = [a * a + b * b, c * c + d * d, 2.0 * (a * c + b * d)]
    small = np.array([_SMALL])
    rows = [_start_row(pair)]
    slopes = {}
    for name, (eps1, eps2), printed in (
        ("AB/eps1", (1.0, 0.0), np.sqrt(squares[0])),
        ("CD/eps2", (0.0, 1.0), np.sqrt(squares[1])),
        ("EF/eps with eps1 = eps2", (1.0, 1.0), np.sqrt(sum(squares))),
        ("EF/eps1 with eps2 = -eps1/2", (1.0, -0.5), np.sqrt(squares @ np.array([1, 0.25, -0.5]))),
    ):
        lower, upper = (float(end[0]) for end in pair.along(eps1, eps2, small))
        slopes[name[:2]] = (0.5 * (lower + upper) - 0.25 * n * n) / _SMALL
        rows.append(
            Quoted(
                name,
                float(printed),
                (upper - lower) / _SMALL,
                2.0 * _SMALL,
                "exact width at eps = 1e-4; second order adds less",
                "8.4",
            )
        )
    means = {"AB": -pair.first.mean, "CD": -pair.second.mean}
    for line, name, symbol in (("PG", "AB", "a0"), ("PH", "CD", "c0")):
        rows.append(
            Quoted(
                f"slope of {line}: -{symbol}",
                means[name],
                slopes[name],
                2.0 * _SMALL,
                "middle of the exact region at eps = 1e-4",
                "Fig. 38",
            )
        )
    rows.append(
        Quoted(
            "slope of PH in the text: -a0",
            means["AB"],
            slopes["CD"],
            2.0 * _SMALL,
            "the same",
            "8.4",
            differs="a slip of the text for -c0, which the caption has",
        )
    )
    return [*rows, _finite_row(pair), _decrease_row(pair)]


def _start_row(pair: _Pair) -> Quoted:
    ends = pair.along(1.0, 1.0, np.zeros(1))
    return Quoted(
        "OP = (n/2)^2, n = 2",
        0.25 * _REGION**2,
        float(ends[0][0] + ends[1][0]) / 2.0,
        1e-12,
        "round-off, both parameters zero",
        "Fig. 38",
    )


def _finite_row(pair: _Pair) -> Quoted:
    turn = np.linspace(0.0, 2.0 * pi, 73)
    widths = []
    for t in turn:
        lower, upper = pair.along(float(np.cos(t)), float(np.sin(t)), np.array([_SMALL]))
        widths.append(float(upper[0] - lower[0]) / _SMALL)
    return Quoted(
        "least width over eps in all directions of (eps1, eps2)",
        0.0,
        min(widths),
        0.0,
        "'finite ranges of lambda^2', 72 directions at eps = 1e-4",
        "8.4",
        relation=">",
    )


def _decrease_row(pair: _Pair) -> Quoted:
    size = [f.amplitudes[8] / f.amplitudes[1] for f in (pair.first, pair.second)]
    return Quoted(
        "amplitude of harmonic 8 over that of harmonic 1, larger of both",
        0.2,
        float(max(size)),
        0.0,
        "'in general will decrease rapidly with increasing n', read as a fifth",
        "8.4",
        relation="<",
    )
