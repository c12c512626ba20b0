"""Response of linear periodic systems: the steady state, and its resonances over the speed."""

from __future__ import annotations

from .frozen import FrozenFrequencies, frozen_frequencies
from .operation_counts import operation_count, printed_count
from .operation_times import run_times
from .peaks import SteadyPeaks, steady_peaks
from .resonances import ResonanceCurve, resonance_curve
from .result import SteadyState
from .settling import cycles_to_settle
from .steady_state import steady_state

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
