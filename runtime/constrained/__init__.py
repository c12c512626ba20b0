"""Constrained systems: consistent initial values, motion on the constraints, its stability."""

from __future__ import annotations

from .consistent import ConsistentState, consistent_state
from .guards import Guard
from .motion import constrained_motion
from .multipliers import ConstrainedMultipliers, orbit_multipliers
from .norms import constraint_norms
from .orbits import PeriodicOrbit, periodic_orbit
from .result import ConstrainedMotion
from .steppers import motion_with_variations, tangent_basis

__all__ = [
    "ConsistentState",
    "ConstrainedMotion",
    "ConstrainedMultipliers",
    "Guard",
    "PeriodicOrbit",
    "consistent_state",
    "constrained_motion",
    "constraint_norms",
    "motion_with_variations",
    "orbit_multipliers",
    "periodic_orbit",
    "tangent_basis",
]
