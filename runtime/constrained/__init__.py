"""Constrained systems: consistent initial values, motion on the constraints, its stability.

``constrained_motion`` integrates, ``periodic_orbit`` finds a motion that repeats, and
``orbit_multipliers`` tells its stability; all three take a
:class:`~elastolink.runtime.core.families.Constrained`, such as ``free_free_rod`` makes.
"""

from __future__ import annotations

from ..core.families import Constrained, Guard
from .consistent import ConsistentState, consistent_state
from .equations import constraint_norms
from .motion import METHODS, ConstrainedMotion, constrained_motion
from .multipliers import ConstrainedMultipliers, orbit_multipliers
from .orbits import PeriodicOrbit, periodic_orbit

__all__ = [
    "METHODS",
    "ConsistentState",
    "Constrained",
    "ConstrainedMotion",
    "ConstrainedMultipliers",
    "Guard",
    "PeriodicOrbit",
    "consistent_state",
    "constrained_motion",
    "constraint_norms",
    "orbit_multipliers",
    "periodic_orbit",
]
