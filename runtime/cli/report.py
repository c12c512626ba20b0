"""``elastolink report``: one page with all that is known of a scene."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from .. import report
from . import options as opt


def add(commands: Any) -> None:
    """Add the subcommand."""
    parser = opt.command(commands, "report", _report, saves=False)
    opt.add(parser, {"--out FILE": "the page, a .html file; default the scene's name with .html"})


def _report(options: argparse.Namespace) -> int:
    """Report of a scene: one page with its numbers, motion, forces, vibration and checks.

    elastolink report smith_1972_5152_sixteenth_inch --out report.html
    elastolink report slider_crank_example --set operation.speed='3000 rpm'
    """
    from ..report.page import check_report_path
    from ..scenes.pictures import draw_scene

    given = None if options.out is None else check_report_path(options.out)
    scene = opt.load(options)
    path = given or check_report_path(f"{scene.name}.html")
    found = report.make_report(scene)
    found.save(path)
    opt.draw_into(options, lambda ax: draw_scene(scene, ax))
    told = {one.heading: one.failed or one.brief for one in found.sections}
    content = {"path": str(path), "sections": told, "passed": found.passed}
    lines = [f"{heading}: {line}" for heading, line in told.items() if line]
    opt.say(options, content, "\n".join([*lines, f"written: {path}"]))
    for heading in found.failed:
        print(f"elastolink report: {heading} failed: {told[heading]}", file=sys.stderr)
    return max(opt.exit_status(options, [found.checks]), int(bool(found.failed)))
