"""``elastolink stability`` and ``elastolink chart``: where the motion is stable.

Large charts are made by several processes, in pieces that are kept and resumed, and estimated.
"""

from __future__ import annotations

import argparse
from contextlib import AbstractContextManager, nullcontext
from math import isfinite
from typing import TYPE_CHECKING, Any

from .. import constrained, periodic, stability, sweeps
from ..core.errors import bad
from . import options as opt
from .design import measured_points, points_option, with_points
from .linkages import (
    around,
    at_speed,
    is_constrained,
    moving_scene,
    speed_of,
    speeds_of,
    speeds_option,
    without_crank,
)

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from ..constrained.multipliers import ConstrainedMultipliers
    from ..constrained.orbits import PeriodicOrbit
    from ..core.families import Array, LinearPeriodic
    from ..design import Point
    from ..scenes import Scene
    from ..sweeps.tasks import AnyArray

    Axis = tuple[str, Array]

# Speeds over a range that nobody divided.
_SPEEDS = 61


def add(commands: Any) -> None:
    """Add the two subcommands."""
    multipliers = opt.command(commands, "stability", _stability)
    opt.add(multipliers, speeds_option("operation.speed or .speed_range, 1 without crank"))
    chart = opt.command(commands, "chart", _chart)
    order = "order of the perturbation boundaries of one mode, 1 to 8; default 1"
    opt.add(chart, {"--order N": order}, type=int, default=1)
    edges = "trace regions of several modes, combinations among them, at nine rows; takes longer"
    opt.switches(chart, {"--edges": edges})
    opt.add(
        chart,
        {
            "--speed SPEED": "crank speed where that is no axis, e.g. '500 rpm', rad/s without a"
            " unit; default operation.speed, 1 without crank",
            "--workers N": "work in N processes; the answer does not depend on it",
            "--store PATH": "keep the chart, without boundaries, in this folder or .npz file, piece"
            " by piece; the same command goes on from there after it was stopped",
        },
    )
    points_option(chart)
    estimate = "with --store: tell time and memory, and work nothing out"
    opt.switches(chart, {"--estimate": estimate})
    for axis in ("x", "y"):
        along = f"parameter along {axis}; default from the scene"
        opt.add(chart, {f"--{axis} NAME=START:STOP:COUNT[UNIT]": along})


def _stability(options: argparse.Namespace) -> int:
    """Floquet multipliers at one crank speed or over a range of them.

    elastolink stability smith_1972_5152_sixteenth_inch --speed '500 rpm'
    elastolink stability smith_1972_5152_sixteenth_inch --speed 300:900:61rpm
    """
    scene = moving_scene(options)
    if is_constrained(scene):
        return _about_orbit(options, scene)
    system, said = scene.linear_system(), []
    span = scene.get("operation.speed_range", None)
    if without_crank(options, scene):
        speeds: Any = [1.0]
    elif options.speed is None and span and scene.get("operation.speed", None) is None:
        speeds = opt.spaced(span[0], span[1], _SPEEDS)
        said = [f"{_SPEEDS} speeds, chosen: operation.speed_range, for there is no one speed"]
    else:
        speeds = speeds_of(options, scene)
    result = periodic.floquet_multipliers(system, speeds if len(speeds) > 1 else speeds[0])
    return opt.finish(options, result, [*said, *_multiplier_lines(result, scene)])


def _about_orbit(options: argparse.Namespace, scene: Scene) -> int:
    """Find the periodic motion by shooting, and the multipliers about it."""
    orbit = constrained.periodic_orbit(at_speed(options, scene))
    if not orbit.converged:
        return opt.finish(options, orbit, [f"no periodic motion: {orbit.message}"])
    result = constrained.orbit_multipliers(orbit)
    lines = [
        *opt.multipliers("physical multiplier", result.physical),
        "",
        f"{_verdict(orbit, result)}; largest deflection {orbit.deflection:.3g} of the "
        f"length; {len(result.others)} more multipliers belong to the constraints and are 1",
    ]
    return opt.finish(options, result, lines, beside=(orbit,))


def _verdict(orbit: PeriodicOrbit, found: ConstrainedMultipliers) -> str:
    """Return the verdict, and whether the equations hold where it was found."""
    told = ("stable" if found.stable else "unstable") + " about the periodic motion"
    reached = orbit.checks["linear range"]
    if not orbit.checks["accuracy"].passed:
        return f"not known: the periodic motion is known to {orbit.error:.2g} only"
    if not reached.passed:
        return (
            f"no verdict on the rod: the motion leaves the linear range, {reached.limit:g} of the "
            f"length, where the equations hold; by them it is {told}"
        )
    return told


def _multiplier_lines(result: periodic.FloquetMultipliers, scene: Scene) -> list[str]:
    import numpy as np

    speeds = np.atleast_1d(result.speed)
    multipliers = result.multipliers.reshape(len(speeds), -1)
    stable = np.atleast_1d(result.stable)
    if len(speeds) == 1:
        lines = opt.multipliers("multiplier", multipliers[0])
        verdict = "stable" if stable[0] else "unstable"
        return [*lines, "", f"{verdict} at {_crank(float(speeds[0]), scene)}"]
    lines = [f"{int(stable.sum())} of {len(speeds)} speeds stable; unstable ones:"]
    edges = np.flatnonzero(np.diff(np.concatenate(([0], (~stable).astype(int), [0]))))
    for first, last in edges.reshape(-1, 2):
        ends = _crank(float(speeds[first]), scene), _crank(float(speeds[last - 1]), scene)
        worst = float(np.abs(multipliers[first:last]).max())
        lines.append(f"  {ends[0]} to {ends[1]}, largest modulus {worst:.6g}")
    return lines if len(edges) else [f"all {len(speeds)} speeds stable"]


def _crank(speed: float, scene: Scene) -> str:
    if scene.model["mechanism"] == "hill":
        return f"{speed:g}"
    from ..core.units import describe

    return describe(speed, "frequency")


def _chart(options: argparse.Namespace) -> int:
    """Stability chart over two parameters, with exact and perturbation boundaries.

    elastolink chart smith_1972_5152_sixteenth_inch --plot chart.png
    elastolink chart mathieu --x lam2=-0.5:10:400 --y mu=0:4:300 --plot mathieu.svg
    elastolink chart mathieu --x lam2=-0.5:30:4000 --y mu=0:4:2500 --store fine.npz
    """
    count = _check_scale(options)
    from ..stability.chart_axes import measured_marks

    scene = moving_scene(options)
    system = scene.linear_system()
    other = (options.y or "").partition("=")[0].strip() or scene.get("chart.y", None)
    x, told_x = _axis(options.x, "x", other, scene, system)
    y, told_y = _axis(options.y, "y", x[0], scene, system)
    said = [told for told in (told_x, told_y) if told]
    if x[0] == y[0]:
        raise bad("--y", repr(y[0]), "another parameter than along x", "choose one")
    points = measured_points(options, x[0])
    unset = "speed" in (x[0], y[0]) or scene.get("operation.speed", None) is None
    speed = None if options.speed is None and unset else speed_of(options, scene)
    if options.store is not None:
        return _stored(options, system, (x, y), speed, count, points, said)
    from ..core.workers import in_order

    name = "coupler frequency" if tuple(scene.get("model.flexible", ())) == ("coupler",) else None
    with pool_of(count) as executor:
        chart = stability.stability_chart(
            system,
            x=x,
            y=y,
            order=options.order,
            edges=options.edges,
            speed=speed,
            marks=measured_marks(scene, y),
            workers=map if executor is None else in_order(executor),
            frequency_name=name or "natural frequency",
        )
    lines = [*said, *_chart_lines(chart, scene)]
    return opt.finish(options, chart, lines, with_points(points, chart.plot))


def _chart_lines(chart: stability.StabilityChart, scene: Scene) -> list[str]:
    """Return the unstable share, and the ends of each region at the ends of the other axis."""
    names = chart.x_name, chart.y_name
    first, *lines = _shares(names, chart.stable, chart.kind)
    lines = [first, chart.method, *lines]
    if min(chart.nodes) > 0:
        lines.append(f"sampled at {chart.nodes[0]} x {chart.nodes[1]} nodes")
    curves = chart.exact
    if curves is None:
        return [*lines, *_edge_lines(chart)]
    other = chart.y_name if curves.along == chart.x_name else chart.x_name
    dimensions = scene.layout.parameters
    along, across = dimensions[curves.along], dimensions[other]
    values = chart.x if curves.along == chart.x_name else chart.y
    rows = []
    for i, region in enumerate(curves.regions):
        pairs = [sorted((curves.lower[i, j], curves.upper[i, j])) for j in (0, -1)]
        ends = [end for pair in pairs for end in pair]
        known = [end for end in ends if isfinite(end)]
        if known and min(known) <= values[-1] and max(known) >= values[0]:
            told = (_brief(end, along) if isfinite(end) else "-" for end in ends)
            rows.append((str(region), *told))
    low, high = (_brief(curves.at[i], across) for i in (0, -1))
    header = ("region", f"from, at {low}", "to", f"from, at {high}", "to")
    table = [*lines, "", f"boundaries along {curves.along}:", *opt.table(header, rows)]
    if curves.left_out:
        table.append(f"{curves.left_out} higher regions reach into the chart but are left out")
    return [*table, ""]


def _edge_lines(chart: stability.StabilityChart) -> list[str]:
    """Return the widest extent of each traced combination region that can be told from none."""
    edges = chart.edges
    if edges is None:
        return []
    rows = []
    for i, kind in enumerate(edges.kind):
        width = edges.upper[i] - edges.lower[i]
        known = [j for j, w in enumerate(width) if w > 2 * edges.error[i, j]]
        if kind == "principal" or not known:
            continue
        widest = max(known, key=lambda j: float(width[j]))
        pair = " and ".join(map(str, edges.modes[i]))
        ends = (_brief(float(e[i, widest]), "frequency") for e in (edges.lower, edges.upper))
        rows.append((f"{kind} of {pair}", str(edges.harmonic[i]), *ends, f"{edges.at[widest]:.4g}"))
    if not rows:
        return ["no combination region wide enough to be told from none"]
    other = chart.y_name if chart.x_name == "speed" else chart.x_name
    header = ("combination region, where widest", "harmonic", "from", "to", f"at {other}")
    return ["", *opt.table(header, rows), ""]


def _brief(value: float, dimension: str) -> str:
    """Return a value with its unit; a crank speed in rpm alone, as in the picture."""
    from ..core.units import describe

    text = describe(float(value), dimension)
    return text.partition("(")[2].rstrip(")") or text


def _axis(
    given: str | None, axis: str, other: str | None, scene: Scene, system: LinearPeriodic
) -> tuple[Axis, str]:
    """Return name and values along an axis, and the line that says how the scene chose it."""
    known = scene.layout.parameters
    if given is None:
        return _axis_by_scene(axis, other, scene, system)
    name, sign, text = given.partition("=")
    name = name.strip()
    if name not in known:
        from ..scenes.validation import nearest

        fix = nearest(name, known, "use one of these")
        raise bad(f"--{axis}", repr(name), f"a parameter of {sorted(known)}", fix)
    if not sign:
        raise bad(f"--{axis}", repr(given), "NAME=START:STOP:COUNT[UNIT]", "add the values")
    return (name, opt.values(text, known[name], f"--{axis}")), ""


def _axis_by_scene(
    axis: str, other: str | None, scene: Scene, system: LinearPeriodic
) -> tuple[Axis, str]:
    """Return the axis that the scene gives, or one around a value."""
    from ..stability.chart_axes import axis_of_scene

    found = axis_of_scene(scene, axis)
    if found is not None:
        return found, ""
    name, points = scene.get(f"chart.{axis}", None), scene.get(f"chart.{axis}_points", 201)
    given = {k: v for table in scene.tables.values() for k, v in table.items()}
    values = {**given, **system.parameters, "speed": scene.get("operation.speed", 0.0)}
    known = scene.layout.parameters
    if axis == "x" and name is None and other != "speed" and "speed" in known:
        name = "speed"
    for one, dimension in known.items():
        if one == (name or one) != other and values.get(one, 0.0) > 0.0:
            low, high, told = around(one, values[one], dimension)
            return (one, opt.spaced(low, high, max(points, 2))), told
    missing = f"no chart.{axis}_range in scene {scene.name}, nor a value to choose it by"
    fix = f"give --{axis} NAME=START:STOP:COUNT, or operation.speed"
    raise bad(f"--{axis}", missing, "a parameter and its values", fix)


def _check_scale(options: argparse.Namespace) -> int:
    """Refuse options that do not go together, and return the number of processes."""
    count = worker_count(options)
    if options.store is None:
        opt.refuse_unused(options, ("estimate",), "--store PATH")
        return count
    opt.refuse_unused(options, ("edges",), "a chart without --store")
    if options.order != 1:
        fix = "leave one of them out"
        raise bad("--order", options.order, "none beside --store, which has no boundaries", fix)
    return count


def worker_count(options: argparse.Namespace) -> int:
    """Return the number of processes of ``--workers``, 1 without it."""
    if options.workers is None:
        return 1
    from ..core.workers import check_workers

    text = options.workers.strip()
    return check_workers(int(text) if text.isdecimal() and len(text) < 10 else text, "--workers")


def pool_of(count: int) -> AbstractContextManager[Executor | None]:
    """Open as many processes; none for one."""
    return nullcontext() if count == 1 else sweeps.process_pool(count)


def _stored(
    options: argparse.Namespace,
    system: LinearPeriodic,
    axes: tuple[Axis, Axis],
    speed: float | None,
    count: int,
    points: tuple[Point, ...],
    said: list[str],
) -> int:
    """Work out a chart piece by piece, or estimate what that takes."""
    (x, _), (y, _) = axes
    what = "stability_chart", system, dict(reversed(axes))
    fixed = {} if speed is None else {"speed": speed}
    if options.estimate:
        opt.refuse_unused(options, ("save",), "without --estimate")
        found = sweeps.estimate_sweep(*what, options=fixed, workers=count)
        return opt.say(options, vars(found), str(found))
    shown = opt.progress(options)
    with pool_of(count) as pool:
        told = {"executor": pool, "store": options.store, "progress": shown}
        chart = sweeps.sweep(*what, options=fixed, **told)
    left = 100.0 * float((chart["undecided"] == 1).mean())
    lines = [
        *said,
        *_shares((x, y), chart["stable"], chart["kind"]),
        f"{left:.3g} % undecided",
        f"{chart.pieces} pieces, {chart.resumed} of them found there, in {chart.store}: "
        + ", ".join(sorted(chart.outputs)),
        *(f"damaged, and done anew: {what}" for what in chart.damaged),
    ]
    return opt.finish(options, chart, lines, with_points(points, chart.plot))


def _shares(names: tuple[str, str], stable: AnyArray, kind: AnyArray) -> list[str]:
    """Return what share of a chart ``(ny, nx)`` is unstable, and how much of it by combination."""
    ny, nx = stable.shape
    unstable, mixed = 100.0 * float((stable == 0).mean()), 100.0 * float((kind == 2).mean())
    lines = [f"{names[0]} x {names[1]}: {nx} x {ny} points, {unstable:.3g} % unstable"]
    if mixed > 0:
        lines.append(f"{mixed:.3g} % by combination (complex multipliers)")
    return lines
