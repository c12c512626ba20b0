"""Natural frequencies and critical speeds, of finite elements and of exact members.

The names load on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .campbell_diagram import Campbell, campbell
    from .comparison import CriticalComparison, compare_critical_speeds
    from .counting import FrameFrequencies, MemberShape, Mode, wittrick_williams
    from .critical import CriticalSpeeds, critical_speeds
    from .frames import DynamicStiffness, dynamic_stiffness, element_matrices, log_determinant
    from .held import Buckling, buckling_speed
    from .hybrid import HybridMatrices, hybrid_matrices
    from .link_study import (
        FrequencyExponents,
        LinkFrequencies,
        frequency_exponents,
        link_frequencies,
        pinned_frequency,
    )
    from .members import member_matrices
    from .mode_pictures import draw_mode, draw_modes
    from .models import ModelComparison, compare_models, exact_frequencies
    from .natural import NaturalFrequencies, natural_frequencies
    from .tracking import Encounter

_PUBLIC = {
    "Buckling": "held",
    "Campbell": "campbell_diagram",
    "CriticalComparison": "comparison",
    "CriticalSpeeds": "critical",
    "DynamicStiffness": "frames",
    "Encounter": "tracking",
    "FrameFrequencies": "counting",
    "FrequencyExponents": "link_study",
    "HybridMatrices": "hybrid",
    "LinkFrequencies": "link_study",
    "MemberShape": "counting",
    "Mode": "counting",
    "ModelComparison": "models",
    "NaturalFrequencies": "natural",
    "buckling_speed": "held",
    "campbell": "campbell_diagram",
    "compare_critical_speeds": "comparison",
    "compare_models": "models",
    "critical_speeds": "critical",
    "draw_mode": "mode_pictures",
    "draw_modes": "mode_pictures",
    "dynamic_stiffness": "frames",
    "element_matrices": "frames",
    "exact_frequencies": "models",
    "frequency_exponents": "link_study",
    "hybrid_matrices": "hybrid",
    "link_frequencies": "link_study",
    "log_determinant": "frames",
    "member_matrices": "members",
    "natural_frequencies": "natural",
    "pinned_frequency": "link_study",
    "wittrick_williams": "counting",
}

__all__ = [
    "Buckling",
    "Campbell",
    "CriticalComparison",
    "CriticalSpeeds",
    "DynamicStiffness",
    "Encounter",
    "FrameFrequencies",
    "FrequencyExponents",
    "HybridMatrices",
    "LinkFrequencies",
    "MemberShape",
    "Mode",
    "ModelComparison",
    "NaturalFrequencies",
    "buckling_speed",
    "campbell",
    "compare_critical_speeds",
    "compare_models",
    "critical_speeds",
    "draw_mode",
    "draw_modes",
    "dynamic_stiffness",
    "element_matrices",
    "exact_frequencies",
    "frequency_exponents",
    "hybrid_matrices",
    "link_frequencies",
    "log_determinant",
    "member_matrices",
    "natural_frequencies",
    "pinned_frequency",
    "wittrick_williams",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
