"""Constrained systems: consistent initial values, motion on the constraints, its stability.

- ``consistent_state`` moves a state onto the constraints.
- ``constrained_motion`` integrates.
- ``periodic_orbit`` computes a motion that repeats, ``orbit_multipliers`` its stability.

All take a :class:`~elastolink.runtime.core.families.Constrained`, such as ``free_free_rod`` makes.
"""

from __future__ import annotations

from .motion import consistent_state, constrained_motion
from .multipliers import orbit_multipliers
from .orbits import periodic_orbit

__all__ = ["consistent_state", "constrained_motion", "orbit_multipliers", "periodic_orbit"]
