"""Response of linear periodic systems: the steady state, and its resonances over the speed.

Names other than the steady state's load on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use
from .result import SteadyState
from .steady_state import steady_state

if TYPE_CHECKING:
    from .frozen import FrozenFrequencies, frozen_frequencies
    from .operation_counts import operation_count, printed_count
    from .operation_times import run_times
    from .peaks import SteadyPeaks, steady_peaks
    from .resonances import ResonanceCurve, resonance_curve
    from .settling import cycles_to_settle

_PUBLIC = {
    "FrozenFrequencies": "frozen",
    "ResonanceCurve": "resonances",
    "SteadyPeaks": "peaks",
    "cycles_to_settle": "settling",
    "frozen_frequencies": "frozen",
    "operation_count": "operation_counts",
    "printed_count": "operation_counts",
    "resonance_curve": "resonances",
    "run_times": "operation_times",
    "steady_peaks": "peaks",
}

__all__ = [
    "FrozenFrequencies",
    "ResonanceCurve",
    "SteadyPeaks",
    "SteadyState",
    "cycles_to_settle",
    "frozen_frequencies",
    "operation_count",
    "printed_count",
    "resonance_curve",
    "run_times",
    "steady_peaks",
    "steady_state",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
