"""Free bodies of a four-bar's links: forces at pins and centre, their balance, drawn to scale."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..rigid import Machine, RigidForces, rigid_forces
from .drawing import COLOURS, LINK_COLOURS, Array, arrow, bar, pin, turning_arrow, write

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PIN_COLOUR, INERTIA_COLOUR, COUPLE_COLOUR = COLOURS[3], COLOURS[5], COLOURS[6]
# Pins of each link, and the joint forces there: which, and whether on this link or by it.
_PINS = {
    "crank": (("A", "f12", 1.0), ("B", "f23", -1.0)),
    "coupler": (("B", "f23", 1.0), ("C", "f34", -1.0)),
    "follower": (("D", "f41", -1.0), ("C", "f34", 1.0)),
}


@dataclass(frozen=True)
class Body:
    """A link with all that acts on it, inertia included, at some crank angles.

    Places [m] of first joint, second joint and centre of mass, ``(..., 2)``; at these the two pin
    forces on the link and minus mass times acceleration [N]; minus inertia about the centre times
    angular acceleration, and the driving torque, zero but on the crank [N m].
    """

    link: str
    places: tuple[Array, Array, Array]
    forces: tuple[Array, Array, Array]
    inertia_couple: Array
    torque: Array

    @property
    def unbalanced_force(self) -> float:
        """Largest sum of the forces over the largest of them."""
        largest = max(float(np.max(np.hypot(*part.T))) for part in self.forces)
        return float(np.max(np.abs(sum(self.forces)))) / largest

    @property
    def unbalanced_moment(self) -> float:
        """Largest sum of moments about the centre of mass over the largest of its terms."""
        terms = [self.inertia_couple, self.torque]
        for place, force in zip(self.places, self.forces, strict=True):
            arm = place - self.places[2]
            terms.append(arm[..., 0] * force[..., 1] - arm[..., 1] * force[..., 0])
        return float(np.max(np.abs(sum(terms)))) / max(float(np.max(np.abs(t))) for t in terms)


def free_bodies(
    machine: Machine, theta: ArrayLike, speed: float, acceleration: float = 0.0
) -> tuple[dict[str, Body], RigidForces]:
    """Return the links of a four-bar machine cut free, and the forces that were computed.

    Without gravity and loads, at crank angles [rad], crank speed [rad/s] and acceleration.  The pin
    forces come from the closed form, the inertia forces from the motion of the centres.
    """
    forces = rigid_forces(machine, theta, speed, acceleration, ("pins", "torque"))
    motion = machine.linkage.motion(theta, speed, acceleration)
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
    bar(ax, first, second, LINK_COLOURS[body.link], lw=4.5, zorder=3, alpha=0.85)
    pin(ax, first, second)
    ax.plot(*centre, "o", color="0.15", ms=4.0, zorder=6)
    normal = np.array([first[1] - second[1], second[0] - first[0]]) / length
    # The centre's letter goes to one side of the link, the inertia force's name to its own side.
    aside = normal if normal @ body.forces[2] > 0 else -normal
    for place, letter in zip(places, letters, strict=True):
        shift = -12.0 * (aside if letter == "G" else normal)
        if "torque" in names and place is first:
            # In the gap of the arrow that stands for the torque.
            shift = np.array([-13.0, 5.0])
        write(ax, place, letter, shift, style="italic")
    colours = (PIN_COLOUR, PIN_COLOUR, INERTIA_COLOUR)
    for place, letter, force, colour in zip(places, letters, body.forces, colours, strict=True):
        name = names.get(letter, "")
        arrow(ax, place, scale * force, colour, "" if letter == "G" else name)
        if letter == "G" and name:
            side = "left" if aside[0] > 0 else "right"
            write(ax, place + scale * force, name, 8.0 * aside, color=colour, ha=side)
    if "torque" in names:
        value = float(body.torque)
        turning_arrow(ax, first, 0.19 * length, value, names["torque"], COUPLE_COLOUR)
    if "couple" in names:
        value = float(body.inertia_couple)
        turning_arrow(ax, centre, 0.13 * length, value, names["couple"], COUPLE_COLOUR)


def scale_bar(ax: Axes, corner: ArrayLike, scale: float, force: float) -> None:
    """Draw a force of a round size as a measure of the others."""
    x, y = np.asarray(corner, dtype=float)
    length = scale * force
    ax.plot([x, x + length], [y, y], color="0.2", lw=1.4)
    for end in (x, x + length):
        ax.plot([end, end], [y - 0.03 * length, y + 0.03 * length], color="0.2", lw=1.0)
    write(ax, (x + 0.5 * length, y), f"{force:g} N", (0.0, 9.0), fontsize=8)


def round_force(largest: float) -> float:
    """Return 1, 2 or 5 times a power of ten, at most half of the largest force."""
    power = 10.0 ** np.floor(np.log10(0.5 * largest))
    return float(max(step for step in (1.0, 2.0, 5.0) if step * power <= 0.5 * largest) * power)
