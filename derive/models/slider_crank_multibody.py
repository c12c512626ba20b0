"""The rigid slider-crank in redundant coordinates, for a second opinion on its forces."""

from __future__ import annotations

from ..rigid.multibody import multibody_model
from .slider_crank import ARGUMENTS
from .slider_crank_forces import linkage

MODEL = multibody_model("slider_crank", "the rigid slider-crank", linkage, ARGUMENTS[1:-1])
