"""Smith's Figs. 11 to 19: free bodies of the links, polar diagrams of the pin forces."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import degrees, pi, radians
from typing import TYPE_CHECKING, Any

import numpy as np

from ..linkages import FourBar
from ..rigid import Machine, MassDistribution, RigidForces, rigid_forces
from ..scenes import load_scene
from . import sketch
from .drawing import COLOURS, Array
from .records import Drawn
from .registry import contents

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INCH, POUND = 0.0254, 4.4482216152605
TURN = np.linspace(0.0, 2.0 * pi, 1441)
_JOINTS = ("12", "23", "34", "41")


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
    return float(size[at]), _signed_degrees(TURN[at])


def _signed_degrees(angle: float) -> float:
    return (degrees(angle) + 180.0) % 360.0 - 180.0


def figure_11(axes: Sequence[Axes]) -> Drawn:
    """Draw the links cut free, every force to one scale."""
    ax = axes[0]
    sketch.canvas(ax)
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
    rows = [(f"F{joint}", *(getattr(forces, f"f{joint}") / POUND)) for joint in _JOINTS]
    return Drawn(_equations(machine, speed, 40.0), tables=[rows])


def _equations(machine: Machine, speed: float, acceleration: float) -> list[float]:
    """Return how well the equations (4.4) to (4.13) hold, at a crank that speeds up too."""
    drive = (speed, acceleration)
    bodies = sketch.free_bodies(machine, TURN, *drive)[0]
    forces = rigid_forces(machine, TURN, *drive)
    pin, torque = _printed_forces(machine, *drive)
    moment, complete = machine.linkage.lengths["frame"] * forces["y41"], forces.shaking_moment
    pairs = (
        _accelerations(machine, drive),
        (pin, forces.f34),
        (torque, forces.torque),
        (forces.f41 - forces.f12, forces.shaking_force),
        (moment, complete),
        (moment - forces.torque, complete),
    )
    return [
        *(
            value
            for body in bodies.values()
            for value in (body.unbalanced_force, body.unbalanced_moment)
        ),
        *(float(np.max(np.abs(one - other)) / np.max(np.abs(other))) for one, other in pairs),
    ]


def _accelerations(machine: Machine, drive: tuple[float, float]) -> tuple[Array, Array]:
    """Return those of the centres by (4.1) to (4.3) as printed, and by the motion of points."""
    motion: Any = machine.linkage.motion(TURN, *drive)

    def swung(radius: float, angle: Array, speed: Any, acceleration: Any) -> Array:
        along = speed**2 * np.cos(angle) + acceleration * np.sin(angle)
        up = speed**2 * np.sin(angle) - acceleration * np.cos(angle)
        return -radius * np.stack([along, up], axis=-1)

    radii = {link: machine.mass(link).centre[0] for link in machine.linkage.links}
    crank_pin = swung(machine.linkage.lengths["crank"], TURN, *drive)
    printed = [
        swung(radii["crank"], TURN, *drive),
        crank_pin + swung(radii["coupler"], motion.theta3, motion.omega3, motion.alpha3),
        swung(radii["follower"], motion.theta4, motion.omega4, motion.alpha4),
    ]
    points = [motion.point(link, radius).acceleration for link, radius in radii.items()]
    return np.array(printed), np.array(points)


def _printed_forces(machine: Machine, speed: float, acceleration: float) -> tuple[Array, Array]:
    """Return the pin force (4.7) and the torque (4.11) as printed, over the turn."""
    motion: Any = machine.linkage.motion(TURN, speed, acceleration)
    l2, l3, l4 = (machine.linkage.lengths[name] for name in ("crank", "coupler", "follower"))
    coupler, follower = machine.mass("coupler"), machine.mass("follower")
    t2, t3, t4 = motion.theta2, motion.theta3, motion.theta4
    bracket = speed**2 * np.sin(t2 - t3) - acceleration * np.cos(t2 - t3)
    parts = [
        coupler.inertia * motion.alpha3 * l4 * part(t4)
        + follower.inertia * motion.alpha4 * l3 * part(t3)
        - coupler.along * l2 * l4 * part(t4) * bracket
        for part in (np.cos, np.sin)
    ]
    pin = np.stack(parts, axis=-1) / (l3 * l4 * np.sin(t3 - t4))[:, np.newaxis]
    forces = rigid_forces(machine, TURN, speed, acceleration, ("pins",))
    arm = forces["y23"] * l2 * np.cos(t2) - forces["x23"] * l2 * np.sin(t2)
    return pin, machine.mass("crank").inertia * acceleration + arm


def polar(axes: Sequence[Axes], joint: str) -> Drawn:
    """Draw one polar diagram of Figs. 12 to 16."""
    ax, forces = axes[0], example_forces()
    forces.plot(ax, joint)
    polar_look(ax)
    ax.set_title("")
    values = [peak(forces.shaking_force if joint == "frame" else getattr(forces, f"f{joint}"))[1]]
    if joint == "12":
        motion: Any = example()[0].linkage.motion(TURN)
        values += [peak(motion.alpha3)[1], peak(motion.alpha4)[1]]
        values.append(_signed_degrees(TURN[int(np.argmin(motion.transmission_angle))]))
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
    axes: Sequence[Axes], frame: float, coupler: float, follower: float, cranks: Sequence[float]
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
