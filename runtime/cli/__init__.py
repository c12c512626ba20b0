"""The ``elastolink`` command, one file per group of subcommands."""

from __future__ import annotations

from .application import main

__all__ = ["main"]
