"""``elastolink balance``: counterweights of the classic cases, the best ones, and the trade-off."""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING, Any

from ..core.errors import bad
from . import options as opt
from .linkages import drive_of, drive_options

if TYPE_CHECKING:
    from ..rigid import Balancing, Machine


_POINTS = 13


def add(commands: Any) -> None:
    """Add the subcommand."""
    parser = opt.command(
        commands,
        "balance",
        _balance,
        summary="Counterweights: the classic cases, the best ones within bounds, the trade-off.",
        example=(
            "elastolink balance smith_1972_12_6_12_12 --speed 10 --offset '6 in'\n"
            "  elastolink balance smith_1972_12_6_12_12 --speed 10 --case d --offset '3 in'\n"
            "  elastolink balance smith_1972_12_6_12_12 --speed 10 --links crank,coupler,follower"
            " --weights shaking_force=1,torque=1,f23=1\n"
            "  elastolink balance smith_1972_12_6_12_12 --speed 10"
            " --trade-off shaking_force,torque --plot curve.png"
        ),
    )
    drive_options(parser, "default operation.speed")
    parser.add_argument(
        "--case",
        choices=("b", "c", "d"),
        help="b: crank and follower about their pivots; c, d: full force balance, with three or"
        " two counterweights; default: optimise",
    )
    parser.add_argument(
        "--offset",
        metavar="LENGTH",
        help="of the counterweights from the first joints of their links: at most this when"
        " optimising; default the length of the link",
    )
    parser.add_argument(
        "--mass", metavar="MASS", help="greatest mass of one counterweight; default all links'"
    )
    _choices(parser)


def _choices(parser: argparse.ArgumentParser) -> None:
    """Add what says which forces count, and how."""
    parser.add_argument(
        "--weights",
        metavar="NAME=W,...",
        help="of shaking_force, shaking_moment, torque, f12, f23, f34, f41; default"
        " f23=1,torque=1,shaking_moment=1: pin of the crank, torque, moment on the frame",
    )
    parser.add_argument(
        "--limits", metavar="NAME=R,...", help="relative peaks that must not be passed"
    )
    parser.add_argument(
        "--links", metavar="LINK,...", help="that may carry one; default those on the frame"
    )
    parser.add_argument(
        "--measure", choices=("peak", "rms"), help="of each force, when optimising; default peak"
    )
    parser.add_argument(
        "--trade-off",
        metavar="FIRST,SECOND",
        help="least second peak over the first one, cases (a)-(d) marked",
    )
    parser.add_argument("--points", type=int, metavar="N", help=f"of that curve; default {_POINTS}")


def _balance(options: argparse.Namespace) -> int:
    chosen = [name for name in ("case", "trade_off") if getattr(options, name) is not None]
    if len(chosen) == 2:
        raise bad("--case", "--trade-off beside it", "one of the two", "leave one out")
    _refuse_unused(options)
    scene = opt.load(options)
    (speed, acceleration), machine = drive_of(options, scene), scene.machine()
    if speed == acceleration == 0.0:
        fix = "give --speed or --acceleration"
        raise bad("--speed", "a crank at rest", "a speed or an acceleration", fix)
    offset = _size(options, "offset", "length")
    mass = _size(options, "mass", "mass")

    from ..rigid import Bounds, balance

    given: dict[str, Any] = {"case": options.case, "offsets": offset}
    if options.case is None:
        links = None
        if options.links is not None:
            links = [name.strip() for name in options.links.split(",")]
        given = {"links": links, "bounds": Bounds(mass=mass, offset=offset)}
        if options.trade_off is not None:
            return _trade_off(
                options, machine, speed, acceleration=acceleration, offsets=offset, **given
            )
        given["weights"] = _pairs(options.weights, "--weights")
        given["limits"] = _pairs(options.limits, "--limits")
        given["measure"] = options.measure or "peak"
    found = balance(machine, speed, acceleration=acceleration, **given)
    return opt.finish(options, found, _lines(found))


def _refuse_unused(options: argparse.Namespace) -> None:
    """Raise BadInput for options that the chosen way of balancing does not look at."""
    optimum = ("weights", "limits", "measure")
    if options.case is not None:
        unused = (*optimum, "links", "mass", "points")
        opt.refuse_unused(options, unused, "the optimum or the trade-off, without --case")
    elif options.trade_off is not None:
        opt.refuse_unused(options, optimum, "the optimum, without --trade-off")
    else:
        opt.refuse_unused(options, ("points",), "--trade-off beside it")


def _trade_off(options: argparse.Namespace, machine: Machine, speed: float, **given: Any) -> int:
    names = [name.strip() for name in options.trade_off.split(",")]
    if len(names) != 2:
        fix = "write --trade-off shaking_force,torque"
        raise bad("--trade-off", repr(options.trade_off), "two forces", fix)
    from ..rigid import trade_off

    first, second = names
    points = _POINTS if options.points is None else options.points
    curve = trade_off(machine, speed, first, second, points, **given)
    lines = opt.columns((first, ".6f", curve.first_values), (second, ".6f", curve.second_values))
    rows = [(f"({name})", f"{x:.6f}", f"{y:.6f}") for name, (x, y) in curve.cases.items()]
    lines += ["", *opt.table(("case", first, second), rows), ""]
    return opt.finish(options, curve, lines)


def _lines(found: Balancing) -> list[str]:
    moments = ("torque", "shaking_moment")
    rows = [
        (
            f"{name} [{'N m' if name in moments else 'N'}]",
            f"{found.unbalanced[name]:.6g}",
            f"{relative * found.unbalanced[name]:.6g}",
            f"{relative:.6f}",
            f"{found.weights[name]:g}" if name in found.weights else "",
        )
        for name, relative in found.relative.items()
    ]
    lines = opt.table((found.measure, "unbalanced", "balanced", "relative", "weight"), rows)
    weights = found.counterweights.values()
    placed = opt.columns(
        ("counterweight", "", [item.link for item in weights]),
        ("mass [kg]", ".6g", [item.mass for item in weights]),
        ("along [m]", ".6g", [item.along for item in weights]),
        ("across [m]", ".6g", [item.across for item in weights]),
        ("radius [m]", ".6g", [item.disc_radius for item in weights]),
    )
    lines += ["", *(placed if weights else ["no counterweights"]), ""]
    if found.weights:
        text = f"weighted sum: {found.value:.8g}, not below {found.lower_bound:.8g} within bounds"
        lines.append(text)
    return lines


def _size(options: argparse.Namespace, name: str, dimension: str) -> float | None:
    value = opt.given(options, name, dimension)
    if value is not None and not value > 0.0:
        text = repr(getattr(options, name))
        raise bad(f"--{name}", text, "a positive quantity", "correct the sign")
    return value


def _pairs(text: str | None, where: str) -> dict[str, float] | None:
    if text is None:
        return None
    found = {}
    for pair in text.split(","):
        name, sign, value = pair.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not sign or not math.isfinite(number):
            raise bad(where, repr(pair), "NAME=NUMBER", "write torque=1,f23=0.5")
        found[name.strip()] = number
    return found
