"""Motion of linear periodic systems over many revolutions."""

from __future__ import annotations

from .trajectory import Trajectory, simulate

__all__ = ["Trajectory", "simulate"]
