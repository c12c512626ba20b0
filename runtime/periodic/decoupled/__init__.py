"""Slow modes of stiff periodic systems, decoupled from the fast ones."""

from __future__ import annotations

from .exponents import SlowMultipliers, characteristic_exponents
from .reduced import SlowSystem, slow_system

__all__ = ["SlowMultipliers", "SlowSystem", "characteristic_exponents", "slow_system"]
