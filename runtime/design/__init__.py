"""Diagnosis, margins, changes that help, running speeds, run-ups, fatigue, tolerances, fits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .certificates import certify as certify
    from .closing import closing_damping as closing_damping
    from .diagnosis import diagnose as diagnose
    from .differentiation import sensitivities as sensitivities
    from .fatigue_life import Material as Material
    from .fatigue_life import fatigue as fatigue
    from .identification import identify as identify
    from .measured import Point as Point
    from .measured import draw_points as draw_points
    from .measured import read_points as read_points
    from .nearest_regions import margins as margins
    from .procedure import running_speed as running_speed
    from .quiet import quiet_speeds as quiet_speeds
    from .speed_profile import SpeedProfile as SpeedProfile
    from .stabilising import stabilise as stabilise
    from .transient import run_through as run_through
    from .within_tolerances import tolerance_bands as tolerance_bands

__all__ = on_first_use(globals())
