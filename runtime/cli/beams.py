"""Commands for linkages of beams: frequencies, critical speeds, stresses, running speeds."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import astuple
from math import degrees
from typing import TYPE_CHECKING, Any

from .. import design, frequencies, recovery
from ..core.errors import bad
from . import options as opt
from .linkages import moving_scene, speed_of, speed_range

if TYPE_CHECKING:
    from ..core.families import LinearPeriodic
    from ..recovery.stress_over_speed import StressCurve
    from ..recovery.stresses import StressResult
    from ..scenes import Scene

_METHODS = ("mean_frequency", "running_mean", "response", "multipliers", "meissner")


def add(commands: Any) -> None:
    """Add the subcommands."""
    speeds = {"--range LOW:HIGH": "crank speeds, rad/s; default operation.speed_range"}
    limit = {"--limit LIMIT": "allowed stress, such as '250 MPa'"}
    parser = opt.command(commands, "frequencies", _frequencies)
    opt.add(parser, {"--count COUNT": "modes; default 6"}, type=int)
    parser = opt.command(commands, "critical-speeds", _critical)
    opt.add(parser, speeds)
    parser.add_argument("--method", choices=_METHODS, default="mean_frequency")
    parser = opt.command(commands, "campbell", _campbell)
    opt.add(parser, speeds)
    parser = opt.command(commands, "stress", _stress)
    opt.add(parser, {"--speed SPEED": "'30 rad/s', or START:STOP:COUNT[UNIT]", **limit})
    parser = opt.command(commands, "running-speed", _running)
    opt.add(parser, speeds)
    opt.add(parser, limit, required=True)
    parser = opt.command(commands, "run-through", _through)
    ends = {"--from START": "first crank speed", "--to STOP": "last crank speed"}
    time = {"--time TIME": "duration of the change, such as '2 s'"}
    opt.add(parser, {**ends, **time}, required=True)


def _of_beams(options: argparse.Namespace, *, moving: bool = False) -> tuple[Scene, LinearPeriodic]:
    """Return the scene and its system, refused where the links are no beams."""
    scene = moving_scene(options) if moving else opt.load(options)
    system = scene.linear_system()
    if system.structure is not None:
        return scene, system
    from ...derive.spec import BEAM_FORMULATIONS

    where = f"scene {scene.name}"
    if scene.model["formulation"] not in BEAM_FORMULATIONS:
        expected = "links that are beams, such as formulation 'cubic_beams'"
        fix = "begin with `elastolink new beams`, or choose aannaque_1996_table_4_1"
        raise bad(where, f"formulation '{scene.model['formulation']}'", expected, fix)
    if scene.model["mechanism"] == "frame":
        found, fix = "members that do not stretch", "say --set frame.axial=elastic"
    else:
        found, fix = "a pin that slides along a beam", "use frequencies or steady-state"
    raise bad(where, found, "beams whose forces can be recovered", fix)


def _frequencies(options: argparse.Namespace) -> int:
    """Natural frequencies over the crank angle: means, ranges, crossings, veerings.

    elastolink frequencies aannaque_1996_table_4_1 --count 4 --plot frequencies.png
    """
    found = frequencies.natural_frequencies(opt.load(options).linear_system(), count=options.count)
    lines = opt.columns(
        ("mode", "", range(1, found.frequency.shape[1] + 1)),
        ("mean [rad/s]", ".7g", found.mean),
        ("least", ".7g", found.frequency.min(axis=0)),
        ("greatest", ".7g", found.frequency.max(axis=0)),
    )
    lines.append(f"crossings: {len(found.crossings)}, veerings: {len(found.veerings)}")
    return opt.finish(options, found, lines)


def _critical(options: argparse.Namespace) -> int:
    """Critical speeds within a range: means over n, multipliers, J_N, the response.

    elastolink critical-speeds aannaque_1996_table_4_1 --range 20:70 --method mean_frequency
    """
    scene, shown = moving_scene(options), opt.progress(options)
    speeds = speed_range(options.range, scene, "--range")
    system = scene.linear_system()
    found = frequencies.critical_speeds(system, speeds, method=options.method, progress=shown)
    lines = opt.columns(
        ("speed [rad/s]", ".6g", found.speed),
        ("mode", "", [mode for mode, _ in found.labels]),
        ("n", "", [n for _, n in found.labels]),
        ("error", ".2g", found.error),
    )
    if not len(found.speed):
        lines = [
            "none of this kind in the range; of stresses: elastolink stress --speed LOW:HIGH:N"
        ]
    return opt.finish(options, found, lines)


def _campbell(options: argparse.Namespace) -> int:
    """Campbell diagram: frequencies against the crank speed, and the orders that meet.

    elastolink campbell aannaque_1996_table_4_1 --range 5:70 --plot campbell.png
    """
    scene = moving_scene(options)
    speeds = opt.spaced(*speed_range(options.range, scene, "--range"), 27)
    found = frequencies.campbell(scene.linear_system(), speeds, progress=opt.progress(options))
    return opt.finish(options, found, opt.ranges(found))


def _stress(options: argparse.Namespace) -> int:
    """Stresses of a linkage of beams: over the cycle at one speed, or over the speed.

    elastolink stress aannaque_1996_table_4_1 --speed '30 rad/s' --limit '250 MPa'
    elastolink stress aannaque_1996_table_4_1 --speed 5:30:1000 --plot stress.png
    """
    scene, system = _of_beams(options)
    limit = opt.positive(options, "limit", "stress")
    if scene.model["mechanism"] == "frame":
        opt.refuse_unused(options, ("speed",), "a linkage; a frame has no crank")
        standing = recovery.stress(system)
        return opt.finish(options, standing, _peaks(standing, scene, limit))
    if options.speed is None or ":" not in options.speed:
        result = recovery.stress(system, speed_of(options, scene))
        return opt.finish(options, result, _peaks(result, scene, limit))
    speeds = opt.values(options.speed, "frequency", "--speed")
    if limit is None:
        curve = recovery.stress_curve(system, speeds)
        lines = [*_curve_lines(curve), *_unstable_lines(curve.unstable_ranges)]
        return opt.finish(options, curve, lines)
    found = design.quiet_speeds(system, speeds, limit)
    lines = opt.columns(
        ("from [rad/s]", ".5g", [band.low for band in found.bands]),
        ("to", ".5g", [band.high for band in found.bands]),
        ("quietest", ".5g", [band.best for band in found.bands]),
        ("stress/limit", ".3g", [band.ratio for band in found.bands]),
        ("beyond the critical speed", "", [_known(b.above, ".5g") for b in found.bands]),
    )
    lines += _unstable_lines(found.unstable)
    return opt.finish(options, found, lines, more={"bands": list(map(astuple, found.bands))})


def _known(value: float | None, form: str) -> str:
    return "-" if value is None else format(value, form)


def _unstable_lines(ranges: Sequence[tuple[float, float]]) -> list[str]:
    return [f"unstable from {low:.5g} to {high:.5g} rad/s" for low, high in ranges]


def _peaks(found: StressResult, scene: Scene, limit: float | None) -> list[str]:
    """Return a row per link: its largest stress, where and when.

    What it may bear is ``limit``, else what the scene says of the link.
    """
    peaks, safety = found.maxima.values(), []
    for name, one in found.maxima.items():
        own = (scene.get(f"{table}.limit_stress", None) for table in (name, f"members.{name}"))
        allowed = limit or next((value for value in own if value), None)
        safety.append(allowed / abs(one.value) if allowed and one.value else None)
    return opt.columns(
        ("link", "", found.maxima),
        ("stress [MPa]", ".6g", [one.value / 1e6 for one in peaks]),
        ("at x/length", ".3g", [one.place for one in peaks]),
        ("at [deg]", ".4g", [degrees(one.theta) for one in peaks]),
        ("fibre", "", [one.fibre for one in peaks]),
        ("safety", "", [_known(factor, ".4g") for factor in safety]),
    )


def _curve_lines(curve: StressCurve) -> list[str]:
    """Return a row per local maximum of a link's largest stress, the highest ones of each."""
    peaks = [set(opt.highest(column).tolist()) for column in curve.maximum.T]
    rows = [
        (
            f"{curve.speed[i]:.5g}",
            *(
                f"{value / 1e6:.5g}{'*' if i in own else ' '}"
                for value, own in zip(curve.maximum[i], peaks, strict=True)
            ),
        )
        for i in sorted(set().union(*peaks))
    ]
    count = len(curve.speed)
    if not rows:
        return [f"{count} speeds; no link's largest stress is higher than beside"]
    title = f"{count} speeds; largest stress [MPa], * where that of the link is higher than beside:"
    return [title, "", *opt.table(("speed [rad/s]", *curve.links), rows)]


def _running(options: argparse.Namespace) -> int:
    """Quiet running speed above limiting critical speeds, and how to get there.

    elastolink running-speed aannaque_1996_table_4_1 --range 5:45 --limit '250 MPa'
    """
    scene, system = _of_beams(options, moving=True)
    limit: Any = opt.positive(options, "limit", "stress")
    speeds = speed_range(options.range, scene, "--range")
    found = design.running_speed(system, speeds, limit, progress=opt.progress(options))
    least, band = f"{found.speed:.5g} rad/s, stress over limit {found.band.ratio:.3g}", found.band
    span = f"from {band.low:.5g} to {band.high:.5g} rad/s"
    if band.above is None:
        lines = [
            "no quiet speed beyond a limiting critical speed in this range",
            f"below, within the limit {span}; least stress at {least}",
        ]
    else:
        lines = [f"running speed: {least}", f"quiet {span}"]
        lines.append(f"beyond the limiting critical speed {found.band.above:.5g} rad/s")
        length = found.run_up_length
        lines.append(
            "no frame length that was tried brings it there within the limit: pass quickly"
            if length is None
            else f"frame length for the run-up: {length:.5g} m"
        )
    if found.best_damping is not None:
        lines.append(f"damping ratio with the least stress there: {found.best_damping:.3g}")
    return opt.finish(options, found, lines, more={"bands": list(map(astuple, found.quiet.bands))})


def _through(options: argparse.Namespace) -> int:
    r"""Run-up or coast-down through critical speeds, as a transient.

    elastolink run-through aannaque_1996_table_4_1 --from '25 rad/s' --to '36 rad/s' --time '2 s' \
        --plot run.png
    """
    _, system = _of_beams(options, moving=True)
    profile = design.SpeedProfile.ramp(
        opt.quantity(vars(options)["from"], "frequency", "--from"),
        opt.quantity(options.to, "frequency", "--to"),
        opt.quantity(options.time, "time", "--time"),
    )
    found = design.run_through(system, profile)
    stresses = [value / 1e6 for value in found.largest.values()]
    lines = opt.columns(("link", "", found.largest), ("largest stress [MPa]", ".5g", stresses))
    return opt.finish(options, found, lines)
