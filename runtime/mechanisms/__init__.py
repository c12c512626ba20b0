"""Mechanisms at run time: lengths and assembly, and the motion that they have."""

from __future__ import annotations

from .four_bar import FourBar, FourBarMotion
from .linkage import Linkage, LinkMotion, Motion, PointMotion
from .quick_return import QuickReturn, QuickReturnMotion
from .slider_crank import SliderCrank, SliderCrankMotion

__all__ = [
    "FourBar",
    "FourBarMotion",
    "LinkMotion",
    "Linkage",
    "Motion",
    "PointMotion",
    "QuickReturn",
    "QuickReturnMotion",
    "SliderCrank",
    "SliderCrankMotion",
]
