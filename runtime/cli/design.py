"""``elastolink diagnose``, ``stabilise``, ``identify``, ``tolerance-bands``, ``certify``.

What a machine does at its speed, what changes it, what is measured of it, within which bounds.
"""

from __future__ import annotations

import argparse
import re
import shlex
from collections.abc import Callable, Iterator
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

from .. import design
from ..core.errors import bad
from . import options as opt
from .linkages import moving_scene, speed_of, speed_option, speed_range

if TYPE_CHECKING:
    from ..design.stabilising import Change
    from ..scenes import Scene

_BANDS = ("frequencies", "edges", "boundaries", "stress", "motion", "forces")


def add(commands: Any) -> None:
    """Add the five subcommands."""
    parser = opt.command(commands, "diagnose", _diagnose)
    opt.add(parser, speed_option("operation.speed"))
    window = "how far about the speed unstable regions are looked for; default 0.3"
    opt.add(parser, {"--window PART": window}, default="0.3")

    parser = opt.command(commands, "stabilise", _stabilise)
    opt.add(parser, {"--speed LOW:HIGH": "crank speeds; default operation.speed_range"})
    key = "a key to change, or LINK.thickness; may be repeated; default all that usually can be"
    within = "least and greatest value of a key, e.g. links.crank='2.8in:3.2in'; may be repeated"
    told = {"--change KEY": key, "--bounds KEY=LOW:HIGH": within}
    opt.add(parser, told, action="append", default=[])
    margin = "how far regions keep away, over the speed; default 0.01"
    opt.add(parser, {"--margin PART": margin}, default="0.01")
    opt.add(parser, {"--decay DECAY": "least logarithmic decay per turn; default 0"}, default="0")
    opt.add(parser, {"--stress LIMIT": "allowed stress of beams, such as '200 MPa'"})
    opt.switches(parser, {"--keep-shaking-force": "do not let the shaking force become larger"})

    parser = opt.command(commands, "identify", _identify)
    points = "a CSV file: kind, speed [rpm], and as known deflection [mm], speed deviation [rpm]"
    opt.add(parser, {"points POINTS": points})
    unknown = "a parameter to fit, e.g. bending_stiffness; may be repeated"
    opt.add(parser, {"--unknown NAME": unknown}, action="append", default=[])
    window = "how far from a measured speed the computed one is looked for; default 0.15"
    opt.add(parser, {"--window PART": window}, default="0.15")

    parser = opt.command(commands, "tolerance-bands", _bands)
    opt.add(parser, {"--of": "which answer"}, choices=_BANDS, required=True)
    at = "crank angles; of edges, boundaries and stress speeds, of edges their ends alone"
    opt.add(parser, {"--at START:STOP:COUNT[UNIT]": at})
    over = "of boundaries: the second parameter and its values; default five of the chart's y"
    opt.add(parser, {"--over NAME=START:STOP:COUNT[UNIT]": over})
    trials = "machines at random that check the bands; default 32, or 8 of proved ones"
    opt.add(parser, {"--trials N": trials}, type=int)
    opt.add(parser, {"--seed N": "of all that is random; default 0"}, type=int, default=0)
    opt.add(parser, {"--row NAME": "the row that --plot draws; default those of the first unit"})

    parser = opt.command(commands, "certify", _certify)
    opt.add(parser, {"--speed LOW:HIGH": "range of crank speed"}, required=True)
    resolution = "length of speed that is not halved again; default 1/10000 of the range"
    opt.add(parser, {"--resolution SPEED": resolution})


def _diagnose(options: argparse.Namespace) -> int:
    """Tell what happens at a running speed, what lies near, and what would help.

    elastolink diagnose smith_1972_5152_sixteenth_inch --speed '765 rpm'
    """
    scene = moving_scene(options)
    window = opt.quantity(options.window, "dimensionless", "--window")
    found = design.diagnose(scene, speed_of(options, scene), window=window)
    # What it advises is to work as it is printed: for this file, with these overrides.
    typed = shlex.join([options.scene, *(f"--set={pair}" for pair in options.set)])
    if options.modules is not None:
        typed += f" --modules {shlex.quote(options.modules)}"
    advice = re.compile(rf"(?<=elastolink )(\w+) {re.escape(scene.name)} ")
    lines = [advice.sub(lambda found: f"{found[1]} {typed} ", line) for line in found.lines]
    found = replace(found, lines=tuple(lines))
    return opt.finish(options, found, found.lines)


def _bounds(scene: Scene, texts: list[str]) -> dict[str, tuple[float, float]]:
    """Return least and greatest values by key; a thickness that no key has takes factors."""
    found = {}
    for text in texts:
        key, ends = opt.pair(text, "--bounds", "KEY=LOW:HIGH", "links.crank='2.8in:3.2in'")
        known = scene.get(key, None) is not None
        dimension = scene.dimension(key) if known else None
        found[key] = opt.span(ends, dimension or "dimensionless", "--bounds", "2.8in:3.2in")
    return found


def _stabilise(options: argparse.Namespace) -> int:
    """Least changes of lengths, thickness, inertia or damping that make speeds stable.

    elastolink stabilise smith_1972_5152_sixteenth_inch --speed 740rpm:780rpm
    elastolink stabilise SCENE --speed 740:780rpm --change coupler.thickness --margin 0.02
    """
    scene = moving_scene(options)
    found = design.stabilise(
        scene,
        speed_range(options.speed, scene, "--speed"),
        options.change or None,
        bounds=_bounds(scene, options.bounds),
        margin=opt.quantity(options.margin, "dimensionless", "--margin"),
        decay=opt.quantity(options.decay, "dimensionless", "--decay"),
        limit=opt.positive(options, "stress", "stress"),
        keep=("shaking_force",) if options.keep_shaking_force else (),
    )
    lines = list(found.present)
    if not lines:
        least = "regions narrower than 0.01 % of their speed are left out"
        lines = [f"the range is stable with its margin as it is; {least}"]
    for number, change in enumerate(found.changes, 1):
        lines += _change_lines(number, change)
    for change in found.unverified:
        lines += [f"not verified: {'; '.join((*change.words, *change.failed))}"]
    lines += [f"not to be had {text}" for text in found.impossible]
    more = {name: list(map(asdict, getattr(found, name))) for name in ("changes", "unverified")}
    return opt.finish(options, found, lines, more=more)


def _change_lines(number: int, change: Change) -> Iterator[str]:
    """Yield a change, its size, and what verifies it."""
    first, *others = change.words
    yield f"{number}  {first}"
    yield from (f"   {word}" for word in others)
    stress = "" if change.stress is None else f"; stress up to {change.stress / 1e6:.4g} MPa"
    away = f", {100.0 * change.distance:.3g} % away" if change.distance < 1.0 else ""
    yield f"   size of the change {100.0 * change.size:.3g} %; {change.nearest}{away}{stress}"
    yield f"   marched, a disturbance grows by {100.0 * change.growth:+.2g} % per turn"
    yield from (f"   too narrow to count: {name}" for name in change.narrow)


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
    units = [("mm", 1e3) if p.kind == "deflection" else ("rpm", opt.RPM) for p in found.points]
    scales = [scale for _, scale in units]
    rows = opt.columns(
        ("point", "", [point.kind for point in found.points]),
        ("at [rpm]", ".6g", [point.speed * opt.RPM for point in found.points]),
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


def _bands(options: argparse.Namespace) -> int:
    r"""Worst case and spread of an answer within tolerances of any of a scene's numbers.

    elastolink tolerance-bands smith_1972_10_8_10_10 --of motion \
        --set 'links.crank=8 in +- 0.05 mm' --plot bands.png
    elastolink tolerance-bands smith_1972_5152_sixteenth_inch --of edges --at 600:900:2rpm \
        --set 'follower.inertia=655e-6 kg*m**2 +- 2 %'
    """
    scene = opt.load(options)
    angles = options.of in ("frequencies", "motion", "forces")
    at = options.at and opt.values(options.at, "angle" if angles else "frequency", "--at")
    if at is not None and options.of in ("edges", "boundaries"):
        at = at[[0, -1]]
    over = None
    if options.over is not None:
        example = "follower_inertia=0.0006:0.002:5"
        name, values = opt.pair(options.over, "--over", "NAME=START:STOP:COUNT", example)
        dimension = scene.layout.parameters.get(name, "dimensionless")
        over = name, opt.values(values, dimension, "--over")
    drawn = {"trials": options.trials, "seed": options.seed}
    found = design.tolerance_bands(scene, options.of, at, over=over, **drawn)
    return opt.finish(options, found, _band_lines(found), lambda ax: found.plot(ax, options.row))


def _band_lines(found: Any) -> list[str]:
    """Return of every row its widest band, and what has a share in it."""
    import numpy as np

    at = np.argmax(found.upper - found.lower, axis=1)
    rows, places = np.arange(len(at)), found.place[at]
    places = np.degrees(places) if found.across.endswith("[rad]") else places
    names = {"value": "value", "lower": "worst case from", "upper": "to"}
    names |= {"likely_lower": "95 of 100 from", "likely_upper": "to"}
    return opt.columns(
        ("widest", "", [f"{n} [{u}]" for n, u in zip(found.rows, found.units, strict=True)]),
        *[(found.across.replace("[rad]", "[deg]"), ".6g", places)][: len(found.place) - 1],
        *((words, ".6g", getattr(found, name)[rows, at]) for name, words in names.items()),
        *(
            (f"{name} [%]", ".1f", 100.0 * found.share[rows, at, k])
            for k, name in enumerate(found.numbers)
        ),
    )


def _certify(options: argparse.Namespace) -> int:
    """Prove a damped system of 1 to 3 modes stable over a range of speeds; needs the extra fast.

    elastolink certify smith_1972_5152_sixteenth_inch --speed 300:400rpm --set coupler.damping=0.1
    """
    low, high = opt.span(options.speed, "frequency", "--speed", "300rpm:400rpm")
    resolution = opt.positive(options, "resolution", "frequency")
    system: Any = opt.load(options).system()
    found = design.certify(system, (low, high), resolution=resolution)
    return opt.finish(options, found, [line for _, line in sorted(_proof_lines(found))])


def _proof_lines(found: Any) -> list[tuple[float, str]]:
    """Return what is said of each interval, with its lower end."""

    def span(low: float, high: float) -> str:
        return f"from {low * opt.RPM:.6g} to {high * opt.RPM:.6g} rpm"

    lines = []
    for (low, high), bound in zip(found.proved, found.bound, strict=True):
        fall = f"every disturbance falls to at most {bound:.4g} of itself per period"
        more = f"; {fall} in the long run" if bound < 1.0 else ""
        lines.append((low, f"proved: stable {span(low, high)}{more}"))
    lines += [(low, f"proved: unstable {span(low, high)}") for low, high in found.unstable]
    why = "multipliers too close to the unit circle for --resolution"
    return lines + [(low, f"not proved {span(low, high)}: {why}") for low, high in found.open]
