"""Reduction of large linear periodic systems: moving modes, and curves over the crank speed."""

from __future__ import annotations

from .reduced import ReducedSystem, reduced_system
from .stress_curve import StressCurve, stress_curve
from ..periodic.moving_basis import MovingBasis, moving_basis

__all__ = [
    "MovingBasis",
    "ReducedSystem",
    "StressCurve",
    "moving_basis",
    "reduced_system",
    "stress_curve",
]
