"""``elastolink reproduce`` and ``report``: pages, of the documents' figures and of a scene."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from typing import Any

from .. import report
from . import options as opt


def add(commands: Any) -> None:
    """Add the two subcommands."""
    reproduce = opt.command(commands, "reproduce", _reproduce, scene=False)
    document = {"document DOCUMENT": "smith, aannaque or beale; all documents by default"}
    opt.add(reproduce, document, nargs="?")
    opt.add(reproduce, {"--figure N": "one figure or table, e.g. 23, 23d, 3.8, table_coupler"})
    opt.add(reproduce, {"--out DIR": "folder to write; default %(default)s"}, default="gallery")

    parser = opt.command(commands, "report", _report, saves=False)
    opt.add(parser, {"--out FILE": "the page, a .html file; default the scene's name with .html"})


def _reproduce(options: argparse.Namespace) -> int:
    """Redraw the computed figures of a document, and check the numbers that it quotes.

    elastolink reproduce smith --figure 84 --out gallery
    """
    from ..gallery import reproduce

    shown = opt.progress(options)
    result = reproduce(options.document, options.figure, options.out, progress=shown)
    lines = result.lines()
    if not options.json:
        # The lines show every comparison; of the checks only those that fail remain to be told.
        failed = {name: check for name, check in result.checks.items() if not check.passed}
        result = replace(result, checks=failed)
    return opt.finish(options, result, lines)


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
