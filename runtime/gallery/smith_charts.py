"""Smith's Figs. 34 to 37: stability charts of the equation in lambda^2 and mu."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from ..core.periodic_function import PeriodicFunction
from ..hill import (
    Boundaries,
    critical_damping,
    discriminant,
    hill_boundaries,
    perturbation_boundaries,
)
from ..linkages import FourBar
from .records import Drawn, Quoted
from .smith_linkages import Array, end_load, f3_series
from .style import COLOURS, legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_UNSTABLE = "#f4dcc8"
_EXACT, _FIRST, _SECOND = COLOURS[5], COLOURS[0], COLOURS[2]
_LINKAGE = "(2,1,2,2)"
_CRANKS = (0.5, 1.5, 3.0, 4.0)
_DAMPINGS = (0.0, 0.02, 0.05, 0.1)


def _to_order(f: PeriodicFunction, mu: Array, regions: Sequence[int], order: int) -> Boundaries:
    """Return Smith's series to an order, (7.25) and (7.37), drawn beyond where it is good."""
    return perturbation_boundaries(f, mu, regions, order=order, form="series", outside="value")


def figure_34(axes: Sequence[Axes]) -> Drawn:
    """Draw exact, first-order and second-order boundaries of a typical linkage."""
    ax, f = axes[0], f3_series(_LINKAGE)
    regions = (1, 2, 3, 4, 5)
    mu = np.linspace(0.0, 1.5, 151)
    lam2 = np.linspace(-1.5, 7.5, 401)
    _shade(ax, f, lam2, mu)
    exact = hill_boundaries(f, mu, regions)
    first, second = (_to_order(f, mu, regions, order) for order in (1, 2))
    for i in range(len(regions)):
        for found, style, colour, label in (
            (exact, "-", _EXACT, "exact"),
            (first, "--", _FIRST, "first order"),
            (second, ":", _SECOND, "second order"),
        ):
            for k, end in enumerate((found.lower[i], found.upper[i])):
                named = label if i == 0 and k == 0 else None
                ax.plot(end, mu, style, color=colour, lw=1.3, label=named)
    ax.set_xlim(lam2[0], lam2[-1])
    ax.set_ylim(mu[0], mu[-1])
    ax.set_xlabel(r"$\lambda^2 = (\Omega/\omega_2)^2$")
    ax.set_ylabel(r"load parameter $\mu$")
    ax.grid(visible=False)
    legend_below([ax])
    errors = [
        max(
            float(np.max(np.abs(found.lower[0] - exact.lower[0]))),
            float(np.max(np.abs(found.upper[0] - exact.upper[0]))),
        )
        for found in (first, second)
    ]
    note = (
        "The mechanism is not stated; taken is (2,1,2,2), as for Fig. 36, with f = f3. Shaded: "
        "unstable. Up to mu = 1.5 the boundaries of the first region are off by up to "
        f"{errors[0]:.2f} in lambda^2 at first order and {errors[1]:.2f} at second."
    )
    return Drawn(tuple(_start_rows(f)), (note,))


def _start_rows(f: PeriodicFunction) -> list[Quoted]:
    tiny, regions = 1e-7, (1, 2, 3, 4)
    found = hill_boundaries(f, tiny, regions)
    starts = np.array([0.25 * n * n for n in regions])
    gap = np.max(np.abs(np.stack([found.lower, found.upper]) - starts))
    levels = discriminant(f, hill_boundaries(f, 1.0, regions).lower, 1.0).value
    signs = np.array([(-1.0) ** n for n in regions])
    return [
        Quoted(
            "boundaries at vanishing mu less (n/2)^2, n = 1 to 4",
            0.0,
            float(gap),
            1e-6,
            "mu = 1e-7",
            "7.1.3.1",
        ),
        Quoted(
            "half trace on the boundaries less (-1)^n: period 2 pi, 4 pi",
            0.0,
            float(np.max(np.abs(levels - signs))),
            1e-9,
            "round-off, mu = 1",
            "7.1.3.1",
        ),
    ]


def _shade(ax: Axes, f: PeriodicFunction, lam2: Array, mu: Array) -> None:
    half = discriminant(f, lam2[:, None], mu[None, :]).value
    # A signed measure that stays of order one keeps the contour smooth.
    excess = np.tanh(np.abs(half) - 1.0)
    ax.contourf(lam2, mu, excess.T, levels=[0.0, 2.0], colors=[_UNSTABLE])


def figure_35(axes: Sequence[Axes]) -> Drawn:
    """Draw the unstable regions for four cranks, the other links being equal."""
    mu = np.linspace(0.0, 1.0, 121)
    regions = (1, 2, 3)
    widths = []
    for ax, crank in zip(axes, _CRANKS, strict=True):
        f = _f3(crank)
        exact, second = hill_boundaries(f, mu, regions), _to_order(f, mu, regions, 2)
        for i in range(len(regions)):
            ax.fill_betweenx(mu, exact.lower[i], exact.upper[i], color=_UNSTABLE, lw=0)
            for k, end in enumerate((exact.lower[i], exact.upper[i])):
                named = "exact" if i == 0 and k == 0 else None
                ax.plot(end, mu, color=_EXACT, lw=1.0, label=named)
            for k, end in enumerate((second.lower[i], second.upper[i])):
                named = "second order" if i == 0 and k == 0 else None
                ax.plot(end, mu, ":", color=_SECOND, lw=1.3, label=named)
        widths.append(exact.upper[:, -1] - exact.lower[:, -1])
        ax.set_xlim(-1.0, 3.2)
        ax.set_ylim(0.0, 1.0)
        ax.grid(visible=False)
        panel_title(ax, f"crank {crank:g}")
    for ax in axes[2:]:
        ax.set_xlabel(r"$\lambda^2$")
    for ax in axes[::2]:
        ax.set_ylabel(r"$\mu$")
    legend_below(axes[:1])
    short = widths[0]
    rows = [
        Quoted(
            f"width of region {n} over that of region 1, mu = 1, crank 0.5",
            0.2,
            float(short[n - 1] / short[0]),
            0.0,
            "'the only one not of negligible proportions' read as a fifth",
            "7.1.3.3",
            relation="<",
        )
        for n in (2, 3)
    ]
    growth = min(float(np.min(b / a)) for a, b in pairwise(widths))
    rows.append(
        Quoted(
            "least growth of a region's width with the crank",
            1.0,
            growth,
            0.0,
            "'grow in extent', from each crank to the next, regions 1 to 3 at mu = 1",
            "7.1.3.3",
            relation=">",
        )
    )
    note = "Other links 6, as in the caption; the cranks and mu are not legible: 0.5 to 4 taken."
    return Drawn(tuple(rows), (note,))


def _f3(crank: float) -> PeriodicFunction:
    linkage = FourBar(frame=6.0, crank=crank, coupler=6.0, follower=6.0)
    return PeriodicFunction.from_callable(lambda theta: end_load(linkage, theta).f3)


def _outline(lower: Array, upper: Array, mu: Array) -> tuple[Array, Array]:
    """Return a region's outline as one line, closed at its tip where damping has blunted it."""
    open_ = np.isfinite(lower) & np.isfinite(upper)
    edge = np.concatenate([lower[open_][::-1], upper[open_]])
    return edge, np.concatenate([mu[open_][::-1], mu[open_]])


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
        for ends, style, label in (
            ((exact.lower, exact.upper), "-", f"K = {damping:g}, exact"),
            ((first.lower, first.upper), "--", f"K = {damping:g}, first order"),
        ):
            ax.plot(*_outline(ends[0][0], ends[1][0], mu), style, color=colour, label=label)
    ax.set_xlim(-0.2, 0.5)
    ax.set_ylim(0.0, 0.6)
    ax.set_xlabel(r"$\lambda^2$")
    ax.set_ylabel(r"load parameter $\mu$")
    legend_below([ax])
    note = "The dampings are not legible; K = 0.02, 0.05 and 0.1 of (7.38) taken."
    return Drawn(tuple(_least_mu_rows(f, (1,), 0.05)), (note,))


def figure_37(axes: Sequence[Axes]) -> Drawn:
    """Draw the first four regions with and without damping."""
    f, mu = f3_series(_LINKAGE), np.linspace(0.0, 1.0, 201)
    regions, ax = (1, 2, 3, 4), axes[0]
    for damping, colour in zip(_DAMPINGS[:3], COLOURS, strict=False):
        exact = hill_boundaries(f, mu, regions, damping=damping)
        for i in range(len(regions)):
            named = f"K = {damping:g}" if i == 0 else None
            ax.plot(*_outline(exact.lower[i], exact.upper[i], mu), color=colour, label=named)
    ax.set_xlim(-0.7, 4.6)
    ax.set_ylim(0.0, 1.0)
    ax.set_xlabel(r"$\lambda^2$")
    ax.set_ylabel(r"load parameter $\mu$")
    legend_below([ax])
    note = "Linkage (2,1,2,2), exact boundaries; linkage and dampings are not legible."
    return Drawn(tuple(_least_mu_rows(f, regions, 0.02)), (note,))


def _least_mu_rows(f: PeriodicFunction, regions: Sequence[int], damping: float) -> list[Quoted]:
    rows = []
    exact = critical_damping(f, None, regions, damping=damping).mu
    for n, least in zip(regions, exact, strict=True):
        printed = 2.0 * damping * n / float(f.amplitudes[n])
        rows.append(
            Quoted(
                f"(7.51): least mu of region {n} with K = {damping:g}",
                printed,
                float(least),
                0.05 * printed,
                "first order: 5 %",
                "7.1.4.2",
                differs="first order is too coarse for so large a mu" if n > 3 else "",
            )
        )
    return rows
