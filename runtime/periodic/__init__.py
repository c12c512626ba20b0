"""Linear periodic systems: the transition matrices of a revolution, and what follows from them.

``floquet_multipliers``, ``monodromy``
    Stability at given speeds, with the error of every multiplier.
``steady_state``
    The periodic motion of a forced system, however stiff; ``cycles_to_settle`` how long a start
    takes to die away.
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
    from .motion import Trajectory as Trajectory
    from .motion import simulate as simulate
    from .multipliers import FloquetMultipliers as FloquetMultipliers
    from .multipliers import Monodromy as Monodromy
    from .multipliers import cycles_to_settle as cycles_to_settle
    from .multipliers import floquet_multipliers as floquet_multipliers
    from .multipliers import monodromy as monodromy
    from .periodic_motion import SteadyState as SteadyState
    from .periodic_motion import steady_state as steady_state
    from .prepared import Prepared as Prepared
    from .prepared import prepare as prepare
    from .reduced import reduced_system as reduced_system

__all__ = on_first_use(globals())
