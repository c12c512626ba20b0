"""Floquet analysis of linear periodic systems: monodromy, multipliers, critical speeds."""

from __future__ import annotations

from .boundary_speeds import SpeedBoundaries, speed_boundaries
from .monodromy_matrix import FloquetMultipliers, Monodromy, floquet_multipliers, monodromy

__all__ = [
    "FloquetMultipliers",
    "Monodromy",
    "SpeedBoundaries",
    "floquet_multipliers",
    "monodromy",
    "speed_boundaries",
]
