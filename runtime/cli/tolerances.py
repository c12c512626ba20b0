"""``elastolink tolerances``: what tolerances of lengths and masses do to motion and forces."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from .. import linkages
from ..core.errors import bad
from . import options as opt
from .linkages import WHOLE_TURN, angles_of, drive_options, speed_of

if TYPE_CHECKING:
    from ..linkages.length_tolerances import Tolerances, ToleranceTrial
    from ..scenes import Scene

_DIMENSIONS = {
    "theta2": "angle",
    "mass": "mass",
    "along": "first_moment",
    "across": "first_moment",
    "inertia": "inertia",
}


def add(commands: Any) -> None:
    """Add the subcommand."""
    parser = opt.command(commands, "tolerances", _tolerances)
    width = (
        "greatest deviation to either side: crank='0.05 mm', theta2='0.1 deg', "
        "coupler.mass='1 g'; may be repeated"
    )
    opt.add(parser, {"--tolerance NAME=WIDTH": width}, action="append", default=[])
    opt.add(parser, opt.angles(f"{WHOLE_TURN}, or the range that the crank reaches"))
    opt.switches(parser, {"--forces": "forces too; needs a crank speed"})
    masses = "whether masses stay, or grow with the links as those of bars; default %(default)s"
    opt.add(parser, {"--masses": masses}, choices=("fixed", "bars"), default="fixed")
    without = "without it rates are over the crank's; default with --forces operation.speed"
    opt.add(parser, drive_options(without, rest="0"))
    trial = "check with N random linkages, the tolerances being three standard deviations"
    opt.add(parser, {"--monte-carlo N": trial}, type=int)
    opt.add(parser, {"--output NAME": "what --plot draws, e.g. theta4"})


def _tolerances(options: argparse.Namespace) -> int:
    r"""Worst case and root sum square of tolerances, in motion and forces.

    elastolink tolerances smith_1972_12_6_12_12 --tolerance crank='0.05 mm' \
        --tolerance coupler='0.1 mm' --plot band.png
    elastolink tolerances slider_crank_example --tolerance crank='20 um' --forces \
        --speed '1500 rpm' --monte-carlo 2000
    """
    scene = opt.load(options)
    subject: Any = scene.machine() if options.forces else scene.mechanism()
    linkage = subject.linkage if options.forces else subject
    # At the folds themselves the sensitivities are infinite: stay a twentieth of the range away.
    theta = angles_of(options, linkage, margin=0.05)
    speed, acceleration = _drive(options, scene)
    widths = dict(_width(pair) for pair in options.tolerance)
    if not widths:
        raise bad("--tolerance", "nothing", "NAME=WIDTH", "write --tolerance crank='0.05 mm'")
    found = linkages.tolerances(subject, widths, theta, speed, acceleration, masses=options.masses)
    if options.output is not None:
        found.place(options.output)
    lines = _table(found)
    if not found.keeps_turning and linkage.crank_turns:
        lines.append("within the tolerances the crank may cease to turn fully")
    status = 0
    if options.monte_carlo is not None:
        trial = found.monte_carlo(options.monte_carlo)
        lines += ["", *_trial(trial)]
        status = 0 if trial.passed else 1
    done = opt.finish(options, found, lines, lambda ax: found.plot(ax, output=options.output))
    return max(status, done)


def _drive(options: argparse.Namespace, scene: Scene) -> tuple[float, float]:
    """Return crank speed and acceleration; without either, rates are over the crank's."""
    speed = 1.0
    if options.forces or options.speed is not None:
        speed = speed_of(options, scene)
    elif options.acceleration is not None:
        raise bad("--acceleration", "no --speed beside it", "both", "give --speed '500 rpm' too")
    return speed, opt.given(options, "acceleration", "angular_acceleration") or 0.0


def _width(pair: str) -> tuple[str, float]:
    """Return name and width of a tolerance in SI units."""
    name, width = opt.pair(pair, "--tolerance", "NAME=WIDTH", "crank='0.05 mm'")
    dimension = _DIMENSIONS.get(name.rpartition(".")[2], "length")
    return name, opt.quantity(width, dimension, f"--tolerance {name}")


def _table(found: Tolerances) -> list[str]:
    """Return the worst case and the root of squares of every output, and the shares there."""
    import numpy as np

    shown = [place for place, width in enumerate(found.tolerance) if width > 0.0]
    worst, spread, share = found.worst_case, found.root_sum_square, found.contribution
    rows = []
    for row, name in enumerate(found.outputs):
        top, peak = (int(np.argmax(values[row])) for values in (worst, spread))
        at_top, at_peak = (f"{np.degrees(found.theta2[at]):.2f}" for at in (top, peak))
        sizes = f"{worst[row, top]:.5g}", at_top, f"{spread[row, peak]:.5g}", at_peak
        shares = (f"{100.0 * share[row, place, peak]:.1f}" for place in shown)
        rows.append((f"{name} [{found.unit(name)}]", *sizes, *shares))
    header = ("output", "worst case", "at [deg]", "root sum square", "at [deg]")
    return opt.table((*header, *(f"{found.parameters[place]} [%]" for place in shown)), rows)


def _trial(trial: ToleranceTrial) -> list[str]:
    """Return what the random linkages say."""
    kept = trial.samples - trial.lost
    lines = [f"{kept} random linkages of {trial.samples} reach every angle ({trial.method})"]
    for name, check in sorted(trial.checks.items()):
        verdict = "agrees" if check.passed else "DISAGREES"
        lines.append(f"{verdict}: {name}: {check.value:.2g} (limit {check.limit:.2g})")
    return lines
