"""Smith's Figs. 23(a) to (c): inertia of a balanced link over offset and counterweight density."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .balanced_link import BalancedLink, density_number, offset_function, optimal_offset
from .records import Drawn, Quoted, Table
from .sketches import Array, write
from .style import COLOURS, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MASS, _LENGTH, _THICKNESS = 1.0, 1.0, 0.1
_DENSITIES = (5.0, 10.0, 20.0, 40.0, 80.0)
_LETTERS = "ABCDE"
# So light that no counterweight at all is best.
_LIGHT = 2.5
_ROUND_OFF = 1e-12


def _number(density: float) -> float:
    return density_number(_MASS, _LENGTH, _THICKNESS, density)


def _best() -> list[tuple[str, float, float, float]]:
    """Return letter, density, K and best offset of the five counterweights."""
    return [
        (letter, density, _number(density), float(optimal_offset(_number(density))))
        for letter, density in zip(_LETTERS, _DENSITIES, strict=True)
    ]


def figure_23a(axes: Sequence[Axes]) -> Drawn:
    """Draw K over the offset for which it makes the inertia least."""
    ax = axes[0]
    delta = np.linspace(0.0, 1.0, 401)
    ax.plot(delta, offset_function(delta), color=COLOURS[0])
    for letter, _, number, best in _best():
        ax.plot([best, best, 0.0], [0.0, number, number], ":", color="0.6", lw=0.9)
        ax.plot(best, number, "o", color=COLOURS[1], ms=5)
        write(ax, (best, number), letter, (-10.0, 8.0))
    ax.set_xlim(0.0, 1.0)
    ax.set_ylim(0.0, 0.55)
    ax.set_xlabel(r"offset $\delta=\ell/L$")
    ax.set_ylabel(r"$K=\delta^3/(1+\delta^2)$")
    inside = delta[1:]
    steps = np.diff(offset_function(delta))
    rows = [
        Quoted("least value of K", 0.0, float(offset_function(0.0)), _ROUND_OFF, "round-off", "5"),
        Quoted(
            "greatest value of K", 0.5, float(offset_function(1.0)), _ROUND_OFF, "round-off", "5"
        ),
        Quoted(
            "least step of K between rising offsets",
            0.0,
            float(steps.min()),
            0.0,
            "one offset for each K: it only rises",
            "5",
            relation=">",
        ),
        Quoted(
            "best offset where K exceeds 0.5, K = 0.6",
            1.0,
            float(optimal_offset(0.6)),
            _ROUND_OFF,
            "no extreme within 0 < delta < 1: the end is best",
            "5",
        ),
        *_equation_rows(inside),
    ]
    return Drawn(tuple(rows), (_DATA_NOTE,))


_DATA_NOTE = (
    "A to E: the link of Figs. 23(b) and (c), M = 1, L = 1, h = 0.1 and densities 5, 10, 20, 40 "
    "and 80. For the mass 'H = 1' read M."
)


def _equation_rows(delta: Array) -> list[Quoted]:
    """Return the printed inertia, its derivative and the quintic beside what holds."""
    number = _number(_DENSITIES[2])
    link = BalancedLink(delta, number)
    bars = 0.5 * (1.0 + delta**2)
    rest = 0.25 * number * (1.0 / delta - delta) ** 2 + 0.5 * (delta - delta**3)
    slope = 0.5 * (1.0 - delta**2) + 0.5 * number * (delta - delta**-3.0)
    quintic = max(abs(d**5 - k * d**4 - d**3 + k) for _, _, k, d in _best())
    exact = (1.0 + delta**3) / 3.0
    scale = np.abs(link.slope).max()
    return [
        Quoted(
            "printed inertia less the true one, worst, over M L^2",
            0.0,
            float(np.max(np.abs(bars + rest - link.inertia))),
            _ROUND_OFF,
            "round-off",
            "5",
            differs="the bars have M L^2 (1 + delta^3)/3, not (1 + delta^2)/2",
        ),
        Quoted(
            "the same with the bars' own inertia, over the greatest",
            0.0,
            float(np.max(np.abs(exact + rest - link.inertia)) / link.inertia.max()),
            _ROUND_OFF,
            "round-off",
            "5",
        ),
        Quoted(
            "printed derivative less the true one, over the greatest",
            0.0,
            float(np.max(np.abs(slope - link.slope)) / scale),
            _ROUND_OFF,
            "round-off; it belongs to the true inertia",
            "5",
        ),
        Quoted(
            "quintic at the best offsets A to E",
            0.0,
            quintic,
            _ROUND_OFF,
            "round-off",
            "5",
        ),
    ]


def _densities(ax: Axes, delta: Array, beside: float) -> None:
    """Draw the inertia over the offset for the densities, and its minima with their letters."""
    for (letter, density, number, best), colour in zip(_best(), COLOURS, strict=False):
        link = BalancedLink(delta, number)
        ax.plot(delta, link.inertia, color=colour, label=rf"$\rho$ = {density:g}")
        least = float(BalancedLink(best, number).inertia)
        ax.plot(best, least, "o", color=colour, ms=4.5)
        write(ax, (best, least), letter, (beside, -10.0), color=colour)
    ax.set_xlabel(r"offset $\delta=\ell/L$")
    ax.set_ylabel(r"$I_G/(M L^2)$")
    legend_below([ax], columns=6)


def figure_23b(axes: Sequence[Axes]) -> Drawn:
    """Draw the inertia over the offset for a range of densities."""
    ax = axes[0]
    delta = np.linspace(0.06, 1.0, 471)
    light = BalancedLink(delta, _number(_LIGHT))
    ax.plot(delta, light.inertia, "--", color="0.45", label=rf"$\rho$ = {_LIGHT:g}")
    _densities(ax, delta, 0.0)
    ax.set_xlim(0.0, 1.0)
    ax.set_ylim(0.3, 2.0)
    return Drawn(tuple(_density_rows()), (_DATA_NOTE, _LIGHT_NOTE), (_best_table(),))


_LIGHT_NOTE = (
    f"The density {_LIGHT:g} is added: of the five, none is so low that K exceeds 0.5 and no "
    "counterweight at all is best."
)


def _density_rows() -> list[Quoted]:
    end = BalancedLink(1.0, _number(_LIGHT))
    offsets = [best for *_, best in _best()]
    pivoted = 2.0 * _MASS * (2.0 * _LENGTH) ** 2 / 12.0
    return [
        Quoted(
            "offset of least inertia for a low density",
            1.0,
            float(optimal_offset(_number(_LIGHT))),
            _ROUND_OFF,
            f"density {_LIGHT:g}",
            "5",
        ),
        Quoted(
            "inertia there: a link of length 2 L pivoted at its centre",
            pivoted,
            float(end.inertia),
            _ROUND_OFF,
            "round-off",
            "5",
        ),
        Quoted(
            "radius of the counterweight there", 0.0, float(end.radius), _ROUND_OFF, "zero", "5"
        ),
        Quoted(
            "greatest of the best offsets A to E",
            1.0,
            max(offsets),
            0.0,
            "'within the range 0 < delta < 1'",
            "5",
            relation="<",
        ),
        Quoted(
            "least of the best offsets A to E",
            0.0,
            min(offsets),
            0.0,
            "'within the range 0 < delta < 1'",
            "5",
            relation=">",
        ),
    ]


def _best_table() -> Table:
    rows = []
    for letter, density, number, best in _best():
        link = BalancedLink(best, number)
        values = (number, best, link.inertia, link.counterweight, link.radius)
        rows.append((letter, f"{density:g}", *(f"{float(value):.5f}" for value in values)))
    header = ("point", "density", "K", "delta", "I/(M L^2)", "m_c/M", "r_c/L")
    return Table("Minima of the inertia", header, tuple(rows))


def figure_23c(axes: Sequence[Axes]) -> Drawn:
    """Draw the neighbourhood of the minima, and the line on which they lie."""
    ax = axes[0]
    delta = np.linspace(0.1, 1.0, 451)
    numbers = offset_function(delta)
    line = BalancedLink(delta, numbers)
    ax.plot(delta, line.inertia, "--", color="0.3", lw=1.3, label="minima of all densities")
    _densities(ax, delta, 6.0)
    ax.set_xlim(0.1, 1.0)
    ax.set_ylim(0.4, 0.85)
    return Drawn(tuple(_minimum_rows()), (_DATA_NOTE,))


def _minimum_rows() -> list[Quoted]:
    """Return each lettered offset beside the least of the sampled inertia: another route."""
    delta = np.linspace(0.05, 1.0, 9501)
    rows = []
    for letter, density, number, best in _best():
        sampled = BalancedLink(delta, number).inertia
        rows.append(
            Quoted(
                f"offset {letter}, density {density:g}: root of (1 + delta^2) K = delta^3",
                float(delta[int(np.argmin(sampled))]),
                best,
                1e-4,
                "left, the least of 9501 samples, 1e-4 apart",
                "5",
            )
        )
    offsets, least = zip(
        *((best, float(BalancedLink(best, k).inertia)) for *_, k, best in _best()),
        strict=True,
    )
    falls = max(np.max(np.diff(offsets)), np.max(np.diff(least)))
    rows.append(
        Quoted(
            "largest step of best offset and least inertia from A to E",
            0.0,
            float(falls),
            0.0,
            "both fall as the density grows",
            "5",
            relation="<",
        )
    )
    return rows
