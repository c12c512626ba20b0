"""Floquet analysis of linear periodic systems: monodromy, multipliers, critical speeds."""

from __future__ import annotations

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
from .monodromy_matrix import (
    FloquetMultipliers,
    Monodromy,
    floquet_multipliers,
    monodromy,
    relative_multipliers,
)
from .slow_driving import SlowTongues, slow_tongues
from .tongues.resonances import Resonance, resonances
from .tongues.series import Tongue, tongue

__all__ = [
    "FloquetMultipliers",
    "KreinSignatures",
    "MarkedSpeeds",
    "Monodromy",
    "Resonance",
    "SlowMultipliers",
    "SlowSystem",
    "SlowTongues",
    "SpeedBoundaries",
    "StabilityEdges",
    "Tongue",
    "TongueCurves",
    "TongueTrace",
    "characteristic_exponents",
    "floquet_multipliers",
    "krein_signatures",
    "mean_frequency_speeds",
    "meissner_function",
    "meissner_speeds",
    "monodromy",
    "multiplier_maxima",
    "relative_multipliers",
    "resonances",
    "slow_system",
    "slow_tongues",
    "speed_boundaries",
    "stability_edges",
    "tongue",
    "tongue_curves",
    "trace_tongue",
    "unstable_bands",
]
