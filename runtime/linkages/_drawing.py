"""Pictures of a linkage: bars, pins, pivots, guide, slider and block, and the path of a point."""

from __future__ import annotations

from collections.abc import Iterable
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from ._circuits import Circuit
from ._taylor import Array, Complex

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .curves import CouplerCurve

COLOURS = {
    "crank": "tab:red",
    "coupler": "tab:blue",
    "follower": "tab:green",
    "slider": "tab:green",
    "block": "tab:green",
    "rod": "tab:blue",
}
_GREY = "0.45"


def bars(motion: Circuit, s: float) -> dict[str, Complex]:
    """Return the moving parts at one position as lines through complex places, by link."""
    at = {name: complex(place[0]) for name, place in motion.joints(np.array([s])).items()}
    unit = _unit(motion)
    found = {"crank": np.array([at["A"], at["B"]])}
    if motion.kind == "quick_return":
        rod = np.array([at["D"], at["C"]])
        turned = np.exp(1j * np.angle(at["B"] - at["D"]))
        return found | {"rod": rod, "block": at["B"] + turned * _box(unit, 0.6 * unit)}
    found["coupler"] = np.array([at["B"], at["C"]])
    if motion.kind == "four_bar":
        return found | {"follower": np.array([at["D"], at["C"]])}
    return found | {"slider": at["C"] + _box(unit, 0.6 * unit)}


def pins(motion: Circuit, s: float) -> Complex:
    """Return the places of the moving pins."""
    at = motion.joints(np.array([s]))
    names = ("B",) if motion.kind == "quick_return" else ("B", "C")
    return np.array([complex(at[name][0]) for name in names])


def point_bar(motion: Circuit, s: float, link: str, place: complex) -> Complex:
    """Return the line from the link's joints to a point of it."""
    here = motion.links(np.array([s]), 0)[link]
    origin, turn = complex(here.origin.c[0, 0]), complex(here.direction.c[0, 0])
    ends = [0.0, place / motion.scale]
    if link in motion.sizes and place.imag != 0:
        ends.append(motion.sizes[link])
    return motion.scale * (origin + turn * np.array(ends))


def draw_frame(ax: Axes, motion: Circuit, places: Iterable[Complex] = ()) -> None:
    """Draw what stands still, and set the limits so that the whole motion is seen."""
    unit = _unit(motion)
    s = np.arange(181) * 2 * pi / 181
    joints = motion.joints(s)
    pivots = [0j, *([complex(joints["D"][0])] if "D" in joints else [])]
    for pivot in pivots:
        foot = pivot + unit * np.array([0, -0.6 - 0.9j, 0.6 - 0.9j, 0])
        ax.fill(foot.real, foot.imag, color="0.8", ec=_GREY, lw=1.0, zorder=1)
        ax.plot(pivot.real, pivot.imag, "o", color="w", mec=_GREY, ms=5, zorder=5)
    if motion.kind == "slider_crank":
        travel = joints["C"].real
        ends = np.array([np.min(travel) - 1.6 * unit, np.max(travel) + 1.6 * unit])
        for side in (-0.6, 0.6):
            level = motion.scale * motion.sizes["offset"] + side * unit
            ax.plot(ends, [level, level], color=_GREY, lw=1.0, zorder=1)
    drawn = np.concatenate([*joints.values(), *(np.ravel(place) for place in places)])
    edge = 1.8 * unit
    ax.set_xlim(float(np.min(drawn.real)) - edge, float(np.max(drawn.real)) + edge)
    ax.set_ylim(float(np.min(drawn.imag)) - edge, float(np.max(drawn.imag)) + edge)
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")


def draw_linkage(ax: Axes, motion: Circuit, s: float, alpha: float = 1.0) -> dict[str, Any]:
    """Draw the moving parts at one position; return the artists by link, and "pins"."""
    artists: dict[str, Any] = {}
    for link, line in bars(motion, s).items():
        width = 2.5 if len(line) == 2 else 1.5
        (artists[link],) = ax.plot(
            line.real, line.imag, color=COLOURS[link], lw=width, alpha=alpha, zorder=3
        )
    at = pins(motion, s)
    (artists["pins"],) = ax.plot(
        at.real, at.imag, "o", color="w", mec="0.2", ms=5, alpha=alpha, zorder=4
    )
    return artists


def draw_curve(ax: Axes, curve: CouplerCurve) -> None:
    """Draw a path, the linkage at some positions, and what is marked on it."""
    motion = Circuit(curve.linkage, curve.circuit)
    place = complex(curve.along, curve.across)
    s = np.linspace(0.0, 2 * pi, max(721, len(curve.parameter) + 1))
    z = motion.scale * motion.path(s, curve.link, place / motion.scale, 0).c[0]
    draw_frame(ax, motion, [z])
    for i, start in enumerate((0.7, 0.7 + pi / 2, 0.7 + pi, 0.7 + 3 * pi / 2)):
        alpha = 1.0 if i == 0 else 0.22
        draw_linkage(ax, motion, start, alpha)
        line = point_bar(motion, start, curve.link, place)
        ax.plot(line.real, line.imag, color=COLOURS[curve.link], lw=1.0, alpha=alpha, zorder=2)
        ax.plot(line[1].real, line[1].imag, ".", color="k", alpha=alpha, zorder=6)
    ax.plot(z.real, z.imag, color="k", lw=1.3, label=f"point of the {curve.link}")
    _mark(ax, curve.cusp_position, "v", "tab:orange", "cusp")
    _mark(ax, curve.double_position, "D", "tab:purple", "double point")
    ax.legend(loc="best", fontsize="small")


def _mark(ax: Axes, places: Array, marker: str, colour: str, label: str) -> None:
    if len(places):
        ax.plot(
            *places.T, marker, color=colour, mec="k", mew=0.5, ms=7, ls="", label=label, zorder=7
        )


def _unit(motion: Circuit) -> float:
    """Return the half-width of a drawn block."""
    joints = motion.joints(np.arange(8) * pi / 4)
    places = np.concatenate(list(joints.values()))
    return 0.035 * float(np.ptp(places.real) + np.ptp(places.imag))


def _box(half_width: float, half_height: float) -> Complex:
    corners = np.array([1 + 1j, -1 + 1j, -1 - 1j, 1 - 1j, 1 + 1j])
    return half_width * corners.real + 1j * half_height * corners.imag
