"""Linear periodic systems: the transition matrices of a revolution, and what follows from them.

``floquet_multipliers``, ``monodromy``
    Stability at given speeds, with the error of every multiplier.
``steady_state``
    The periodic motion of a forced system, however stiff; ``steady_peaks`` its largest deflection
    alone, at any number of speeds; ``cycles_to_settle`` how long a start takes to die away.
``simulate``
    The motion from a start, over any number of revolutions.
``prepare``
    Tables for a range of speeds: later answers take micro- or milliseconds.

All of them rest on :mod:`~.transition`: collocation over segments of the period, in steps that suit
the modes that are still alive after it.  The names load on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .motion import Trajectory, simulate
    from .multipliers import (
        FloquetMultipliers,
        Monodromy,
        cycles_to_settle,
        floquet_multipliers,
        monodromy,
    )
    from .peaks import SteadyPeaks, steady_peaks
    from .periodic_motion import SteadyState, steady_state
    from .prepared import Prepared, prepare
    from .reduced import ReducedSystem, reduced_system

_PUBLIC = {
    "FloquetMultipliers": "multipliers",
    "Monodromy": "multipliers",
    "Prepared": "prepared",
    "ReducedSystem": "reduced",
    "SteadyPeaks": "peaks",
    "SteadyState": "periodic_motion",
    "Trajectory": "motion",
    "cycles_to_settle": "multipliers",
    "floquet_multipliers": "multipliers",
    "monodromy": "multipliers",
    "prepare": "prepared",
    "reduced_system": "reduced",
    "simulate": "motion",
    "steady_peaks": "peaks",
    "steady_state": "periodic_motion",
}

__all__ = [
    "FloquetMultipliers",
    "Monodromy",
    "Prepared",
    "ReducedSystem",
    "SteadyPeaks",
    "SteadyState",
    "Trajectory",
    "cycles_to_settle",
    "floquet_multipliers",
    "monodromy",
    "prepare",
    "reduced_system",
    "simulate",
    "steady_peaks",
    "steady_state",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
