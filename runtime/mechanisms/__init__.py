"""Mechanisms at run time: lengths and assembly, and the motion that they have.

The names load on first use: one needs little of what the others need.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..lazy import on_first_use

if TYPE_CHECKING:
    from .four_bar import FourBar, FourBarMotion
    from .linkage import Linkage, LinkMotion, Motion, PointMotion
    from .quick_return import QuickReturn, QuickReturnMotion
    from .slider_crank import SliderCrank, SliderCrankMotion

_PUBLIC = {
    "FourBar": "four_bar",
    "FourBarMotion": "four_bar",
    "LinkMotion": "linkage",
    "Linkage": "linkage",
    "Motion": "linkage",
    "PointMotion": "linkage",
    "QuickReturn": "quick_return",
    "QuickReturnMotion": "quick_return",
    "SliderCrank": "slider_crank",
    "SliderCrankMotion": "slider_crank",
}

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

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
