"""``elastolink clearance`` and ``elastolink tolerances``: what play and deviations do."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from math import degrees
from typing import TYPE_CHECKING, Any

from .. import linkages
from ..core.errors import bad
from . import options as opt
from .linkages import WHOLE_TURN, angles_of, drive_options, speed_of

if TYPE_CHECKING:
    from ..linkages.clearance import ClearanceRange
    from ..linkages.length_tolerances import Tolerances, ToleranceTrial
    from ..scenes import Scene

_JOINTS = ("12", "23", "34", "41")
_DIMENSIONS = {
    "theta2": "angle",
    "mass": "mass",
    "along": "first_moment",
    "across": "first_moment",
    "inertia": "inertia",
}


def add(commands: Any) -> None:
    """Add the two subcommands."""
    clearance = opt.command(commands, "clearance", _clearance)
    size = "diametral clearance of one joint, e.g. '0.1 mm'; repeated, one curve each"
    opt.add(clearance, {"--clearance SIZE": size}, action="append", default=[])
    joint = "the joint with --clearance; default 34, at the follower"
    opt.add(clearance, {"--joint": joint}, choices=_JOINTS)
    several = "clearance of one of several joints, e.g. 23='0.1 mm'; instead of --clearance"
    opt.add(clearance, {"--at JOINT=SIZE": several}, action="append", default=[])
    link = {"--link LINK": "coupler, instead of the link that gives the output"}
    opt.add(clearance, link | opt.angles("361 over a turn, or what the crank reaches"))

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


def _clearance(options: argparse.Namespace) -> int:
    """Free movement of follower, slider or rod that clearance at the joints leaves.

    elastolink clearance smith_1972_10_8_10_10 --clearance '0.1 in' --plot fig10.png
    elastolink clearance smith_1972_2122 --at 23='0.1 mm' --at 34='0.05 mm'
    """
    cases = _cases(options)
    if len(cases) > 1:
        opt.refuse_unused(options, ("save",), "one clearance")
    given = options.angles
    theta = None if given is None else opt.values(given, "angle", "--angles")
    linkage: Any = opt.load(options).mechanism()
    found = [
        linkages.clearance_range(linkage, size, theta, joint=joint, link=options.link)
        for _, size, joint in cases
    ]

    def draw(ax: Any) -> None:
        for (label, *_), result in zip(cases, found, strict=True):
            result.plot(ax, label=label)

    if len(found) == 1:
        return opt.finish(options, found[0], _movement(found[0]), draw)
    opt.draw_into(options, draw)
    content = {"ranges": [result.to_dict() for result in found]}
    opt.say(options, content, "\n\n".join("\n".join(_movement(result)) for result in found))
    return opt.exit_status(options, [result.checks for result in found])


def _cases(options: argparse.Namespace) -> list[tuple[str, Any, str | None]]:
    """Return label, clearance and joint of each curve."""
    if options.at:
        if options.clearance or options.joint:
            fix = "name every joint with --at, or one with --joint"
            raise bad("--at", "--clearance or --joint beside it", "one of the two ways", fix)
        return [("clearance " + ", ".join(options.at), _by_joint(options.at), None)]
    if not options.clearance:
        raise bad("--clearance", "nothing", "a clearance", "give --clearance '0.1 mm'")
    return [
        (f"clearance {text}", opt.size(text, "length", "--clearance"), options.joint)
        for text in options.clearance
    ]


def _by_joint(texts: Sequence[str]) -> dict[str, float]:
    found = {}
    expected = f"JOINT=SIZE, JOINT one of {', '.join(_JOINTS)}"
    for text in texts:
        joint, size = opt.pair(text, "--at", expected, "23='0.1 mm'")
        if joint not in _JOINTS:
            raise bad("--at", repr(text), expected, "write --at 23='0.1 mm'")
        found[joint] = opt.size(size, "length", "--at")
    return found


def _movement(found: ClearanceRange) -> list[str]:
    """Return the range at some crank angles, its extremes, and where the linkage can fold."""
    import numpy as np

    scale, unit = (1.0, "m") if found.unit == "m" else (degrees(1.0), "deg")
    chosen = opt.even_rows(found.theta2.size)
    names = {"nominal": "nominal", "lower": "lower", "upper": "upper", "width": "width"}
    names["small"] = "first order"
    table = opt.columns(
        ("theta2 [deg]", "z.4f", np.degrees(found.theta2[chosen])),
        *(
            (f"{words} [{unit}]", "z.7g", scale * getattr(found, name)[chosen])
            for name, words in names.items()
        ),
        ("", "", ["folds" if folds else "" for folds in found.folds[chosen]]),
    )
    sizes = ", ".join(f"{joint}: {size:.6g} m" for joint, size in found.clearances.items())
    rows = [
        (word, f"{degrees(extreme.theta2):.2f}", f"{scale * extreme.width:.6g}")
        for word, extreme in (("greatest", found.greatest), ("least", found.least))
    ]
    header = (f"free movement of the {found.link}", "crank angle [deg]", f"width [{unit}]")
    lines = [*table, "", f"clearance at {sizes}", *opt.table(header, rows)]
    if np.any(found.folds):
        first = degrees(float(np.ravel(found.theta2)[np.argmax(np.ravel(found.folds))]))
        lines.append(
            f"at {int(np.sum(found.folds))} of {found.folds.size} angles, the first at"
            f" {first:.4g} deg, the clearance lets the linkage pass into its other assembly"
        )
    return lines


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
    name, width = opt.pair(pair, "--tolerance", "NAME=WIDTH", "crank='0.05 mm'")
    dimension = _DIMENSIONS.get(name.rpartition(".")[2], "length")
    return name, opt.size(width, dimension, f"--tolerance {name}")


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
    kept = trial.samples - trial.lost
    lines = [f"{kept} random linkages of {trial.samples} reach every angle ({trial.method})"]
    for name, check in sorted(trial.checks.items()):
        verdict = "agrees" if check.passed else "DISAGREES"
        lines.append(f"{verdict}: {name}: {check.value:.2g} (limit {check.limit:.2g})")
    return lines
