"""``elastolink sweep``: stability or deflection of all designs over some numbers of a scene."""

from __future__ import annotations

import argparse
from functools import partial
from math import isnan
from typing import TYPE_CHECKING, Any

from .. import sweeps
from ..core.errors import bad
from . import options as opt
from .linkages import moving_scene, speed_of
from .stability import pool_of, worker_count

if TYPE_CHECKING:
    from ..core.families import Array
    from ..scenes import Scene
    from ..sweeps import Sweep

# What is answered, and the output that is drawn and ranked unless told otherwise.
_ANSWERS = {"steady_state": "peak", "floquet_multipliers": "growth"}


def add(commands: Any) -> None:
    """Add the subcommand."""
    parser = opt.command(commands, "sweep", _sweep)
    over = (
        "a number and its values, e.g. links.coupler=12in:18in:50; 'speed' and parameters of the"
        " system as well; repeated, all combinations"
    )
    opt.add(parser, {"--over KEY=START:STOP:COUNT[UNIT]": over}, action="append", default=[])
    answer = "deflection (steady_state, the default) or stability (floquet_multipliers)"
    opt.add(parser, {"--of ANSWER": answer}, choices=list(_ANSWERS), default="steady_state")
    opt.add(
        parser,
        {
            "--speed SPEED": "crank speed where that is not swept; default operation.speed",
            "--workers N": "work in N processes; the answer does not depend on it",
            "--store PATH": "keep finished pieces in this folder or .npz file; the same command"
            " goes on from there after it was stopped",
            "--output NAME": "what --plot draws: peak, rms, error; growth (logarithm of the largest"
            " multiplier's modulus), stable",
        },
    )
    opt.switches(parser, {"--estimate": "tell time and memory, and work nothing out"})


def _values(scene: Scene, texts: list[str]) -> dict[str, Array]:
    """Return the values along each axis by name."""
    from ..sweeps.tasks import axis_dimensions

    # Answers are given at the speed of an option or an axis, whatever the scene's own is.
    known = axis_dimensions(scene).items()
    dimensions = {key: kind for key, kind in known if not key.startswith("operation.")}
    found = {}
    for text in texts:
        key, values = opt.pair(text, "--over", "KEY=START:STOP:COUNT", "links.coupler=12in:18in:50")
        if key not in dimensions:
            from ..scenes.validation import nearest

            fix = nearest(key, sorted(dimensions), "use one of these")
            raise bad("--over", repr(key), f"one of {sorted(dimensions)}", fix)
        if key in found:
            raise bad("--over", f"{key} twice", "each number once", "leave one of them out")
        found[key] = opt.values(values, dimensions[key], "--over")
    if not found:
        fix = "give --over links.coupler=12in:18in:50"
        raise bad("--over", "nothing", "at least one number and its values", fix)
    return found


def _sweep(options: argparse.Namespace) -> int:
    r"""Deflection or stability of all designs over some numbers of a scene.

    elastolink sweep smith_1972_5152_sixteenth_inch --over links.crank=2:3.2:20in \
        --over links.follower=5:9:20in --save designs.csv
    elastolink sweep SCENE --of floquet_multipliers --over speed=300:900:61rpm \
        --over links.crank=2:3:50in --store study
    """
    count = worker_count(options)
    scene = moving_scene(options)
    values = _values(scene, options.over)
    fixed = {} if "speed" in values else {"speed": speed_of(options, scene)}
    if not fixed:
        opt.refuse_unused(options, ("speed",), "a speed that is not swept")
    what = options.of, scene, values
    if options.estimate:
        opt.refuse_unused(options, ("save",), "without --estimate")
        told = sweeps.estimate_sweep(*what, options=fixed, workers=count)
        return opt.say(options, vars(told), str(told))
    with pool_of(count) as pool:
        given = {"executor": pool, "store": options.store, "progress": opt.progress(options)}
        found = sweeps.sweep(*what, options=fixed, **given)
    name = options.output or _ANSWERS[options.of]
    draw = partial(found.plot, output=name)
    return opt.finish(options, found, _lines(found, _ANSWERS[options.of]), draw)


def _lines(found: Sweep, name: str) -> list[str]:
    """Return how many designs there are, which are least and greatest, and why some failed."""
    import numpy as np

    shape = tuple(map(len, found.axes.values()))
    grid = " x ".join(f"{count} {key}" for key, count in zip(found.axes, shape, strict=True))
    lines = [f"{grid}: {np.prod(shape)} designs, {len(found.failures)} of them failed"]
    if found.store is not None:
        lines.append(f"{found.pieces} pieces, {found.resumed} of them found in {found.store}")
    if "stable" in found.outputs:
        lines.append(f"{int(np.sum(found['stable'] == 1))} stable")
    # Of several coordinates the one that is largest.
    ranked = np.asarray(found[name]).reshape(np.prod(shape), -1).max(axis=1)

    def told(key: str, value: float) -> str:
        unit = found.units.get(key, "")
        if unit == "rad/s" and key.endswith("speed"):
            return f"{value * opt.RPM:.6g} rpm"
        return f"{value:.6g} {unit}".rstrip()

    for word, place in (("least", np.nanargmin(ranked)), ("greatest", np.nanargmax(ranked))):
        if not isnan(ranked[place]):
            at = ", ".join(f"{key} {told(key, v)}" for key, v in found.point(int(place)).items())
            lines.append(f"{word} {name}: {told(name, ranked[place])} at {at}")
    for reason, places in found.reasons().items():
        first = ", the first" if len(places) > 1 else ""
        lines.append(f"{len(places)} failed{first}: {reason}")
    return lines
