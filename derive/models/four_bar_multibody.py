"""The rigid four-bar linkage in redundant coordinates, for a second opinion on its forces."""

from __future__ import annotations

from ..rigid.multibody import multibody_model
from .four_bar import ARGUMENTS
from .four_bar_forces import linkage

MODEL = multibody_model("four_bar", "the rigid four-bar linkage", linkage, ARGUMENTS[1:-1])
