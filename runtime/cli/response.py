"""``elastolink steady-state``: periodic motion of a flexible link, at one speed or over many."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from .. import periodic
from ..core.errors import bad
from . import options as opt
from .linkages import moving_scene, speeds_of, speeds_option

if TYPE_CHECKING:
    from ..core.families import Array

# Of the coordinates of beams, by the end of their names; all others are rotations.
_UNITS = {**dict.fromkeys(("x", "y", "along", "across"), "m"), "curvature": "1/m"}


def add(commands: Any) -> None:
    """Add the subcommand."""
    steady = opt.command(commands, "steady-state", _steady_state)
    opt.add(steady, speeds_option("operation.speed"))
    place = "place on the link, 0 to 1, whose deflection is shown; default where it is largest"
    opt.add(steady, {"--at X": place}, type=float)
    opt.add(steady, {"--method METHOD": "auto (default) or harmonic_balance"}, default="auto")


def _steady_state(options: argparse.Namespace) -> int:
    r"""Periodic motion of a flexible link without marching; resonances over the speed.

    elastolink steady-state beale_1992_flexible_rod --speed '100 rad/s'
    elastolink steady-state beale_1992_flexible_rod --set links.crank_ratio=0.1 \
        --set rod.damping_ratio=0.002 --speed 60:1000:471 --plot resonances.png
    """
    import numpy as np

    if options.at is not None and not 0.0 <= options.at <= 1.0:
        raise bad("--at", f"{options.at:g}", "a place from 0 to 1", "divide by the length")
    scene = moving_scene(options)
    speeds = speeds_of(options, scene)
    system = scene.linear_system()
    if system.structure is not None:
        opt.refuse_unused(options, ("at",), "a link with mode shapes")
        if len(speeds) > 1:
            fix = "elastolink stress takes many: --speed START:STOP:COUNT"
            raise bad("--speed", f"{len(speeds)} speeds", "one for a linkage of beams", fix)
    shown = opt.progress(options)
    result = periodic.steady_state(system, speeds, method=options.method, progress=shown)
    if system.structure is not None:
        return opt.finish(options, result, _largest(result, system.labels))
    places = np.linspace(0.0, 1.0, 41) if options.at is None else np.array([options.at])
    reached = result.peak(places)
    largest, place = np.max(reached, axis=1), places[np.argmax(reached, axis=1)]
    more = {"peak_deflection": largest.tolist()}
    return opt.finish(options, result, _lines(result, largest, place), more=more)


def _largest(found: periodic.SteadyState, labels: tuple[str, ...]) -> list[str]:
    """Return the largest values of the coordinates of a linkage of beams."""
    units = [_UNITS.get(label.rpartition(".")[2], "rad") for label in labels]
    return opt.columns(
        ("coordinate", "", labels), ("largest", ".6g", abs(found.q[0]).max(axis=0)), ("", "", units)
    )


def _lines(found: periodic.SteadyState, peaks: Array, places: Array) -> list[str]:
    """Return a row per speed, or per resonance where there are many."""
    import numpy as np

    speeds = found.speed
    chosen = np.arange(len(speeds))
    title: list[str] = []
    if len(speeds) > opt.MOST_ROWS:
        chosen = opt.highest(peaks)
        title = [f"{len(speeds)} speeds; where the deflection is larger than beside:", ""]
    lines = opt.columns(
        ("speed [rad/s]", ".6g", speeds[chosen]),
        ("deflection [m]", ".6g", peaks[chosen]),
        ("at x/length", ".2f", places[chosen]),
        ("multiplier from 1", ".3g", found.distance[chosen]),
        ("motion", "", np.where(found.stable[chosen], "stable", "unstable").tolist()),
    )
    return [*title, *lines]
