"""``elastolink balance``: counterweights of the classic cases, the best ones, and the trade-off."""

from __future__ import annotations

import argparse
import math
from typing import Any

from .. import rigid
from ..core.errors import bad
from . import options as opt
from .linkages import drive_of, drive_options

_POINTS = 13


def add(commands: Any) -> None:
    """Add the subcommand."""
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
    lines = opt.columns((first, ".6f", curve.first_values), (second, ".6f", curve.second_values))
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
