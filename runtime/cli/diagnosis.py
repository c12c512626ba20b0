"""``elastolink diagnose``: what a machine does at its speed, what lies near, what to change."""

from __future__ import annotations

import argparse
import re
import shlex
from dataclasses import replace
from typing import Any

from .. import design
from . import options as opt
from .linkages import moving_scene, speed_of, speed_option


def add(commands: Any) -> None:
    """Add the subcommand."""
    parser = opt.command(commands, "diagnose", _diagnose)
    opt.add(parser, speed_option("operation.speed"))
    window = "how far about the speed unstable regions are looked for; default 0.3"
    opt.add(parser, {"--window PART": window}, default="0.3")


def _diagnose(options: argparse.Namespace) -> int:
    """Tell what happens at a running speed, what lies near, and what would help.

    elastolink diagnose smith_1972_5152_sixteenth_inch --speed '765 rpm'
    """
    scene = moving_scene(options)
    window = opt.quantity(options.window, "dimensionless", "--window")
    found = design.diagnose(scene, speed_of(options, scene), window=window)
    # What it advises is to work as it is printed: for this file, with these overrides.
    typed = shlex.join([options.scene, *(f"--set={pair}" for pair in options.set)])
    if options.modules is not None:
        typed += f" --modules {shlex.quote(options.modules)}"
    advice = re.compile(rf"(?<=elastolink )(\w+) {re.escape(scene.name)} ")
    lines = [advice.sub(lambda found: f"{found[1]} {typed} ", line) for line in found.lines]
    found = replace(found, lines=tuple(lines))
    return opt.finish(options, found, found.lines)
