"""Rigid linkages: mechanisms and their motion, classes, curves, clearance, tolerances.

The names load on first use: one needs little of what the others need.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .base_planes import base_plane as base_plane
    from .classification import SYMBOLS as SYMBOLS
    from .classification import classify as classify
    from .clearance import clearance_range as clearance_range
    from .curves import CouplerCurve as CouplerCurve
    from .curves import coupler_curve as coupler_curve
    from .degrees_of_freedom import mobility as mobility
    from .four_bar import FourBar as FourBar
    from .four_bar import FourBarMotion as FourBarMotion
    from .harmonic_analysis import harmonics as harmonics
    from .length_tolerances import tolerances as tolerances
    from .linkage import Linkage as Linkage
    from .linkage import LinkMotion as LinkMotion
    from .linkage import Motion as Motion
    from .pictures import animate as animate
    from .quick_return import QuickReturn as QuickReturn
    from .slider_crank import SliderCrank as SliderCrank
    from .transmission import transmission_angle as transmission_angle

_PUBLIC = {
    "CouplerCurve": "curves",
    "FourBar": "four_bar",
    "FourBarMotion": "four_bar",
    "LinkMotion": "linkage",
    "Linkage": "linkage",
    "Motion": "linkage",
    "QuickReturn": "quick_return",
    "SYMBOLS": "classification",
    "SliderCrank": "slider_crank",
    "animate": "pictures",
    "base_plane": "base_planes",
    "classify": "classification",
    "clearance_range": "clearance",
    "coupler_curve": "curves",
    "harmonics": "harmonic_analysis",
    "mobility": "degrees_of_freedom",
    "tolerances": "length_tolerances",
    "transmission_angle": "transmission",
}

__all__ = [*_PUBLIC]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
