"""``elastolink explain``: what a scene needs, and what is skipped for it."""

from __future__ import annotations

import argparse
from typing import Any

from . import options as opt


def add(commands: Any) -> None:
    """Add the subcommand."""
    parser = opt.command(
        commands,
        "explain",
        _explain,
        summary="Tell what a scene needs, and what is not derived, emitted, imported or evaluated.",
        example="elastolink explain smith_1972_5152_sixteenth_inch --set model.modes=2",
    )
    opt.scene_options(parser)


def _explain(options: argparse.Namespace) -> int:
    from .skipping import explain

    result = explain(options.scene, opt.settings(options.set))
    return opt.finish(options, result, result.lines())
