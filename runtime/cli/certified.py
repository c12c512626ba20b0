"""``elastolink certify``: a proof that a damped machine is stable over a range of speeds."""

from __future__ import annotations

import argparse
from typing import Any

from .. import design
from . import options as opt


def add(commands: Any) -> None:
    """Add the subcommand."""
    parser = opt.command(commands, "certify", _certify)
    opt.add(parser, {"--speed LOW:HIGH": "range of crank speed"}, required=True)
    resolution = "length of speed that is not halved again; default 1/10000 of the range"
    opt.add(parser, {"--resolution SPEED": resolution})


def _certify(options: argparse.Namespace) -> int:
    """Prove a damped system of 1 to 3 modes stable over a range of speeds; needs the extra fast.

    elastolink certify smith_1972_5152_sixteenth_inch --speed 300:400rpm --set coupler.damping=0.1
    """
    from ..core.plotting import RPM

    low, high = opt.span(options.speed, "frequency", "--speed", "300rpm:400rpm")
    resolution = opt.positive(options, "resolution", "frequency")
    system: Any = opt.load(options).system()
    found = design.certify(system, (low, high), resolution=resolution)
    return opt.finish(options, found, [line for _, line in sorted(_told(found, RPM))])


def _told(found: Any, rpm: float) -> list[tuple[float, str]]:
    """Return what is said of each interval, with its lower end."""
    lines = []
    for (low, high), bound in zip(found.proved, found.bound, strict=True):
        fall = (
            f"every disturbance falls to at most {bound:.4g} of itself per period in the long run"
        )
        text = f"proved: stable from {low * rpm:.6g} to {high * rpm:.6g} rpm; {fall}"
        lines.append((low, text if bound < 1.0 else text.partition(";")[0]))
    for low, high in found.unstable:
        lines.append((low, f"proved: unstable from {low * rpm:.6g} to {high * rpm:.6g} rpm"))
    for low, high in found.open:
        why = "multipliers too close to the unit circle for --resolution"
        lines.append((low, f"not proved from {low * rpm:.6g} to {high * rpm:.6g} rpm: {why}"))
    return lines
