"""Sweeps at scale: pieces on any executor, resumed after a kill, estimated beforehand."""

from __future__ import annotations

from ..core.lazy import on_first_use
from ..core.workers import WorkersLost, process_pool

_PUBLIC = {
    "Sweep": "result",
    "SweepEstimate": "estimate",
    "estimate_sweep": "estimate",
    "sweep": "sweeping",
}

__all__ = ["Sweep", "SweepEstimate", "WorkersLost", "estimate_sweep", "process_pool", "sweep"]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
