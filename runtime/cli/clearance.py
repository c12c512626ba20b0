"""``elastolink clearance``: the free movement that play in the joints leaves."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from math import degrees
from typing import TYPE_CHECKING, Any

from .. import linkages
from ..core.errors import bad
from . import options as opt

if TYPE_CHECKING:
    from ..linkages.clearance import ClearanceRange

_JOINTS = ("12", "23", "34", "41")


def add(commands: Any) -> None:
    """Add the subcommand."""
    clearance = opt.command(commands, "clearance", _clearance)
    size = "diametral clearance of one joint, e.g. '0.1 mm'; repeated, one curve each"
    opt.add(clearance, {"--clearance SIZE": size}, action="append", default=[])
    joint = "the joint with --clearance; default 34, at the follower"
    opt.add(clearance, {"--joint": joint}, choices=_JOINTS)
    several = "clearance of one of several joints, e.g. 23='0.1 mm'; instead of --clearance"
    opt.add(clearance, {"--at JOINT=SIZE": several}, action="append", default=[])
    link = {"--link LINK": "coupler, instead of the link that gives the output"}
    opt.add(clearance, link | opt.angles("361 over a turn, or what the crank reaches"))


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
