"""Slow modes of stiff periodic systems, decoupled from the fast ones."""

from __future__ import annotations

from .slow_modes import SlowModes
from .slow_system import SlowSystem, slow_system

__all__ = ["SlowModes", "SlowSystem", "slow_system"]
