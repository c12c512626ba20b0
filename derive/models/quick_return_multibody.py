"""The rigid quick-return mechanism in redundant coordinates, for a second opinion on its forces."""

from __future__ import annotations

from ..rigid.multibody import multibody_model
from .quick_return import ARGUMENTS
from .quick_return_forces import linkage

MODEL = multibody_model("quick_return", "the rigid quick-return mechanism", linkage, ARGUMENTS[1:])
