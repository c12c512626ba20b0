"""``elastolink forces``: pin forces, driving torque, shaking force and moment of rigid links."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from ..core.errors import bad
from . import options as opt
from .linkages import drive_of, drive_options

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..core.results import Result
    from ..rigid import ForcePeak, Machine

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
    drive_options(forces, "default operation.speed")
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

    from ..rigid import rigid_forces

    if options.plot is None:
        opt.refuse_unused(options, ("joint",), "--plot FILE beside it")
    scene = opt.load(options)
    machine = scene.machine()
    speed, acceleration = drive_of(options, scene)
    theta = np.array(_angles(options, machine))
    found = rigid_forces(machine, theta, speed, acceleration)
    even = _evenness(machine, speed, options.fluctuation)
    from ..rigid import force_peaks

    peaks = force_peaks(machine, speed, acceleration, span=(float(theta[0]), float(theta[-1])))
    lines = [*_table(peaks), "", *even.lines]
    more = {"peaks": {name: asdict(peak) for name, peak in peaks.items()}, **even.numbers}

    def draw(ax: Axes) -> Axes:
        return found.plot(ax, joint=options.joint)

    return opt.finish(options, found, lines, draw, more=more, beside=even.results)


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


_LABELS = {
    **{f"f{joint}": f"pin force {joint} [N]" for joint in ("12", "23", "34", "41")},
    "torque": "driving torque [N m]",
    "shaking_force": "force on the frame [N]",
    "shaking_moment": "moment on the frame [N m]",
    **{f"couple{joint}": f"couple of the slide {joint} [N m]" for joint in ("34", "41")},
}


def _table(peaks: Mapping[str, ForcePeak]) -> list[str]:
    """Return the greatest size of each force, and where."""
    rows = []
    for name, peak in peaks.items():
        # No minus before a zero.
        angle = f"{math.degrees(peak.crank_angle):z.2f}"
        rows.append((_LABELS[name], f"{peak.value:z.6g}", angle))
    return opt.table(("quantity", "peak", "crank angle [deg]"), rows)


@dataclass(frozen=True)
class _Evenness:
    """What is told of the torque over a revolution: in words, in numbers, and what was checked."""

    lines: Sequence[str]
    numbers: Mapping[str, Any] = field(default_factory=dict)
    results: Sequence[Result] = ()


def _evenness(machine: Machine, speed: float, wanted: float | None) -> _Evenness:
    """Return mean torque, energy fluctuation and flywheel."""
    from ..rigid import flywheel_inertia, torque_fluctuation

    for lacking, words, expected, fix in (
        (
            not machine.linkage.crank_turns,
            "a crank that does not turn fully",
            "one that does",
            "change a length",
        ),
        (speed == 0.0, "a crank without speed", "one that runs", "give --speed"),
    ):
        if lacking and wanted is not None:
            raise bad("--fluctuation", words, expected, fix)
        if lacking:
            return _Evenness([f"{words}: no mean torque over a revolution"])
    steady = torque_fluctuation(machine, speed)
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
        return _Evenness(lines, numbers, (steady,))
    wheel = flywheel_inertia(machine, speed, wanted)
    lines.append(
        f"flywheel {wheel.inertia:.6g} kg m^2 for a coefficient of {wheel.fluctuation:.4g}"
        f" (first order {wheel.first_order:.6g})"
    )
    names = ("inertia", "first_order", "fluctuation", "motor_torque", "error")
    numbers["flywheel"] = {name: getattr(wheel, name) for name in names}
    return _Evenness(lines, numbers, (steady, wheel))
