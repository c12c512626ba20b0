"""Floquet analysis of linear periodic systems: monodromy, multipliers, critical speeds."""

from __future__ import annotations

from .boundary_speeds import SpeedBoundaries, speed_boundaries
from .edges.over_parameter import TongueTrace, trace_tongue
from .edges.tracing import StabilityEdges, stability_edges
from .krein import KreinSignatures, krein_signatures
from .monodromy_matrix import FloquetMultipliers, Monodromy, floquet_multipliers, monodromy
from .tongues.resonances import Resonance, resonances
from .tongues.series import Tongue, tongue

__all__ = [
    "FloquetMultipliers",
    "KreinSignatures",
    "Monodromy",
    "Resonance",
    "SpeedBoundaries",
    "StabilityEdges",
    "Tongue",
    "TongueTrace",
    "floquet_multipliers",
    "krein_signatures",
    "monodromy",
    "resonances",
    "speed_boundaries",
    "stability_edges",
    "tongue",
    "trace_tongue",
]
