"""Rigid linkages: mechanisms and their motion, classes, curves, clearance.

The names load on first use: one needs little of what the others need.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .classification import classify as classify
    from .clearance import clearance_range as clearance_range
    from .curves import coupler_curve as coupler_curve
    from .degrees_of_freedom import mobility as mobility
    from .four_bar import FourBar as FourBar
    from .four_bar import FourBarMotion as FourBarMotion
    from .harmonic_analysis import harmonics as harmonics
    from .linkage import Linkage as Linkage
    from .linkage import Motion as Motion
    from .pictures import animate as animate
    from .quick_return import QuickReturn as QuickReturn
    from .slider_crank import SliderCrank as SliderCrank
    from .transmission import transmission_angle as transmission_angle

__all__ = on_first_use(globals())
