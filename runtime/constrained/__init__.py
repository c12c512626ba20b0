"""Constrained systems: consistent initial values, motion on the constraints, its stability.

- ``consistent_state`` moves a state onto the constraints.
- ``constrained_motion`` integrates.
- ``periodic_orbit`` computes a motion that repeats, ``orbit_multipliers`` its stability.

All take a :class:`~elastolink.runtime.core.families.Constrained`, such as ``free_free_rod`` makes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .motion import consistent_state as consistent_state
    from .motion import constrained_motion as constrained_motion
    from .multipliers import orbit_multipliers as orbit_multipliers
    from .orbits import periodic_orbit as periodic_orbit

__all__ = on_first_use(globals())
