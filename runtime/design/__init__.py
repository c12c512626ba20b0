"""Choosing a running speed: quiet speeds, run-ups, damping, geometry, screening and fatigue."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .effects import StressEffect, damping_effect, length_effect
    from .fatigue_life import Fatigue, Material, fatigue
    from .procedure import RunningSpeed, running_speed
    from .quiet import Band, QuietSpeeds, quiet_speeds
    from .screening import Screening, screen
    from .speed_profile import SpeedProfile
    from .transient import Transient, run_through

_PUBLIC = {
    "Band": "quiet",
    "Fatigue": "fatigue_life",
    "Material": "fatigue_life",
    "QuietSpeeds": "quiet",
    "RunningSpeed": "procedure",
    "Screening": "screening",
    "SpeedProfile": "speed_profile",
    "StressEffect": "effects",
    "Transient": "transient",
    "damping_effect": "effects",
    "fatigue": "fatigue_life",
    "length_effect": "effects",
    "quiet_speeds": "quiet",
    "run_through": "transient",
    "running_speed": "procedure",
    "screen": "screening",
}

__all__ = [
    "Band",
    "Fatigue",
    "Material",
    "QuietSpeeds",
    "RunningSpeed",
    "Screening",
    "SpeedProfile",
    "StressEffect",
    "Transient",
    "damping_effect",
    "fatigue",
    "length_effect",
    "quiet_speeds",
    "run_through",
    "running_speed",
    "screen",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
