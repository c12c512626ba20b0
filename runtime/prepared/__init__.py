"""A linear periodic system prepared once for a range of speeds, to be answered in microseconds."""

from __future__ import annotations

from .prepared import Prepared, prepare

__all__ = ["Prepared", "prepare"]
