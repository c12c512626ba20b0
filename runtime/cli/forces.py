"""``elastolink forces``, ``run-up``, ``balance``: machines of rigid links, driven and balanced."""

from __future__ import annotations

import argparse
import math
from dataclasses import asdict
from functools import partial
from math import degrees
from typing import TYPE_CHECKING, Any

from .. import rigid
from ..core.errors import bad
from . import options as opt
from .linkages import drive_of, drive_options

if TYPE_CHECKING:
    from ..core.families import Array
    from ..core.results import Result
    from ..linkages import Linkage
    from ..scenes import Scene

_WHOLE_TURN, _REVOLUTIONS = "0:360:721deg", 10.0
_JOINTS = ("12", "23", "34", "41", "frame", "torque", "moment")


def add(commands: Any) -> None:
    """Add the three subcommands."""
    forces = opt.command(commands, "forces", _forces)
    opt.add(forces, drive_options("default operation.speed"))
    opt.add(forces, opt.angles(f"{_WHOLE_TURN}, or the range that the crank reaches"))
    drawn = "what --plot draws: a polar diagram, or the torque or moment over the angle"
    opt.add(forces, {"--joint": drawn}, choices=_JOINTS)
    wheel = "size a flywheel for this coefficient of speed fluctuation, e.g. 0.02"
    opt.add(forces, {"--fluctuation COEFF": wheel}, type=float)

    run_up = opt.command(commands, "run-up", _run_up)
    opt.add(
        run_up,
        {
            "--torque TORQUE": "constant motor torque, e.g. '5 N*m'; default: the scene's motor",
            "--stall-torque TORQUE": "motor torque at rest; default motor.stall_torque",
            "--no-load-speed SPEED": "speed at which the torque has fallen to zero, e.g. '1500"
            " rpm', rad/s without a unit; default motor.no_load_speed",
            "--duration TIME": "where the run ends, e.g. '2 s'",
            "--start-speed SPEED": "crank speed at the start, e.g. '100 rpm'; default 0",
            "--start-angle ANGLE": "crank angle at the start, e.g. '30 deg'; default 0",
        },
    )
    end = f"where the run ends; default {_REVOLUTIONS:g} where there is no --duration"
    opt.add(run_up, {"--revolutions N": end}, type=float)
    _add_balance(commands)


def _forces(options: argparse.Namespace) -> int:
    """Pin forces, driving torque, shaking force and moment of rigid links.

    elastolink forces smith_1972_12_6_12_12 --speed '10 rad/s' --joint 34 --plot f34.png
    elastolink forces slider_crank_example --speed '1500 rpm' --fluctuation 0.02
    """
    from ..rigid.peaks import LABELS

    if options.plot is None:
        opt.refuse_unused(options, ("joint",), "--plot FILE beside it")
    scene = opt.load(options)
    machine = scene.machine()
    speed, acceleration = drive_of(options, scene)
    theta = _angles(options, machine.linkage)
    found = rigid.rigid_forces(machine, theta, speed, acceleration)
    even, numbers, beside = _evenness(machine, speed, options.fluctuation)
    span = float(theta[0]), float(theta[-1])
    peaks = rigid.force_peaks(machine, speed, acceleration, span=span)
    # No minus before a zero.
    table = opt.columns(
        ("quantity", "", ["{} [{}]".format(*LABELS[name]) for name in peaks]),
        ("peak", "z.6g", [peak.value for peak in peaks.values()]),
        ("crank angle [deg]", "z.2f", [degrees(peak.crank_angle) for peak in peaks.values()]),
    )
    more = {"peaks": {name: asdict(peak) for name, peak in peaks.items()}, **numbers}
    draw = partial(found.plot, joint=options.joint)
    return opt.finish(options, found, [*table, "", *even], draw, more=more, beside=beside)


def _angles(options: argparse.Namespace, linkage: Linkage) -> Array:
    """Return the crank angles of ``--angles``: by default a turn, or what the crank reaches."""
    if options.angles is not None or linkage.crank_turns:
        text = _WHOLE_TURN if options.angles is None else options.angles
        return opt.values(text, "angle", "--angles")
    low, high = linkage.crank_ranges()[-1]
    # At the folds themselves the forces are infinite: stay a hundredth of the range away.
    inset = 0.01 * (high - low)
    return opt.spaced(low + inset, high - inset, 721)


def _evenness(
    machine: rigid.Machine, speed: float, wanted: float | None
) -> tuple[list[str], dict[str, Any], tuple[Result, ...]]:
    """Return mean torque, energy fluctuation and flywheel in lines, in numbers, as results."""
    lacking = None
    if not machine.linkage.crank_turns:
        lacking = "a crank that does not turn fully", "one that does", "change a length"
    elif speed == 0.0:
        lacking = "a crank without speed", "one that runs", "give --speed"
    if lacking and wanted is not None:
        raise bad("--fluctuation", *lacking)
    if lacking:
        return [f"{lacking[0]}: no mean torque over a revolution"], {}, ()
    steady = rigid.torque_fluctuation(machine, speed)
    size = float(abs(steady.torque).max())
    # Round-off of a mean that is zero reads as zero.
    mean = steady.mean_torque if abs(steady.mean_torque) > 1e-14 * size else 0.0
    lines = [
        f"mean torque {mean:.6g} N m; energy fluctuation"
        f" {steady.energy_fluctuation:.6g} J at constant speed"
    ]
    numbers: dict[str, Any] = {
        "mean_torque": mean,
        "energy_fluctuation": steady.energy_fluctuation,
        "energy_fluctuation_error": steady.error,
    }
    if wanted is None:
        return lines, numbers, (steady,)
    wheel = rigid.flywheel_inertia(machine, speed, wanted)
    lines.append(
        f"flywheel {wheel.inertia:.6g} kg m^2 for a coefficient of {wheel.fluctuation:.4g}"
        f" (first order {wheel.first_order:.6g})"
    )
    names = ("inertia", "first_order", "fluctuation", "motor_torque", "error")
    numbers["flywheel"] = {name: getattr(wheel, name) for name in names}
    return lines, numbers, (steady, wheel)


def _run_up(options: argparse.Namespace) -> int:
    """How a machine of rigid links runs under its motor, from rest or a given speed.

    elastolink run-up slider_crank_example --revolutions 20 --plot run_up.png
    elastolink run-up slider_crank_example --torque '5 N*m' --duration '0.5 s'
    """
    scene = opt.load(options)
    machine = scene.machine()
    torque = _torque(options, scene)
    duration = opt.given(options, "duration", "time")
    revolutions = options.revolutions
    if revolutions is None and duration is None:
        revolutions = _REVOLUTIONS
    found = rigid.run_up(
        machine,
        torque,
        revolutions=revolutions,
        duration=duration,
        speed0=opt.given(options, "start-speed", "frequency") or 0.0,
        theta0=opt.given(options, "start-angle", "angle") or 0.0,
        flywheel=float(scene.get("motor.flywheel", 0.0)),
    )
    return opt.finish(options, found, _run_lines(found))


def _torque(options: argparse.Namespace, scene: Scene) -> rigid.TorqueLine | float:
    """Return what drives: the constant torque, or the torque line of options and scene."""
    constant = opt.given(options, "torque", "moment")
    stall = opt.given(options, "stall-torque", "moment")
    free = opt.given(options, "no-load-speed", "frequency")
    if constant is not None:
        if stall is not None or free is not None:
            found = "a constant torque and a torque line"
            raise bad("--torque", found, "one of them", "leave the other out")
        return constant
    table = scene.get("motor", {})
    stall = table.get("stall_torque") if stall is None else stall
    free = table.get("no_load_speed") if free is None else free
    if stall is None or free is None:
        missing = "--stall-torque" if stall is None else "--no-load-speed"
        fix = "give --torque '5 N*m', or --stall-torque with --no-load-speed"
        raise bad(missing, "nothing, and none in the scene's [motor]", "a motor", fix)
    return rigid.TorqueLine(stall, free)


def _run_lines(found: rigid.RunUp) -> list[str]:
    speed, fluctuation = float(found.speed[-1]), found.fluctuation
    balance = found.checks["energy less work, relative"].value
    rows = [
        ("time [s]", f"{found.time[-1]:.6g}"),
        ("revolutions", f"{found.revolutions:.6g}"),
        ("final speed [rad/s]", f"{speed:.6g}"),
        ("final speed [rpm]", f"{speed * opt.RPM:.6g}"),
        (
            "speed fluctuation, last revolution",
            "less than one made" if fluctuation is None else f"{fluctuation:.4g}",
        ),
        ("kinetic and potential energy [J]", f"{found.energy[-1]:.6g}"),
        ("energy balance, relative", f"{balance:.2g}"),
        ("flywheel [kg m^2]", f"{found.flywheel:.6g}"),
    ]
    return [*opt.table(("quantity", "value"), rows), "", f"status: {found.status}: {found.message}"]


_POINTS = 13


def _add_balance(commands: Any) -> None:
    parser = opt.command(commands, "balance", _balance)
    opt.add(parser, drive_options("default operation.speed"))
    case = (
        "b: crank and follower about their pivots; c, d: full force balance, with three or two "
        "counterweights; default: optimise"
    )
    opt.add(parser, {"--case": case}, choices=("b", "c", "d"))
    opt.add(
        parser,
        {
            "--offset LENGTH": "of the counterweights from the first joints of their links: at most"
            " this when optimising; default the length of the link",
            "--mass MASS": "greatest mass of one counterweight; default all links'",
            "--weights NAME=W,...": "of shaking_force, shaking_moment, torque, f12, f23, f34, f41;"
            " default f23=1,torque=1,shaking_moment=1: pin of the crank, torque, moment on the"
            " frame",
            "--limits NAME=R,...": "relative peaks that must not be passed",
            "--links LINK,...": "that may carry one; default those on the frame",
        },
    )
    measure = "of each force, when optimising; default peak"
    opt.add(parser, {"--measure": measure}, choices=("peak", "rms"))
    curve = "least second peak over the first one, cases (a)-(d) marked"
    opt.add(parser, {"--trade-off FIRST,SECOND": curve})
    opt.add(parser, {"--points N": f"of that curve; default {_POINTS}"}, type=int)


def _balance(options: argparse.Namespace) -> int:
    r"""Counterweights: the classic cases, the best ones within bounds, the trade-off.

    elastolink balance smith_1972_12_6_12_12 --speed 10 --offset '6 in'
    elastolink balance smith_1972_12_6_12_12 --speed 10 --case d --offset '3 in'
    elastolink balance smith_1972_12_6_12_12 --speed 10 --links crank,coupler,follower \
        --weights shaking_force=1,torque=1,f23=1
    elastolink balance smith_1972_12_6_12_12 --speed 10 --trade-off shaking_force,torque \
        --plot curve.png
    """
    optimum = ("weights", "limits", "measure")
    if options.case is not None:
        if options.trade_off is not None:
            raise bad("--case", "--trade-off beside it", "one of the two", "leave one out")
        unused = (*optimum, "links", "mass", "points")
        opt.refuse_unused(options, unused, "the optimum or the trade-off, without --case")
    elif options.trade_off is not None:
        opt.refuse_unused(options, optimum, "the optimum, without --trade-off")
    else:
        opt.refuse_unused(options, ("points",), "--trade-off beside it")
    scene = opt.load(options)
    (speed, acceleration), machine = drive_of(options, scene), scene.machine()
    if speed == acceleration == 0.0:
        fix = "give --speed or --acceleration"
        raise bad("--speed", "a crank at rest", "a speed or an acceleration", fix)
    offset = opt.positive(options, "offset", "length")
    mass = opt.positive(options, "mass", "mass")
    given: dict[str, Any] = {"case": options.case, "offsets": offset}
    if options.case is None:
        links = None if options.links is None else _names(options.links)
        given = {"links": links, "bounds": rigid.Bounds(mass=mass, offset=offset)}
        if options.trade_off is not None:
            given |= {"acceleration": acceleration, "offsets": offset}
            return _trade_off(options, machine, speed, **given)
        given["weights"] = _pairs(options.weights, "--weights")
        given["limits"] = _pairs(options.limits, "--limits")
        given["measure"] = options.measure or "peak"
    found = rigid.balance(machine, speed, acceleration=acceleration, **given)
    return opt.finish(options, found, _lines(found))


def _trade_off(
    options: argparse.Namespace, machine: rigid.Machine, speed: float, **given: Any
) -> int:
    names = _names(options.trade_off)
    if len(names) != 2:
        fix = "write --trade-off shaking_force,torque"
        raise bad("--trade-off", repr(options.trade_off), "two forces", fix)
    first, second = names
    points = _POINTS if options.points is None else options.points
    curve = rigid.trade_off(machine, speed, first, second, points, **given)
    bodies = [point.counterweights for point in curve.points]
    placed: list[tuple[str, str, Any]] = []
    for link in dict.fromkeys(link for one in bodies for link in one):
        for name, unit in (("mass", "kg"), ("along", "m"), ("across", "m")):
            told = [getattr(one[link], name) if link in one else 0.0 for one in bodies]
            placed.append((f"{link} {name} [{unit}]", ".4g", told))
    peaks = (first, ".6f", curve.first_values), (second, ".6f", curve.second_values)
    lines = opt.columns(*peaks, *placed)
    rows = [(f"({name})", f"{x:.6f}", f"{y:.6f}") for name, (x, y) in curve.cases.items()]
    lines += ["", *opt.table(("case", first, second), rows), ""]
    return opt.finish(options, curve, lines)


def _lines(found: rigid.Balancing) -> list[str]:
    units = dict.fromkeys(("torque", "shaking_moment"), "N m")
    alone, weights = found.unbalanced, found.weights
    lines = opt.columns(
        (found.measure, "", [f"{name} [{units.get(name, 'N')}]" for name in found.relative]),
        ("unbalanced", ".6g", [alone[name] for name in found.relative]),
        ("balanced", ".6g", [share * alone[name] for name, share in found.relative.items()]),
        ("relative", ".6f", found.relative.values()),
        ("weight", "", [f"{weights[n]:g}" if n in weights else "" for n in found.relative]),
    )
    bodies = found.counterweights.values()
    placed = opt.columns(
        ("counterweight", "", [body.link for body in bodies]),
        ("mass [kg]", ".6g", [body.mass for body in bodies]),
        ("along [m]", ".6g", [body.along for body in bodies]),
        ("across [m]", ".6g", [body.across for body in bodies]),
        ("radius [m]", ".6g", [body.disc_radius for body in bodies]),
    )
    lines += ["", *(placed if bodies else ["no counterweights"]), ""]
    if weights:
        lines.append(
            f"weighted sum: {found.value:.8g}, not below {found.lower_bound:.8g} within bounds"
        )
        grown = [k for k, share in found.relative.items() if share > 1.0 and k not in weights]
        if grown:
            rest = ",".join([*(f"{name}={weight:g}" for name, weight in weights.items()), ""])
            lines.append(
                f"{', '.join(grown)}: larger than before, for want of a weight; "
                f"try --weights {rest}{grown[0]}=1"
            )
    return lines


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",")]


def _pairs(text: str | None, where: str) -> dict[str, float] | None:
    if text is None:
        return None
    found = {}
    for each in text.split(","):
        name, value = opt.pair(each, where, "NAME=NUMBER", "torque=1,f23=0.5")
        try:
            found[name] = float(value)
        except ValueError:
            found[name] = math.nan
        if not math.isfinite(found[name]):
            raise bad(where, repr(each), "NAME=NUMBER", f"write {where} torque=1,f23=0.5")
    return found
