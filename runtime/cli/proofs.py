"""``elastolink reproduce`` and ``elastolink benchmark``: what shows that the answers are right."""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..core.errors import bad
from . import options as opt

_REPORTS = (
    *("chart", "slices", "forces", "mathieu", "perturbation", "rod", "scaling", "stress-curve"),
)


def add(commands: Any) -> None:
    """Add the two subcommands."""
    reproduce = opt.command(
        commands,
        "reproduce",
        _reproduce,
        summary="Redraw the computed figures of a document, and check the numbers that it quotes.",
        example="elastolink reproduce smith --figure 84 --out gallery",
    )
    reproduce.add_argument(
        "document",
        nargs="?",
        metavar="DOCUMENT",
        help="smith, aannaque or beale; all documents by default",
    )
    reproduce.add_argument(
        "--figure", metavar="N", help="one figure or table, e.g. 23, 23d, 3.8, table_coupler"
    )
    reproduce.add_argument(
        "--out", default="gallery", metavar="DIR", help="folder to write; default %(default)s"
    )
    benchmark = opt.command(
        commands,
        "benchmark",
        _benchmark,
        summary="Time this toolkit beside its peers, in one run, one thread each.",
        example="elastolink benchmark hill --plot work.png",
    )
    benchmark.add_argument(
        "subject",
        nargs="*",
        metavar="PROBLEM",
        help=(
            "time against error of every method: hill, coupler, quick-return, four-bar, or "
            "trajectory, monodromy, steady, chart, or one of each (hill-chart); all by default. "
            "Or one report: chart: a million half traces; slices: boundaries; forces: a million "
            "crank angles; mathieu: characteristic values; rod: a chart of the flexible rod in a "
            "quick return; perturbation; stress-curve: a four-bar at a thousand speeds; scaling: "
            "a sweep on two cores"
        ),
    )
    benchmark.add_argument("--methods", metavar="NAMES", help="of ours, separated by commas")
    benchmark.add_argument("--peers", metavar="NAMES", help="of others, separated by commas")
    benchmark.add_argument("--rounds", type=int, default=5, metavar="N", help="default %(default)s")
    benchmark.add_argument("--compare", metavar="FILE", help="status 1 where ratios have fallen")
    benchmark.add_argument("--store", metavar="FILE", help="write the ratios to compare with")


def _writable_folder(name: str) -> Path:
    """Return a folder that can be made or written, refused here before any work starts."""
    folder = Path(name)
    existing = folder
    while not existing.exists() and existing.parent != existing:
        existing = existing.parent
    if not existing.is_dir() or not os.access(existing, os.W_OK):
        raise bad("--out", repr(name), "a folder that can be written", "choose another place")
    return folder


def _reproduce(options: argparse.Namespace) -> int:
    folder = _writable_folder(options.out)
    opt.picture(options)
    from ..gallery import reproduce

    result = reproduce(
        options.document, options.figure, folder, progress=sys.stderr.isatty() and not options.json
    )
    lines = result.lines()
    if not options.json:
        # The lines show every comparison; of the checks only those that fail remain to be told.
        failed = {name: check for name, check in result.checks.items() if not check.passed}
        result = replace(result, checks=failed)
    return opt.finish(options, result, lines)


def _benchmark(options: argparse.Namespace) -> int:
    opt.picture(options)
    from .. import benchmarking

    reports = {name: f"benchmark_{name.replace('-', '_')}" for name in _REPORTS}
    chosen = [name for name in options.subject if name in reports]
    # A task by the name of a report is meant only beside other problems.
    if len(options.subject) == 1 and chosen:
        opt.refuse_unused(options, ("methods", "peers", "compare", "store"), "of a report")
        result = getattr(benchmarking, reports[chosen[0]])()
        return opt.finish(options, result, result.table().splitlines())
    return _work_precision(options)


def _work_precision(options: argparse.Namespace) -> int:
    from ..benchmarking import work_precision as work

    stored = None if options.compare is None else work.load_ratios(options.compare)
    target = None if options.store is None else Path(options.store)
    if target is not None:
        _writable_folder(str(target.parent))
        if target.exists():
            work.load_ratios(target)
    methods, peers = (_names(value) for value in (options.methods, options.peers))
    result = work.benchmark_work_precision(
        options.subject,
        methods=methods,
        peers=peers,
        rounds=options.rounds,
        progress=sys.stderr.isatty() and not options.json,
    )
    if stored is not None:
        result = work.compared(result, stored)
    if target is not None:
        work.store_ratios(result, target)
    lines = [*result.full_table().splitlines(), "", *result.table().splitlines()]

    def draw(ax: Any) -> None:
        figure = ax.figure
        ax.remove()
        result.draw_on(figure)

    return opt.finish(options, result, lines, draw)


def _names(text: str | None) -> list[str] | None:
    return None if text is None else [name.strip() for name in text.split(",") if name.strip()]
