"""``elastolink reproduce`` and ``elastolink benchmark``: what shows that the answers are right."""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..errors import bad
from . import options as opt

_BENCHMARKS = ("chart", "slices", "forces", "mathieu", "perturbation", "rod", "stress-curve")


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
        example="elastolink benchmark chart --json",
    )
    benchmark.add_argument(
        "subject",
        choices=_BENCHMARKS,
        help=(
            "chart: a million half traces; slices: boundaries; forces: a million crank angles; "
            "mathieu: characteristic values; rod: a chart of the flexible rod in a quick return; "
            "stress-curve: largest stresses of a four-bar at a thousand speeds"
        ),
    )


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

    result = getattr(benchmarking, f"benchmark_{options.subject.replace('-', '_')}")()
    return opt.finish(options, result, result.table().splitlines())
