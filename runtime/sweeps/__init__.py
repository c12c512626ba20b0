"""Sweeps at scale: pieces on any executor, resumed after a kill, estimated beforehand."""

from __future__ import annotations

from ..core.lazy import on_first_use

_PUBLIC = {
    "Sweep": "result",
    "SweepEstimate": "estimate",
    "WorkersLost": ".core.workers",
    "estimate_sweep": "estimate",
    "process_pool": ".core.workers",
    "sweep": "sweeping",
}

__all__ = ["Sweep", "SweepEstimate", "WorkersLost", "estimate_sweep", "process_pool", "sweep"]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
