"""Exact natural frequencies of planar frames, and of linkages held in one position."""

from __future__ import annotations

from .determinant import log_determinant
from .elements import element_matrices
from .frames import DynamicStiffness, dynamic_stiffness
from .hybrid import HybridMatrices, hybrid_matrices
from .members import member_matrices
from .result import FrameFrequencies
from .shapes import MemberShape
from .solutions import Mode
from .wittrick_williams import wittrick_williams

__all__ = [
    "DynamicStiffness",
    "FrameFrequencies",
    "HybridMatrices",
    "MemberShape",
    "Mode",
    "dynamic_stiffness",
    "element_matrices",
    "hybrid_matrices",
    "log_determinant",
    "member_matrices",
    "wittrick_williams",
]
