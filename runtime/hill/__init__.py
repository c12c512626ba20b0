"""Hill's equation: half traces, exact and perturbation boundaries."""

from __future__ import annotations

from .half_trace import HalfTrace, discriminant, discriminant_grid
from .matrix import Boundaries, hill_boundaries
from .perturbation import perturbation_boundaries

__all__ = [
    "Boundaries",
    "HalfTrace",
    "discriminant",
    "discriminant_grid",
    "hill_boundaries",
    "perturbation_boundaries",
]
