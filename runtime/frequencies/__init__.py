"""Natural frequencies over the crank angle, critical speeds and what they depend on."""

from __future__ import annotations

from .buckling import Buckling, buckling_speed
from .campbell import Campbell, campbell
from .comparison import CriticalComparison, compare_critical_speeds
from .critical import critical_speeds
from .critical_result import CriticalSpeeds
from .encounters import Encounter
from .link_study import (
    FrequencyExponents,
    LinkFrequencies,
    frequency_exponents,
    link_frequencies,
    pinned_frequency,
)
from .mode_pictures import draw_mode, draw_modes
from .models import ModelComparison, compare_models, exact_frequencies
from .natural import NaturalFrequencies, natural_frequencies

__all__ = [
    "Buckling",
    "Campbell",
    "CriticalComparison",
    "CriticalSpeeds",
    "Encounter",
    "FrequencyExponents",
    "LinkFrequencies",
    "ModelComparison",
    "NaturalFrequencies",
    "buckling_speed",
    "campbell",
    "compare_critical_speeds",
    "compare_models",
    "critical_speeds",
    "draw_mode",
    "draw_modes",
    "exact_frequencies",
    "frequency_exponents",
    "link_frequencies",
    "natural_frequencies",
    "pinned_frequency",
]
