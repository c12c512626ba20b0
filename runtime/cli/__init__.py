"""The ``elastolink`` command, one file per group of subcommands.

It loads when it is called: the process that measures what a scene loads must not bring it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .application import main as main

__all__ = on_first_use(globals())
