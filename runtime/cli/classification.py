"""``elastolink classify``: class, change points, transmission angle and dead centres."""

from __future__ import annotations

import argparse
import math
from typing import Any

from .. import linkages
from ..core.errors import bad
from . import options as opt


def add(commands: Any) -> None:
    """Add the subcommand."""
    parser = opt.command(commands, "classify", _classify, scene=False)
    opt.scene_options(parser, nargs="?")
    lengths = "frame, crank, coupler, follower, instead of a scene"
    opt.add(parser, {"--lengths A,B,C,D": lengths})
    driven = {"--input": "driven link of a four-bar; default crank"}
    opt.add(parser, driven, choices=("crank", "follower"))
    opt.add(
        parser, {"--tolerance": "relative, of every length; default 0"}, type=float, default=0.0
    )
    plane = "draw Barker's base plane instead of the transmission angle"
    opt.switches(parser, {"--base-plane": plane})


def _classify(options: argparse.Namespace) -> int:
    """Grashof's and Barker's class, change points, transmission angle, dead centres.

    elastolink classify smith_1972_12_6_12_12 --plot transmission.png
    elastolink classify --lengths 12,6,12,12 --base-plane --plot plane.png
    """
    if options.plot is None:
        opt.refuse_unused(options, ("base_plane",), "--plot FILE beside it")
    linkage: Any = _linkage(options)
    four_bar = isinstance(linkage, linkages.FourBar)
    if not four_bar:
        opt.refuse_unused(options, ("input",), "a four-bar linkage")
    driven: Any = options.input or "crank"
    found: Any = linkages.classify(linkage, input=driven, tolerance=options.tolerance)
    passed_on = linkages.transmission_angle(linkage)
    if options.base_plane and not four_bar:
        raise bad("--base-plane", found.mechanism, "a four-bar linkage", "leave it out")
    draw = found.plot if options.base_plane else passed_on.plot
    lines = [*_class_lines(found), "", *_transmission_lines(passed_on)]
    more = {"transmission": passed_on.to_dict()}
    return opt.finish(options, found, lines, draw, more=more, beside=(passed_on,))


def _linkage(options: argparse.Namespace) -> Any:
    """Return the linkage of the scene or of ``--lengths``."""
    if (options.scene is None) == (options.lengths is None):
        expected = "either SCENE or --lengths A,B,C,D"
        raise bad("classify", "both or neither", expected, "give one of them")
    if options.scene is not None:
        return opt.load(options).mechanism()
    try:
        lengths = [float(text) for text in options.lengths.split(",")]
    except ValueError as refusal:
        fix = "write --lengths 12,6,12,12"
        raise bad("--lengths", repr(options.lengths), "four numbers", fix) from refusal
    checked = linkages.classify(lengths)
    return linkages.FourBar(checked.frame, checked.crank, checked.coupler, checked.follower)


def _class_lines(found: Any) -> list[str]:
    symbol = found.symbol if hasattr(found, "symbol") else found.mechanism
    turning = ", ".join(link for link, full in found.turns.items() if full) or "no link"
    lines = [f"{symbol}: {found.name} ({found.category})"]
    if hasattr(found, "also"):
        lines.append(f"also called: {found.also}; {found.characteristic}")
        kinds = ", ".join(f"{link} {kind}" for link, kind in found.inversions.items())
        lines.append(f"inversions, by fixed link: {kinds}")
    lines.append(f"turning fully against the frame: {turning}")
    lines.append(
        f"change point {found.nearest_change}: {found.distance:+.6g} of the sum of lengths away"
    )
    return lines


def _transmission_lines(found: Any) -> list[str]:
    low, high = (math.degrees(value) for value in (found.least, found.greatest))
    band = "within" if found.within_band else "outside"
    first, last = (math.degrees(value) for value in found.band)
    lines = [f"transmission angle: {low:.6g} to {high:.6g} deg, {band} {first:g} to {last:g} deg"]
    for name, angle in found.dead_centres.items():
        at = math.degrees(angle)
        lines.append(f"dead centre, {name}: crank at {at:.6g} deg")
    for name, angles in found.toggles.items():
        if len(angles):
            shown = ", ".join(f"{math.degrees(angle):.6g}" for angle in angles)
            lines.append(f"coupler and follower in line, {name}: crank at {shown} deg")
    if found.swing is not None:
        slides = found.mechanism == "slider-crank"
        size = f"{found.swing:.6g}" if slides else f"{math.degrees(found.swing):.6g} deg"
        lines.append(f"{'stroke' if slides else 'swing'} of the output: {size}")
    if found.time_ratio is not None:
        lines.append(f"time ratio: {found.time_ratio:.6g}")
    return lines
