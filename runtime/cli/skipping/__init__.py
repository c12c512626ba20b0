"""What a scene does not need, and that it is not derived, emitted, imported or evaluated.

The names load on first use: the process that measures imports must not bring its own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...core.lazy import on_first_use

if TYPE_CHECKING:
    from .explanation import EmittedUse, Explanation, Stage
    from .report import EmittedCost, explain, read_cost

_PUBLIC = {
    "EmittedCost": "report",
    "EmittedUse": "explanation",
    "Explanation": "explanation",
    "Stage": "explanation",
    "explain": "report",
    "read_cost": "report",
}

__all__ = [
    "EmittedCost",
    "EmittedUse",
    "Explanation",
    "Stage",
    "explain",
    "read_cost",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
