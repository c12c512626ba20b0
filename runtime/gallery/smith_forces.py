"""Smith's Figs. 11 to 19: free bodies of the links, polar diagrams of the pin forces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import degrees, log, pi, radians
from typing import TYPE_CHECKING, Any

import numpy as np

from ..linkages import FourBar
from ..rigid import Machine, MassDistribution, RigidForces, rigid_forces
from ..scenes import load_scene
from .free_bodies import draw_body, free_bodies, round_force, scale_bar
from .records import Drawn, Quoted, Table
from .sketches import Array, arrow, canvas, pivot
from .style import COLOURS, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SCENE = "smith_1972_12_6_12_12"
INCH, POUND = 0.0254, 4.4482216152605
TURN = np.linspace(0.0, 2.0 * pi, 1441)
_CRANK_ANGLE = radians(30.0)
_CRANK_ACCELERATION = 40.0
_ROUND_OFF = 1e-11
_NEAR_ZERO = 30.0


@lru_cache(maxsize=1)
def example() -> tuple[Machine, float]:
    """Return the machine of Figs. 12 to 16 and its crank speed [rad/s]."""
    scene = load_scene(SCENE)
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


def figure_11(axes: Sequence[Axes]) -> Drawn:
    """Draw the links cut free, every force to one scale."""
    ax = axes[0]
    canvas(ax)
    machine, speed = example()
    bodies, forces = free_bodies(machine, _CRANK_ANGLE, speed)
    largest = max(float(np.hypot(*force)) for body in bodies.values() for force in body.forces)
    frame = machine.linkage.lengths["frame"]
    scale = 0.5 * frame / largest
    names: dict[str, tuple[str, dict[str, str]]] = {
        "crank": (
            "ABG",
            {"A": "$F_{12}$", "B": "$F_{32}$", "G": r"$-M_2\mathbf{a}_2$", "torque": "$T$"},
        ),
        "coupler": ("BCG", {"B": "$F_{23}$", "C": "$F_{43}$", "G": r"$-M_3\mathbf{a}_3$"}),
        "follower": ("DCG", {"D": "$F_{14}$", "C": "$F_{34}$", "G": r"$-M_4\mathbf{a}_4$"}),
    }
    apart = {"crank": (-0.45, -0.25), "coupler": (0.05, 0.55), "follower": (0.95, 0.0)}
    for link, body in bodies.items():
        letters, called = names[link]
        draw_body(ax, body, letters, called, scale, frame * np.array(apart[link]))
    ground = frame * np.array([[-0.45, -0.75], [1.95, -0.55]])
    for place in ground:
        pivot(ax, place, 0.1 * frame)
    on_frame = ((-forces.f12, "$F_{21}$"), (forces.f41, "$F_{41}$"))
    for place, (force, text) in zip(ground, on_frame, strict=True):
        arrow(ax, place, scale * np.asarray(force), COLOURS[3], text)
    scale_bar(ax, (0.15 * frame, -0.8 * frame), scale, round_force(largest))
    note = (
        f"Drawn at theta2 = {degrees(_CRANK_ANGLE):g} deg with the data of Figs. 12 to 16, at "
        "constant crank speed; the figure states neither. Resultants instead of components, "
        "inertia forces at the centres of mass; a force F_ij is that of link i upon link j."
    )
    return Drawn(tuple(_equation_rows()), (note,), (_force_table(forces),))


def _force_table(forces: RigidForces) -> Table:
    rows = tuple(
        (f"F{name[1:]}", *(f"{float(part) / POUND:.4f}" for part in getattr(forces, name)))
        for name in ("f12", "f23", "f34", "f41")
    )
    return Table("Pin forces at this angle [lbf]", ("force", "X", "Y"), rows)


def _equation_rows() -> list[Quoted]:
    """Return how well the equations (4.4) to (4.13) hold, at a crank that speeds up too."""
    machine, speed = example()
    drive = (speed, _CRANK_ACCELERATION)
    bodies = free_bodies(machine, TURN, *drive)[0]
    forces = rigid_forces(machine, TURN, *drive)
    meaning = f"round-off; a whole turn at alpha2 = {_CRANK_ACCELERATION:g} rad/s^2"
    rows = [
        Quoted(
            f"sum of {kind} on link {ends}, ({number}), over the largest",
            0.0,
            value,
            _ROUND_OFF,
            meaning,
            "4.2",
        )
        for (link, ends, number) in (
            ("crank", "AB", "4.4"),
            ("coupler", "BC", "4.5"),
            ("follower", "CD", "4.6"),
        )
        for kind, value in (
            ("forces", bodies[link].unbalanced_force),
            ("moments", bodies[link].unbalanced_moment),
        )
    ]
    printed = _printed(machine, drive)
    for number, value, found in (
        ("accelerations of G2, G3, G4 by (4.1) to (4.3)", *_printed_accelerations(machine, drive)),
        ("X34 and Y34 by (4.7)", printed["pin"], forces.f34),
        ("T by (4.11)", printed["torque"], forces.torque),
        ("force on the frame by (4.12)", forces.f41 - forces.f12, forces.shaking_force),
    ):
        gap = float(np.max(np.abs(value - found)) / np.max(np.abs(found)))
        text = f"{number} less the one here, over its peak"
        rows.append(Quoted(text, 0.0, gap, _ROUND_OFF, meaning, "4.2"))
    return [*rows, *_moment_rows(machine, forces, meaning)]


def _moment_rows(machine: Machine, forces: RigidForces, meaning: str) -> list[Quoted]:
    """Return (4.13) beside the complete moment, without and with the drive's reaction."""
    moment = machine.linkage.lengths["frame"] * forces["y41"]
    complete = forces.shaking_moment
    return [
        Quoted(
            "moment on the frame by (4.13) less the complete one, over its peak",
            0.0,
            float(np.max(np.abs(moment - complete)) / np.max(np.abs(complete))),
            _ROUND_OFF,
            meaning,
            "4.2",
            differs="l1 Y41 leaves out the reaction of the drive, which the frame bears too; the "
            "moment about A is l1 Y41 - T",
        ),
        Quoted(
            "the same with the reaction of the drive",
            0.0,
            float(np.max(np.abs(moment - forces.torque - complete)) / np.max(np.abs(complete))),
            _ROUND_OFF,
            meaning,
            "4.2",
        ),
    ]


def _printed_accelerations(machine: Machine, drive: tuple[float, float]) -> tuple[Array, Array]:
    """Return the accelerations of the three centres as printed, and by the motion of points."""
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
    found = [motion.point(link, radius).acceleration for link, radius in radii.items()]
    return np.array(printed), np.array(found)


def _printed(machine: Machine, drive: tuple[float, float]) -> dict[str, Array]:
    """Return (4.7) and (4.11) as printed, over the turn."""
    speed, acceleration = drive
    motion: Any = machine.linkage.motion(TURN, *drive)
    lengths = machine.linkage.lengths
    l2, l3, l4 = (lengths[name] for name in ("crank", "coupler", "follower"))
    coupler, follower = machine.mass("coupler"), machine.mass("follower")
    t2, t3, t4 = motion.theta2, motion.theta3, motion.theta4
    bracket = speed**2 * np.sin(t2 - t3) - acceleration * np.cos(t2 - t3)
    below = l3 * l4 * np.sin(t3 - t4)
    pin = np.stack(
        [
            (
                coupler.inertia * motion.alpha3 * l4 * part(t4)
                + follower.inertia * motion.alpha4 * l3 * part(t3)
                - coupler.along * l2 * l4 * part(t4) * bracket
            )
            / below
            for part in (np.cos, np.sin)
        ],
        axis=-1,
    )
    forces = rigid_forces(machine, TURN, *drive, ("pins",))
    torque = (
        machine.mass("crank").inertia * acceleration
        + forces["y23"] * l2 * np.cos(t2)
        - forces["x23"] * l2 * np.sin(t2)
    )
    return {"pin": pin, "torque": torque}


def polar_figure(joint: str) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the function that draws one polar diagram of Figs. 12 to 16."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        ax = axes[0]
        forces = example_forces()
        forces.plot(ax, joint)
        polar_look(ax)
        ax.set_title("")
        values = forces.shaking_force if joint == "frame" else getattr(forces, f"f{joint}")
        note = (
            "The captions do not say which joint is which; taken in the order 12, 23, 34, 41, and "
            "the frame last. A point is the force at the crank angle beside it, every 30 deg."
        )
        return Drawn(tuple(_polar_rows(joint, values)), (note,))

    return draw


def polar_look(ax: Axes) -> None:
    """Draw the axes of a polar diagram through its origin, and leave room for the angles."""
    ax.axhline(0.0, color="0.75", lw=0.8, zorder=1)
    ax.axvline(0.0, color="0.75", lw=0.8, zorder=1)
    ax.margins(0.12)
    ax.autoscale_view()


def _polar_rows(joint: str, values: Array) -> list[Quoted]:
    _, at = peak(values)
    name = "force on the frame" if joint == "frame" else f"pin force F{joint}"
    rows = [
        Quoted(
            f"crank angle of the greatest {name}",
            0.0,
            at,
            _NEAR_ZERO,
            "'in the region of' 0 deg read as within 30 deg",
            "4.2",
            unit="deg",
        )
    ]
    if joint == "12":
        rows += _kinematic_rows()
    return rows


def _kinematic_rows() -> list[Quoted]:
    motion: Any = example()[0].linkage.motion(TURN)
    rows = []
    for name, link in (("alpha3", "coupler"), ("alpha4", "follower")):
        rows.append(
            Quoted(
                f"crank angle of the greatest acceleration of the {link}",
                0.0,
                peak(getattr(motion, name))[1],
                _NEAR_ZERO,
                "'where maximum accelerations occur': within 30 deg of 0",
                "4.2",
                unit="deg",
            )
        )
    at = int(np.argmin(motion.transmission_angle))
    return [
        *rows,
        Quoted(
            "crank angle of the least transmission angle",
            0.0,
            (degrees(TURN[at]) + 180.0) % 360.0 - 180.0,
            1e-9,
            "round-off",
            "4.2",
            unit="deg",
        ),
    ]


@dataclass(frozen=True)
class Family:
    """Linkages that differ in the length of the crank alone [in]."""

    frame: float
    coupler: float
    follower: float
    cranks: tuple[float, ...]


FAMILIES = {
    "17": Family(12.0, 12.0, 12.0, (4.0, 5.0, 6.0, 7.0)),
    "18": Family(12.0, 16.0, 12.0, (3.0, 4.0, 5.0, 6.0)),
    "19": Family(12.0, 12.0, 16.0, (3.0, 4.0, 5.0, 6.0)),
}


def family_figure(label: str) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the function that draws the follower-frame force of a family (Figs. 17 to 19)."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        ax, family = axes[0], FAMILIES[label]
        peaks, accelerations = [], []
        for crank, colour in zip(family.cranks, COLOURS, strict=False):
            forces, fastest = _family_forces(family, crank)
            peaks.append(peak(forces)[0])
            accelerations.append(fastest)
            x, y = forces.T
            name = f"({family.frame:g}, {crank:g}, {family.coupler:g}, {family.follower:g})"
            ax.plot(x, y, color=colour, label=f"{name}: {peaks[-1]:.1f} N")
            ax.plot(x[:-1:120], y[:-1:120], "o", color=colour, ms=2.6)
            ax.plot(x[0], y[0], "o", mfc="w", mec=colour, ms=5.0)
        ax.plot(0.0, 0.0, "+", color="k")
        ax.set_aspect("equal", adjustable="datalim")
        polar_look(ax)
        ax.set_xlabel(r"$X_{41}$ [N]")
        ax.set_ylabel(r"$Y_{41}$ [N]")
        legend_below([ax], columns=2)
        note = (
            "The dimensions are not legible. Chosen here: cranks "
            + ", ".join(f"{crank:g}" for crank in family.cranks)
            + f" in with frame {family.frame:g}, coupler {family.coupler:g} and follower "
            f"{family.follower:g} in; uniform bars of the section of Figs. 12 to 16 at 10 rad/s. "
            "Dots every 30 deg of crank angle, the open one at 0; peaks in the legend."
        )
        rows = _growth_rows(family, peaks, accelerations)
        return Drawn(tuple(rows), (note,))

    return draw


def _family_forces(family: Family, crank: float) -> tuple[Array, float]:
    """Return the follower-frame force over a turn and the follower's greatest acceleration."""
    own, speed = example()
    per_length = own.mass("coupler").mass / own.linkage.lengths["coupler"]
    sizes = {"crank": crank, "coupler": family.coupler, "follower": family.follower}
    masses = {
        link: MassDistribution.uniform_bar(per_length * INCH * size, INCH * size)
        for link, size in sizes.items()
    }
    frame, crank, coupler, follower = (INCH * size for size in (family.frame, *sizes.values()))
    linkage = FourBar(frame, crank, coupler, follower)
    forces = rigid_forces(Machine(linkage, masses), TURN, speed, outputs=("pins",))
    return forces.f41, float(np.max(np.abs(linkage.motion(TURN).alpha4)))


def _growth_rows(
    family: Family, peaks: Sequence[float], accelerations: Sequence[float]
) -> list[Quoted]:
    rows = []
    for name, values in (
        ("acceleration of the follower", accelerations),
        ("follower-frame force", peaks),
    ):
        pairs = zip(values[:-1], values[1:], family.cranks[:-1], family.cranks[1:], strict=True)
        powers = [log(b / a) / log(v / u) for a, b, u, v in pairs]
        rows.append(
            Quoted(
                f"least power of the crank length by which the peak {name} grows",
                1.0,
                min(powers),
                0.0,
                "'rapidly' read as faster than in proportion, from each crank to the next",
                "4.2",
                relation=">",
            )
        )
    return rows
