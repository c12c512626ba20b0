"""Response of linear periodic systems: the steady state, and its resonances over the speed."""

from __future__ import annotations

from .frozen import FrozenFrequencies, frozen_frequencies
from .peaks import SteadyPeaks, steady_peaks
from .resonances import ResonanceCurve, resonance_curve
from .steady_state import SteadyState, steady_state

__all__ = [
    "FrozenFrequencies",
    "ResonanceCurve",
    "SteadyPeaks",
    "SteadyState",
    "frozen_frequencies",
    "resonance_curve",
    "steady_peaks",
    "steady_state",
]
