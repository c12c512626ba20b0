"""``elastolink reproduce``: the documents' figures and tables, redrawn and checked."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import Any

from . import options as opt


def add(commands: Any) -> None:
    """Add the subcommand."""
    reproduce = opt.command(commands, "reproduce", _reproduce, scene=False)
    document = {"document DOCUMENT": "smith, aannaque or beale; all documents by default"}
    opt.add(reproduce, document, nargs="?")
    opt.add(reproduce, {"--figure N": "one figure or table, e.g. 23, 23d, 3.8, table_coupler"})
    opt.add(reproduce, {"--out DIR": "folder to write; default %(default)s"}, default="gallery")


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
