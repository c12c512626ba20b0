"""Rigid linkages: mechanisms and their motion, classes, curves, clearance, tolerances.

The names load on first use: one needs little of what the others need.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .base_planes import BasePlane, base_plane
    from .classification import Classification, SlidingClassification, classify, classify_many
    from .clearance import ClearanceRange, WidthExtreme, clearance_range
    from .cognate_linkages import Cognate, cognates
    from .coupler_sextic import SexticNodes, sextic_nodes
    from .curves import CouplerCurve, coupler_curve
    from .degrees_of_freedom import Mobility, kutzbach, mobility
    from .four_bar import FourBar, FourBarMotion
    from .harmonic_analysis import Harmonics, harmonics
    from .length_tolerances import Tolerances, tolerances
    from .linkage import Linkage, LinkMotion, Motion, PointMotion
    from .pictures import animate
    from .quick_return import QuickReturn, QuickReturnMotion
    from .slider_crank import SliderCrank, SliderCrankMotion
    from .transmission import MechanicalAdvantage, TransmissionAngle, transmission_angle

_PUBLIC = {
    "BasePlane": "base_planes",
    "Classification": "classification",
    "ClearanceRange": "clearance",
    "Cognate": "cognate_linkages",
    "CouplerCurve": "curves",
    "FourBar": "four_bar",
    "FourBarMotion": "four_bar",
    "Harmonics": "harmonic_analysis",
    "LinkMotion": "linkage",
    "Linkage": "linkage",
    "MechanicalAdvantage": "transmission",
    "Mobility": "degrees_of_freedom",
    "Motion": "linkage",
    "PointMotion": "linkage",
    "QuickReturn": "quick_return",
    "QuickReturnMotion": "quick_return",
    "SexticNodes": "coupler_sextic",
    "SliderCrank": "slider_crank",
    "SliderCrankMotion": "slider_crank",
    "SlidingClassification": "classification",
    "Tolerances": "length_tolerances",
    "TransmissionAngle": "transmission",
    "WidthExtreme": "clearance",
    "animate": "pictures",
    "base_plane": "base_planes",
    "classify": "classification",
    "classify_many": "classification",
    "clearance_range": "clearance",
    "cognates": "cognate_linkages",
    "coupler_curve": "curves",
    "harmonics": "harmonic_analysis",
    "kutzbach": "degrees_of_freedom",
    "mobility": "degrees_of_freedom",
    "sextic_nodes": "coupler_sextic",
    "tolerances": "length_tolerances",
    "transmission_angle": "transmission",
}

__all__ = [
    "BasePlane",
    "Classification",
    "ClearanceRange",
    "Cognate",
    "CouplerCurve",
    "FourBar",
    "FourBarMotion",
    "Harmonics",
    "LinkMotion",
    "Linkage",
    "MechanicalAdvantage",
    "Mobility",
    "Motion",
    "PointMotion",
    "QuickReturn",
    "QuickReturnMotion",
    "SexticNodes",
    "SliderCrank",
    "SliderCrankMotion",
    "SlidingClassification",
    "Tolerances",
    "TransmissionAngle",
    "WidthExtreme",
    "animate",
    "base_plane",
    "classify",
    "classify_many",
    "clearance_range",
    "cognates",
    "coupler_curve",
    "harmonics",
    "kutzbach",
    "mobility",
    "sextic_nodes",
    "tolerances",
    "transmission_angle",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
