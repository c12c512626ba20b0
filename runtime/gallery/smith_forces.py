"""Smith's Figs. 11 to 19: free bodies of the links, polar diagrams of the pin forces."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import degrees, pi, radians
from typing import Any

import numpy as np

from ..linkages import FourBar
from ..rigid import Machine, MassDistribution, RigidForces, rigid_forces
from ..scenes import load_scene
from . import sketch
from .drawing import COLOURS, Array, Axes, Panels
from .records import Drawn
from .registry import contents

INCH, POUND = 0.0254, 4.4482216152605
TURN = np.linspace(0.0, 2.0 * pi, 1441)


@lru_cache(maxsize=1)
def example() -> tuple[Machine, float]:
    """Return the machine of Figs. 12 to 16 and its crank speed [rad/s]."""
    scene = load_scene("smith_1972_12_6_12_12")
    return scene.machine(), float(scene["operation"]["speed"])


@lru_cache(maxsize=1)
def example_forces() -> RigidForces:
    """Return its forces over a turn, a quarter of a degree apart."""
    machine, speed = example()
    return rigid_forces(machine, TURN, speed)


def peak(values: Array) -> tuple[float, float]:
    """Return the largest size of vectors over the turn, and its crank angle [deg] from 0."""
    size = np.hypot(*values.T) if values.ndim > 1 else np.abs(values)
    at = int(np.argmax(size))
    return float(size[at]), (degrees(TURN[at]) + 180.0) % 360.0 - 180.0


def figure_11(axes: Panels) -> Drawn:
    """Draw the links cut free, every force to one scale."""
    ax = sketch.canvas(axes[0])
    machine, speed = example()
    bodies, forces = sketch.free_bodies(machine, radians(30.0), speed)
    largest = max(float(np.hypot(*force)) for body in bodies.values() for force in body.forces)
    frame = machine.linkage.lengths["frame"]
    scale = 0.5 * frame / largest
    for link, body in bodies.items():
        drawn = contents("smith")["bodies"][link]
        place = frame * np.array(drawn["place"])
        sketch.draw_body(ax, body, drawn["letters"], drawn["names"], scale, place)
    ground = frame * np.array([[-0.45, -0.75], [1.95, -0.55]])
    for place in ground:
        sketch.pivot(ax, place, 0.1 * frame)
    on_frame = ((-forces.f12, "$F_{21}$"), (forces.f41, "$F_{41}$"))
    for place, (force, text) in zip(ground, on_frame, strict=True):
        sketch.arrow(ax, place, scale * np.asarray(force), COLOURS[3], text)
    sketch.scale_bar(ax, (0.15 * frame, -0.8 * frame), scale, sketch.round_force(largest))
    names = ("f12", "f23", "f34", "f41")
    rows = [(name.upper(), *(getattr(forces, name) / POUND)) for name in names]
    return Drawn(tables=[rows])


def polar(axes: Panels, joint: str) -> Drawn:
    """Draw one polar diagram of Figs. 12 to 16."""
    ax, forces = axes[0], example_forces()
    forces.plot(ax, joint)
    polar_look(ax)
    ax.set_title("")
    values = [peak(forces.shaking_force if joint == "frame" else getattr(forces, f"f{joint}"))[1]]
    if joint == "12":
        motion: Any = example()[0].linkage.motion(TURN)
        values += [peak(motion.alpha3)[1], peak(motion.alpha4)[1]]
    return Drawn(values)


def polar_look(ax: Axes) -> None:
    """Draw the axes of a polar diagram through its origin, and leave room for the angles."""
    ax.axhline(0.0, color="0.75", lw=0.8, zorder=1)
    ax.axvline(0.0, color="0.75", lw=0.8, zorder=1)
    ax.margins(0.12)
    ax.autoscale_view()


def finish_polar(ax: Axes) -> None:
    """Mark the origin and scale both axes alike."""
    ax.plot(0.0, 0.0, "+", color="k")
    ax.set_aspect("equal", adjustable="datalim")
    polar_look(ax)


def family(
    axes: Panels, frame: float, coupler: float, follower: float, cranks: Sequence[float]
) -> Drawn:
    """Draw the follower-frame force of linkages that differ in the crank [in], Figs. 17 to 19."""
    ax, peaks, accelerations = axes[0], [], []
    machine, speed = example()
    per_length = machine.mass("coupler").mass / machine.linkage.lengths["coupler"]
    for crank, colour in zip(cranks, COLOURS, strict=False):
        linkage = FourBar(INCH * frame, INCH * crank, INCH * coupler, INCH * follower)
        masses = {
            link: MassDistribution.uniform_bar(per_length * length, length)
            for link, length in linkage.lengths.items()
            if link != "frame"
        }
        forces = rigid_forces(Machine(linkage, masses), TURN, speed, outputs=("pins",)).f41
        peaks.append(peak(forces)[0])
        accelerations.append(float(np.max(np.abs(linkage.motion(TURN).alpha4))))
        x, y = forces.T
        name = f"({frame:g}, {crank:g}, {coupler:g}, {follower:g})"
        ax.plot(x, y, color=colour, label=f"{name}: {peaks[-1]:.1f} N")
        ax.plot(x[:-1:120], y[:-1:120], "o", color=colour, ms=2.6)
        ax.plot(x[0], y[0], "o", mfc="w", mec=colour, ms=5.0)
    finish_polar(ax)
    powers = np.diff(np.log([accelerations, peaks])) / np.diff(np.log(cranks))
    return Drawn(list(np.min(powers, axis=1)))
