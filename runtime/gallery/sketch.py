"""Linkages drawn with pins, arrows and arcs; links cut free with all that acts on them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..rigid import Machine, RigidForces, rigid_forces
from .drawing import COLOURS, Array, Axes

INK, GROUND = "#2b2b2b", "0.45"
LINK_COLOURS = {"crank": "#c8641e", "coupler": "#1f5a8c", "follower": "#3a7d44"}


def canvas(ax: Axes) -> Axes:
    """Make the axes a sheet to draw on, without frame and grid, in equal scales; return them."""
    ax.set_axis_off()
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    return ax


def bar(ax: Axes, start: ArrayLike, end: ArrayLike, link: str, **style: Any) -> None:
    """Draw a link as a rounded bar between two places, in its colour."""
    (x, u), (y, v) = np.transpose([start, end])
    look = {"color": LINK_COLOURS[link], "solid_capstyle": "round", "lw": 3.2, "zorder": 3}
    ax.plot([x, u], [y, v], **{**look, **style})


def pin(ax: Axes, *places: ArrayLike, size: float = 5.5) -> None:
    """Draw pins as small open circles."""
    for place in places:
        ax.plot(*np.asarray(place), "o", mfc="w", mec=INK, mew=1.0, ms=size, zorder=6)


def pivot(ax: Axes, place: ArrayLike, unit: float) -> None:
    """Draw a fixed pivot: a foot on hatched ground, about ``unit`` wide."""
    x, y = np.asarray(place, dtype=float)
    foot = unit * np.array([[0.0, 0.0], [-0.5, -0.8], [0.5, -0.8]]) + (x, y)
    ax.fill(*foot.T, facecolor="0.88", edgecolor=GROUND, lw=0.9, zorder=1)
    ground = y - 0.8 * unit
    ax.plot([x - 0.9 * unit, x + 0.9 * unit], [ground, ground], color=GROUND, lw=1.0, zorder=1)
    for left in np.linspace(-0.9, 0.7, 6):
        ends = [x + (left + 0.2) * unit, x + left * unit]
        ax.plot(ends, [ground, ground - 0.25 * unit], color=GROUND, lw=0.7, zorder=1)
    pin(ax, place)


def grounds(ax: Axes, a: ArrayLike, d: ArrayLike, unit: float, letters: str = "AD") -> None:
    """Draw the fixed pivots of a linkage with their letters outside, the first at the left."""
    for place, letter, side in zip((a, d), letters, (-16.0, 16.0), strict=True):
        pivot(ax, place, unit)
        write(ax, place, letter, (side, 3.0), style="italic")


def four_bar(ax: Axes, joints: Mapping[str, ArrayLike], unit: float, letters: str = "ABCD") -> None:
    """Draw a four-bar linkage by its joints, with letters at A, B, C and D."""
    a, b, c, d = (np.asarray(joints[name], dtype=float) for name in "ABCD")
    for link, start, end in (("crank", a, b), ("coupler", b, c), ("follower", d, c)):
        bar(ax, start, end, link)
    grounds(ax, a, d, unit, letters[0] + letters[3])
    pin(ax, b, c)
    for place, letter in ((b, letters[1]), (c, letters[2])):
        away = place - (a + b + c + d) / 4.0
        write(ax, place, letter, 13.0 * away / (np.hypot(*away) or 1.0), style="italic")


def _pair(place: ArrayLike) -> tuple[float, float]:
    x, y = np.asarray(place, dtype=float)
    return float(x), float(y)


def write(
    ax: Axes, place: ArrayLike, text: str, shift: ArrayLike = (0.0, 0.0), **style: Any
) -> None:
    """Write at a place, shifted by some points, on a pale halo so that lines do not cross it."""
    from matplotlib import patheffects

    ax.annotate(
        text,
        _pair(place),
        xytext=_pair(shift),
        textcoords="offset points",
        path_effects=[patheffects.withStroke(linewidth=2.5, foreground="w")],
        **{"ha": "center", "va": "center", "fontsize": 9, "zorder": 9, **style},
    )


def arrow(ax: Axes, tail: ArrayLike, vector: ArrayLike, colour: str, text: str = "") -> None:
    """Draw a vector to the scale of the axes; its name beyond the head."""
    start, way = np.asarray(tail, dtype=float), np.asarray(vector, dtype=float)
    head = start + way
    _head(ax, start, head, colour, ",head_length=0.45,head_width=0.2", lw=1.6, mutation_scale=14)
    # Annotations do not widen the limits of the axes.
    ax.update_datalim([start, head])
    ax.autoscale_view()
    if text:
        write(ax, head, text, 11.0 * way / (np.hypot(*way) or 1.0), color=colour)


def _head(
    ax: Axes, start: ArrayLike, tip: ArrayLike, colour: str, size: str = "", **style: Any
) -> None:
    look = {"arrowstyle": f"-|>{size}", "color": colour, "shrinkA": 0.0, "shrinkB": 0.0, **style}
    ax.annotate("", _pair(tip), xytext=_pair(start), arrowprops=look, zorder=7)


def arc(
    ax: Axes,
    centre: ArrayLike,
    radius: float,
    ends: tuple[float, float],
    text: str = "",
    **style: Any,
) -> None:
    """Draw an arc between two angles [rad], its letter outside the middle."""
    angles = np.linspace(*ends, 61)
    x, y = np.asarray(centre, dtype=float)
    look = {"color": "0.35", "lw": 0.9, "zorder": 2, **style}
    ax.plot(x + radius * np.cos(angles), y + radius * np.sin(angles), **look)
    if text:
        middle = 0.5 * (ends[0] + ends[1])
        way = np.array([np.cos(middle), np.sin(middle)])
        write(ax, (x, y) + radius * way, text, 11.0 * way)


def turning_arrow(
    ax: Axes, centre: ArrayLike, radius: float, value: float, text: str, colour: str
) -> None:
    """Draw a couple as three quarters of a turn about a place, in the sense of its sign."""
    ends = (-0.65 * pi, 0.65 * pi)
    arc(ax, centre, radius, ends, color=colour, lw=1.5)
    x, y = np.asarray(centre, dtype=float)
    last = ends[1] if value >= 0 else ends[0]
    before = last - 0.12 * np.sign(last)
    tip, start = (
        (x + radius * np.cos(angle), y + radius * np.sin(angle)) for angle in (last, before)
    )
    _head(ax, start, tip, colour)
    write(ax, (x + radius, y), text, (4.0, 0.0), color=colour, ha="left")


PIN_COLOUR, INERTIA_COLOUR, COUPLE_COLOUR = COLOURS[3], COLOURS[5], COLOURS[6]
# Pins of each link, and the joint forces there: which, and whether on this link or by it.
_PINS = {
    "crank": (("A", "f12", 1.0), ("B", "f23", -1.0)),
    "coupler": (("B", "f23", 1.0), ("C", "f34", -1.0)),
    "follower": (("D", "f41", -1.0), ("C", "f34", 1.0)),
}


@dataclass(frozen=True)
class Body:
    """A link with all that acts on it, inertia included.

    Places [m] of first joint, second joint and centre of mass; at these the two pin
    forces on the link and minus mass times acceleration [N]; minus inertia about the centre times
    angular acceleration, and the driving torque, zero but on the crank [N m].
    """

    link: str
    places: tuple[Array, Array, Array]
    forces: tuple[Array, Array, Array]
    inertia_couple: Array
    torque: Array


def free_bodies(
    machine: Machine, theta: float, speed: float
) -> tuple[dict[str, Body], RigidForces]:
    """Return the links of a four-bar machine cut free, and the forces that were computed.

    Without gravity and loads, at a crank angle [rad] and an even crank speed [rad/s].  The pin
    forces come from the closed form, the inertia forces from the motion of the centres.
    """
    forces = rigid_forces(machine, theta, speed, outputs=("pins", "torque"))
    motion = machine.linkage.motion(theta, speed)
    joints = motion.joints
    bodies = {}
    for link, ends in _PINS.items():
        mass = machine.mass(link)
        centre = motion.point(link, *mass.centre)
        spin = motion.link(link).angular_acceleration
        torque = forces.torque if link == "crank" else np.zeros_like(forces.torque)
        bodies[link] = Body(
            link,
            (joints[ends[0][0]], joints[ends[1][0]], centre.position),
            (
                *(sign * getattr(forces, name) for _, name, sign in ends),
                -mass.mass * centre.acceleration,
            ),
            -mass.inertia_about_centre * spin,
            torque,
        )
    return bodies, forces


def draw_body(
    ax: Axes,
    body: Body,
    letters: str,
    names: Mapping[str, str],
    scale: float,
    shift: ArrayLike = (0.0, 0.0),
) -> None:
    """Draw one link cut free at a single crank angle, every force to the same scale.

    Letters of first joint, second joint and centre; names of the forces at these, and of "torque"
    and "couple" where they are drawn; the length on paper of one newton [m]; where the link is
    moved to [m].
    """
    places = [place + np.asarray(shift) for place in body.places]
    first, second, centre = places
    length = float(np.hypot(*(second - first)))
    bar(ax, first, second, body.link, lw=4.5, alpha=0.85)
    pin(ax, first, second)
    ax.plot(*centre, "o", color="0.15", ms=4.0, zorder=6)
    normal = np.array([first[1] - second[1], second[0] - first[0]]) / length
    # The centre's letter goes to one side of the link, the inertia force's name to its own side.
    aside = normal if normal @ body.forces[2] > 0 else -normal
    for place, letter, force in zip(places, letters, body.forces, strict=True):
        name, head = names.get(letter, ""), place + scale * force
        if letter == "G":
            write(ax, place, letter, -12.0 * aside, style="italic")
            arrow(ax, place, scale * force, INERTIA_COLOUR)
            side = "left" if aside[0] > 0 else "right"
            write(ax, head, name, 8.0 * aside, color=INERTIA_COLOUR, ha=side)
            continue
        # In the gap of the arrow that stands for the torque.
        gap = np.array([-13.0, 5.0]) if "torque" in names and place is first else -12.0 * normal
        write(ax, place, letter, gap, style="italic")
        arrow(ax, place, scale * force, PIN_COLOUR, name)
    for name, place, share, value in (
        ("torque", first, 0.19, body.torque),
        ("couple", centre, 0.13, body.inertia_couple),
    ):
        if name in names:
            turning_arrow(ax, place, share * length, float(value), names[name], COUPLE_COLOUR)


def scale_bar(ax: Axes, corner: ArrayLike, scale: float, largest: float) -> None:
    """Draw a measure of forces: 1, 2 or 5 times a power of ten, at most half of the largest one."""
    power = 10.0 ** np.floor(np.log10(0.5 * largest))
    force = max(step for step in (1.0, 2.0, 5.0) if step * power <= 0.5 * largest) * power
    x, y = np.asarray(corner, dtype=float)
    length = scale * force
    ax.plot([x, x + length], [y, y], color="0.2", lw=1.4)
    for end in (x, x + length):
        ax.plot([end, end], [y - 0.03 * length, y + 0.03 * length], color="0.2", lw=1.0)
    write(ax, (x + 0.5 * length, y), f"{force:g} N", (0.0, 9.0), fontsize=8)
