"""Floquet analysis of linear periodic systems: boundaries, unstable bands, critical speeds.

The names load on first use: one needs little of what the others need.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .boundary_speeds import SpeedBoundaries, speed_boundaries
    from .critical import (
        MarkedSpeeds,
        mean_frequency_speeds,
        meissner_function,
        meissner_speeds,
        multiplier_maxima,
    )
    from .decoupled import (
        SlowMultipliers,
        SlowSystem,
        characteristic_exponents,
        slow_system,
        unstable_bands,
    )
    from .edges.over_geometry import TongueCurves, tongue_curves
    from .edges.over_parameter import TongueTrace, trace_tongue
    from .edges.tracing import StabilityEdges, stability_edges
    from .krein import KreinSignatures, krein_signatures

_PUBLIC = {
    "KreinSignatures": "krein",
    "MarkedSpeeds": "critical",
    "SlowMultipliers": "decoupled",
    "SlowSystem": "decoupled",
    "SpeedBoundaries": "boundary_speeds",
    "StabilityEdges": "edges.tracing",
    "TongueCurves": "edges.over_geometry",
    "TongueTrace": "edges.over_parameter",
    "characteristic_exponents": "decoupled",
    "krein_signatures": "krein",
    "mean_frequency_speeds": "critical",
    "meissner_function": "critical",
    "meissner_speeds": "critical",
    "multiplier_maxima": "critical",
    "slow_system": "decoupled",
    "speed_boundaries": "boundary_speeds",
    "stability_edges": "edges.tracing",
    "tongue_curves": "edges.over_geometry",
    "trace_tongue": "edges.over_parameter",
    "unstable_bands": "decoupled",
}

__all__ = [
    "KreinSignatures",
    "MarkedSpeeds",
    "SlowMultipliers",
    "SlowSystem",
    "SpeedBoundaries",
    "StabilityEdges",
    "TongueCurves",
    "TongueTrace",
    "characteristic_exponents",
    "krein_signatures",
    "mean_frequency_speeds",
    "meissner_function",
    "meissner_speeds",
    "multiplier_maxima",
    "slow_system",
    "speed_boundaries",
    "stability_edges",
    "tongue_curves",
    "trace_tongue",
    "unstable_bands",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
