"""Smith's Figs. 34 to 38: stability charts in lambda^2 and mu, and the space of two functions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.periodic_function import PeriodicFunction
from ..hill import (
    boundary_series,
    critical_damping,
    discriminant,
    hill_boundaries,
    perturbation_boundaries,
)
from ..linkages import FourBar
from .drawing import COLOURS, Array, legend_below, panel_title
from .records import Drawn, Value
from .smith_linkages import end_load, f3_series, linkage_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_UNSTABLE = "#f4dcc8"
_EXACT, _FIRST, _SECOND = COLOURS[5], COLOURS[0], COLOURS[2]
_LINKAGE = "(2,1,2,2)"
_DAMPINGS = (0.0, 0.02, 0.05, 0.1)
# Of the space: the region, the parameters' range, where limits for small ones are taken; second
# order adds less than twice this.
_REGION, _REACH, _SMALL = 2, 0.6, 1e-4


def _exact(f: PeriodicFunction, mu: Array, regions: Sequence[int]) -> Array:
    """Return the exact lower and upper ends, ``(2, len(regions), len(mu))``."""
    found = hill_boundaries(f, mu, regions)
    return np.stack([found.lower, found.upper])


def _to_order(f: PeriodicFunction, mu: Array, regions: Sequence[int], order: int) -> Array:
    """Return Smith's series (7.25) or (7.37) likewise, drawn beyond where it is good."""
    return np.stack([boundary_series(f, n, order)(mu) for n in regions], axis=1)


def _largest(one: Array, other: Array) -> float:
    return float(np.max(np.abs(one - other)))


def figure_34(axes: Sequence[Axes]) -> Drawn:
    """Draw exact, first-order and second-order boundaries of a typical linkage."""
    ax, f, regions = axes[0], f3_series(_LINKAGE), (1, 2, 3, 4, 5)
    mu, lam2 = np.linspace(0.0, 1.5, 151), np.linspace(-1.5, 7.5, 401)
    half = discriminant(f, lam2[:, None], mu[None, :]).value
    # A signed measure that stays of order one keeps the contour smooth.
    excess = np.tanh(np.abs(half) - 1.0)
    ax.contourf(lam2, mu, excess.T, levels=[0.0, 2.0], colors=[_UNSTABLE])
    exact = _exact(f, mu, regions)
    first, second = (_to_order(f, mu, regions, order) for order in (1, 2))
    for i in range(len(regions)):
        for ends, style, colour, label in (
            (exact, "-", _EXACT, "exact"),
            (first, "--", _FIRST, "first order"),
            (second, ":", _SECOND, "second order"),
        ):
            for end, named in ((ends[0, i], label), (ends[1, i], None)):
                ax.plot(end, mu, style, color=colour, lw=1.3, label=named if i == 0 else None)
    _chart_axes(ax, (lam2[0], lam2[-1]), mu[-1], r"$\lambda^2 = (\Omega/\omega_2)^2$")
    ax.grid(visible=False)
    gaps = [_largest(near[:, 0], exact[:, 0]) for near in (first, second)]
    return Drawn(_start_values(f), {"first": gaps[0], "second": gaps[1]})


def _chart_axes(ax: Axes, lam2: tuple[float, float], mu: float, name: str) -> None:
    ax.set(xlim=lam2, ylim=(0.0, mu), xlabel=name, ylabel=r"load parameter $\mu$")
    legend_below([ax])


def _start_values(f: PeriodicFunction) -> list[float]:
    regions = (1, 2, 3, 4)
    start = hill_boundaries(f, 1e-7, regions)
    gap = _largest(np.stack([start.lower, start.upper]), np.array([0.25 * n * n for n in regions]))
    levels = discriminant(f, hill_boundaries(f, 1.0, regions).lower, 1.0).value
    return [gap, _largest(levels, np.array([(-1.0) ** n for n in regions]))]


def figure_35(axes: Sequence[Axes]) -> Drawn:
    """Draw the unstable regions for four cranks, the other links being equal."""
    mu, regions, widths = np.linspace(0.0, 1.0, 121), (1, 2, 3), []
    for ax, crank in zip(axes, (0.5, 1.5, 3.0, 4.0), strict=True):
        linkage = FourBar(frame=6.0, crank=crank, coupler=6.0, follower=6.0)
        f = _series(linkage, "f3")
        exact, second = _exact(f, mu, regions), _to_order(f, mu, regions, 2)
        for i in range(len(regions)):
            ax.fill_betweenx(mu, exact[0, i], exact[1, i], color=_UNSTABLE, lw=0)
            for ends, style, colour, width, label in (
                (exact, "-", _EXACT, 1.0, "exact"),
                (second, ":", _SECOND, 1.3, "second order"),
            ):
                for end, named in ((ends[0, i], label), (ends[1, i], None)):
                    named = named if i == 0 else None
                    ax.plot(end, mu, style, color=colour, lw=width, label=named)
        widths.append(exact[1, :, -1] - exact[0, :, -1])
        ax.set(xlim=(-1.0, 3.2), ylim=(0.0, 1.0))
        ax.grid(visible=False)
        panel_title(ax, f"crank {crank:g}")
    for ax in axes[2:]:
        ax.set_xlabel(r"$\lambda^2$")
    for ax in axes[::2]:
        ax.set_ylabel(r"$\mu$")
    legend_below(axes[:1])
    short = widths[0]
    growth = min(float(np.min(b / a)) for a, b in pairwise(widths))
    return Drawn([short[1] / short[0], short[2] / short[0], growth])


def _series(linkage: FourBar, name: str) -> PeriodicFunction:
    return PeriodicFunction.from_callable(lambda theta: getattr(end_load(linkage, theta), name))


def _outline(lower: Array, upper: Array, mu: Array) -> tuple[Array, Array]:
    """Return a region's outline as one line, closed at its tip where damping has blunted it."""
    real = np.isfinite(lower) & np.isfinite(upper)
    edge = np.concatenate([lower[real][::-1], upper[real]])
    return edge, np.concatenate([mu[real][::-1], mu[real]])


def figure_36(axes: Sequence[Axes]) -> Drawn:
    """Draw the first region for several dampings, first order and exact."""
    f, ax = f3_series(_LINKAGE), axes[0]
    for damping, colour in zip(_DAMPINGS, COLOURS, strict=False):
        # Closer values above the tip of (7.51), where the outline is flat.
        tip = 2.0 * damping / float(f.amplitudes[1])
        near = tip * (1.0 + 1e-9 + np.linspace(0.0, 0.3, 31) ** 2)
        mu = np.unique(np.concatenate([np.linspace(0.0, 0.6, 241), near]))
        exact = hill_boundaries(f, mu, (1,), damping=damping)
        first = perturbation_boundaries(f, mu, (1,), damping=damping, outside="value")
        for ends, style, label in ((exact, "-", "exact"), (first, "--", "first order")):
            named = f"K = {damping:g}, {label}"
            ax.plot(*_outline(ends.lower[0], ends.upper[0], mu), style, color=colour, label=named)
    _chart_axes(ax, (-0.2, 0.5), 0.6, r"$\lambda^2$")
    return Drawn(_least_mu(f, (1,), 0.05))


def figure_37(axes: Sequence[Axes]) -> Drawn:
    """Draw the first four regions with and without damping."""
    f, mu, regions, ax = f3_series(_LINKAGE), np.linspace(0.0, 1.0, 201), (1, 2, 3, 4), axes[0]
    for damping, colour in zip(_DAMPINGS[:3], COLOURS, strict=False):
        exact = hill_boundaries(f, mu, regions, damping=damping)
        for i in range(len(regions)):
            named = f"K = {damping:g}" if i == 0 else None
            ax.plot(*_outline(exact.lower[i], exact.upper[i], mu), color=colour, label=named)
    _chart_axes(ax, (-0.7, 4.6), 1.0, r"$\lambda^2$")
    return Drawn(_least_mu(f, regions, 0.02))


def _least_mu(f: PeriodicFunction, regions: Sequence[int], damping: float) -> list[Value]:
    """Return the least mu of each damped region, and (7.51) within a twentieth."""
    exact = critical_damping(f, None, regions, damping=damping).mu
    printed = [2.0 * damping * n / float(f.amplitudes[n]) for n in regions]
    return [(mu, near, 0.05 * near) for mu, near in zip(exact, printed, strict=True)]


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


def _functions() -> _Pair:
    return _Pair(_series(linkage_of(_LINKAGE), "f1"), f3_series(_LINKAGE))


def figure_38(axes: Sequence[Axes]) -> Drawn:
    """Draw both boundary surfaces of one region and their first-order lines in the planes."""
    space: Any = axes[0]
    pair = _functions()
    turn, amounts = np.linspace(0.0, 0.5 * pi, 41), np.linspace(0.0, 1.0, 33)
    reach = np.minimum(_REACH / np.maximum(np.cos(turn), np.sin(turn)), 2.0 * _REACH)
    rays = [
        pair.along(r * np.cos(t), r * np.sin(t), amounts) for r, t in zip(reach, turn, strict=True)
    ]
    waves: tuple[Callable[[Array], Array], ...] = (np.cos, np.sin)
    eps1, eps2 = (np.outer(reach * wave(turn), amounts) for wave in waves)
    for which, colour in enumerate(COLOURS[:2]):
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
        (COLOURS[0], "-", "lower boundary, exact"),
        (COLOURS[1], "-", "upper boundary, exact"),
        ("0.25", "--", "first order"),
        ("0.25", ":", "middle, first order"),
    ):
        space.plot([], [], [], style, color=colour, label=label)
    legend_below([space])
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
            space.plot(x, end, z, "--", color=ink, lw=1.0, zorder=20)
            name((x[1], end[1], z[1]), letter)
        if middle_name:
            middle = 0.5 * (ends[0] + ends[1])
            space.plot(x, middle, z, ":", color=ink, lw=1.0, zorder=20)
            name((x[1], middle[1], z[1]), middle_name)
        space.plot([x[1]] * 2, [end[1] for end in ends], [z[1]] * 2, color=ink, lw=1.6, zorder=21)
    name((0.0, 0.25 * _REGION**2, 0.0), "P")
    name((0.0, 0.0, 0.0), "O")


def _frame(space: Any) -> None:
    space.plot([0.0, 0.0], [0.0, 1.75], [0.0, 0.0], color="0.2", lw=1.0)
    space.set(xlabel=r"$\epsilon_1$", ylabel=r"$\lambda^2$", zlabel=r"$\epsilon_2$")
    space.set(xlim=(0.0, _REACH), ylim=(0.0, 1.75), zlim=(0.0, _REACH))
    ticks = [0.0, 0.2, 0.4, 0.6]
    space.set(xticks=ticks, zticks=ticks)
    space.set_box_aspect((1.0, 1.7, 1.0), zoom=1.12)
    space.view_init(elev=22.0, azim=-28.0)


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


def _space_values(pair: _Pair) -> list[Value]:
    """Return start, widths and slopes at small parameters beside (8.43), and the other claims."""
    n = _REGION
    a, b, c, d = pair.first.a[n], pair.first.b[n], pair.second.a[n], pair.second.b[n]
    squares = [a * a + b * b, c * c + d * d, 2.0 * (a * c + b * d)]
    start = pair.along(1.0, 1.0, np.zeros(1))
    widths: list[Value] = []
    slopes = []
    for eps1, eps2 in ((1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, -0.5)):
        printed = np.sqrt(eps1**2 * squares[0] + eps2**2 * squares[1] + eps1 * eps2 * squares[2])
        low, high = (float(end[0]) for end in pair.along(eps1, eps2, np.array([_SMALL])))
        slopes.append((0.5 * (low + high) - 0.25 * n * n) / _SMALL)
        widths.append(((high - low) / _SMALL, printed))
    around = []
    for t in np.linspace(0.0, 2.0 * pi, 73):
        lower, upper = pair.along(float(np.cos(t)), float(np.sin(t)), np.array([_SMALL]))
        around.append(float(upper[0] - lower[0]) / _SMALL)
    return [
        float(start[0][0] + start[1][0]) / 2.0,
        *widths,
        (slopes[0], -pair.first.mean),
        (slopes[1], -pair.second.mean),
        (slopes[1], -pair.first.mean),
        min(around),
        max(f.amplitudes[8] / f.amplitudes[1] for f in (pair.first, pair.second)),
    ]
