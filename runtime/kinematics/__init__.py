"""Kinematics of rigid linkages: classification, curves, harmonics, clearance, tolerances."""

from __future__ import annotations

from .animation import animate
from .base_planes import BasePlane, base_plane
from .classification import Classification, SlidingClassification, classify, classify_many
from .clearance import ClearanceRange, WidthExtreme, clearance_range
from .cognates import Cognate, cognates
from .coupler_curve import CouplerCurve, coupler_curve
from .coupler_sextic import SexticNodes, sextic_nodes
from .harmonics import Harmonics, harmonics
from .mobility import Mobility, kutzbach, mobility
from .simpson import simpson_harmonics
from .tolerance_result import Tolerances
from .tolerances import tolerances
from .transmission import (
    MechanicalAdvantage,
    TransmissionAngle,
    mechanical_advantage,
    transmission_angle,
)

__all__ = [
    "BasePlane",
    "Classification",
    "ClearanceRange",
    "Cognate",
    "CouplerCurve",
    "Harmonics",
    "MechanicalAdvantage",
    "Mobility",
    "SexticNodes",
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
    "mechanical_advantage",
    "mobility",
    "sextic_nodes",
    "simpson_harmonics",
    "tolerances",
    "transmission_angle",
]
