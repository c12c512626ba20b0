"""Aannaque's Figs. 8.2 to 8.4: the computed path of the coupler's midpoint, slow and fast."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from .aannaque_rig import SPEEDS_C, Array, quiet_motion, rig
from .records import Drawn, Quoted, Relation
from .style import COLOURS, crank_axis, legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..recovery import ElasticCurve

_SLOW, _FAST = SPEEDS_C[0], SPEEDS_C[-1]
# Half a division of graph paper in millimetres [m].
_READ = 0.5e-3
# How much larger displacements are drawn beside the true path.
_LARGER = {_SLOW: 200.0, _FAST: 8.0}
_NOTES = (
    "The document's Fig. 8.2 is a pair of photographs, and the measured curves of Figs. 8.3 and "
    "8.4 are lost in the scan; drawn are the computed ones.",
    f"The speeds are not stated: the lowest and the highest of Appendix C, {_SLOW:g} and "
    f"{_FAST:g} rad/s, are taken.",
)


@lru_cache(maxsize=4)
def midpoint(speed: float) -> ElasticCurve:
    """Return the path of the coupler's midpoint at a crank speed [rad/s]."""
    from ..recovery import elastic_coupler_curve

    system = rig()
    return elastic_coupler_curve(system, quiet_motion(system, speed))


def figure_8_2(axes: Sequence[Axes]) -> Drawn:
    """Draw the path at a low and at a high speed, the rigid linkage's beside it."""
    for ax, speed in zip(axes, (_SLOW, _FAST), strict=True):
        found = midpoint(speed)
        _closed(ax, found.elastic, "-", COLOURS[0], "elastic linkage")
        _closed(ax, found.rigid, "--", "0.8", "rigid linkage")
        larger = _LARGER[speed]
        drawn = found.rigid + larger * found.displacement
        _closed(ax, drawn, ":", COLOURS[1], "elastic linkage, its displacement enlarged")
        _paper(ax)
        panel_title(ax, f"{speed:g} rad/s; dotted: displacement {larger:g} times as large")
    legend_below(axes)
    rows = (
        _off("largest distance from the rigid path at the low speed", _SLOW, "<", "'quasi-static'"),
        _off(
            "largest distance from the rigid path at the high speed",
            _FAST,
            ">",
            "'dynamic vibration starts to appear'",
        ),
    )
    return Drawn(rows, _NOTES)


def figure_8_3(axes: Sequence[Axes]) -> Drawn:
    """Draw the path at a low speed and how far it lies from that of the rigid linkage."""
    found = midpoint(_SLOW)
    _closed(axes[0], found.elastic, "-", COLOURS[0], "elastic linkage")
    _closed(axes[0], found.rigid, "--", "0.8", "rigid linkage")
    _paper(axes[0])
    legend_below(axes)
    _displacements(axes[1], (_SLOW,))
    row = _off("largest distance of both paths", _SLOW, "<", "not to be seen on graph paper")
    return Drawn((row,), _NOTES)


def figure_8_4(axes: Sequence[Axes]) -> Drawn:
    """Draw the paths at a low and at a high speed over each other, and their distances."""
    for speed, style, colour in ((_SLOW, "--", COLOURS[4]), (_FAST, "-", COLOURS[1])):
        _closed(axes[0], midpoint(speed).elastic, style, colour, f"{speed:g} rad/s")
    fast = midpoint(_FAST)
    enlarged = fast.rigid + _LARGER[_FAST] * fast.displacement
    label = f"{_FAST:g} rad/s, displacement {_LARGER[_FAST]:g} times as large"
    _closed(axes[0], enlarged, ":", COLOURS[1], label)
    _paper(axes[0])
    legend_below(axes)
    _displacements(axes[1], (_SLOW, _FAST))
    growth = fast.largest / midpoint(_SLOW).largest / (_FAST / _SLOW) ** 2
    row = Quoted(
        "distance from the rigid path, its growth over that of the inertia forces",
        1.0,
        float(growth),
        0.0,
        "'dynamic vibration starts to appear': more than the squared speed gives",
        "8.3",
        relation=">",
    )
    return Drawn((row,), _NOTES)


def _closed(ax: Axes, places: Array, style: str, colour: str, label: str) -> None:
    around = np.vstack([places, places[:1]])
    ax.plot(*(1e3 * around).T, style, color=colour, label=label)


def _paper(ax: Axes) -> None:
    ax.set_aspect("equal")
    ax.set_xlabel("x [mm]")
    ax.set_ylabel("y [mm]")


def _displacements(ax: Axes, speeds: Sequence[float]) -> None:
    for speed in speeds:
        found = midpoint(speed)
        colour = COLOURS[0] if len(speeds) == 1 else COLOURS[4 if speed == _SLOW else 1]
        size = 1e3 * np.hypot(*found.displacement.T)
        angle = np.degrees(np.append(found.theta, 2 * np.pi))
        ax.plot(angle, np.append(size, size[0]), color=colour)
    crank_axis(ax)
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel("distance from the rigid path [mm]")


def _off(number: str, speed: float, relation: Relation, words: str) -> Quoted:
    return Quoted(
        number,
        1e3 * _READ,
        1e3 * midpoint(speed).largest,
        0.0,
        f"{words}: half a millimetre, what graph paper shows",
        "8.3",
        relation=relation,
        unit="mm",
    )
