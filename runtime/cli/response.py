"""``elastolink steady-state`` and ``response``: periodic motions, linear and beyond."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any, cast

from .. import nonlinear, periodic
from ..core.errors import bad
from . import options as opt
from .design import measured_points, points_option, with_points
from .linkages import moving_scene, speed_of, speed_range, speeds_of, speeds_option

if TYPE_CHECKING:
    from ..core.families import Array, Nonlinear
    from ..scenes import Scene

# Of the coordinates of beams, by the end of their names; all others are rotations.
_UNITS = {**dict.fromkeys(("x", "y", "along", "across"), "m"), "curvature": "1/m"}
_INEXTENSIBLE = "inextensible"


def add(commands: Any) -> None:
    """Add the two subcommands."""
    steady = opt.command(commands, "steady-state", _steady_state)
    opt.add(steady, speeds_option("operation.speed"))
    place = "place on the link, 0 to 1, whose deflection is shown; default where it is largest"
    opt.add(steady, {"--at X": place}, type=float)
    opt.add(steady, {"--method METHOD": "auto (default) or harmonic_balance"}, default="auto")

    parser = opt.command(commands, "response", _response)
    speeds = "LOW:HIGH[UNIT], or one speed with --in; default operation.speed_range or .speed"
    opt.add(parser, {"--speed SPEED": speeds})
    over = "vary a parameter of the equations at one speed instead, e.g. follower_inertia=LOW:HIGH"
    opt.add(parser, {"--in NAME=LOW:HIGH[UNIT]": over})
    turns = "follow doublings to motions of N revolutions; default 1"
    opt.add(parser, {"--turns N": turns}, type=int, default=1)
    rate = "march up and down at this acceleration of the crank instead, e.g. '2 rpm/s'"
    opt.add(parser, {"--sweep RATE": rate})
    points_option(parser)
    kicks = "disturbance of the coordinates in each revolution of a sweep; default 1e-3"
    opt.add(parser, {"--kicks SIZE": kicks}, type=float)
    search = "search for branches that do not hang together with the first, at three values"
    opt.switches(parser, {"--search": search})


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
    return opt.finish(options, result, _steady_lines(result, largest, place), more=more)


def _largest(found: periodic.SteadyState, labels: tuple[str, ...]) -> list[str]:
    """Return the largest values of the coordinates of a linkage of beams."""
    units = [_UNITS.get(label.rpartition(".")[2], "rad") for label in labels]
    return opt.columns(
        ("coordinate", "", labels), ("largest", ".6g", abs(found.q[0]).max(axis=0)), ("", "", units)
    )


def _steady_lines(found: periodic.SteadyState, peaks: Array, places: Array) -> list[str]:
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


def _response(options: argparse.Namespace) -> int:
    """Periodic motions of a flexible coupler beyond the linear range: jumps, coexisting motions.

    elastolink response smith_1972_101104_thirtysecond_inch --speed 300:540rpm --plot response.png
    elastolink response smith_1972_101104_thirtysecond_inch --speed 300:540rpm --turns 2
    elastolink response smith_1972_101104_thirtysecond_inch --speed 300:400rpm --sweep '2 rpm/s'
    """
    scene, told = _scene(options)
    system = cast("Nonlinear", scene.system())
    if options.sweep is not None:
        return _sweep(options, scene, system, told)
    opt.refuse_unused(options, ("kicks",), "--sweep")
    shown = opt.progress(options)
    varied = getattr(options, "in")
    points = measured_points(options, "a parameter" if varied else "speed")
    if varied is None:
        name, bounds = "speed", speed_range(options.speed, scene, "--speed")
        speed = None
    else:
        name, bounds = _parameter(varied, scene, system)
        speed = speed_of(options, scene)
    starts: list[Any] = []
    lines: list[str] = [*told]
    if options.search:
        starts, searched = _searched(system, name, bounds, speed, options)
        lines += searched
    curve = nonlinear.response_curve(
        system, name, bounds, speed=speed, turns=options.turns, starts=starts, progress=shown
    )
    return opt.finish(
        options, curve, [*lines, *_curve_lines(curve)], with_points(points, curve.plot)
    )


def _scene(options: argparse.Namespace) -> tuple[Scene, list[str]]:
    """Return the scene in a nonlinear formulation, and what was assumed."""
    scene = opt.load(options)
    told: list[str] = []
    if not scene.layout.formulations:  # a model of the user's: as it is
        return scene, told
    more: dict[str, Any] = {}
    if not scene.model["formulation"].startswith(_INEXTENSIBLE):
        if scene.layout.flexible != ("coupler",) or scene.model["mechanism"] != "four_bar":
            found = f"formulation '{scene.model['formulation']}'"
            fix = "choose a scene with a flexible coupler"
            raise bad(f"scene {scene.name}", found, "a nonlinear formulation", fix)
        more["model.formulation"] = _INEXTENSIBLE
    if "coupler" in scene.tables and not scene["coupler"].get("damping", 0.0):
        # A damping that was set to zero is meant.
        meant = any(key.startswith("coupler.damping") for key in opt.settings(options.set))
        decrements = None if meant else scene.get("measured.log_decrement", None)
        if decrements is None:
            told.append("no damping: resonances are bounded by the nonlinear terms alone")
        else:
            # The geometric mean of what was observed at rest.
            decrement = float((decrements[0] * decrements[1]) ** 0.5)
            more["coupler.damping_ratio"] = decrement / 6.283185307179586
            told.append(
                f"damping: a logarithmic decrement of {decrement:.3g}, the geometric mean of "
                f"{decrements[0]:g} and {decrements[1]:g} measured at rest"
            )
    return (opt.load(options, **more) if more else scene), told


def _parameter(text: str, scene: Scene, system: Nonlinear) -> tuple[str, tuple[float, float]]:
    """Return name and range of the parameter that is varied."""
    given, values = opt.pair(text, "--in", "NAME=LOW:HIGH", "follower_inertia='5:15 g*m**2'")
    known = sorted(system.parameters)
    for name in (given, given.replace(".", "_"), given.rpartition(".")[2]):
        if name in system.parameters:
            dimension = scene.layout.parameters.get(name, "length")
            example = "follower_inertia=0.0006:0.002"
            return name, opt.span(values, dimension, f"--in {given}", example)
    raise bad("--in", repr(given), f"one of {known}", "correct the name")


def _searched(
    system: Nonlinear,
    name: str,
    bounds: tuple[float, float],
    speed: float | None,
    options: argparse.Namespace,
) -> tuple[list[Any], list[str]]:
    """Return starts of branches from searches within the range, and what was searched."""
    starts: list[Any] = []
    tried: dict[str, int] = {}
    for part in (0.25, 0.5, 0.75):
        value = bounds[0] + part * (bounds[1] - bounds[0])
        found = nonlinear.coexisting_motions(
            system, name, value, speed=speed, turns=options.turns, progress=opt.progress(options)
        )
        starts += [(value, motion) for motion in found.motions]
        for kind, count in found.searched.items():
            tried[kind] = tried.get(kind, 0) + count
    words = ", ".join(f"{count} from {kind}" for kind, count in tried.items())
    return starts, [f"searched at three values: {words}; there may be other motions"]


def _curve_lines(curve: nonlinear.ResponseCurve) -> list[str]:
    """Return the special points, the branches, and the largest stable deflection."""
    import numpy as np

    speed = curve.parameter == "speed"
    factor, head = (opt.RPM, "speed [rpm]") if speed else (1.0, f"{curve.parameter} [SI]")
    size, unit = (1e3, "mm") if curve.unit == "m" else (1.0, curve.unit)
    deflection = size * (curve.special_highest - curve.special_lowest)
    count = len(curve.ended)
    lines = [f"{len(curve.value)} points on {count} branch{'es' * (count > 1)}"]
    for number, ended in enumerate(curve.ended):
        at = curve.branch == number
        turns = int(curve.turns[at][0])
        ends = factor * np.min(curve.value[at]), factor * np.max(curve.value[at])
        lines.append(
            f"  branch {number}, {turns} turn{'s' * (turns > 1)}: {ends[0]:.6g} to {ends[1]:.6g}, "
            f"{int(np.sum(curve.stable[at]))} of {int(np.sum(at))} points stable; {ended}"
        )
    none = f"  no motion was found to begin with at {head.split()[0]}"
    lines += [f"{none} {factor * end:.6g}" for end in curve.missed]
    if not curve.special:
        return [*lines, "", "no folds, doublings or crossings"]
    table = opt.columns(
        ("special point", "", curve.special),
        (head, ".8g", factor * curve.special_value),
        ("error", ".1g", factor * curve.special_error),
        (f"peak to peak [{unit}]", ".5g", deflection),
        ("branch", "d", curve.special_branch),
    )
    return [*lines, "", *table]


def _sweep(options: argparse.Namespace, scene: Scene, system: Nonlinear, told: list[str]) -> int:
    """March up and down, and print the jumps."""
    opt.refuse_unused(options, ("in", "search"), "a response curve, without --sweep")
    rate = opt.positive(options, "sweep", "angular_acceleration") or 0.0
    bounds = speed_range(options.speed, scene, "--speed")
    kicks = 1e-3 if options.kicks is None else options.kicks
    points = measured_points(options, "speed")
    found = nonlinear.sweep_response(
        system, bounds, rate, kicks=kicks, progress=opt.progress(options)
    )
    lines = [*told, f"{len(found.speed)} revolutions"]
    if found.stopped:
        lines.append(f"the motion is lost {found.stopped}")
    if found.jump_speed.size:
        lines += [
            "",
            *opt.columns(
                ("jump at [rpm]", ".6g", opt.RPM * found.jump_speed),
                ("", "", ["run up" if up else "run down" for up in found.jump_rising]),
                ("deflection after / before", ".3g", found.jump_ratio),
            ),
        ]
    else:
        lines.append("no jumps")
    return opt.finish(options, found, lines, with_points(points, found.plot))
