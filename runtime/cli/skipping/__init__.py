"""What a scene does not need, and that it is not derived, emitted, imported or evaluated.

The names load on first use: the process that measures imports must not bring its own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...core.lazy import on_first_use

if TYPE_CHECKING:
    from .explanation import Explanation as Explanation
    from .report import explain as explain
    from .report import read_cost as read_cost

__all__, __getattr__, __dir__ = on_first_use(
    globals(), {"explanation": ("Explanation",), "report": ("explain", "read_cost")}
)
