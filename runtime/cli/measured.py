"""``elastolink identify``: numbers of a machine from measured points; and these in pictures."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

from .. import design
from ..core.errors import bad
from . import options as opt


def add(commands: Any) -> None:
    """Add the subcommand."""
    parser = opt.command(commands, "identify", _identify)
    points = "a CSV file: kind, speed [rpm], and as known deflection [mm], speed deviation [rpm]"
    opt.add(parser, {"points POINTS": points})
    unknown = "a parameter to fit, e.g. bending_stiffness; may be repeated"
    opt.add(parser, {"--unknown NAME": unknown}, action="append", default=[])
    window = "how far from a measured speed the computed one is looked for; default 0.15"
    opt.add(parser, {"--window PART": window}, default="0.15")


def points_option(parser: argparse.ArgumentParser) -> None:
    """Add the option of a file of points that are drawn too."""
    points = "draw the measured points of this CSV file, too (see identify)"
    opt.add(parser, {"--points FILE": points})


def measured_points(options: argparse.Namespace, across: str) -> tuple[design.Point, ...]:
    """Return the points of ``--points``, none without it; ``across``: along the picture."""
    if options.points is None:
        return ()
    if options.plot is None or across != "speed":
        found = "no --plot" if options.plot is None else f"a picture over {across}"
        raise bad("--points", found, "a picture over the speed", "draw one with --plot")
    return design.read_points(options.points)


def with_points(
    points: tuple[design.Point, ...], draw: Callable[[Any], Any]
) -> Callable[[Any], Any]:
    """Return what draws measured points beside what is drawn."""

    def both(ax: Any) -> None:
        draw(ax)
        if points:
            design.draw_points(ax, points)

    return both


def _identify(options: argparse.Namespace) -> int:
    """Stiffness, mass, damping and inertia from measured resonances and unstable speeds.

    elastolink identify smith_1972_5152_sixteenth_inch points.csv --unknown bending_stiffness
    where points.csv has lines like
      kind, speed [rpm], speed deviation [rpm]
      unstable from, 752, 2
      unstable to, 770, 2
    """
    from ..core.plotting import RPM

    points = design.read_points(options.points)
    window = opt.quantity(options.window, "dimensionless", "--window")
    system: Any = opt.load(options).system()
    found = design.identify(system, points, options.unknown, window=window)
    numbers = opt.columns(
        ("fitted [SI]", "", found.unknown),
        ("value", ".7g", found.value),
        ("standard error", ".2g", found.deviation),
        ("start", ".7g", found.start),
        ("", "", ["" if decided else "not decided" for decided in found.decided]),
    )
    units = [("mm", 1e3) if p.kind == "deflection" else ("rpm", RPM) for p in found.points]
    scales = [scale for _, scale in units]
    rows = opt.columns(
        ("point", "", [point.kind for point in found.points]),
        ("at [rpm]", ".6g", [point.speed * RPM for point in found.points]),
        ("measured", ".6g", found.measured * scales),
        ("computed", ".6g", found.computed * scales),
        ("", "", [unit for unit, _ in units]),
        ("residual/deviation", "+.2f", found.residual),
        *(
            (f"{name} without it", ".6g", values)
            for name, values in zip(found.unknown, found.without.T, strict=True)
        ),
    )
    return opt.finish(options, found, [*numbers, *found.undecided, "", *rows])
