"""``elastolink forces``: pin forces, driving torque, shaking force and moment of rigid links."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import asdict
from functools import partial
from math import degrees
from typing import TYPE_CHECKING, Any

from .. import rigid
from ..core.errors import bad
from . import options as opt
from .linkages import WHOLE_TURN, angles_of, drive_of, drive_options

if TYPE_CHECKING:
    from ..core.results import Result

_JOINTS = ("12", "23", "34", "41", "frame", "torque", "moment")


def add(commands: Any) -> None:
    """Add the subcommand."""
    forces = opt.command(commands, "forces", _forces)
    opt.add(forces, drive_options("default operation.speed"))
    opt.add(forces, opt.angles(f"{WHOLE_TURN}, or the range that the crank reaches"))
    drawn = "what --plot draws: a polar diagram, or the torque or moment over the angle"
    opt.add(forces, {"--joint": drawn}, choices=_JOINTS)
    wheel = "size a flywheel for this coefficient of speed fluctuation, e.g. 0.02"
    opt.add(forces, {"--fluctuation COEFF": wheel}, type=float)


def _forces(options: argparse.Namespace) -> int:
    """Pin forces, driving torque, shaking force and moment of rigid links.

    elastolink forces smith_1972_12_6_12_12 --speed '10 rad/s' --joint 34 --plot f34.png
    elastolink forces slider_crank_example --speed '1500 rpm' --fluctuation 0.02
    """
    if options.plot is None:
        opt.refuse_unused(options, ("joint",), "--plot FILE beside it")
    scene = opt.load(options)
    machine = scene.machine()
    speed, acceleration = drive_of(options, scene)
    # At the folds themselves the forces are infinite: stay a hundredth of the range away.
    theta = angles_of(options, machine.linkage, margin=0.01)
    found = rigid.rigid_forces(machine, theta, speed, acceleration)
    even, numbers, beside = _evenness(machine, speed, options.fluctuation)
    span = float(theta[0]), float(theta[-1])
    peaks = rigid.force_peaks(machine, speed, acceleration, span=span)
    lines = [*_table(peaks), "", *even]
    more = {"peaks": {name: asdict(peak) for name, peak in peaks.items()}, **numbers}
    draw = partial(found.plot, joint=options.joint)
    return opt.finish(options, found, lines, draw, more=more, beside=beside)


_LABELS = {
    **{f"f{joint}": f"pin force {joint} [N]" for joint in ("12", "23", "34", "41")},
    "torque": "driving torque [N m]",
    "shaking_force": "force on the frame [N]",
    "shaking_moment": "moment on the frame [N m]",
    **{f"couple{joint}": f"couple of the slide {joint} [N m]" for joint in ("34", "41")},
}


def _table(peaks: Mapping[str, rigid.ForcePeak]) -> list[str]:
    """Return the greatest size of each force, and where."""
    # No minus before a zero.
    return opt.columns(
        ("quantity", "", [_LABELS[name] for name in peaks]),
        ("peak", "z.6g", [peak.value for peak in peaks.values()]),
        ("crank angle [deg]", "z.2f", [degrees(peak.crank_angle) for peak in peaks.values()]),
    )


def _evenness(
    machine: rigid.Machine, speed: float, wanted: float | None
) -> tuple[list[str], dict[str, Any], tuple[Result, ...]]:
    """Return mean torque, energy fluctuation and flywheel in lines, in numbers, as results."""
    lacking = None
    if not machine.linkage.crank_turns:
        lacking = "a crank that does not turn fully", "one that does", "change a length"
    elif speed == 0.0:
        lacking = "a crank without speed", "one that runs", "give --speed"
    if lacking and wanted is not None:
        raise bad("--fluctuation", *lacking)
    if lacking:
        return [f"{lacking[0]}: no mean torque over a revolution"], {}, ()
    steady = rigid.torque_fluctuation(machine, speed)
    size = float(abs(steady.torque).max())
    # Round-off of a mean that is zero reads as zero.
    mean = steady.mean_torque if abs(steady.mean_torque) > 1e-14 * size else 0.0
    lines = [
        f"mean torque {mean:.6g} N m; energy fluctuation"
        f" {steady.energy_fluctuation:.6g} J at constant speed"
    ]
    numbers: dict[str, Any] = {
        "mean_torque": mean,
        "energy_fluctuation": steady.energy_fluctuation,
        "energy_fluctuation_error": steady.error,
    }
    if wanted is None:
        return lines, numbers, (steady,)
    wheel = rigid.flywheel_inertia(machine, speed, wanted)
    lines.append(
        f"flywheel {wheel.inertia:.6g} kg m^2 for a coefficient of {wheel.fluctuation:.4g}"
        f" (first order {wheel.first_order:.6g})"
    )
    names = ("inertia", "first_order", "fluctuation", "motor_torque", "error")
    numbers["flywheel"] = {name: getattr(wheel, name) for name in names}
    return lines, numbers, (steady, wheel)
