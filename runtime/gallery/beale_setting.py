"""Beale and Scott's Fig. 4, its setting: linkage and components of the tip's deflection."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..core.families import Array
from ..linkages import QuickReturn
from ..scenes import load_scene
from .beale_tip import (
    HEAVY,
    NAMES,
    READINGS,
    SIGN,
    STIFF,
    UNITS,
    peak,
    stiff_shapes,
    tip_axis,
    turns,
)
from .records import Drawn, Quoted
from .sketches import INK, LINK_COLOURS, bar, canvas, pin, pivot, write
from .style import COLOURS, legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ANGLES = (0.0, 60.0, 120.0, 180.0, 240.0, 300.0)
_CM = 100.0
_STATIONS = 201
_NOTES = (
    "Bahgat and Willmert's curves are not drawn: their data are not in the paper. What is drawn is "
    "our own converged deflection v across the rod, centrifugal tension kept, along the paper's "
    "unit vectors: U3 = -v sin(phi) along the base, V2 = v cos(phi) across it.",
    "Bahgat and Willmert's crank and block bend and their links stretch; here the crank is rigid "
    "and the rod does not stretch. In which configuration they count the crank angle from the "
    "paper does not say.",
)


def _linkage() -> QuickReturn:
    linkage = load_scene(STIFF).mechanism()
    if not isinstance(linkage, QuickReturn):
        raise TypeError("not a quick return")
    return linkage


def components(scene: str) -> tuple[Array, Array, Array]:
    """Return crank angles and the tip deflection's components U3 and V2 [m], converged."""
    theta, bent = stiff_shapes(scene, _STATIONS)
    tip = bent[:, -1]
    direction = np.asarray(_linkage().motion(theta).theta4)
    return theta, -tip * np.sin(direction), tip * np.cos(direction)


def figure_4(axes: Sequence[Axes]) -> Drawn:
    """Draw the linkage at some crank angles, and both components for both mass readings."""
    _draw_linkage(axes[0])
    rows = []
    for ax, (scene, title) in zip(axes[1:], READINGS, strict=True):
        theta, across, up = components(scene)
        angle = np.degrees(theta)
        ax.plot(angle, 1e3 * up, color=COLOURS[0], label="$V_2$, across the base (j)")
        ax.plot(angle, 1e3 * across, "--", color=COLOURS[1], label="$U_3$, along the base (i)")
        tip_axis(ax, title)
        rows += _rows(scene, across, up)
    axes[1].set_ylabel("tip deflection [mm]")
    legend_below(axes)
    return Drawn(tuple(rows), (*_NOTES, UNITS, SIGN))


def _draw_linkage(ax: Axes) -> None:
    """Draw the mechanism to scale, one position full and the others pale."""
    linkage = _linkage()
    centre = np.array([linkage.frame, 0.0]) * _CM
    canvas(ax)
    around = np.linspace(0.0, 2.0 * np.pi, 181)
    circle = centre[:, None] + linkage.crank * _CM * np.array([np.cos(around), np.sin(around)])
    ax.plot(*circle, color="0.75", lw=0.7, ls=(0, (4, 3)))
    shown = 60.0
    for degrees in sorted(_ANGLES, key=lambda angle: angle == shown):
        theta = np.radians(degrees)
        direction = float(linkage.motion(theta).theta4)
        tip = linkage.rod * _CM * np.array([np.cos(direction), np.sin(direction)])
        block = centre + linkage.crank * _CM * np.array([np.cos(theta), np.sin(theta)])
        pale = degrees != shown
        alpha = 0.25 if pale else 1.0
        bar(ax, (0.0, 0.0), tip, LINK_COLOURS["coupler"], alpha=alpha, lw=2.6, zorder=2)
        bar(ax, centre, block, LINK_COLOURS["crank"], alpha=alpha, lw=2.6, zorder=3)
        away = 11.0 * (block - centre) / np.hypot(*(block - centre))
        write(ax, block, f"{degrees:.0f}°", away, fontsize=7, color="0.3")
        if not pale:
            box = np.array([[-0.9, -0.5], [0.9, -0.5], [0.9, 0.5], [-0.9, 0.5]])
            turn = np.array([[tip[0], tip[1]], [-tip[1], tip[0]]]) / np.hypot(*tip)
            ax.fill(*(block + box @ turn).T, facecolor="w", edgecolor=INK, lw=1.0, zorder=5)
            pin(ax, block)
            write(ax, tip, "tip", (6.0, 9.0), style="italic")
    pivot(ax, (0.0, 0.0), 1.0)
    pivot(ax, centre, 1.0)
    write(ax, centre, "$C$", (0.0, -20.0))
    write(ax, (0.0, 0.0), "O", (-10.0, 5.0), style="italic")
    panel_title(ax, "crank 1.5 in, base 4 in, rod 9.3746 in, 90 rad/s")


def _rows(scene: str, across: Array, up: Array) -> list[Quoted]:
    name, where = NAMES[scene], "2.2"
    moved = np.abs(up) > 1e-3 * peak(up)
    whole = np.hypot(across, up)
    heavy = scene == HEAVY
    return [
        Quoted(
            f"largest U3 over V2 at one crank angle, {name}",
            0.5,
            float(np.max(np.abs(across[moved] / up[moved]))),
            0.0,
            "'U3 is always small compared to V2': below half",
            where,
            relation="<",
        ),
        Quoted(
            f"largest gap of the whole deflection to V2, over its peak, {name}",
            0.1,
            peak(whole - np.abs(up)) / peak(whole),
            0.0,
            "'approximately V2': within a tenth",
            where,
            relation="<",
        ),
        Quoted(
            f"largest angle of the tip's displacement from the perpendicular, {name}",
            5.0,
            lean(scene),
            0.0,
            "'almost perpendicularly to the rod axis': within 5 degrees",
            where,
            relation="<",
            unit="deg",
            differs="a deflection of a fifth of the length draws the tip in" if heavy else "",
        ),
        Quoted(
            f"turns of V2 in one revolution, {name}",
            2.0,
            float(turns(up)),
            0.0,
            "'absence of high frequency oscillations': the two of the inertia load",
            where,
            differs="undamped, this reading has them" if heavy else "",
        ),
    ]


def lean(scene: str) -> float:
    """Return the angle [deg] by which foreshortening turns the tip's largest displacement.

    The tip is drawn in by half the integral of the squared slope, to second order.
    """
    length = _linkage().rod
    _, bent = stiff_shapes(scene, _STATIONS)
    last = bent[int(np.argmax(np.abs(bent[:, -1])))]
    along = np.linspace(0.0, length, _STATIONS)
    drawn_in = 0.5 * float(np.trapezoid(np.gradient(last, along) ** 2, along))
    return float(np.degrees(np.arctan2(drawn_in, abs(last[-1]))))
