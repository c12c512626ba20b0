"""``elastolink reproduce``: the documents' figures and tables, redrawn and checked."""

from __future__ import annotations

import argparse
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..core.errors import bad
from . import options as opt


def add(commands: Any) -> None:
    """Add the subcommand."""
    reproduce = opt.command(
        commands,
        "reproduce",
        _reproduce,
        summary="Redraw the computed figures of a document, and check the numbers that it quotes.",
        example="elastolink reproduce smith --figure 84 --out gallery",
        scene=False,
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
    from ..gallery import reproduce

    result = reproduce(options.document, options.figure, folder, progress=opt.progress(options))
    lines = result.lines()
    if not options.json:
        # The lines show every comparison; of the checks only those that fail remain to be told.
        failed = {name: check for name, check in result.checks.items() if not check.passed}
        result = replace(result, checks=failed)
    return opt.finish(options, result, lines)
