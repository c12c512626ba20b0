"""``elastolink stabilise``: the least changes with which a range of speeds is stable."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from .. import design
from . import options as opt
from .linkages import moving_scene, speed_range

if TYPE_CHECKING:
    from ..design.stabilising import Change
    from ..scenes import Scene


def add(commands: Any) -> None:
    """Add the subcommand."""
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
        lines += _lines(number, change)
    for change in found.unverified:
        lines += [f"not verified: {'; '.join((*change.words, *change.failed))}"]
    lines += [f"not to be had {text}" for text in found.impossible]
    more = {name: list(map(asdict, getattr(found, name))) for name in ("changes", "unverified")}
    return opt.finish(options, found, lines, more=more)


def _lines(number: int, change: Change) -> Iterator[str]:
    """Yield a change, its size, and what verifies it."""
    first, *others = change.words
    yield f"{number}  {first}"
    yield from (f"   {word}" for word in others)
    stress = "" if change.stress is None else f"; stress up to {change.stress / 1e6:.4g} MPa"
    away = f", {100.0 * change.distance:.3g} % away" if change.distance < 1.0 else ""
    yield f"   size of the change {100.0 * change.size:.3g} %; {change.nearest}{away}{stress}"
    yield f"   marched, a disturbance grows by {100.0 * change.growth:+.2g} % per turn"
    yield from (f"   too narrow to count: {name}" for name in change.narrow)
