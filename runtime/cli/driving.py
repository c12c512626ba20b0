"""``elastolink run-up``: a machine of rigid links under its motor."""

from __future__ import annotations

import argparse
from math import pi
from typing import TYPE_CHECKING, Any

from .. import rigid
from ..core.errors import bad
from . import options as opt

if TYPE_CHECKING:
    from ..scenes import Scene

_REVOLUTIONS = 10.0


def add(commands: Any) -> None:
    """Add the subcommand."""
    parser = opt.command(commands, "run-up", _run_up)
    opt.add(
        parser,
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
    opt.add(parser, {"--revolutions N": end}, type=float)


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
    return opt.finish(options, found, _lines(found))


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


def _lines(found: rigid.RunUp) -> list[str]:
    """Return the table of a run, and how it ended."""
    speed, fluctuation = float(found.speed[-1]), found.fluctuation
    balance = found.checks["energy less work, relative"].value
    rows = [
        ("time [s]", f"{found.time[-1]:.6g}"),
        ("revolutions", f"{found.revolutions:.6g}"),
        ("final speed [rad/s]", f"{speed:.6g}"),
        ("final speed [rpm]", f"{speed * 30.0 / pi:.6g}"),
        (
            "speed fluctuation, last revolution",
            "less than one made" if fluctuation is None else f"{fluctuation:.4g}",
        ),
        ("kinetic and potential energy [J]", f"{found.energy[-1]:.6g}"),
        ("energy balance, relative", f"{balance:.2g}"),
        ("flywheel [kg m^2]", f"{found.flywheel:.6g}"),
    ]
    return [*opt.table(("quantity", "value"), rows), "", f"status: {found.status}: {found.message}"]
