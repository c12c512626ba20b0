"""System families at run time.  A solver accepts a family, never a particular mechanism."""

from __future__ import annotations

from .constrained import Constrained, Guard
from .emitted import array_function
from .linear_periodic import DAMPING, MATRICES, VECTORS, Array, LinearPeriodic, Term, require_system
from .nonlinear import Drive, Nonlinear, Varied
from .transcendental import Transcendental

__all__ = [
    "DAMPING",
    "MATRICES",
    "VECTORS",
    "Array",
    "Constrained",
    "Drive",
    "Guard",
    "LinearPeriodic",
    "Nonlinear",
    "Term",
    "Transcendental",
    "Varied",
    "array_function",
    "require_system",
]
