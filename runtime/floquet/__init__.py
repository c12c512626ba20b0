"""Floquet analysis of linear periodic systems: monodromy, multipliers, critical speeds."""

from __future__ import annotations

from .boundary_speeds import SpeedBoundaries, speed_boundaries
from .edges.over_geometry import TongueCurves, tongue_curves
from .edges.over_parameter import TongueTrace, trace_tongue
from .edges.tracing import StabilityEdges, stability_edges
from .krein import KreinSignatures, krein_signatures
from .monodromy_matrix import FloquetMultipliers, Monodromy, floquet_multipliers, monodromy
from .slow_driving import SlowTongues, slow_tongues
from .tongues.resonances import Resonance, resonances
from .tongues.series import Tongue, tongue

__all__ = [
    "FloquetMultipliers",
    "KreinSignatures",
    "Monodromy",
    "Resonance",
    "SlowTongues",
    "SpeedBoundaries",
    "StabilityEdges",
    "Tongue",
    "TongueCurves",
    "TongueTrace",
    "floquet_multipliers",
    "krein_signatures",
    "monodromy",
    "resonances",
    "slow_tongues",
    "speed_boundaries",
    "stability_edges",
    "tongue",
    "tongue_curves",
    "trace_tongue",
]
