"""``elastolink forces``: pin forces, driving torque, shaking force and moment of rigid links."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from ..errors import bad
from . import options as opt
from .linkages import speed_of

if TYPE_CHECKING:
    from ..dynamics import Machine, RigidForces

_JOINTS = ("12", "23", "34", "41", "frame", "torque", "moment")
_WHOLE_TURN = "0:360:721deg"


def add(commands: Any) -> None:
    """Add the subcommand."""
    forces = opt.command(
        commands,
        "forces",
        _forces,
        summary="Pin forces, driving torque, shaking force and moment of rigid links.",
        example=(
            "elastolink forces smith_1972_12_6_12_12 --speed '10 rad/s' --joint 34 --plot f34.png\n"
            "  elastolink forces slider_crank_example --speed '1500 rpm' --fluctuation 0.02"
        ),
    )
    opt.scene_options(forces)
    forces.add_argument(
        "--speed",
        metavar="SPEED",
        help="crank speed, e.g. '195 rpm', rad/s without a unit; default operation.speed",
    )
    forces.add_argument(
        "--acceleration",
        metavar="ALPHA",
        help="crank acceleration, e.g. '25 rad/s**2', the unit of a plain number; default 0",
    )
    forces.add_argument(
        "--angles",
        metavar="START:STOP:COUNT[UNIT]",
        help=f"crank angles; default {_WHOLE_TURN}, or the range that the crank reaches",
    )
    forces.add_argument(
        "--joint",
        choices=_JOINTS,
        help="what --plot draws: a polar diagram, or the torque or moment over the angle",
    )
    forces.add_argument(
        "--fluctuation",
        type=float,
        metavar="COEFF",
        help="size a flywheel for this coefficient of speed fluctuation, e.g. 0.02",
    )


def _forces(options: argparse.Namespace) -> int:
    import numpy as np

    from ..dynamics import rigid_forces

    opt.picture(options)
    scene = opt.load(options)
    machine = scene.machine()
    speed, acceleration = speed_of(options, scene), 0.0
    if options.acceleration is not None:
        where = "--acceleration"
        acceleration = opt.quantity(options.acceleration, "angular_acceleration", where)
    theta = np.array(_angles(options, machine))
    found = rigid_forces(machine, theta, speed, acceleration)
    lines = [*_peaks(found), "", *_evenness(machine, speed, options.fluctuation)]
    return opt.finish(options, found, lines, lambda ax: found.plot(ax, joint=options.joint))


def _angles(options: argparse.Namespace, machine: Machine) -> list[float]:
    """Return the wanted angles; by default a turn, or the first range that the crank reaches."""
    if options.angles is not None:
        return opt.values(options.angles, "angle", "--angles")
    if machine.linkage.crank_turns:
        return opt.values(_WHOLE_TURN, "angle", "--angles")
    low, high = machine.linkage.crank_ranges()[-1]
    # At the folds themselves the forces are infinite: stay a hundredth of the range away.
    margin = 0.01 * (high - low)
    return opt.spaced(low + margin, high - margin, 721)


def _peaks(found: RigidForces) -> list[str]:
    """Return the greatest size of each force, and where."""
    import numpy as np

    sizes = {}
    for joint in ("12", "23", "34", "41"):
        pair = found["x" + joint], found["y" + joint]
        sizes[f"pin force {joint} [N]"] = np.hypot(*pair)
    sizes["driving torque [N m]"] = found.torque
    sizes["force on the frame [N]"] = np.hypot(found["shaking_x"], found["shaking_y"])
    sizes["moment on the frame [N m]"] = found.shaking_moment
    couples = [name for name in found.values if name.startswith("couple")]
    for name in couples:
        sizes[f"couple of the slide {name[-2:]} [N m]"] = found[name]
    rows = []
    for label, values in sizes.items():
        top = int(np.argmax(np.abs(values)))
        angle = f"{np.degrees(found.theta2[top]):.2f}"
        rows.append((label, f"{values[top]:.6g}", angle))
    return opt.table(("quantity", "peak", "crank angle [deg]"), rows)


def _evenness(machine: Machine, speed: float, wanted: float | None) -> list[str]:
    """Return lines on mean torque, energy fluctuation and flywheel."""
    from ..dynamics import flywheel_inertia, torque_fluctuation

    if not machine.linkage.crank_turns:
        if wanted is not None:
            found = "a crank that does not turn fully"
            raise bad("--fluctuation", found, "one that does", "change a length")
        return ["the crank does not turn fully: no mean torque over a revolution"]
    steady = torque_fluctuation(machine, speed)
    size = float(abs(steady.torque).max())
    # Round-off of a mean that is zero reads as zero.
    mean = steady.mean_torque if abs(steady.mean_torque) > 1e-14 * size else 0.0
    lines = [
        f"mean torque {mean:.6g} N m; energy fluctuation"
        f" {steady.energy_fluctuation:.6g} J at constant speed"
    ]
    if wanted is not None:
        wheel = flywheel_inertia(machine, speed, wanted)
        lines.append(
            f"flywheel {wheel.inertia:.6g} kg m^2 for a coefficient of {wheel.fluctuation:.4g}"
            f" (first order {wheel.first_order:.6g})"
        )
    return lines
