"""Natural frequencies, critical speeds and resonance curves, of finite elements and exact members.

The names load on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .campbell_diagram import Campbell, campbell
    from .counting import FrameFrequencies, MemberShape, Mode, wittrick_williams
    from .critical import CriticalSpeeds, critical_speeds
    from .frames import DynamicStiffness, dynamic_stiffness, element_matrices, log_determinant
    from .held import Buckling, buckling_speed
    from .link_study import (
        FrequencyExponents,
        LinkFrequencies,
        frequency_exponents,
        link_frequencies,
        pinned_frequency,
    )
    from .members import member_matrices
    from .mode_pictures import draw_mode, draw_modes
    from .natural import NaturalFrequencies, natural_frequencies
    from .resonance_curves import ResonanceCurve, resonance_curve
    from .tracking import Encounter

_PUBLIC = {
    "Buckling": "held",
    "Campbell": "campbell_diagram",
    "CriticalSpeeds": "critical",
    "DynamicStiffness": "frames",
    "Encounter": "tracking",
    "FrameFrequencies": "counting",
    "FrequencyExponents": "link_study",
    "LinkFrequencies": "link_study",
    "MemberShape": "counting",
    "Mode": "counting",
    "NaturalFrequencies": "natural",
    "ResonanceCurve": "resonance_curves",
    "buckling_speed": "held",
    "campbell": "campbell_diagram",
    "critical_speeds": "critical",
    "draw_mode": "mode_pictures",
    "draw_modes": "mode_pictures",
    "dynamic_stiffness": "frames",
    "element_matrices": "frames",
    "frequency_exponents": "link_study",
    "link_frequencies": "link_study",
    "log_determinant": "frames",
    "member_matrices": "members",
    "natural_frequencies": "natural",
    "pinned_frequency": "link_study",
    "resonance_curve": "resonance_curves",
    "wittrick_williams": "counting",
}

__all__ = [
    "Buckling",
    "Campbell",
    "CriticalSpeeds",
    "DynamicStiffness",
    "Encounter",
    "FrameFrequencies",
    "FrequencyExponents",
    "LinkFrequencies",
    "MemberShape",
    "Mode",
    "NaturalFrequencies",
    "ResonanceCurve",
    "buckling_speed",
    "campbell",
    "critical_speeds",
    "draw_mode",
    "draw_modes",
    "dynamic_stiffness",
    "element_matrices",
    "frequency_exponents",
    "link_frequencies",
    "log_determinant",
    "member_matrices",
    "natural_frequencies",
    "pinned_frequency",
    "resonance_curve",
    "wittrick_williams",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
