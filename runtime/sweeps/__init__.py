"""Sweeps at scale: pieces on any executor, resumed after a kill, estimated beforehand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from ..core.workers import WorkersLost as WorkersLost
    from ..core.workers import process_pool as process_pool
    from .sweeping import Sweep as Sweep
    from .sweeping import estimate_sweep as estimate_sweep
    from .sweeping import sweep as sweep

__all__ = on_first_use(globals())
